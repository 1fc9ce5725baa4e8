// Wendland's C2 kernel over its factors, of q = r/h. Twin of `wendland_c2.rs`.
fn laplacian_shape(q: f32) -> f32 {
    let inside = max(1.0 - q, 0.0);
    return inside * inside * inside;
}

fn value_shape(q_squared: f32) -> f32 {
    let q = sqrt(q_squared);
    return laplacian_shape(q) * (1.0 - q) * (1.0 + 4.0 * q);
}

fn slope_shape(q: f32) -> f32 {
    return q * laplacian_shape(q);
}
