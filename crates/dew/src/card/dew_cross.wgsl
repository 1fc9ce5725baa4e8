// Each parcel gets the role of where it is now, what comes and goes is booked, and each counts itself in its cell. Twin of `cross` and
// `cross_faces` in `faces/mod.rs`.
#import dew_neighbours

@group(0) @binding(1) var<storage, read> status: Status;
@group(0) @binding(2) var<storage, read_write> particles: array<Particle>;
@group(0) @binding(3) var<storage, read_write> counts: array<atomic<u32>>;
@group(0) @binding(4) var<storage, read_write> places: array<vec2u>;
@group(0) @binding(5) var<storage, read_write> keys: array<u32>;
@group(0) @binding(6) var<storage, read_write> partials: array<Partial>;

// How far air goes on beyond an open face, in smoothing lengths.
const BEYOND = 2.0;

const NOWHERE = 6u;

var<workgroup> came: array<vec4f, 256>;
var<workgroup> went: array<vec4f, 256>;

fn depth_beyond(place: vec3f, number: u32) -> f32 {
    let axis = number / 2u;
    return select(place[axis] - parameters.high[axis], parameters.low[axis] - place[axis], number % 2u == 0u);
}

// The first face that air passes beyond which a place lies.
fn beyond(place: vec3f) -> u32 {
    for (var number = 0u; number < 6u; number++) {
        let axis = number / 2u;
        let is_beyond = select(place[axis] >= parameters.high[axis], place[axis] < parameters.low[axis], number % 2u == 0u);
        if is_beyond && face(number) >= INLET {
            return number;
        }
    }
    return NOWHERE;
}

// Twin of `Particle::leave`.
fn leave(particle: ptr<function, Particle>, number: u32, speed: f32) {
    let outward = select(1.0, -1.0, number % 2u == 0u);
    (*particle).role = LEAVING | (number << FACE_BITS);
    (*particle).velocity[number / 2u] = outward * max(outward * speed, parameters.slowest);
}

// Whether it has gone for good.
fn cross_over(particle: ptr<function, Particle>, thread: u32) -> bool {
    let role = (*particle).role & ROLE_MASK;
    let number = beyond((*particle).place);
    let held = vec4f(1.0, value((*particle).temperature), value((*particle).vapour), (*particle).fog);
    if role == INSIDE && number != NOWHERE {
        went[thread] = held;
        leave(particle, number, (*particle).velocity[number / 2u]);
    } else if role == LEAVING {
        let left = (*particle).role >> FACE_BITS;
        leave(particle, left, (*particle).velocity[left / 2u] + status.before[left]);
    } else if role == COMING && number == NOWHERE {
        (*particle).role = INSIDE;
        came[thread] = held;
    }
    let is_leaving = ((*particle).role & ROLE_MASK) == LEAVING;
    return is_leaving && !(depth_beyond((*particle).place, (*particle).role >> FACE_BITS) < BEYOND * parameters.h);
}

@compute @workgroup_size(256)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    came[thread] = vec4f(0.0);
    went[thread] = vec4f(0.0);
    let i = id.x;
    if i < status.particles {
        var particle = particles[i];
        var cell = status.cells - 1u;
        if !cross_over(&particle, thread) {
            cell = cell_at(particle.place);
        }
        particles[i] = particle;
        places[i] = vec2u(cell, atomicAdd(&counts[cell], 1u));
        keys[i] = particle.id;
    }
    workgroupBarrier();
    for (var half = 128u; half > 0u; half /= 2u) {
        if thread < half {
            came[thread] += came[thread + half];
            went[thread] += went[thread + half];
        }
        workgroupBarrier();
    }
    if thread == 0u {
        partials[group.x].came = came[0];
        partials[group.x].went = went[0];
    }
}
