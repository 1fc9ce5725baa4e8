// Reflects or books particles that cross the edges, and counts the particles of each cell. Twin of `remove_outflow` in `outflow.rs`.
#import sph_common
#import group_reduction

// Puts a coordinate that has left over a periodic side or a wall back: its new value, the sign of its velocity, and whether it has
// left for good, over the low side (1) or the high one (2).
fn keep(value: f32, low: f32, high: f32, low_rule: u32, high_rule: u32) -> vec3f {
    let is_low = value < low;
    // A value that is not finite stays so, and ends the run: see `sph_forces.wgsl`.
    if !is_finite(value) || (!is_low && value < high) {
        return vec3f(value, 1.0, 0.0);
    }
    let rule = select(high_rule, low_rule, is_low);
    if rule == PERIODIC {
        let size = high - low;
        return vec3f(clamp(value - size * floor((value - low) / size), low, high), 1.0, 0.0);
    }
    if rule == WALL {
        return vec3f(clamp(2.0 * select(high, low, is_low) - value, low, high), -1.0, 0.0);
    }
    return vec3f(value, 1.0, select(2.0, 1.0, is_low));
}

// Outflow, inflow and momentum booked.
fn put_back(particle: ptr<function, Particle>) -> vec3f {
    var booked = vec3f(0.0);
    let volume = (*particle).volume;
    let position = (*particle).position;
    let was_inside = (*particle).outside == 0u;
    let x = keep(position.x, parameters.bounds.x, parameters.bounds.y, parameters.rules.x, parameters.rules.y);
    let y = keep(position.y, parameters.bounds.z, parameters.bounds.w, parameters.rules.z, parameters.rules.w);
    var velocity = (*particle).velocity;
    let before = sum(velocity);
    velocity *= vec2f(x.y, y.y);
    let side = select(u32(x.z), 2u + u32(y.z), y.z > 0.0);
    if was_inside && side == 0u {
        booked.z = volume * (sum(velocity) - before);
    } else if was_inside {
        booked.x = volume;
        booked.z = -volume * before;
        let outward = array(vec2f(-1.0, 0.0), vec2f(1.0, 0.0), vec2f(0.0, -1.0), vec2f(0.0, 1.0))[side - 1u];
        let slowest = SLOWEST_LEAVING * sqrt(parameters.gravity * (*particle).depth);
        velocity += max(slowest - dot(velocity, outward), 0.0) * outward;
    } else if side == 0u {
        booked.y = volume;
        booked.z = volume * sum(velocity);
    }
    (*particle).position = vec2f(x.x, y.x);
    (*particle).velocity = velocity;
    (*particle).outside = side;
    return booked;
}

// Whether a particle is so far beyond an edge that it is removed. One whose position is not finite stays, so that it is found.
fn is_gone(particle: Particle) -> bool {
    let bounds = parameters.bounds;
    let position = particle.position;
    let beyond = max(max(bounds.x - position.x, position.x - bounds.y), max(bounds.z - position.y, position.y - bounds.w));
    return particle.outside > 0u && is_finite(position.x) && is_finite(position.y) && beyond >= BEYOND * particle.next_h;
}

// A particle counts itself in its cell.
fn count(i: u32, particle: Particle) {
    var cell = status.cells - 1u;
    if !is_gone(particle) {
        let at = (particle.position - parameters.grid.corner) * parameters.grid.per_cell;
        let column = min(u32(max(at.x, 0.0)), parameters.grid.columns - 1u);
        let row = min(u32(max(at.y, 0.0)), parameters.grid.rows - 1u);
        cell = row * parameters.grid.columns + column;
    }
    slots[i] = vec2u(cell, atomicAdd(&counts[cell], 1u));
    keys[i] = particle.id;
}

alias Reduced = vec4f;

fn combine(a: Reduced, b: Reduced) -> Reduced {
    return a + b;
}

@compute @workgroup_size(GROUP)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    var own = vec4f(0.0);
    if id.x < status.particles {
        var particle = unpacked(particles[id.x]);
        let booked = put_back(&particle);
        own = vec4f(booked.xy, max(booked.z, 0.0), max(-booked.z, 0.0));
        particles[id.x] = packed(particle);
        count(id.x, particle);
    }
    let all = reduce_group(thread, own);
    if thread == 0u {
        partials[group.x].outflow = all.x;
        partials[group.x].inflow = all.y;
        partials[group.x].gained_at_edges = all.z;
        partials[group.x].lost_at_edges = all.w;
    }
}
