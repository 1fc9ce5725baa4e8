//! What is known of hard disks and balls in equilibrium.

use std::f64::consts::PI;

/// Compressibility P V / N T of the fluid at a packing.
///
/// Disks: Kolafa & Rottner, Mol. Phys. 104 (2006) 3435, fitted up to a packing of 0.7069. Balls: Kolafa's equation, in Boublik &
/// Nezbeda, Collect. Czech. Chem. Commun. 51 (1986) 2301.
pub fn compressibility<const D: usize>(packing: f64) -> f64 {
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
pub fn contact_value<const D: usize>(packing: f64) -> f64 {
    (compressibility::<D>(packing) - 1.0) / (2_f64.powi(D as i32 - 1) * packing)
}

/// Enskog's collisions of a ball in a unit of time, for balls of this radius and this thermal speed sqrt(T/m) (Chapman & Cowling
/// 1970, section 16.21; in the plane likewise).
pub fn collision_rate<const D: usize>(packing: f64, radius: f64, thermal_speed: f64) -> f64 {
    let solid = if D == 2 { 2.0 } else { 4.0 };
    let density = packing / crate::ball_volume::<D>(radius);
    let diameter = 2.0 * radius;
    solid * PI.sqrt() * density * diameter.powi(D as i32 - 1) * contact_value::<D>(packing) * thermal_speed
}

/// Time in which a granular gas that stays even cools to a quarter: T = T0 / (1 + t / tau)^2 (Haff, J. Fluid Mech. 134, 1983, 401).
///
/// Balls meet with a mean square of the normal speed of 4 T/m, and a collision takes (1 - e^2)/4 of m times that; so
/// 1 / tau = (1 - e^2) w / (2 D), w the collisions of a ball in a unit of time at the start.
pub fn haff_time<const D: usize>(restitution: f64, collision_rate: f64) -> f64 {
    2.0 * D as f64 / ((1.0 - restitution * restitution) * collision_rate)
}

/// Steps in which laws are integrated.
const STEPS: usize = 200;

/// Packing over height of an atmosphere in balance, at heights from 0 to 1 of the box: dP/dh = -m g n, P = n T Z. `weight` is
/// m g H / T, H the box's height, and `mean` the packing of the whole.
pub fn atmosphere<const D: usize>(mean: f64, weight: f64) -> Vec<f64> {
    // d(packing Z)/d(packing), by a central difference.
    let stiffness = |packing: f64| {
        let step = 1e-4 * packing;
        let pressure = |packing: f64| packing * compressibility::<D>(packing);
        (pressure(packing + step) - pressure(packing - step)) / (2.0 * step)
    };
    let fall = |packing: f64| -weight / stiffness(packing);
    let above = |ground: f64| {
        let width = 1.0 / STEPS as f64;
        let mut packings = vec![ground];
        for step in 0..STEPS {
            let half = packings[step] * (0.5 * width * fall(packings[step])).exp();
            packings.push(packings[step] * (width * fall(half)).exp());
        }
        packings
    };
    let average =
        |packings: &[f64]| (packings.iter().sum::<f64>() - 0.5 * (packings[0] + packings[STEPS])) / STEPS as f64;
    let (mut low, mut high) = (mean, 0.7_f64.max(mean));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if average(&above(middle)) < mean { low = middle } else { high = middle }
    }
    above(0.5 * (low + high))
}

/// Temperature over that at the start of a gas that is slowly taken from one volume to another, without heat: d ln T =
/// -(2/D) Z d ln V. `packing_at` gives the packing at a volume.
pub fn adiabat<const D: usize>(from: f64, to: f64, packing_at: impl Fn(f64) -> f64) -> f64 {
    let width = (to / from).ln() / STEPS as f64;
    let middles = (0..STEPS).map(|step| from * ((step as f64 + 0.5) * width).exp());
    let integral: f64 = middles.map(|volume| compressibility::<D>(packing_at(volume)) * width).sum();
    (-2.0 / D as f64 * integral).exp()
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
        agree(collision_rate::<3>(0.3, 0.5, 1.0), 10.102, 1e-4);
        agree(collision_rate::<3>(0.49, 0.5, 1.0), 37.78, 1e-4);
        agree(collision_rate::<2>(0.3, 0.5, 1.0), 2.3995, 1e-4);
        agree(collision_rate::<2>(0.6, 0.5, 1.0), 12.311, 1e-4);
        // Half the size, four times the density, a third of the speed.
        agree(collision_rate::<2>(0.6, 0.25, 1.0 / 3.0), 12.311 * 2.0 / 3.0, 1e-4);
    }

    #[test]
    fn a_thin_atmosphere_is_barometric_and_a_dense_one_is_not() {
        let thin = atmosphere::<2>(1e-6, 5.0);
        for (step, packing) in thin.iter().enumerate() {
            let height = step as f64 / STEPS as f64;
            agree(*packing, 1e-6 * 5.0 * (-5.0 * height).exp() / (1.0 - (-5.0_f64).exp()), 2e-4);
        }
        let dense = atmosphere::<2>(0.1, 5.0);
        assert!(dense[0] < 0.5 && dense[0] > dense[STEPS]);
        agree((dense.iter().sum::<f64>() - 0.5 * (dense[0] + dense[STEPS])) / STEPS as f64, 0.1, 1e-9);
    }

    #[test]
    fn a_thin_gas_keeps_t_v_to_the_two_over_d() {
        agree(adiabat::<2>(1.0, 0.5, |_| 1e-9), 2.0, 1e-6);
        agree(adiabat::<3>(1.0, 0.5, |_| 1e-9), 2_f64.powf(2.0 / 3.0), 1e-6);
        assert!(adiabat::<2>(1.0, 0.5, |volume| 0.3 / volume) > 3.0);
    }

    #[test]
    fn haffs_time_is_that_of_the_loss_in_collisions() {
        // dT/dt at the start is -2 T / tau, and -(1 - e^2) w T / D.
        agree(2.0 / haff_time::<2>(0.8, 3.0), 0.36 * 3.0 / 2.0, 1e-12);
    }
}
