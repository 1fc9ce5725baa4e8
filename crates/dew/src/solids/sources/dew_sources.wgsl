// Heat that solids get from their heaters, from outside the box and by radiation: a group for each solid. Twin of `HeatSources::add_heat` and
// `Conditions::flux` in `solids/sources/mod.rs`.
#import dew_particles
#import dew_rows
#import group_reduction

// Surroundings at a time; temperatures from the ambient air's, K.
struct Conditions {
    transfer_coefficient: f32,
    emissivity_sigma: f32,
    air_temperature: f32,
    radiant_temperature: f32,
}

var<workgroup> power: f32;
var<workgroup> outside: Conditions;
var<workgroup> radiation: Conditions;

alias Reduced = vec3f;

fn combine(a: Reduced, b: Reduced) -> Reduced {
    return a + b;
}

fn value_of(first: u32, end: u32, time: vec2f) -> f32 {
    if first >= end {
        return 0.0;
    }
    return value_at(first, end, time);
}

fn conditions_at(around: Surroundings, time: vec2f) -> Conditions {
    let air = value_of(around.air_first, around.air_end, time);
    let radiant = value_of(around.radiant_first, around.radiant_end, time);
    return Conditions(around.transfer_coefficient, around.emissivity_sigma, air, radiant);
}

// Heat transfer coefficient of radiation between a surface of that temperature and the surroundings, W/(m2 K).
fn radiation_coefficient(conditions: Conditions, surface: f32) -> f32 {
    let a = parameters.ambient + conditions.radiant_temperature;
    let b = parameters.ambient + surface;
    return conditions.emissivity_sigma * (a + b) * (a * a + b * b);
}

// Heat flux into a surface of that temperature, W/m2, and by how much it falls with the temperature, W/(m2 K).
fn flux_at(conditions: Conditions, surface: f32) -> vec2f {
    let b = parameters.ambient + surface;
    let slope = conditions.transfer_coefficient + 4.0 * conditions.emissivity_sigma * b * b * b;
    let convected = conditions.transfer_coefficient * (conditions.air_temperature - surface);
    let radiated = radiation_coefficient(conditions, surface) * (conditions.radiant_temperature - surface);
    return vec2f(convected + radiated, slope);
}

// Heat, W, and conductance, W/K, of a part of the surface before a particle.
fn heat(conditions: Conditions, part: Part, temperature: f32) -> vec2f {
    if part.area <= 0.0 {
        return vec2f(0.0);
    }
    let coefficient = conditions.transfer_coefficient + radiation_coefficient(conditions, temperature);
    var difference = part.resistance * flux_at(conditions, temperature).x / (1.0 + part.resistance * coefficient);
    for (var k = 0u; k < ITERATIONS; k++) {
        let flux = flux_at(conditions, temperature + difference);
        difference += (part.resistance * flux.x - difference) / (1.0 + part.resistance * flux.y);
    }
    let flux = flux_at(conditions, temperature + difference);
    return part.area * vec2f(flux.x, flux.y / (1.0 + part.resistance * flux.y));
}

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) thread: u32) {
    let body = bodies[group.x];
    if thread == 0u {
        let middle = add(status.time, 0.5 * status.step);
        let source = sources[group.x];
        power = source.power_factor * value_of(source.power_first, source.power_end, middle);
        outside = conditions_at(source.outside, middle);
        radiation = conditions_at(source.radiation, middle);
    }
    workgroupBarrier();
    var own = vec3f(0.0);
    for (var i = body.first + thread; i < body.end; i += GROUP) {
        let share = shares[i];
        let temperature = total(solids[i].temperature);
        let from_outside = heat(outside, share.outside, temperature);
        let radiated = heat(radiation, share.radiation, temperature);
        let all = vec3f(share.heater * power, from_outside.x, radiated.x);
        surfaces[i].all_heat += all.x + all.y + all.z;
        surfaces[i].conductance += from_outside.y + radiated.y;
        own += all;
    }
    let all = reduce_group(thread, own);
    if thread == 0u {
        let supplied = parameters.time_factor * status.step * all;
        for (var kind = 0u; kind < 3u; kind++) {
            sources[group.x].supplied[kind] = add(sources[group.x].supplied[kind], supplied[kind]);
        }
    }
}
