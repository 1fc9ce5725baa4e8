// The cubic spline by which water is sampled, whichever kernel the scheme has. Twin of `CubicSpline` of crate `sph`, which names the source.
#import declared
#import cubic_spline_shape

// W(r, h), 1/m2.
fn spline(r: f32, per_h: f32) -> f32 {
    return cubic_spline_shape(r * per_h) * (per_h * per_h * SIGMA);
}
