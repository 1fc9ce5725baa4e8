// Weights of the smoothing kernel in the plane. Twin of the trait `SmoothingKernel` of crate `sph`.
#import declared
#import smoothing_kernel

// 1/m2.
fn kernel_value(r: f32, h: f32) -> f32 {
    let q = r / h;
    return VALUE_FACTOR / (h * h) * value_shape(q * q);
}

// -dW/dr, 1/m3.
fn kernel_slope(r: f32, h: f32) -> f32 {
    return SLOPE_FACTOR / (h * h * h) * slope_shape(r / h);
}

// 1/m4.
fn kernel_laplacian(r: f32, h: f32) -> f32 {
    return LAPLACIAN_FACTOR / (h * h * h * h) * laplacian_shape(r / h);
}
