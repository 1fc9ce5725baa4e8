// Water in the air.

struct Drop {
    place: vec2f,
    velocity: vec2f,
    // Height above the level that heights are counted from, m, and upward velocity, m/s.
    z: f32,
    w: f32,
    volume: f32,
    h: f32,
    id: u32,
    // 0 where it has landed.
    is_up: u32,
}

struct Air {
    // How many have landed in this step.
    landed: atomic<u32>,
    unused: u32,
    drops: array<Drop>,
}
