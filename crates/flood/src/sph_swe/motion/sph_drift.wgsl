// Moves the particles, and puts those that penetrate obstacles back to the wall. Twin of `move_particles` in `mod.rs` and of `resolve_obstacle_penetration` in `obstacles/impulses.rs`.
#import sph_common
#import sph_outlines
#import group_reduction

// Where a position is to an outline: the way to it from the nearest wall, that wall, and whether it is inside.
struct Within {
    way: vec2f,
    wall: vec4f,
    is_inside: bool,
}

// Of an outline from its first side to its last.
fn within(position: vec2f, first: u32, end: u32) -> Within {
    var found = Within(vec2f(0.0), vec4f(0.0), false);
    var nearest = FAR;
    for (var number = first; number < end; number++) {
        let wall = side(number);
        let way = way_from(position, wall);
        if dot(way, way) < nearest {
            nearest = dot(way, way);
            found.way = way;
            found.wall = wall;
        }
        found.is_inside = found.is_inside != crosses(position, wall);
    }
    return found;
}

// The way out of an outline that a position is inside, to a little before its wall.
fn way_out(position: vec2f, found: Within, first: u32, end: u32) -> vec2f {
    let off = BEFORE_WALL * parameters.spacing;
    let deep = length(found.way);
    if deep > off {
        return -(1.0 + off / deep) * found.way;
    }
    // So near the wall rounding may have turned the way round: across the wall, to the side that is not inside.
    let along = normalize(found.wall.zw - found.wall.xy);
    let across = (off + deep) * vec2f(along.y, -along.x);
    return select(across, -across, within(position + across, first, end).is_inside);
}

// Puts a particle that has come into an obstacle back to the wall, and removes the inward part of its velocity. Returns that. Twin of `Obstacles::resolve_penetration`.
fn kept_out(particle: ptr<function, Particle>) -> vec2f {
    let cell = outline_cell((*particle).position);
    if cell == NONE {
        return vec2f(0.0);
    }
    for (var k = outlines[cell]; k < outlines[cell + 1u]; k += 3u) {
        let obstacle = outlines[k];
        let found = within((*particle).position, outlines[k + 1u], outlines[k + 2u]);
        if !found.is_inside {
            continue;
        }
        let way = way_out((*particle).position, found, outlines[k + 1u], outlines[k + 2u]);
        (*particle).position += way;
        let normal = normalize(way);
        let inward = max(-dot((*particle).velocity, normal), 0.0);
        (*particle).velocity += inward * normal;
        let taken = -(*particle).volume * inward * normal;
        let knock = vec2i(round(taken / (KNOCK * parameters.new_volume)));
        atomicAdd(&knocks[2u * obstacle], knock.x);
        atomicAdd(&knocks[2u * obstacle + 1u], knock.y);
        atomicAdd(&knocks[2u * parameters.obstacles], 1);
        return taken;
    }
    return vec2f(0.0);
}

alias Reduced = f32;

fn combine(a: Reduced, b: Reduced) -> Reduced {
    return a + b;
}

@compute @workgroup_size(GROUP)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    var own = 0.0;
    if id.x < status.particles {
        var particle = unpacked(particles[id.x]);
        particle.position += status.step * particle.velocity;
        if particle.outside == 0u {
            own = -sum(kept_out(&particle));
        }
        particles[id.x] = packed(particle);
    }
    let all = reduce_group(thread, own);
    if thread == 0u {
        partials[group.x].knocked = all;
    }
}
