// Turns drops that have landed into particles, in the order of the drops. Twin of `add_inflow` in `inflow/mod.rs`. One group.
#import sph_common
#import sums_before

var<workgroup> before: vec2u;

fn particle_of(drop: Drop) -> Particle {
    var particle = Particle();
    particle.position = drop.position;
    particle.velocity = drop.velocity;
    particle.volume = drop.volume;
    particle.h = drop.h;
    particle.next_h = drop.h;
    particle.id = drop.id;
    return particle;
}

@compute @workgroup_size(GROUP)
fn main(@builtin(local_invocation_index) thread: u32) {
    if thread == 0u {
        before = vec2u(status.particles, select(0u, status.falling, status.halted == GOING));
    }
    let begin = workgroupUniformLoad(&before);
    if begin.y == 0u {
        return;
    }
    var landed = 0u;
    for (var first = 0u; first < parameters.in_air; first += GROUP) {
        let number = first + thread;
        let lands = number < parameters.in_air && drops[min(number, parameters.in_air - 1u)].state == LANDS;
        let ranks = sums_before(thread, select(0u, 1u, lands));
        if lands {
            particles[begin.x + landed + ranks.x] = packed(particle_of(drops[number]));
            drops[number].state = GONE;
        }
        landed += ranks.y;
    }
    if thread == 0u {
        status.particles = begin.x + landed;
        status.falling = begin.y - landed;
        groups[0] = (begin.x + landed + GROUP - 1u) / GROUP;
    }
}
