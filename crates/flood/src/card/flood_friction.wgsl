// Bed friction by a backward Euler step, as `friction.rs`: Manning 1891, Chezy 1775, or in proportion to the velocity.
#import flood_card

const SMOOTH = 0u;
const MANNING = 1u;
const CHEZY = 2u;
const LINEAR = 3u;

// What is left of a velocity after `step` s.
fn slowed(parameters: Parameters, velocity: vec2f, depth: f32, step: f32) -> f32 {
    let roughness = parameters.roughness;
    var k = 0.0;
    switch parameters.friction {
        case MANNING: { k = parameters.gravity * roughness * roughness / (depth * pow(depth, 1.0 / 3.0)); }
        case CHEZY: { k = parameters.gravity / (roughness * roughness * depth); }
        case LINEAR: { return 1.0 / (1.0 + step * parameters.gravity * roughness); }
        default: { return 1.0; }
    }
    return 2.0 / (1.0 + sqrt(1.0 + 4.0 * k * step * length(velocity)));
}
