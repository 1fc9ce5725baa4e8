// What the passes of scheme sph-swe read of each particle, and its kernels in the plane. Twins of `Parcel` in `sph_swe.rs` and of the crate
// sph, which name the sources.
#import flood_walls

struct Parcel {
    place: vec2f,
    velocity: vec2f,
    // Area that it stands for, mass over density, m2.
    area: f32,
    density: f32,
    pressure: f32,
    h: f32,
}

const PI = 3.14159265358979;

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

fn sph_swe_pressure(parameters: Parameters, density: f32) -> f32 {
    let pressure = parameters.gas_constant * (density - parameters.rest_density);
    return select(pressure, max(pressure, 0.0), parameters.clips_pressure == 1u);
}
