// Balls of particles that lie on the device. Twin of `Balls::of_device` (balls/device.rs).
#import declared

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i >= settings.room {
        return;
    }
    // What is no particle is no ball.
    var ball = BallInstance(0.0, 0.0, 0.0, -1.0, 0.0);
    if i < particles.count && particles.all[i].volume > 0.0 {
        let particle = particles.all[i];
        let position = (vec3f(1.0, 1.0, settings.raise) * particle.position + settings.shift) / settings.unit;
        let value = select(particle.depth, particle.temperature, settings.value == TEMPERATURE);
        ball = BallInstance(position.x, position.y, position.z, settings.radius * particle.spacing / settings.unit, value);
    }
    balls[i] = ball;
}
