//! Initial velocities: at exactly the given temperature, with no momentum but the given one.

use super::{Setup, Side, Species, Speeds};
use crate::functions::{cos, sin};
use crate::random::{direction, normal};
use rand_chacha::ChaCha8Rng;

impl<const D: usize> Setup<D> {
    /// Whether the momentum along an axis is conserved: it is periodic, and there is no gravity along it.
    pub(crate) fn conserves_momentum(&self, axis: usize) -> bool {
        self.sides[axis][0] == Side::Periodic && self.gravity[axis] == 0.0
    }

    /// Parts of the motion of `balls` balls that are free: less those along axes on which the momentum is conserved.
    pub(crate) fn degrees_of_freedom(&self, balls: usize) -> f64 {
        (D * balls) as f64 - (0..D).filter(|axis| self.conserves_momentum(*axis)).count() as f64
    }

    /// Velocities of the balls of all species, in order.
    pub(crate) fn velocities(&self, random: &mut ChaCha8Rng) -> Vec<Vec<[f64; D]>> {
        let counts: Vec<usize> = self.species.iter().map(|species| self.count_of(species)).collect();
        let all = counts.iter().sum::<usize>() + self.balls.len();
        let each = self.degrees_of_freedom(all) / all as f64;
        let mut velocities: Vec<Vec<[f64; D]>> = Vec::new();
        for (species, &count) in self.species.iter().zip(&counts) {
            // Half of m v^2, summed over the balls.
            let energy = 0.5 * each * count as f64 * self.boltzmann * species.temperature;
            velocities.push(match species.speeds {
                Speeds::Maxwell => self.maxwell(species, count, energy, random),
                Speeds::Equal => equal(count, (2.0 * energy / (species.mass * count as f64)).sqrt(), random),
            });
        }
        if self.balls.is_empty() {
            self.take_off_momentum(&mut velocities);
        }
        for (species, velocities) in self.species.iter().zip(&mut velocities) {
            shift(velocities, species.velocity);
        }
        velocities
    }

    fn maxwell(&self, species: &Species<D>, count: usize, energy: f64, random: &mut ChaCha8Rng) -> Vec<[f64; D]> {
        let thermal = (self.boltzmann * species.temperature / species.mass).sqrt();
        let mut velocities: Vec<[f64; D]> =
            (0..count).map(|_| std::array::from_fn(|_| thermal * normal(random))).collect();
        if count > 1 {
            settle(&mut velocities);
            scale_to(&mut velocities, 2.0 * energy / species.mass);
        }
        velocities
    }

    /// What single balls carry is taken off the others, whose energy stays.
    fn take_off_momentum(&self, velocities: &mut [Vec<[f64; D]>]) {
        let masses = || self.species.iter().map(|species| species.mass);
        let mut momentum = [0.0; D];
        for (mass, velocities) in masses().zip(velocities.iter()) {
            for axis in 0..D {
                momentum[axis] += mass * velocities.iter().map(|v| v[axis]).sum::<f64>();
            }
        }
        let others: f64 =
            masses().zip(velocities.iter()).filter(|(_, v)| v.len() > 1).map(|(m, v)| m * v.len() as f64).sum();
        let singles = velocities.iter().any(|velocities| velocities.len() == 1);
        if !singles || others == 0.0 {
            return;
        }
        for velocities in velocities.iter_mut().filter(|velocities| velocities.len() > 1) {
            shift(velocities, momentum.map(|p| -p / others));
        }
    }
}

/// All of one speed, in pairs of opposite directions; three that are left over in a plane.
fn equal<const D: usize>(count: usize, speed: f64, random: &mut ChaCha8Rng) -> Vec<[f64; D]> {
    let mut velocities = Vec::with_capacity(count);
    let triple = if count % 2 == 1 && count > 1 { 3 } else { 0 };
    while velocities.len() + triple + 1 < count {
        let one = direction::<D>(random).map(|x| x * speed);
        velocities.extend([one, one.map(|v| -v)]);
    }
    if triple == 3 {
        let turn = std::f64::consts::TAU * rand::RngExt::random::<f64>(random);
        for third in 0..3 {
            let angle = turn + std::f64::consts::TAU * f64::from(third) / 3.0;
            velocities.push(std::array::from_fn(|axis| speed * [cos(angle), sin(angle), 0.0][axis]));
        }
    } else if velocities.len() < count {
        velocities.push(direction::<D>(random).map(|x| x * speed));
    }
    // Opposite ones must not be neighbours.
    for at in (1..velocities.len()).rev() {
        velocities.swap(at, rand::RngExt::random_range(random, 0..=at));
    }
    velocities
}

/// Takes off the mean.
fn settle<const D: usize>(velocities: &mut [[f64; D]]) {
    let count = velocities.len() as f64;
    let mean: [f64; D] = std::array::from_fn(|axis| velocities.iter().map(|v| v[axis]).sum::<f64>() / count);
    shift(velocities, mean.map(|v| -v));
}

fn shift<const D: usize>(velocities: &mut [[f64; D]], by: [f64; D]) {
    for velocity in velocities {
        for axis in 0..D {
            velocity[axis] += by[axis];
        }
    }
}

/// Scales to this sum of squares.
fn scale_to<const D: usize>(velocities: &mut [[f64; D]], squares: f64) {
    let now: f64 = velocities.iter().flatten().map(|v| v * v).sum();
    if now > 0.0 {
        let factor = (squares / now).sqrt();
        velocities.iter_mut().flatten().for_each(|v| *v *= factor);
    }
}
