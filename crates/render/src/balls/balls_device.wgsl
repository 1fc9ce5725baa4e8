// Balls of particles that lie on the device. Twin of `Balls::of_device` (balls/device.rs).
#import device_particles

struct Ball {
    x: f32,
    y: f32,
    z: f32,
    radius: f32,
    value: f32,
}

struct Settings {
    // From the origin of the particles to the middle of the stage, m, heights raised.
    shift: vec3f,
    // How many times higher than they are heights are drawn.
    raise: f32,
    // Length of a stage unit, m.
    unit: f32,
    // Radius over the distance of particles.
    radius: f32,
    // 0: the depth of water; 1: the temperature of air.
    value: u32,
    room: u32,
}

@group(0) @binding(0) var<uniform> settings: Settings;
@group(0) @binding(1) var<storage, read> particles: DeviceParticles;
@group(0) @binding(2) var<storage, read_write> balls: array<Ball>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i >= settings.room {
        return;
    }
    // What is no particle is no ball.
    var ball = Ball(0.0, 0.0, 0.0, -1.0, 0.0);
    if i < particles.count && particles.all[i].volume > 0.0 {
        let particle = particles.all[i];
        let place = (vec3f(1.0, 1.0, settings.raise) * particle.place + settings.shift) / settings.unit;
        let value = select(particle.depth, particle.temperature, settings.value == 1u);
        ball = Ball(place.x, place.y, place.z, settings.radius * particle.spacing / settings.unit, value);
    }
    balls[i] = ball;
}
