// Kernels of Müller, Charypar & Gross 2003 over their factors, of q = r/h: poly6, the slope of the spiky kernel, and the Laplacian of the viscosity kernel. Twin of
// `mueller.rs`.
fn value_shape(q_squared: f32) -> f32 {
    let inside = max(1.0 - q_squared, 0.0);
    return inside * inside * inside;
}

fn slope_shape(q: f32) -> f32 {
    let inside = max(1.0 - q, 0.0);
    return inside * inside;
}

fn laplacian_shape(q: f32) -> f32 {
    return max(1.0 - q, 0.0);
}
