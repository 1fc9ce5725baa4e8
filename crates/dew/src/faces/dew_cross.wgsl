// Sets each particle's role by its position, books inflow and outflow, and counts the particles of cells and before open sides.
// Twin of `cross` and `cross_faces` in `faces/mod.rs`, and of `OpenSide::sample_velocities` in `faces/open.rs`.
#import dew_neighbours
#import dew_columns
#import dew_utility
#import group_reduction

// Inflow and outflow of a particle: see `booked`.
struct Crossed {
    came: vec4f,
    went: vec4f,
}

// By this thread's particle.
var<private> crossed: Crossed;

alias Reduced = Crossed;

fn combine(a: Crossed, b: Crossed) -> Crossed {
    return Crossed(a.came + b.came, a.went + b.went);
}

fn depth_beyond(position: vec3f, number: u32) -> f32 {
    let axis = number / 2u;
    return select(position[axis] - parameters.high[axis], parameters.low[axis] - position[axis], number % 2u == 0u);
}

struct Beyond {
    // The face that air passes beyond which a position lies, an open one before others.
    number: u32,
    // Whether it lies beyond two faces or more, one of them open.
    is_edge: bool,
}

// Twin of `Room::beyond` and `Room::is_beyond_edge`.
fn beyond(position: vec3f) -> Beyond {
    var passed = NO_FACE;
    var open = NO_FACE;
    var count = 0u;
    for (var number = 0u; number < NO_FACE; number++) {
        let axis = number / 2u;
        let is_beyond = select(position[axis] >= parameters.high[axis], position[axis] < parameters.low[axis], number % 2u == 0u);
        if !is_beyond {
            continue;
        }
        count += 1u;
        if face(number) >= INLET && passed == NO_FACE {
            passed = number;
        }
        if face(number) == OPEN && open == NO_FACE {
            open = number;
        }
    }
    return Beyond(select(open, passed, open == NO_FACE), open != NO_FACE && count > 1u);
}

// Twin of `Particle::leave`.
fn leave(particle: ptr<function, Particle>, number: u32, speed: f32) {
    let outward = select(1.0, -1.0, number % 2u == 0u);
    (*particle).role = LEAVING | (number << FACE_BITS);
    (*particle).velocity[number / 2u] = outward * max(outward * speed, parameters.slowest);
}

fn booked(particle: Particle) -> vec4f {
    return vec4f(1.0, total(particle.temperature), total(particle.vapour), particle.fog);
}

// Twin of `Room::hold_at_inlets`.
fn hold_at_inlets(particle: ptr<function, Particle>) {
    for (var number = 0u; number < NO_FACE; number++) {
        let axis = number / 2u;
        let at = (*particle).position[axis];
        if face(number) == INLET && select(at >= parameters.high[axis], at < parameters.low[axis], number % 2u == 0u) {
            (*particle).position[axis] = mirrored_inside(at, number);
            (*particle).velocity[axis] = parameters.inlets[number].velocity[axis];
        }
    }
}

// Whether it is removed.
fn cross_over(particle: ptr<function, Particle>) -> bool {
    let role = (*particle).role & ROLE_MASK;
    if role == INSIDE {
        hold_at_inlets(particle);
    }
    let beyond = beyond((*particle).position);
    let number = beyond.number;
    let held = booked(*particle);
    if (role == INSIDE || role == IDLE) && number != NO_FACE {
        // Air of low utility is booked as outflow already.
        crossed.went = select(vec4f(0.0), held, role == INSIDE);
        if beyond.is_edge {
            return true;
        }
        if face(number) == OPEN {
            (*particle).role = OUTSIDE | (number << FACE_BITS);
        } else {
            leave(particle, number, (*particle).velocity[number / 2u]);
            (*particle).spreading = vec3f(0.0);
            (*particle).spreading[number / 2u] = status.spreading_before[number];
        }
    } else if role == LEAVING {
        let left = (*particle).role >> FACE_BITS;
        leave(particle, left, (*particle).velocity[left / 2u] + status.before[left]);
    } else if (role == COMING || role == OUTSIDE) && number == NO_FACE {
        (*particle).role = INSIDE;
        crossed.came = held;
    }
    let now = (*particle).role & ROLE_MASK;
    return (now == LEAVING || now == OUTSIDE) && !(depth_beyond((*particle).position, (*particle).role >> FACE_BITS) < BEYOND * parameters.h);
}

// What a particle in the room before an open side adds to its column, and how far beyond one outside is.
fn mark_columns(particle: Particle) {
    if (particle.role & ROLE_MASK) == OUTSIDE {
        let number = particle.role >> FACE_BITS;
        atomicMax(&columns_before[column_of(number, particle.position)].outermost, bits_of_depth(depth_beyond(particle.position, number)));
    }
    for (var number = 0u; number < NO_FACE; number++) {
        if particle.role != INSIDE || face(number) != OPEN || depth_beyond(particle.position, number) <= -parameters.h {
            continue;
        }
        // Towards the pressure of the air outside: see `move_outside`.
        let outward = select(1.0, -1.0, number % 2u == 0u);
        let along = particle.velocity[number / 2u];
        let inward = max(-outward * along, 0.0);
        let sound = parameters.sound;
        let rise = sound * (particle.density / parameters.rest_density - 1.0) + 0.5 * inward * inward / sound;
        let column = column_of(number, particle.position);
        atomicAdd(&columns_before[column].velocity, units_of(along + outward * rise));
        atomicAdd(&columns_before[column].count, 1u);
    }
}

// Updates whether a particle is of low utility; true where it is to be taken out. Twin of `update_utility`.
fn update_utility(particle: ptr<function, Particle>) -> bool {
    let role = (*particle).role;
    if role != INSIDE && role != IDLE {
        return false;
    }
    let utility = utility(*particle);
    if role == INSIDE && utility != MATTERS {
        crossed.went += booked(*particle);
        (*particle).role = IDLE;
        (*particle).idle = 0.0;
        (*particle).spreading = vec3f(0.0);
    } else if role == IDLE && utility == MATTERS {
        crossed.came += booked(*particle);
        (*particle).role = INSIDE;
    } else if role == IDLE {
        (*particle).idle += difference(status.time, status.seen);
    }
    return utility == USELESS;
}

@compute @workgroup_size(GROUP)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    let i = id.x;
    if i < status.particles {
        var particle = unpacked(particles[i]);
        var cell = status.cells - 1u;
        if !cross_over(&particle) {
            mark_columns(particle);
            let is_turn = is_set(FINDS_LOW_UTILITY) && (status.turn + status.steps) % TURN == 0u;
            if !(is_turn && update_utility(&particle)) {
                cell = cell_at(particle.position);
            }
        }
        particles[i] = packed(particle);
        cell_slots[i] = vec2u(cell, atomicAdd(&counts[cell], 1u));
        keys[i] = particle.id;
    }
    let all = reduce_group(thread, crossed);
    if thread == 0u {
        partials[group.x].came = all.came;
        partials[group.x].went = all.went;
    }
}
