//! Free pistons that carry more energy than the gas can take up, or hardly any mass.

use super::positions::closest;
use super::random::Placed;
use super::{Setup, Side, ball_volume};
use crate::SetupError;
use crate::functions::pow;

/// Least mean gap between neighbours, over their diameter, to which a piston may press a gas; and over the gap at the start, where that
/// is small.
const LEAST_GAP: f64 = 0.02;
const LEAST_PART: f64 = 0.1;

/// Least mass of a piston over that of a ball. A ball that meets a lighter one hits it as many times in a row as it is heavier, about.
const LIGHTEST: f64 = 1e-6;

impl<const D: usize> Setup<D> {
    /// No piston will press the balls together until they hardly move.
    ///
    /// In the free-volume theory of dense balls, Z = 1 / (1 - (packing / closest)^(1/D)) (Salsburg and Wood, J. Chem. Phys. 37, 1962, 798,
    /// where it is shown to be exact near close packing), compression without heat keeps energy times gap squared, the gap being that
    /// between neighbours over their diameter: (closest / packing)^(1/D) - 1. A piston faster than sound heats the gas more: what the
    /// balls have at the piston's speed is counted as energy that they have at first.
    pub(crate) fn check_pistons(&self, balls: &[Placed<D>]) -> Result<(), SetupError> {
        let filled: f64 = balls.iter().map(|placed| ball_volume::<D>(placed.radius)).sum();
        let largest = balls.iter().map(|placed| placed.radius).fold(0.0, f64::max);
        let limit = if balls.iter().all(|placed| placed.radius == largest) { closest::<D>() } else { 1.0 };
        let volume: f64 = self.size.iter().product();
        let gap = (pow(limit * volume / filled, 1.0 / D as f64) - 1.0).max(0.0);
        let [mass, energy] = self.mass_and_energy();
        let heaviest = self
            .balls
            .iter()
            .map(|ball| ball.mass)
            .chain(self.species.iter().map(|species| species.mass))
            .fold(0.0, f64::max);
        let (mut work, mut shock) = (0.0, 0.0);
        for (axis, side) in (0..D).flat_map(|axis| self.sides[axis].iter().map(move |side| (axis, side))) {
            if let Side::Piston { mass: heavy, .. } = side {
                if *heavy < LIGHTEST * heaviest {
                    return Err(SetupError::Contradiction(format!(
                        "a piston of mass {heavy:e} is too light for balls of mass {heaviest:e}: each would hit it some {:.0e} times in a \
                         row. Take one of mass {:e} at least",
                        heaviest / heavy,
                        LIGHTEST * heaviest
                    )));
                }
                let brings = self.work_of(axis, side, filled / limit);
                (work, shock) = (work + brings, shock + brings * mass / heavy);
            }
        }
        let least = gap * ((energy + shock) / (energy + shock + work)).sqrt();
        // Energies beyond all numbers crush, too.
        let bears = least >= LEAST_GAP.min(LEAST_PART * gap);
        if work > 0.0 && !bears {
            return Err(SetupError::Contradiction(format!(
                "a piston would crush the gas: it brings an energy of {work:.3e}, by its motion and the pressure behind it, against {energy:.3e} \
                 of the balls, and would press them together until their gaps are {least:.1e} of a diameter, where they hit each other \
                 ever faster. Take a lighter or slower piston, or less pressure"
            )));
        }
        Ok(())
    }

    /// Energy that a piston can give, until the balls fill all that is left.
    fn work_of(&self, axis: usize, side: &Side, filled: f64) -> f64 {
        let Side::Piston { mass, pressure, velocity } = *side else { return 0.0 };
        let inward = if std::ptr::eq(side, &self.sides[axis][0]) { velocity } else { -velocity };
        // Without a pressure one that goes out does not come back.
        let motion = if inward > 0.0 || pressure > 0.0 { 0.5 * mass * velocity * velocity } else { 0.0 };
        motion + pressure * (self.size.iter().product::<f64>() - filled).max(0.0)
    }

    /// Mass and kinetic energy of all balls at the start.
    fn mass_and_energy(&self) -> [f64; 2] {
        let square = |velocity: &[f64; D]| velocity.iter().map(|v| v * v).sum::<f64>();
        let alone = self.balls.iter().map(|ball| [ball.mass, 0.5 * ball.mass * square(&ball.velocity)]);
        let crowds = self.species.iter().map(|species| {
            let mass = self.count_of(species) as f64 * species.mass;
            let thermal = D as f64 * self.boltzmann * species.temperature / species.mass;
            [mass, 0.5 * mass * (thermal + square(&species.velocity))]
        });
        alone.chain(crowds).fold([0.0; 2], |sum, part| [sum[0] + part[0], sum[1] + part[1]])
    }
}
