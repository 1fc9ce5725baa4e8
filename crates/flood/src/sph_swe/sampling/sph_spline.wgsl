// The cubic spline by which water is sampled. Twin of `CubicSpline` of crate `sph`, which names the source.
#import declared

// W(r, h), 1/m2.
fn spline(r: f32, per_h: f32) -> f32 {
    let q = r * per_h;
    let outer = max(2.0 - q, 0.0);
    let inner = max(1.0 - q, 0.0);
    return (outer * outer * outer - 4.0 * inner * inner * inner) * (per_h * per_h * SIGMA);
}
