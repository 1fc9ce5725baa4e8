// What the kernels of the flood share: numbers of the run, particles, and what the host learns of a step.

// Square cells: their south-west corner, m, size, m, and its inverse. No columns: there is nothing in them.
struct Grid {
    corner: vec2f,
    cell: f32,
    per_cell: f32,
    columns: u32,
    rows: u32,
    unused: vec2f,
}

struct Parameters {
    // West, east, south, north side of the ground, m from its centre.
    bounds: vec4f,
    // What the sides do: OPEN, WALL, PERIODIC or STAGE.
    rules: vec4u,
    // Key of the random numbers.
    key: array<vec4u, 2>,
    // The cells of the particles, of the boundary particles of obstacles, and by which outlines of obstacles are found.
    grid: Grid,
    walls: Grid,
    outlines: Grid,
    // South-west node of the ground, m; nodes per metre; patches between them.
    ground_corner: vec2f,
    ground_per_metre: vec2f,
    ground_patches: vec2u,
    // Cells over which the longest reach spreads.
    farthest: u32,
    friction: u32,
    // Manning's n, Chezy's C or the friction slope over the velocity.
    roughness: f32,
    gravity: f32,
    // Smoothing length over particle distance, and the largest, m.
    eta: f32,
    largest_h: f32,
    viscosity: f32,
    cfl: f32,
    // Time step where nothing moves, and the one at which the run has broken down, s.
    longest_step: f32,
    shortest_step: f32,
    // Volume, m3, and smoothing length, m, of a new particle; distance of particles, m.
    new_volume: f32,
    new_h: f32,
    spacing: f32,
    obstacles: u32,
    // Manning's n over the ground: south-west corner of its cells, m, cells per metre, and how many there are.
    rough_corner: vec2f,
    rough_per_metre: vec2f,
    rough_cells: vec2u,
    // Support of the sampling kernel over that of the scheme.
    smoothing: f32,
    // Where the rows of the rain are told, m/s over s; 0 where it does not rain.
    rain: u32,
    // Cells of the ground that rain falls on: per metre, how many, their area, m2, and the depth at which their film becomes a particle, m.
    patches_per_metre: vec2f,
    patches: vec2u,
    patch_area: f32,
    film: f32,
    // Smoothing length of a particle that comes of a film, m.
    drop_h: f32,
    // BALANCED or SPH_SWE.
    scheme: u32,
    // The part of a step's acceleration that comes before the particles move, and their reach over their smoothing length.
    before: f32,
    reach_over_h: f32,
    // Particles in the air at the start, and the longest step while any are, s.
    in_air: u32,
    fall_step: f32,
    // Of scheme sph-swe, in its own units.
    rest_density: f32,
    gas_constant: f32,
    sph_swe_viscosity: f32,
    clips_pressure: u32,
    control: u32,
    control_strength: f32,
    control_square: f32,
    // Smoothing length at the start, and the largest, m.
    first_h: f32,
    widest_h: f32,
    // 0, which compilers cannot tell.
    zero: u32,
    // The area for which a particle may stand, m2, the smallest volume of a half and the largest of what is merged, m3; 0 where particles
    // are not split and merged.
    widest: f32,
    smallest: f32,
    largest: f32,
    // Where lists of neighbours begin, how far the next four numbers of one are off, and how many neighbours a list takes: see `flood_near`.
    near_first: u32,
    near_stride: u32,
    most_near: u32,
}

const BALANCED = 0u;
const SPH_SWE = 1u;

const OPEN = 0u;
const WALL = 1u;
const PERIODIC = 2u;
// Held at a level over time: water leaves freely, and meets what stands beyond.
const STAGE = 3u;

// A column of water; `outside` is 0 for one inside, or the side over which it has left, from 1.
struct Particle {
    place: vec2f,
    velocity: vec2f,
    acceleration: vec2f,
    volume: f32,
    weight: f32,
    h: f32,
    next_h: f32,
    depth: f32,
    ground: f32,
    surface_slope: vec2f,
    id: u32,
    outside: u32,
}

// A particle as it lies in memory. Cards take up sixteen bytes at a time where they are told so, and a `Particle` member by member.
struct Packed {
    place_and_velocity: vec4u,
    acceleration_and_volume: vec4u,
    h_and_depth: vec4u,
    slope_and_id: vec4u,
}

fn unpacked(packed: Packed) -> Particle {
    let a = bitcast<vec4f>(packed.place_and_velocity);
    let b = bitcast<vec4f>(packed.acceleration_and_volume);
    let c = bitcast<vec4f>(packed.h_and_depth);
    let d = packed.slope_and_id;
    return Particle(a.xy, a.zw, b.xy, b.z, b.w, c.x, c.y, c.z, c.w, bitcast<vec2f>(d.xy), d.z, d.w);
}

fn packed(particle: Particle) -> Packed {
    return Packed(
        bitcast<vec4u>(vec4f(particle.place, particle.velocity)),
        bitcast<vec4u>(vec4f(particle.acceleration, particle.volume, particle.weight)),
        bitcast<vec4u>(vec4f(particle.h, particle.next_h, particle.depth, particle.ground)),
        vec4u(bitcast<vec2u>(particle.surface_slope), particle.id, particle.outside),
    );
}

// A sum that does not forget what is small (Kahan 1965): the sum and what it lacks.
struct Account {
    sum: f32,
    lacking: f32,
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
    // Water that went out and came in, m3; momentum over density that went and came, m4/s.
    outflow: Account,
    inflow: Account,
    momentum_lost: Account,
    momentum_gained: Account,
    // Force from outside at the last evaluation, m4/s2.
    from_outside: vec2f,
    mean_h: f32,
    // Time since the host last spoke at which the maps are looked at: the step that passes it is the last.
    look: f32,
    // Corners of the water.
    low: vec2f,
    high: vec2f,
    // Particles that are to come from sources, and how many of them have.
    births: u32,
    born: u32,
    // The identity of the next new particle, and steps before the host last spoke (the lowest 32 bits).
    next_id: u32,
    steps_before: u32,
    // Particles in the air.
    falling: u32,
    unused: u32,
    // Levels of sides held at one, above the level that heights are counted from, m: at the beginning of the step and at its end.
    stages: vec4f,
    next_stages: vec4f,
    // Rain and what has soaked in, m3, and when it last did by the clock, s.
    rained: Account,
    infiltrated: Account,
    wetted: f32,
    unused_too: f32,
    // Time since the cells were last laid out, s: that of all tables, as how often the host speaks must not matter.
    clock: Account,
    // Rows of gauges: how many times the host has told of, how many of them were taken before this step, how many are due in it, and how
    // many places each looks at.
    rows_told: u32,
    rows_taken: u32,
    rows_due: u32,
    gauge_places: u32,
    // Looks at the maps: how many times the host has told of, and how many of them have passed; when it was last looked, since the host
    // spoke, and for how long it had not been before that, s.
    looks_told: u32,
    looks_taken: u32,
    looked: f32,
    since_look: f32,
    // Their cells, the depth above which one is wet, m, and when the host spoke, s.
    map_cells: u32,
    wet_depth: f32,
    began: f32,
    unused_three: f32,
}

const GOING = 0u;
const ARRIVED = 1u;
const BROKEN = 2u;
// The host has said until when to go on.
const SPOKEN = 3u;

// What a group of threads sums up over its particles: in the drift, and after the forces.
struct Partial {
    outflow: f32,
    inflow: f32,
    // Momentum over density, m4/s: in the drift, what came and what went over the edges, and in the second half of the step.
    booked_in_drift: f32,
    gained_at_edges: f32,
    lost_at_edges: f32,
    booked_in_kick: f32,
    from_outside: vec2f,
    longest_step: f32,
    sum_of_h: f32,
    low: vec2f,
    high: vec2f,
}
