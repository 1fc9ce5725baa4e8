//! The approximate Riemann solver of Harten, Lax & van Leer (1983).

use crate::voronoi::water::THIN;
use corpuscle_simd::{Lanes, Select, Simd, SimdBase, SimdFloat};

/// Speed below which waves carry nothing, m/s: the inverse of a lower one may not be finite.
const SLOWEST: f64 = 1e-100;

/// Depth, m, and velocity across the face, m/s, on one side of eight faces.
#[derive(Clone, Copy)]
pub(crate) struct Sides<S: Simd> {
    pub depth: Lanes<S>,
    pub across: Lanes<S>,
}

/// Flux of volume, m2/s, and of momentum across the face over density, m3/s2, per length, from the first side to the second. Wave speeds
/// after Einfeldt (1988) with the two-rarefaction state (Toro 2001, equations 10.17 to 10.22; 10.24 onto ground with next to no water).
#[inline(always)]
pub(crate) fn hll<S: Simd>(simd: S, a: Sides<S>, b: Sides<S>, gravity: f64) -> [Lanes<S>; 2] {
    let [slowest, fastest] = wave_speeds(simd, a, b, gravity);
    // Where all waves go one way the other side counts for nothing.
    let (slowest, fastest) = (slowest.min(0.0), fastest.max(0.0));
    let (volume_a, volume_b) = (a.depth * a.across, b.depth * b.across);
    let momentum_a = volume_a * a.across + a.depth * a.depth * (0.5 * gravity);
    let momentum_b = volume_b * b.across + b.depth * b.depth * (0.5 * gravity);
    let inverse = Lanes::splat(simd, 1.0) / (fastest - slowest).max(SLOWEST);
    let both = slowest * fastest;
    let volume = (fastest * volume_a - slowest * volume_b + both * (b.depth - a.depth)) * inverse;
    let momentum = (fastest * momentum_a - slowest * momentum_b + both * (volume_b - volume_a)) * inverse;
    [volume, momentum]
}

#[inline(always)]
fn wave_speeds<S: Simd>(simd: S, a: Sides<S>, b: Sides<S>, gravity: f64) -> [Lanes<S>; 2] {
    let [ca, cb] = [(a.depth * gravity).sqrt(), (b.depth * gravity).sqrt()];
    let celerity = ((ca + cb) * 0.5 - (b.across - a.across) * 0.25).max(0.0);
    let velocity = (a.across + b.across) * 0.5 + ca - cb;
    let slowest = (a.across - ca).min(velocity - celerity);
    let fastest = (b.across + cb).max(velocity + celerity);
    let thin = Lanes::splat(simd, THIN);
    let [wet_a, wet_b] = [a.depth.simd_gt(thin), b.depth.simd_gt(thin)];
    let slowest = wet_a.select(wet_b.select(slowest, a.across - ca), b.across - cb * 2.0);
    let fastest = wet_a.select(wet_b.select(fastest, a.across + ca * 2.0), b.across + cb);
    [slowest, fastest]
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_simd::{Level, dispatch};

    const G: f64 = 9.81;

    /// The flux between two sides of `[depth, velocity]`.
    fn flux(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
        dispatch!(Level::new(), simd => {
            let sides = |[depth, across]: [f64; 2]| Sides { depth: Lanes::splat(simd, depth), across: Lanes::splat(simd, across) };
            hll(simd, sides(a), sides(b), G).map(|lanes| lanes[3])
        })
    }

    #[test]
    fn equal_sides_have_their_own_flux() {
        for across in [-9.0, -1.0, 0.0, 2.0, 9.0] {
            let [volume, momentum] = flux([2.0, across], [2.0, across]);
            assert!((volume - 2.0 * across).abs() < 1e-14);
            assert!((momentum - (2.0 * across * across + 2.0 * G)).abs() < 1e-12);
        }
    }

    #[test]
    fn mirrored_sides_have_the_mirrored_flux() {
        let [volume, momentum] = flux([1.3, 0.7], [0.2, -1.1]);
        let [back, same] = flux([0.2, 1.1], [1.3, -0.7]);
        assert!((volume + back).abs() < 1e-15 && (momentum - same).abs() < 1e-14);
    }

    #[test]
    fn water_runs_onto_dry_ground() {
        let [volume, _] = flux([1.0, 0.0], [0.0, 0.0]);
        // From u - c and u + 2c: 2/3 g^(1/2) h^(3/2). Exact is 8/27 (Ritter 1892).
        assert!((volume / (2.0 / 3.0 * G.sqrt()) - 1.0).abs() < 1e-12, "{volume}");
        assert_eq!(flux([0.0, 0.0], [0.0, 3.0]), [0.0; 2]);
    }

    #[test]
    fn next_to_no_velocity_passes_next_to_nothing() {
        for across in [1e-320, -1e-320, 1e-200, 0.0] {
            for depth in [0.0, 1e-320, 1e-200] {
                for [volume, momentum] in [flux([depth, across], [0.0, across]), flux([0.0, across], [depth, across])] {
                    assert!(volume.abs() < 1e-90 && momentum.abs() < 1e-90, "{depth} {across}: {volume} {momentum}");
                }
            }
        }
    }
}
