// What air and solids do to an air particle, the second half of its kick, heat and vapour of the whole step, and what it then has beyond
// saturation. Twin of `air/pairs.rs`, `walls.rs`, `Exchange::to_one`, and of `kick` in `dew/motion.rs`.
#import dew_neighbours
#import dew_humid
#import dew_saturate
#import group_reduction

// What neighbours do: by pressure and viscosity, m/s2; gradient of crowding, 1/m; K/s; 1/s; weights of the Laplacian, 1/m2.
struct Rates {
    acceleration: vec3f,
    spread: vec3f,
    warming: f32,
    moistening: f32,
    weights: f32,
}

// Distances, in h, below which two positions are one.
const NOTHING = 1e-9;

fn of_air(i: u32, own: Column) -> Rates {
    var push = vec3f(0.0);
    var shear = vec3f(0.0);
    var spread = vec3f(0.0);
    var warming = 0.0;
    var moistening = 0.0;
    var weights = 0.0;
    let mirrors = mirrors_round(own.position);
    for (var k = 0u; k < mirrors; k++) {
        let mirror = mirror(k, own.position);
        let truth = behind(mirror, own.position);
        let low = cell_index(truth - parameters.h);
        let high = cell_index(truth + parameters.h);
        for (var z = low.z; z <= high.z; z++) {
            for (var y = low.y; y <= high.y; y++) {
                let across = columns_round(truth, y, z);
                let row = row_of(y, z);
                let end = start[row + across.y + 1u];
                for (var j = start[row + across.x]; j < end; j++) {
                    let away = own.position - shown(mirror, columns[j].position_and_pressure.xyz);
                    let r = length(away);
                    let q = r * parameters.per_h;
                    if q >= 1.0 || q < NOTHING || (j == i && k == 0u) {
                        continue;
                    }
                    let near = unpacked_column(columns[j]);
                    let velocity = mirror.sign * near.velocity;
                    let slope = slope_shape(q) / r;
                    let approach = max(-dot(own.velocity - velocity, away) / r, 0.0);
                    let damping = min(DAMPING * approach, parameters.sound) * approach / parameters.density;
                    // Monaghan 1992, equation 3.1.
                    push += (near.pressure + own.pressure + damping) * slope * parameters.of_pressure * away;
                    spread += slope * away;
                    // Both tensors, the neighbour's as the mirror shows it; halved by `of_laplacian`.
                    let doubled = own.doubled + mirror.sign.xxy * mirror.sign.yzz * near.doubled;
                    let even = factor(own.diagonal + near.diagonal, doubled, away);
                    let weight = laplacian_shape(q) * even * parameters.of_laplacian;
                    let above = from_reference(0.5 * (near.temperature + own.temperature));
                    shear += weight * (1.0 + parameters.viscosity_per_kelvin * above) * (velocity - own.velocity);
                    // Differences of Kirchhoff's transforms, without losing the digits of small ones.
                    warming += weight * (1.0 + parameters.conductivity_per_kelvin * above) * (near.temperature - own.temperature);
                    moistening += weight * (1.0 + parameters.diffusivity_per_kelvin * above) * (near.humidity - own.humidity);
                    weights += weight;
                }
            }
        }
    }
    return Rates(
        push + parameters.viscosity * shear,
        parameters.of_spread * spread,
        parameters.heat_diffusivity * warming,
        parameters.vapour_diffusivity * moistening,
        weights,
    );
}

fn repulsion(r: f32) -> f32 {
    let over = RANGE * parameters.spacing / r;
    let ratio = over * over;
    let force = STRENGTH * parameters.sound * parameters.sound * (ratio * ratio - ratio) / r;
    return select(0.0, force, ratio > 1.0);
}

// The wall has the air's own pressure; air that comes against it is held up (Joukowsky 1898). Twin of `Push::press`.
fn pressed(own: Column, spread: vec3f) -> vec3f {
    let inward = -dot(own.velocity, spread) / max(length(spread), 1e-30);
    return (parameters.density * own.pressure + parameters.sound * max(inward, 0.0)) * spread;
}

// What solids give: K/s, 1/s, and how stiff that is, 1/s.
struct Given {
    warming: f32,
    moistening: f32,
    stiffness: f32,
    // Warming and moistening by ghost particles beyond sides that air passes.
    from_beyond: vec2f,
}

// Adds what one site gives to an air particle.
fn give(given: ptr<function, Given>, site: Site, own: Column, away: vec3f, q: f32) {
    let surface = surfaces[site.particle];
    let flux = flux(site, surface, own, away, q);
    let water = select(flux.water, surface.share * flux.water, flux.water < 0.0);
    let capacity = parameters.mass * parameters.heat_capacity;
    let released = (1.0 - site.part) * parameters.latent_heat * water;
    let rates = vec2f((released - flux.to_air * flux.difference) / capacity, -water / parameters.mass);
    (*given).warming += rates.x;
    (*given).moistening += rates.y;
    (*given).from_beyond += select(vec2f(0.0), rates, (site.flags & GHOST_PARTICLE_BEYOND) != 0u);
    (*given).stiffness += flux.to_air / capacity;
}

// Adds what solids do to the motion; what they give.
fn of_solids(own: Column, rates: ptr<function, Rates>) -> Given {
    var given = Given(0.0, 0.0, 0.0, vec2f(0.0));
    // By the density correction, by ghost samples, and by virtual forces.
    var corrected = vec3f(0.0);
    var ghostly = vec3f(0.0);
    var repelled = vec3f(0.0);
    var stuck = 0.0;
    let low = cell_index(own.position - parameters.h);
    let high = cell_index(own.position + parameters.h);
    for (var z = low.z; z <= high.z; z++) {
        for (var y = low.y; y <= high.y; y++) {
            let across = columns_round(own.position, y, z);
            let row = row_of(y, z);
            let end = site_start[row + across.y + 1u];
            for (var k = site_start[row + across.x]; k < end; k++) {
                let site = sites[k];
                let away = own.position - site.position;
                let r = max(length(away), 1e-9 * parameters.spacing);
                let q = r * parameters.per_h;
                if q >= 1.0 {
                    continue;
                }
                let slope = parameters.of_spread * site.volume * slope_shape(q) / r;
                if (site.flags & GHOST) != 0u {
                    ghostly += slope * away;
                    continue;
                }
                if (site.flags & JOINS_DENSITY) != 0u {
                    corrected += parameters.kappa * slope * away;
                } else if (site.flags & REPELS) != 0u {
                    repelled += repulsion(r) / r * away;
                }
                stuck += site.volume * laplacian_shape(q) * factor(own.diagonal, own.doubled, away);
                give(&given, site, own, away, q);
            }
        }
    }
    // Air at a wall is at rest: viscosity against a wall half way between the air and the site.
    let weight = 2.0 * parameters.of_laplacian * stuck;
    (*rates).acceleration += pressed(own, corrected) + pressed(own, ghostly) + repelled
        - 2.0 * parameters.viscosity * (1.0 + parameters.viscosity_per_kelvin * from_reference(own.temperature)) * weight * own.velocity;
    (*rates).spread += corrected + ghostly;
    (*rates).weights += 2.0 * weight;
    return given;
}

// What fans and the weight of warm and moist air add to the acceleration. Twin of `Fan::acceleration` and of `kick`.
fn driving(particle: Particle) -> vec3f {
    var driven = parameters.driven;
    for (var number = 0u; number < parameters.fans; number++) {
        let fan = fans[number];
        if all(particle.position >= fan.low) && all(particle.position < fan.high) {
            driven += fan.rate * max(fan.speed - dot(particle.velocity, fan.direction), 0.0) * fan.direction;
        }
    }
    // Boussinesq, by differences from the ambient air (Stull 1988, equation 1.5.1).
    let moist = 1.0 + VAPOUR_LIGHTNESS * parameters.ambient_vapour;
    let temperature = total(particle.temperature);
    let lighter = temperature * moist + (parameters.ambient + temperature) * VAPOUR_LIGHTNESS * total(particle.vapour);
    return driven - lighter / (parameters.ambient * moist) * parameters.gravity;
}

// How fast the mass fraction grows with relative humidity. Twin of `HumidAir::mass_fraction_slope`.
fn fraction_by_humidity(vapour: f32) -> f32 {
    let fraction = parameters.ambient_vapour + vapour;
    let pressure = parameters.air_pressure * fraction / (MASS_RATIO + (1.0 - MASS_RATIO) * fraction);
    let rest = parameters.air_pressure - (1.0 - MASS_RATIO) * pressure;
    return parameters.saturated * MASS_RATIO * parameters.air_pressure / (rest * rest);
}

// The longest step after this one; 0 where anything is not a number, which must not be lost in a minimum.
fn longest_step(speed_squared: f32, acceleration_squared: f32, stiffest: f32) -> f32 {
    let by_sound = parameters.cfl * parameters.h / (parameters.sound + sqrt(speed_squared));
    let by_force = ACCELERATION_LIMIT * sqrt(parameters.spacing / max(sqrt(acceleration_squared), 1e-30));
    let by_diffusion = DIFFUSION_LIMIT / max(stiffest, 1e-30);
    let are_numbers = speed_squared < FAR && acceleration_squared < FAR && stiffest < FAR;
    return select(0.0, min(min(by_sound, by_force), by_diffusion), are_numbers);
}

// What a particle adds to the sums of its group: what diffused and what became fog; the longest step, and the square of its speed.
struct Kicked {
    diffused: vec2f,
    fogged: f32,
    longest: f32,
    fastest: f32,
}

// Kicks a particle; what it adds to the sums.
fn kicked(particle: ptr<function, Particle>, own: Column, air: Rates) -> Kicked {
    var rates = air;
    let given = of_solids(own, &rates);
    // What passes between air and ghost particles beyond is not of the solids.
    var diffused = given.from_beyond - vec2f(given.warming, given.moistening);
    var fogged = 0.0;
    (*particle).deposit = 0.0;
    if (*particle).role == INSIDE {
        diffused = vec2f(rates.warming, rates.moistening) + given.from_beyond;
        let step = status.step;
        (*particle).acceleration = rates.acceleration + driving(*particle);
        (*particle).velocity += 0.5 * step * (*particle).acceleration;
        (*particle).spreading = parameters.spreading * rates.spread;
        (*particle).temperature = add((*particle).temperature, step * (rates.warming + given.warming) + status.drift.x);
        (*particle).vapour = add((*particle).vapour, step * (rates.moistening + given.moistening) + status.drift.y);
    }
    let speed = dot((*particle).velocity, (*particle).velocity);
    let acceleration = dot((*particle).acceleration, (*particle).acceleration);
    let steepest = max(max(parameters.viscosity_per_kelvin, parameters.conductivity_per_kelvin), parameters.diffusivity_per_kelvin);
    let warmer = max(1.0 + steepest * from_reference(own.temperature), 1.0);
    let stiffest = max(parameters.largest_diffusivity * warmer * rates.weights, given.stiffness);
    if (*particle).role == INSIDE && is_set(SATURATES) {
        fogged = saturate(particle);
    }
    return Kicked(diffused, fogged, longest_step(speed, acceleration, stiffest), speed);
}

alias Reduced = Kicked;

fn combine(a: Reduced, b: Reduced) -> Reduced {
    return Kicked(a.diffused + b.diffused, a.fogged + b.fogged, min(a.longest, b.longest), max(a.fastest, b.fastest));
}

@compute @workgroup_size(GROUP)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    let i = id.x;
    var part = Kicked(vec2f(0.0), 0.0, FAR, 0.0);
    if i < status.particles {
        let own = unpacked_column(columns[i]);
        var particle = unpacked(particles[i]);
        var rates = of_air(i, own);
        if is_set(RELATIVE) {
            rates.moistening *= fraction_by_humidity(own.vapour);
        }
        part = kicked(&particle, own, rates);
        particles[i] = packed(particle);
    }
    let all = reduce_group(thread, part);
    if thread == 0u {
        partials[group.x].diffused = all.diffused;
        partials[group.x].fogged = all.fogged;
        partials[group.x].longest = all.longest;
        partials[group.x].fastest = all.fastest;
    }
}
