// Air as it is seen at the time shown, which may be a little after the last step. Twin of `Dew::frame`.
#import dew_card
#import device_particles

struct Shown {
    // Time from the last step to the time shown, s.
    since: f32,
    unused_a: f32,
    unused_b: f32,
    unused_c: f32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> status: Status;
@group(0) @binding(2) var<storage, read> particles: array<Particle>;
@group(0) @binding(3) var<uniform> shown: Shown;
@group(0) @binding(4) var<storage, read_write> seen: DeviceParticles;

fn as_seen(particle: Particle) -> DeviceParticle {
    var air: DeviceParticle;
    if particle.role != INSIDE {
        return air;
    }
    air.place = particle.place + shown.since * particle.velocity;
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
        seen.count = status.particles;
    }
    if i < status.particles {
        seen.all[i] = as_seen(particles[i]);
    }
}
