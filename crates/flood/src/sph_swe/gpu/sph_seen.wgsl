// Particles as they are seen at the time shown, which may be a little after the last step. Twin of `SphSweFlood::frame`.
#import sph_common
#import sph_ground
#import sph_outlines

// Whether a position is inside an obstacle.
fn is_held(position: vec2f) -> bool {
    let cell = outline_cell(position);
    if cell == NONE {
        return false;
    }
    for (var k = outlines[cell]; k < outlines[cell + 1u]; k += 3u) {
        var inside = false;
        for (var number = outlines[k + 1u]; number < outlines[k + 2u]; number++) {
            inside = inside != crosses(position, side(number));
        }
        if inside {
            return true;
        }
    }
    return false;
}

fn on_ground(particle: Particle) -> DeviceParticle {
    var as_seen = DeviceParticle();
    if particle.outside != 0u {
        return as_seen;
    }
    // What comes into an obstacle is put back before it is shown.
    let moved = particle.position + shown.since * particle.velocity;
    let position = select(moved, particle.position, is_held(moved));
    as_seen.position = vec3f(position, ground_at(position).x + particle.depth);
    as_seen.spacing = shown.spacing;
    as_seen.velocity = vec3f(particle.velocity, 0.0);
    as_seen.depth = particle.depth;
    as_seen.volume = particle.volume;
    as_seen.id = particle.id;
    return as_seen;
}

fn in_air(drop: Drop) -> DeviceParticle {
    var as_seen = DeviceParticle();
    if drop.state != FALLS {
        return as_seen;
    }
    as_seen.position = vec3f(drop.position, drop.z);
    as_seen.spacing = shown.drop_spacing;
    as_seen.velocity = vec3f(drop.velocity, drop.w);
    as_seen.volume = drop.volume;
    as_seen.id = drop.id;
    return as_seen;
}

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    let count = status.particles + parameters.in_air;
    if i == 0u {
        drawn.count = count;
    }
    if i < status.particles {
        drawn.all[i] = on_ground(unpacked(particles[i]));
    } else if i < count {
        drawn.all[i] = in_air(drops[i - status.particles]);
    }
}
