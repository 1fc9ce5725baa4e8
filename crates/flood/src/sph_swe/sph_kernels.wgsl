// The kernels of the paper in the plane, and the cubic spline by which water is sampled. Twins of those in the crate sph, which names the sources.
#import declared

fn poly6(r: f32, h: f32) -> f32 {
    let q = r / h;
    let inside = max(1.0 - q * q, 0.0);
    return 4.0 / (PI * h * h) * inside * inside * inside;
}

// Magnitude of the gradient of the spiky kernel, 1/m3.
fn spiky_slope(r: f32, h: f32) -> f32 {
    let inside = max(1.0 - r / h, 0.0);
    return 30.0 / (PI * h * h * h) * inside * inside;
}

// Laplacian of the viscosity kernel, 1/m4.
fn viscosity_laplacian(r: f32, h: f32) -> f32 {
    return 40.0 / (PI * h * h * h * h) * max(1.0 - r / h, 0.0);
}

fn pressure_of(density: f32) -> f32 {
    let pressure = parameters.gas_constant * (density - parameters.rest_density);
    return select(pressure, max(pressure, 0.0), parameters.clips_pressure == 1u);
}

// Cubic spline (Monaghan & Lattanzio 1985) as in the crate sph: W(r, h), 1/m2.
fn spline(r: f32, per_h: f32) -> f32 {
    let q = r * per_h;
    let outer = max(2.0 - q, 0.0);
    let inner = max(1.0 - q, 0.0);
    return (outer * outer * outer - 4.0 * inner * inner * inner) * (per_h * per_h * SIGMA);
}
