// Cells of the ground that rain falls on, what stands on them as a film, and what has soaked in. Twin of `Wetness` in `rain.rs`.
#import flood_card

struct Patch {
    // Water that is no particle yet, m3.
    film: f32,
    // By what the rain is multiplied.
    factor: f32,
    // Depth that has soaked in, m.
    soaked: Account,
    // Number of the law of infiltration.
    law: u32,
    // What each square metre of water gains, and what the ground takes of that, m.
    gain: f32,
    demand: f32,
    // 1 where the film becomes a particle.
    is_deep: u32,
}

// Particles add up in whole numbers, so that the sum does not depend on their order: the area that they cover, in parts of their cell's,
// and the depth that the ground takes of them, m.
const AREA = 1048576.0;
const DEPTH = 1e10;

// Most of its cell's area that one particle counts for, and the deepest that the ground takes of one at a time, m.
const WIDEST = 64.0;
const DEEPEST = 0.1;

fn patch_of(parameters: Parameters, place: vec2f) -> u32 {
    let at = max((place - parameters.bounds.xz) * parameters.patches_per_metre, vec2f(0.0));
    let cell = min(vec2u(at), parameters.patches - 1u);
    return cell.y * parameters.patches.x + cell.x;
}

// Water that rain falls on: inside, not taken out, and its depth found.
fn is_rained_on(particle: Particle) -> bool {
    return particle.outside == 0u && particle.volume > 0.0 && particle.depth > 0.0;
}
