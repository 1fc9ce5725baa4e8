// How dense the air is and how its particles stand about each other, solids among them, and what neighbours read of each. Twin of
// `air/density.rs`, of `add_density` and `add_moments` in `walls.rs`, and of `fill_columns` in `dew/motion.rs`.
#import dew_neighbours
#import dew_humid
#import dew_normalisation

// Filling and moments by the air, itself included.
fn of_air(i: u32, position: vec3f, moments: ptr<function, Moments>) -> f32 {
    var filling = value_shape(0.0);
    let mirrors = mirrors_round(position);
    for (var k = 0u; k < mirrors; k++) {
        let mirror = mirror(k, position);
        let truth = behind(mirror, position);
        let low = cell_index(truth - parameters.h);
        let high = cell_index(truth + parameters.h);
        for (var z = low.z; z <= high.z; z++) {
            for (var y = low.y; y <= high.y; y++) {
                let across = columns_round(truth, y, z);
                let row = row_of(y, z);
                let end = start[row + across.y + 1u];
                var of_row = Moments();
                for (var j = start[row + across.x]; j < end; j++) {
                    let away = (shown(mirror, spots[j].xyz) - position) * parameters.per_h;
                    let q_squared = dot(away, away);
                    if q_squared >= 1.0 || (j == i && k == 0u) {
                        continue;
                    }
                    filling += value_shape(q_squared);
                    add_moments(&of_row, away, 1.0);
                }
                join(moments, of_row);
            }
        }
    }
    return filling;
}

// The same by solids: their particles and ghost samples.
fn of_solids(position: vec3f, moments: ptr<function, Moments>) -> f32 {
    var filling = 0.0;
    let low = cell_index(position - parameters.h);
    let high = cell_index(position + parameters.h);
    for (var z = low.z; z <= high.z; z++) {
        for (var y = low.y; y <= high.y; y++) {
            let across = columns_round(position, y, z);
            let row = row_of(y, z);
            let end = site_start[row + across.y + 1u];
            var of_row = Moments();
            for (var k = site_start[row + across.x]; k < end; k++) {
                let away = (sites[k].position - position) * parameters.per_h;
                let q_squared = dot(away, away);
                if q_squared >= 1.0 {
                    continue;
                }
                let flags = sites[k].flags;
                if (flags & GHOST) != 0u {
                    filling += sites[k].volume * value_shape(q_squared);
                    continue;
                }
                if (flags & JOINS_DENSITY) != 0u {
                    filling += parameters.kappa * sites[k].volume * value_shape(q_squared);
                }
                add_moments(&of_row, away, sites[k].volume);
            }
            join(moments, of_row);
        }
    }
    return filling;
}

// Twin of `Room::outlet_near`.
fn outlet_near(position: vec3f) -> u32 {
    for (var number = 0u; number < NO_FACE; number++) {
        let axis = number / 2u;
        let to = select(parameters.high[axis] - position[axis], position[axis] - parameters.low[axis], number % 2u == 0u);
        if to < parameters.h && face(number) == OUTLET {
            return number;
        }
    }
    return NO_FACE;
}

fn density_of(particle: Particle, filling: f32) -> f32 {
    let density = parameters.density * filling;
    let role = particle.role & ROLE_MASK;
    if role == STILL || role == IDLE {
        // Where it no longer matters, the air is as it is at rest.
        return parameters.rest_density;
    }
    if role == LEAVING {
        return parameters.rest_density * (1.0 + status.density_excess_beyond[particle.role >> FACE_BITS]);
    }
    if role == OUTSIDE {
        // What comes in has come from rest (Bernoulli).
        let number = particle.role >> FACE_BITS;
        let velocity = particle.velocity[number / 2u];
        let inward = max(select(-velocity, velocity, number % 2u == 0u), 0.0) / parameters.sound;
        return parameters.rest_density * (1.0 - 0.5 * inward * inward);
    }
    let outlet = outlet_near(particle.position);
    if outlet != NO_FACE {
        // Where air would flow back in there is none beyond: that must not suck.
        return max(density, parameters.rest_density * (1.0 + status.density_excess_beyond[outlet]));
    }
    return density;
}

// Relative humidity referred to the ambient temperature, less that of the ambient air.
fn relative_humidity(vapour: f32) -> f32 {
    let fraction = parameters.ambient_vapour + vapour;
    let pressure = parameters.air_pressure * fraction / (MASS_RATIO + (1.0 - MASS_RATIO) * fraction);
    return (pressure - parameters.ambient_pressure) / parameters.saturated;
}

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i >= status.particles {
        return;
    }
    var particle = unpacked(ordered[i]);
    var moments = Moments();
    let filling = of_air(i, particle.position, &moments) + of_solids(particle.position, &moments);
    particle.density = density_of(particle, parameters.of_filling * filling);
    let tensor = normalised(moments);
    var velocity = particle.velocity;
    if particle.role == INSIDE {
        velocity += 0.5 * status.step * particle.acceleration;
    }
    let density = particle.density;
    let pressure = parameters.sound * parameters.sound * (density - parameters.rest_density) / (density * density);
    let temperature = total(particle.temperature);
    let vapour = total(particle.vapour);
    var humidity = vapour;
    if is_set(RELATIVE) {
        humidity = relative_humidity(vapour);
    }
    columns[i] = PackedColumn(
        vec4f(particle.position, pressure),
        vec4f(velocity, temperature),
        vec4f(tensor.diagonal, vapour),
        vec4f(tensor.others, humidity),
    );
    particles[i] = packed(particle);
}
