// What the kernels of humid air share: numbers of the run, parcels of air, and what the host learns of a step.

// Air as it comes in by a face: m/s, K and part of the mass from the ambient air's; where a new layer stands, m beyond the face.
struct Inlet {
    velocity: vec3f,
    temperature: f32,
    vapour: f32,
    behind: f32,
    unused: vec2f,
}

// A box in which air is driven along `direction` to a speed, m/s, at a rate, 1/s.
struct Fan {
    low: vec3f,
    rate: f32,
    high: vec3f,
    speed: f32,
    direction: vec3f,
    unused: f32,
}

struct Parameters {
    // Corners of the room, m from its middle; the kernels' support and the spacing, m.
    low: vec3f,
    h: f32,
    high: vec3f,
    spacing: f32,
    // What the faces do: at low and high x, low and high y; at low and high z.
    faces: array<vec4u, 2>,
    // Cells: their lowest corner, m, cells per metre, and how many along each axis.
    corner: vec3f,
    per_cell: f32,
    cells: vec3u,
    flags: u32,
    // Distance of parcels that come in by inlets, m, and how many along each axis.
    apart: vec3f,
    fans: u32,
    counts: vec3u,
    per_h: f32,
    // m/s2; artificial speed of sound, m/s; kinematic viscosity, m2/s.
    gravity: vec3f,
    sound: f32,
    driven: vec3f,
    viscosity: f32,
    // Density of the air and the one at which the pressure is that at rest, kg/m3; how dense solids are for the air.
    density: f32,
    rest_density: f32,
    kappa: f32,
    // Factors of the sums over (1 - q^2)^3, (1 - q) q q q q/|q|^2, and, over r or not, (1 - q)^2 and (1 - q), with q = r/h.
    of_filling: f32,
    of_moments: f32,
    of_pressure: f32,
    of_spread: f32,
    of_laplacian: f32,
    // Conductance over conductivity of a pair of air and solid, m; mass of a parcel, kg.
    of_pair: f32,
    mass: f32,
    // J/(kg K), J/kg, W/(m K).
    heat_capacity: f32,
    latent_heat: f32,
    // m2/s, as fast as time goes; and the largest diffusivity.
    heat_diffusivity: f32,
    vapour_diffusivity: f32,
    largest_diffusivity: f32,
    // Twice density times diffusivity of vapour, kg/(m s).
    vapour_reach: f32,
    // The ambient air, from which temperature, K, and vapour, part of the mass, are counted: also in degrees C; pressure, Pa.
    ambient: f32,
    ambient_vapour: f32,
    celsius: f32,
    air_pressure: f32,
    // Times the gradient of crowding, m2/s2; farthest that a parcel is put in a step, m.
    spreading: f32,
    farthest: f32,
    cfl: f32,
    shortest_step: f32,
    // Least speed beyond outlets, m/s.
    slowest: f32,
    // Pressure of saturated vapour at the ambient temperature, Pa, and vapour pressure of the ambient air, Pa.
    saturated: f32,
    ambient_pressure: f32,
    // 0, which no compiler knows: see `add`.
    zero: u32,
    // How far beyond an open side the last parcel of a full column stands, m, by axis; with more parcels than this the host has to make room.
    deepest: vec3f,
    full: u32,
    // Where the distances to solids are known: the first node, m, nodes per metre, and how many; air is of low utility beyond this
    // distance, m, and taken out beyond that, after so long, s.
    field_corner: vec3f,
    per_node: f32,
    nodes: vec3u,
    low_beyond: f32,
    useless_beyond: f32,
    low_after: f32,
    // How many times faster than in reality solids and water on them change.
    time_factor: f32,
    // What the ambient air lacks to be saturated, part of the mass.
    lacking: f32,
    // Temperature coefficients of viscosity, conductivity and diffusivity of vapour, 1/K, from a reference temperature that is counted from the
    // ambient air's, K. Twin of `Properties`.
    viscosity_per_kelvin: f32,
    conductivity_per_kelvin: f32,
    diffusivity_per_kelvin: f32,
    reference: f32,
    // By low and high x, y, z.
    inlets: array<Inlet, 6>,
}

// Flags.
// Air comes and goes by faces.
const IS_PASSED = 1u;
// Vapour diffuses to surfaces; else parcels that are colder than their dew point give up what they have too much.
const DIFFUSES = 2u;
const FOGS = 4u;
const SATURATES = 8u;
// Air faster than sound is refused.
const REFUSES_FAST = 16u;
// What diffuses is relative humidity.
const RELATIVE = 32u;
// Air of low utility is looked for.
const TENDS = 64u;
// No air comes or goes.
const IS_CLOSED = 128u;
// Conductivities of air and solid are harmonically averaged; else arithmetically.
const IS_HARMONIC = 256u;

// Faces.
const WALL = 0u;
const PERIODIC = 1u;
const INLET = 2u;
const OUTLET = 3u;
const OPEN = 4u;

// Roles; those of a face have its number, twice the axis and 1 for the high side, in higher bits.
const INSIDE = 0u;
const COMING = 1u;
const LEAVING = 2u;
const OUTSIDE = 3u;
const STILL = 4u;
const IDLE = 5u;
const FACE_BITS = 4u;
const ROLE_MASK = 15u;

// A sum that does not forget what is small (Kahan 1965): the sum and what it has too much.
struct Account {
    sum: f32,
    lacking: f32,
}

struct Account4 {
    sum: vec4f,
    lacking: vec4f,
}

// A parcel of air; temperature, K, and vapour, part of the mass, are counted from the ambient air's.
struct Particle {
    place: vec3f,
    density: f32,
    velocity: vec3f,
    fog: f32,
    acceleration: vec3f,
    // Water that it lays on solids near, kg, over the sum of their weights.
    deposit: f32,
    spreading: vec3f,
    id: u32,
    temperature: Account,
    vapour: Account,
    role: u32,
    // For how long it has been of low utility, s.
    idle: f32,
    unused: vec2f,
}

// A parcel as it lies in memory. Cards take up sixteen bytes at a time where they are told so, and a `Particle` member by member.
struct Packed {
    place_and_density: vec4f,
    velocity_and_fog: vec4f,
    acceleration_and_deposit: vec4f,
    spreading_and_id: vec4u,
    temperature_and_vapour: vec4f,
    role_and_idle: vec4u,
}

fn unpacked(packed: Packed) -> Particle {
    let a = packed.place_and_density;
    let b = packed.velocity_and_fog;
    let c = packed.acceleration_and_deposit;
    let d = packed.spreading_and_id;
    let e = packed.temperature_and_vapour;
    let f = packed.role_and_idle;
    let spreading = bitcast<vec3f>(d.xyz);
    return Particle(
        a.xyz, a.w, b.xyz, b.w, c.xyz, c.w, spreading, d.w, Account(e.x, e.y), Account(e.z, e.w), f.x, bitcast<f32>(f.y), vec2f(0.0)
    );
}

fn packed(particle: Particle) -> Packed {
    let temperature = particle.temperature;
    let vapour = particle.vapour;
    return Packed(
        vec4f(particle.place, particle.density),
        vec4f(particle.velocity, particle.fog),
        vec4f(particle.acceleration, particle.deposit),
        vec4u(bitcast<vec3u>(particle.spreading), particle.id),
        vec4f(temperature.sum, temperature.lacking, vapour.sum, vapour.lacking),
        vec4u(particle.role, bitcast<u32>(particle.idle), 0u, 0u),
    );
}

// What neighbours read of a parcel; its pressure over the square of the density, Pa m6/kg2.
struct Column {
    place: vec3f,
    pressure: f32,
    velocity: vec3f,
    temperature: f32,
    // By which the Laplacian is exact where particles stand as they do: xx, yy, zz and, doubled, xy, xz, yz.
    diagonal: vec3f,
    vapour: f32,
    doubled: vec3f,
    // What of the vapour diffuses: its part of the mass, or relative humidity.
    humidity: f32,
}

// The same as it lies in memory: who looks for neighbours needs the first part of those out of reach.
struct PackedColumn {
    place_and_pressure: vec4f,
    velocity_and_temperature: vec4f,
    diagonal_and_vapour: vec4f,
    doubled_and_humidity: vec4f,
}

fn unpacked_column(packed: PackedColumn) -> Column {
    let a = packed.place_and_pressure;
    let b = packed.velocity_and_temperature;
    let c = packed.diagonal_and_vapour;
    let d = packed.doubled_and_humidity;
    return Column(a.xyz, a.w, b.xyz, b.w, c.xyz, c.w, d.xyz, d.w);
}

// e^T Q e of a tensor of a column for an offset. Twin of `factor` in `normalisation.rs`.
fn factor(diagonal: vec3f, doubled: vec3f, offset: vec3f) -> f32 {
    let across = offset.xxy * offset.yzz;
    return (dot(diagonal, offset * offset) + dot(doubled, across)) / max(dot(offset, offset), 1e-30);
}

// What a group of threads sums up over its parcels: numbers, and temperature, vapour and fog, of those that came and went; what
// diffused, K/s and 1/s; vapour that became fog; the longest step, s, and the fastest, m2/s2.
struct Partial {
    came: vec4f,
    went: vec4f,
    diffused: vec2f,
    fogged: f32,
    longest: f32,
    fastest: f32,
}

// Sums over the air before a face, along the face's axis.
struct BeforeOutlet {
    // Within a smoothing length: acceleration, m/s2, velocity, m/s, and number.
    near: vec3f,
    // Nearest to it: `spreading`, m/s2, and number.
    nearest: vec2f,
}

struct Status {
    // These two first: the sort reads them.
    particles: u32,
    cells: u32,
    halted: u32,
    steps: u32,
    // Particle-steps, low and high half.
    particle_steps: vec2u,
    // The next step, s; and time since the host last spoke, s, with that at which to halt.
    step: f32,
    until: f32,
    elapsed: Account,
    next_id: u32,
    // The fastest parcel in the last step, m2/s2.
    fastest: f32,
    came: Account4,
    went: Account4,
    // Over the mass of a parcel: water that diffused in and out over faces, and energy, J/kg.
    diffused: Account4,
    fogged: Account,
    // Time since the state was sent, s.
    time: Account,
    // How far the air before each inlet has come since its last layer, m.
    phase: array<Account, 6>,
    // What air beyond each outlet is faster by, m/s.
    before: array<f32, 6>,
    // The mean `spreading` nearest to each outlet along its axis, m/s2; by how much the air beyond it is denser than at rest, over its
    // density at rest; and the running mean of the velocity along its axis of the air before it, m/s.
    spreading_before: array<f32, 6>,
    density_excess_beyond: array<f32, 6>,
    running_mean_before: array<f32, 6>,
    // When it was last looked for air of low utility, s since the state was sent; and the number of the batch's first step, from one that is
    // a multiple of `TURN`.
    seen: Account,
    turn: u32,
    spare: array<u32, 3>,
    // What all air of a closed room gains in the next step for accelerated time: temperature, K, and vapour, part of the mass.
    drift: vec2f,
    // How long the steps were, s.
    lengths: array<f32, 64>,
}

const GOING = 0u;
const ARRIVED = 1u;
const BROKEN = 2u;
// The host has said until when to go on.
const SPOKEN = 3u;
// There may be too little room for what comes in the next step.
const FULL = 4u;

const FAR = 3.0e38;

// It is looked for air of low utility once in so many steps: see `utility.rs`.
const TURN = 10u;

@group(0) @binding(0) var<uniform> parameters: Parameters;

// Temperature from that at which the air's properties are as told, K.
fn from_reference(temperature: f32) -> f32 {
    return temperature - parameters.reference;
}

fn face(number: u32) -> u32 {
    return parameters.faces[number / 4u][number % 4u];
}

// A coordinate beyond a side, mirrored at it, but not beyond the opposite side. Twin of `Room::mirrored_inside`.
fn mirrored_inside(at: f32, number: u32) -> f32 {
    let low = parameters.low[number / 2u];
    let high = parameters.high[number / 2u];
    // The largest number below the high side.
    let last = bitcast<f32>(bitcast<u32>(high) - 1u);
    return clamp(2.0 * select(high, low, number % 2u == 0u) - at, low, last);
}

fn is_set(flag: u32) -> bool {
    return (parameters.flags & flag) != 0u;
}

// A number that compilers cannot tell: some take (a + b) - a for b, and what a sum has too much for 0.
fn opaque(number: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(number) ^ parameters.zero);
}

fn add(account: Account, value: f32) -> Account {
    let more = value - account.lacking;
    let sum = opaque(account.sum + more);
    return Account(sum, opaque(sum - account.sum) - more);
}

fn add4(account: Account4, value: vec4f) -> Account4 {
    let more = value - account.lacking;
    let sum = bitcast<vec4f>(bitcast<vec4u>(account.sum + more) ^ vec4u(parameters.zero));
    let added = bitcast<vec4f>(bitcast<vec4u>(sum - account.sum) ^ vec4u(parameters.zero));
    return Account4(sum, added - more);
}

fn value(account: Account) -> f32 {
    return account.sum - account.lacking;
}
