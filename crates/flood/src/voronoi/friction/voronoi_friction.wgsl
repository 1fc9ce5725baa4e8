// Bed friction: see `friction/mod.rs`.
#import declared

// By what the momentum is multiplied over a step: a backward Euler step of du/dt = -k |u| u or -k u for the depth as it is.
fn friction_factor(coefficient: f32, depth: f32, momentum_per_area: f32, step: f32) -> f32 {
    if coefficient == 0.0 {
        return 1.0;
    }
    if parameters.friction_law == LINEAR {
        return 1.0 / (1.0 + step * coefficient);
    }
    if depth < STILL_ON_BED {
        return 0.0;
    }
    let thick = max(depth, THINNEST);
    let power = select(1.0, 4.0 / 3.0, parameters.friction_law == MANNING);
    let rate = coefficient / pow(thick, power);
    return 2.0 / (1.0 + sqrt(1.0 + 4.0 * step * rate * momentum_per_area / thick));
}
