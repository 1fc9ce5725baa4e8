//! Theory of hard disks and balls, in units of their diameter and mass and of the temperature.

use corpuscle_gas::ball_volume;
pub(super) use corpuscle_gas::theory::compressibility;
use corpuscle_gas::theory::{self, contact_value};
use std::f64::consts::PI;

/// Balls in a unit of area or volume.
fn density<const D: usize>(packing: f64) -> f64 {
    packing / ball_volume::<D>(0.5)
}

/// Compressibility of balls by an equation of state that the gas does not use: Carnahan & Starling, J. Chem. Phys. 51 (1969) 635, equation 8.
pub(super) fn carnahan_starling(x: f64) -> f64 {
    (1.0 + x + x * x - x.powi(3)) / (1.0 - x).powi(3)
}

/// Enskog's collisions of a ball in a unit of time.
pub(super) fn collision_rate<const D: usize>(packing: f64) -> f64 {
    theory::collision_rate::<D>(packing, 0.5, 1.0)
}

/// Enskog's self-diffusion of balls, with what higher Sonine polynomials add to the first (Pekeris et al. 1962).
pub(super) fn enskog_diffusion(packing: f64) -> f64 {
    1.01896 * 0.375 / (PI.sqrt() * density::<3>(packing) * contact_value::<3>(packing))
}

/// Enskog's shear viscosity of balls (Chapman & Cowling 1970, section 16.42).
pub(super) fn enskog_viscosity(packing: f64) -> f64 {
    let dilute = 1.01600 * 5.0 / (16.0 * PI.sqrt());
    let (excluded, collisions) = (4.0 * packing, 4.0 * packing * contact_value::<3>(packing));
    dilute * excluded * (1.0 / collisions + 0.8 + 0.7614 * collisions)
}

/// Enskog's thermal conductivity of balls (Chapman & Cowling 1970, section 16.42).
pub(super) fn enskog_conductivity(packing: f64) -> f64 {
    let dilute = 1.02513 * 75.0 / (64.0 * PI.sqrt());
    let (excluded, collisions) = (4.0 * packing, 4.0 * packing * contact_value::<3>(packing));
    dilute * excluded * (1.0 / collisions + 1.2 + 0.7574 * collisions)
}

/// Self-diffusion of balls over Enskog's by molecular dynamics, for an infinite system: Erpenbeck & Wood, Phys. Rev. A 43 (1991) 4254.
pub(super) fn diffusion_over_enskog(packing: f64) -> f64 {
    let x = density::<3>(packing) / 2_f64.sqrt();
    1.0 + 0.054034 * x + 6.3656 * x * x - 10.9425 * x.powi(3)
}

/// Correction of the self-diffusion of a ball for its images in a periodic cube of this side (Duenweg & Kremer, J. Chem. Phys. 99, 1993,
/// 6983; Yeh & Hummer, J. Phys. Chem. B 108, 2004, 15873).
pub(super) fn slowed_by_images(side: f64, viscosity: f64) -> f64 {
    2.837_297 / (6.0 * PI * viscosity * side)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn enskog_gives_the_printed_diffusion() {
        assert!((enskog_diffusion(0.3) / 1.01896 / 0.1485 - 1.0).abs() < 1e-3);
    }
}
