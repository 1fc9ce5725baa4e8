// Writes the air as particles for drawing at the time shown, which may be a little after the last step. Twin of `Dew::frame`.
#import dew_particles

fn as_seen(particle: Particle) -> DeviceParticle {
    var air = DeviceParticle();
    if particle.role != INSIDE {
        return air;
    }
    air.position = particle.position + seen_at.since * particle.velocity;
    air.spacing = parameters.spacing;
    air.velocity = particle.velocity;
    air.volume = parameters.spacing * parameters.spacing * parameters.spacing;
    air.id = particle.id;
    air.temperature = parameters.celsius + total(particle.temperature);
    return air;
}

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i == 0u {
        drawn.count = status.particles;
    }
    if i < status.particles {
        drawn.all[i] = as_seen(unpacked(particles[i]));
    }
}
