//! What is known of hard disks and balls, in units of their diameter and mass and of the temperature.

use corpuscle_gas::ball_volume;
use std::f64::consts::PI;

/// Compressibility of the fluid: P V / N T.
///
/// Disks: Kolafa & Rottner, Mol. Phys. 104 (2006) 3435, fitted up to a packing of 0.7069. Balls: Kolafa's equation, in Boublik &
/// Nezbeda, Collect. Czech. Chem. Commun. 51 (1986) 2301.
pub(super) fn compressibility<const D: usize>(packing: f64) -> f64 {
    if D == 2 {
        let x = packing / (1.0 - packing);
        return KOLAFA_ROTTNER.iter().map(|&(power, factor)| factor * x.powi(power)).sum();
    }
    let squared = packing * packing;
    (1.0 + packing + squared - 2.0 / 3.0 * (squared * packing + squared * squared)) / (1.0 - packing).powi(3)
}

/// Powers of x and their factors.
const KOLAFA_ROTTNER: [(i32, f64); 15] = [
    (0, 1.0),
    (1, 2.0),
    (2, 1.12801775),
    (3, 0.00181895291),
    (4, -0.0526134737),
    (5, 0.0504960168),
    (6, -0.0325537792),
    (7, 0.0134578632),
    (8, 0.00140888182),
    (9, -0.00834273601),
    (10, 0.00694127367),
    (11, -0.00262254723),
    (12, 0.000355746352),
    (22, -5.24672938e-9),
    (57, 5.88054639e-23),
];

/// g at contact, by the virial theorem: Z = 1 + 2^(D-1) packing chi.
pub(super) fn contact_value<const D: usize>(packing: f64) -> f64 {
    (compressibility::<D>(packing) - 1.0) / (2_f64.powi(D as i32 - 1) * packing)
}

/// Balls in a unit of area or volume.
pub(super) fn density<const D: usize>(packing: f64) -> f64 {
    packing / ball_volume::<D>(0.5)
}

/// Enskog's collisions of a ball in a unit of time (Chapman & Cowling 1970, section 16.21; in the plane likewise).
pub(super) fn collision_rate<const D: usize>(packing: f64) -> f64 {
    let solid = if D == 2 { 2.0 } else { 4.0 };
    solid * PI.sqrt() * density::<D>(packing) * contact_value::<D>(packing)
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

/// Self-diffusion of balls over Enskog's by molecular dynamics, for an infinite system: Erpenbeck & Wood, Phys. Rev. A 43 (1991) 4254.
pub(super) fn diffusion_over_enskog(packing: f64) -> f64 {
    let x = density::<3>(packing) / 2_f64.sqrt();
    1.0 + 0.054034 * x + 6.3656 * x * x - 10.9425 * x.powi(3)
}

/// What the images of a ball in a periodic cube of this side take off its self-diffusion (Duenweg & Kremer, J. Chem. Phys. 99, 1993,
/// 6983; Yeh & Hummer, J. Phys. Chem. B 108, 2004, 15873).
pub(super) fn slowed_by_images(side: f64, viscosity: f64) -> f64 {
    2.837_297 / (6.0 * PI * viscosity * side)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn agree(found: f64, known: f64, within: f64) {
        assert!((found / known - 1.0).abs() < within, "{found} {known}");
    }

    #[test]
    fn equations_of_state_give_their_printed_values() {
        for (packing, known) in [(0.3, 2.06326), (0.5, 4.10636), (0.6, 6.45534), (0.65, 8.40804)] {
            agree(compressibility::<2>(packing), known, 2e-6);
        }
        for (packing, known) in [(0.1, 1.52163), (0.2, 2.40937), (0.3, 3.98426), (0.4, 6.94568), (0.49, 12.1615)] {
            agree(compressibility::<3>(packing), known, 4e-6);
        }
    }

    #[test]
    fn enskog_gives_the_printed_rates() {
        agree(collision_rate::<3>(0.3), 10.102, 1e-4);
        agree(collision_rate::<3>(0.49), 37.78, 1e-4);
        agree(collision_rate::<2>(0.3), 2.3995, 1e-4);
        agree(collision_rate::<2>(0.6), 12.311, 1e-4);
        agree(enskog_diffusion(0.3) / 1.01896, 0.1485, 1e-3);
    }
}
