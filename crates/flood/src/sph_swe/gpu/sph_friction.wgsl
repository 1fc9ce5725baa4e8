// Bed friction by a backward Euler step, as `friction.rs`: Manning 1891, Chezy 1775, or in proportion to the velocity.
#import declared

// The number of the law at a place.
fn roughness_at(place: vec2f) -> f32 {
    if parameters.friction != MAPPED {
        return parameters.roughness;
    }
    let at = max((place - parameters.rough_corner) * parameters.rough_per_metre, vec2f(0.0));
    let cell = min(vec2u(at), parameters.rough_cells - 1u);
    return rough[cell.y * parameters.rough_cells.x + cell.x];
}

// What is left of a velocity after `step` s.
fn slowed(roughness: f32, velocity: vec2f, depth: f32, step: f32) -> f32 {
    var k = 0.0;
    switch parameters.friction {
        case MANNING, MAPPED: { k = parameters.gravity * roughness * roughness / (depth * pow(depth, 1.0 / 3.0)); }
        case CHEZY: { k = parameters.gravity / (roughness * roughness * depth); }
        case LINEAR: { return 1.0 / (1.0 + step * parameters.gravity * roughness); }
        default: { return 1.0; }
    }
    return 2.0 / (1.0 + sqrt(1.0 + 4.0 * k * step * length(velocity)));
}
