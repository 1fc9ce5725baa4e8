// The cubic spline over its factors, of q = r/h with the support h, twice the smoothing length. Twin of `cubic_spline.rs`.
#import cubic_spline_shape

fn value_shape(q_squared: f32) -> f32 {
    return cubic_spline_shape(2.0 * sqrt(q_squared));
}

fn slope_shape(q: f32) -> f32 {
    let outer = max(2.0 - 2.0 * q, 0.0);
    let inner = max(1.0 - 2.0 * q, 0.0);
    return outer * outer - 4.0 * inner * inner;
}

// Written so that nothing cancels where particles are close.
fn laplacian_shape(q: f32) -> f32 {
    let q_2 = 2.0 * q;
    let outer = max(2.0 - q_2, 0.0);
    return select(outer * outer / q_2, 4.0 - 3.0 * q_2, q_2 < 1.0);
}
