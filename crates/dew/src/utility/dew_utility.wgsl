// Which air matters to no solid. Twin of `utility/mod.rs`; how far the solids are is read off nodes half a spacing apart.
#import dew_particles

const MATTERS = 0u;
const LOW = 1u;
const USELESS = 2u;

// Cubic convolution with the parameter -1/2 (Keys 1981), exact for polynomials of second order.
fn cubic(t: f32) -> vec4f {
    let squared = t * t;
    let cubed = squared * t;
    return 0.5 * vec4f(
        2.0 * squared - cubed - t,
        3.0 * cubed - 5.0 * squared + 2.0,
        4.0 * squared - 3.0 * cubed + t,
        cubed - squared,
    );
}

// Distance to the nearest solid, m.
fn distance_at(position: vec3f) -> f32 {
    let at = (position - parameters.field_corner) * parameters.per_node;
    let cell = clamp(vec3u(max(at, vec3f(1.0))), vec3u(1u), parameters.nodes - 3u);
    let part = at - vec3f(cell);
    let along = cubic(part.x);
    var by_y = cubic(part.y);
    var by_z = cubic(part.z);
    var sum = 0.0;
    for (var z = 0u; z < 4u; z++) {
        for (var y = 0u; y < 4u; y++) {
            let row = ((cell.z + z - 1u) * parameters.nodes.y + cell.y + y - 1u) * parameters.nodes.x + cell.x - 1u;
            let four = vec4f(field[row], field[row + 1u], field[row + 2u], field[row + 3u]);
            sum += by_z[z] * by_y[y] * dot(along, four);
        }
    }
    return sum;
}

fn goes_away(position: vec3f, velocity: vec3f, distance: f32) -> bool {
    let speed = length(velocity);
    return speed > 0.0 && distance_at(position + PROBE_STEP * parameters.h / speed * velocity) > distance;
}

fn utility(particle: Particle) -> u32 {
    let distance = distance_at(particle.position);
    let later = parameters.h / parameters.sound;
    if distance < parameters.low_beyond || !goes_away(particle.position, particle.velocity, distance)
        || !goes_away(particle.position, particle.velocity + later * particle.acceleration, distance) {
        return MATTERS;
    }
    let was_long = particle.role == IDLE && particle.idle > parameters.low_after;
    return select(LOW, USELESS, distance > parameters.useless_beyond && was_long);
}
