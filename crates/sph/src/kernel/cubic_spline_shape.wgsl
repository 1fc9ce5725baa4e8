// The cubic spline over its factor, of q = r/h with the smoothing length h, half its support. Twin of `CubicSpline::value_at` in `cubic_spline.rs`.
fn cubic_spline_shape(q: f32) -> f32 {
    let outer = max(2.0 - q, 0.0);
    let inner = max(1.0 - q, 0.0);
    return outer * outer * outer - 4.0 * inner * inner * inner;
}
