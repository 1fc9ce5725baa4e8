// The approximate Riemann solver of Harten, Lax & van Leer (1983): see `fluxes/riemann.rs`.
#import declared

// Wave speeds after Einfeldt (1988) with the two-rarefaction state (Toro 2001, equations 10.17 to 10.22; 10.24 onto ground with next to no water), the slowest 0 at most and
// the fastest at least. `a` and `b` are depth and velocity across the face on both sides.
fn wave_speeds(a: vec2f, b: vec2f) -> vec2f {
    let celerity_a = sqrt(parameters.gravity * a.x);
    let celerity_b = sqrt(parameters.gravity * b.x);
    let celerity = max(0.5 * (celerity_a + celerity_b) - 0.25 * (b.y - a.y), 0.0);
    let velocity = 0.5 * (a.y + b.y) + celerity_a - celerity_b;
    var slowest = min(a.y - celerity_a, velocity - celerity);
    var fastest = max(b.y + celerity_b, velocity + celerity);
    if b.x <= THIN {
        slowest = a.y - celerity_a;
        fastest = a.y + 2.0 * celerity_a;
    }
    if a.x <= THIN {
        slowest = b.y - 2.0 * celerity_b;
        fastest = b.y + celerity_b;
    }
    return vec2f(min(slowest, 0.0), max(fastest, 0.0));
}

// Flux of volume, and of momentum across the face over density less the mean hydrostatic thrust g (a^2 + b^2) / 4, per length. The thrust is taken off in the
// formula, where nothing cancels: P - g (a^2 + b^2) / 4 = g (r + l) (a^2 - b^2) / 4 (r - l) for wave speeds l and r.
fn hll(a: vec2f, b: vec2f) -> vec2f {
    let speeds = wave_speeds(a, b);
    let inverse = 1.0 / max(speeds.y - speeds.x, 1e-20);
    let volume_a = a.x * a.y;
    let volume_b = b.x * b.y;
    let both = speeds.x * speeds.y;
    let volume = speeds.y * volume_a - speeds.x * volume_b + both * (b.x - a.x);
    let advected = speeds.y * volume_a * a.y - speeds.x * volume_b * b.y + both * (volume_b - volume_a);
    let thrust = 0.25 * parameters.gravity * (speeds.y + speeds.x) * (a.x - b.x) * (a.x + b.x);
    return vec2f(volume, advected + thrust) * inverse;
}
