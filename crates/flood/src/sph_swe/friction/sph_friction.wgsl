// Bed friction by a backward Euler step. Twin of `Roughness::slow`.
#import declared
#import friction_rate

// The coefficient of the law at a position, over gravity.
fn roughness_at(position: vec2f) -> f32 {
    if parameters.rough_cells.x == 0u {
        return parameters.roughness;
    }
    let at = max((position - parameters.rough_corner) * parameters.rough_per_metre, vec2f(0.0));
    let cell = min(vec2u(at), parameters.rough_cells - 1u);
    return rough[cell.y * parameters.rough_cells.x + cell.x];
}

// What is left of a velocity after `step` s.
fn slowed(roughness: f32, velocity: vec2f, depth: f32, step: f32) -> f32 {
    if roughness == 0.0 {
        return 1.0;
    }
    let coefficient = parameters.gravity * roughness;
    if is_friction_linear() {
        return 1.0 / (1.0 + step * coefficient);
    }
    return 2.0 / (1.0 + sqrt(1.0 + 4.0 * friction_rate(coefficient, depth) * step * length(velocity)));
}
