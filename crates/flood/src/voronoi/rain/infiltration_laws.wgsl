// How much water soaks into the ground: the formulas of `infiltration.rs` without differences of large numbers. A law is its kind and its numbers.
#import declared

// Most iterations of Newton's method. Fewer than `NEWTON_ITERATIONS` of `infiltration.rs`, as single precision has fewer digits to find.
const NEWTON_ITERATIONS_ON_GPU = 20u;

// 1 - e^-x.
fn fallen_off(x: f32) -> f32 {
    return select(1.0 - exp(-x), x * (1.0 - x * (0.5 - x * (1.0 / 6.0 - x / 24.0))), x < 0.05);
}

// y - ln(1 + y).
fn beyond_logarithm(y: f32) -> f32 {
    return select(y - log(1.0 + y), y * y * (0.5 - y * (1.0 / 3.0 - y * (0.25 - y * (0.2 - y / 6.0)))), y < 0.05);
}

// What soaks in within `step` s after `soaked` m have: last step + (first - last) e^(-k t) (1 - e^(-k step)) / k, with the time t
// after which `soaked` would have soaked in.
fn horton(first: f32, last: f32, decay: f32, soaked: f32, step: f32) -> f32 {
    var time = 0.0;
    for (var k = 0u; k < NEWTON_ITERATIONS_ON_GPU; k++) {
        let missing = soaked - last * time - (first - last) / decay * fallen_off(decay * time);
        let rate = last + (first - last) * exp(-decay * time);
        if rate <= 0.0 || missing <= 1e-7 * soaked {
            break;
        }
        time += missing / rate;
    }
    return last * step + (first - last) / decay * exp(-decay * time) * fallen_off(decay * step);
}

// The root of soaked y + head (y - ln(1 + y)) = K t, with what soaks in, y (soaked + head).
fn green_ampt(conducted: f32, head: f32, soaked: f32) -> f32 {
    if head <= 0.0 || conducted <= 0.0 {
        return conducted;
    }
    let scale = soaked + head;
    var y = (conducted + sqrt(2.0 * conducted * scale)) / scale;
    for (var k = 0u; k < NEWTON_ITERATIONS_ON_GPU; k++) {
        let excess = soaked * y + head * beyond_logarithm(y) - conducted;
        let next = y - excess / (soaked + head * y / (1.0 + y));
        if abs(next - y) <= 1e-7 * y {
            break;
        }
        y = next;
    }
    return y * scale;
}

fn demand(law: vec4f, soaked: f32, step: f32) -> f32 {
    if law.x == CONSTANT {
        return law.y * step;
    }
    if law.x == HORTON {
        return horton(law.y, law.z, law.w, soaked, step);
    }
    if law.x == GREEN_AMPT {
        return green_ampt(law.y * step, law.z, soaked);
    }
    return 0.0;
}
