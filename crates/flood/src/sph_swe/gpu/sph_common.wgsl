// A particle, and how it lies in memory.
#import compensated_sums

// A column of water; `outside` is 0 for one inside, or the side over which it has left, from 1.
struct Particle {
    position: vec2f,
    velocity: vec2f,
    acceleration: vec2f,
    volume: f32,
    depth: f32,
    h: f32,
    next_h: f32,
    ground: f32,
    id: u32,
    outside: u32,
}

fn unpacked(packed: Packed) -> Particle {
    let a = packed.position_and_velocity;
    let b = packed.acceleration_volume_depth;
    let c = packed.lengths_and_ground;
    return Particle(a.xy, a.zw, b.xy, b.z, b.w, c.x, c.y, c.z, packed.identity.x, packed.identity.y);
}

fn packed(particle: Particle) -> Packed {
    return Packed(
        vec4f(particle.position, particle.velocity),
        vec4f(particle.acceleration, particle.volume, particle.depth),
        vec4f(particle.h, particle.next_h, particle.ground, 0.0),
        vec4u(particle.id, particle.outside, 0u, 0u),
    );
}

fn sum(pair: vec2f) -> f32 {
    return pair.x + pair.y;
}

fn book_momentum(momentum: f32) {
    status.momentum_lost = add(status.momentum_lost, max(-momentum, 0.0));
    status.momentum_gained = add(status.momentum_gained, max(momentum, 0.0));
}
