// Heat that solids get from their heaters, from outside the box and by radiation: a group for each solid. Twin of `Sources::give` and `Seen::heat` in
// `solids/sources/mod.rs`.
#import dew_solids
#import dew_rows

// A part of a surface: m2; distance to the particle over the conductivity, m2 K/W.
struct Part {
    area: f32,
    resistance: f32,
}

// What a particle has of its solid's sources: part of the heater's power; what of it is in a side of the box, and in the box.
struct Share {
    heater: f32,
    unused: f32,
    outside: Part,
    radiation: Part,
}

// What a surface exchanges heat with: W/(m2 K); emissivity times the Stefan-Boltzmann constant, W/(m2 K4); rows of the temperature of the air and
// of what is seen.
struct Surroundings {
    transfer: f32,
    radiance: f32,
    air_first: u32,
    air_end: u32,
    seen_first: u32,
    seen_end: u32,
}

// Sources of a solid: power over the numbers in its rows, and those rows; and the heat that came from each kind, J.
struct Source {
    heated: f32,
    unused: f32,
    power_first: u32,
    power_end: u32,
    outside: Surroundings,
    radiation: Surroundings,
    given: array<Account, 3>,
}

// What a surface sees now; temperatures from the ambient air's, K.
struct Seen {
    transfer: f32,
    radiance: f32,
    air: f32,
    seen: f32,
}

@group(0) @binding(1) var<storage, read> status: Status;
@group(0) @binding(2) var<storage, read> solids: array<Solid>;
@group(0) @binding(3) var<storage, read_write> surfaces: array<Surface>;
@group(0) @binding(5) var<storage, read> shares: array<Share>;
@group(0) @binding(6) var<storage, read> bodies: array<Body>;
@group(0) @binding(7) var<storage, read_write> sources: array<Source>;

const ITERATIONS = 5u;

var<workgroup> power: f32;
var<workgroup> outside: Seen;
var<workgroup> radiation: Seen;
var<workgroup> sums: array<vec3f, 256>;

fn value_of(first: u32, end: u32, time: Account) -> f32 {
    if first >= end {
        return 0.0;
    }
    return value_at(first, end, time);
}

fn seen_at(around: Surroundings, time: Account) -> Seen {
    let air = value_of(around.air_first, around.air_end, time);
    return Seen(around.transfer, around.radiance, air, value_of(around.seen_first, around.seen_end, time));
}

// Heat into a surface of that temperature, W/m2, and how much less it is for each K more.
fn heat_at(seen: Seen, surface: f32) -> vec2f {
    let a = parameters.ambient + seen.seen;
    let b = parameters.ambient + surface;
    let radiated = seen.radiance * (seen.seen - surface) * (a + b) * (a * a + b * b);
    return vec2f(seen.transfer * (seen.air - surface) + radiated, seen.transfer + 4.0 * seen.radiance * b * b * b);
}

// Heat, W, and conductance, W/K, of a part of the surface before a particle.
fn heat(seen: Seen, part: Part, temperature: f32) -> vec2f {
    if part.area <= 0.0 {
        return vec2f(0.0);
    }
    var warmer = 0.0;
    for (var k = 0u; k < ITERATIONS; k++) {
        let flux = heat_at(seen, temperature + warmer);
        warmer += (part.resistance * flux.x - warmer) / (1.0 + part.resistance * flux.y);
    }
    let flux = heat_at(seen, temperature + warmer);
    return part.area * vec2f(flux.x, flux.y / (1.0 + part.resistance * flux.y));
}

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) thread: u32) {
    let body = bodies[group.x];
    if thread == 0u {
        let middle = add(status.time, 0.5 * status.step);
        let source = sources[group.x];
        power = source.heated * value_of(source.power_first, source.power_end, middle);
        outside = seen_at(source.outside, middle);
        radiation = seen_at(source.radiation, middle);
    }
    workgroupBarrier();
    var own = vec3f(0.0);
    for (var i = body.first + thread; i < body.end; i += 256u) {
        let share = shares[i];
        let temperature = value(solids[i].temperature);
        let from_outside = heat(outside, share.outside, temperature);
        let radiated = heat(radiation, share.radiation, temperature);
        let all = vec3f(share.heater * power, from_outside.x, radiated.x);
        surfaces[i].all_heat += all.x + all.y + all.z;
        surfaces[i].conductance += from_outside.y + radiated.y;
        own += all;
    }
    sums[thread] = own;
    workgroupBarrier();
    for (var half = 128u; half > 0u; half /= 2u) {
        if thread < half {
            sums[thread] += sums[thread + half];
        }
        workgroupBarrier();
    }
    if thread == 0u {
        let given = parameters.time_factor * status.step * sums[0];
        for (var kind = 0u; kind < 3u; kind++) {
            sources[group.x].given[kind] = add(sources[group.x].given[kind], given[kind]);
        }
    }
}
