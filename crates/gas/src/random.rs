//! Random numbers of the distributions that gases need.

use crate::functions::{cos, ln};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;

/// A number with mean 0 and variance 1 (Box and Muller 1958).
pub(crate) fn normal(random: &mut ChaCha8Rng) -> f64 {
    flux(random) * cos(TAU * random.random::<f64>())
}

/// A speed in units of the thermal one, with density s exp(-s^2/2): that of molecules that cross a plane.
pub(crate) fn flux(random: &mut ChaCha8Rng) -> f64 {
    (-2.0 * ln(1.0 - random.random::<f64>())).sqrt()
}

/// A direction, any as likely as any other.
pub(crate) fn direction<const D: usize>(random: &mut ChaCha8Rng) -> [f64; D] {
    loop {
        let direction: [f64; D] = std::array::from_fn(|_| normal(random));
        let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length > 1e-3 {
            return direction.map(|x| x / length);
        }
    }
}
