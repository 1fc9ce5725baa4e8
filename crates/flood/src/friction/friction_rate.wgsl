// Rate of bed friction. Twin of `Law` in `friction/mod.rs`.
#import declared

fn is_friction_linear() -> bool {
    return parameters.friction_exponent < 0.0;
}

// k of du/dt = -k |u| u for a law that is not linear.
fn friction_rate(coefficient: f32, depth: f32) -> f32 {
    return coefficient / pow(depth, parameters.friction_exponent);
}
