// Bed friction: see `friction/mod.rs`.
#import declared
#import friction_rate

// By what the momentum is multiplied over a step: a backward Euler step of du/dt = -k |u| u or -k u for the depth as it is.
fn friction_factor(coefficient: f32, depth: f32, momentum_per_area: f32, step: f32) -> f32 {
    if coefficient == 0.0 {
        return 1.0;
    }
    if is_friction_linear() {
        return 1.0 / (1.0 + step * coefficient);
    }
    if depth < STILL_ON_BED {
        return 0.0;
    }
    let thick = max(depth, THINNEST);
    let rate = friction_rate(coefficient, thick);
    return 2.0 / (1.0 + sqrt(1.0 + 4.0 * step * rate * momentum_per_area / thick));
}
