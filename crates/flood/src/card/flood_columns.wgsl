// What the passes read of each particle. Twins of `Column` and `Slopes` in `balanced/mod.rs`.
#import flood_neighbours
#import flood_ground

struct Column {
    place: vec2f,
    // Half a step ahead.
    velocity: vec2f,
    surface: f32,
    depth: f32,
    area: f32,
    per_h: f32,
}

struct Slopes {
    // Renormalisation matrix B (symmetric): xx, xy, yy.
    renormalisation: vec3f,
    // 1 at rest, 0 in motion.
    rest: f32,
    surface: vec2f,
    ground: vec2f,
    u: vec2f,
    v: vec2f,
    wave_speed: f32,
    // 1 without neighbours, 0 with enough of them.
    alone: f32,
    // 1 for what is not of this water.
    outside: f32,
    unused: f32,
}

// The depth in which two particles push each other, at most, over the smaller of theirs.
const SHARED = 3.0;

// A vector multiplied by a symmetric matrix.
fn turned(matrix: vec3f, vector: vec2f) -> vec2f {
    return vec2f(dot(matrix.xy, vector), dot(matrix.yz, vector));
}

// How much higher the water and its ground stand in the image over a periodic side.
fn step_up(mirror: Mirror, parameters: Parameters, nodes: texture_2d<f32>, place: vec2f) -> f32 {
    var higher = 0.0;
    let bounds = parameters.bounds;
    if mirror.beyond.x != 0.0 && mirror.sign.x > 0.0 {
        let west = ground_at(parameters, nodes, vec2f(bounds.x, place.y)).x;
        higher += mirror.beyond.x * (ground_at(parameters, nodes, vec2f(bounds.y, place.y)).x - west);
    }
    if mirror.beyond.y != 0.0 && mirror.sign.y > 0.0 {
        let south = ground_at(parameters, nodes, vec2f(place.x, bounds.z)).x;
        higher += mirror.beyond.y * (ground_at(parameters, nodes, vec2f(place.x, bounds.w)).x - south);
    }
    return higher;
}
