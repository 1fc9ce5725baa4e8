//! Air that starts out of order, to show that what is computed does not depend on how its particles are arranged.

use super::Dew;
use crate::air::Role;
use crate::faces::Free;
use corpuscle_model::{Account, CompensatedSum};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// How a [`Dew::scatter`] arranges the air.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scatter {
    /// Particles are moved by up to this along each axis, in spacings.
    pub reach: f64,
    /// Sweeps by which they are then evened out: none leaves them at random, some hundred until they stand still.
    pub sweeps: u32,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// Random positions tried for a particle; it stays where none is free.
const SCATTER_TRIES: u32 = 30;

impl Dew {
    /// Moves the air in the room to random positions outside of solids, as there from the start; `start` gives temperature, K, and
    /// vapour, part of the mass, at a position. Where several processes share the air all of them call this, and positions depend on their number.
    pub fn scatter(&mut self, scatter: Scatter, start: impl Fn([f64; 3]) -> [f64; 2]) {
        let (room, reach) = (self.room, scatter.reach * self.scale.spacing);
        let known = || self.surfaces.iter().cloned().map(Some);
        let unknown = if self.surfaces.is_empty() { self.solids.bodies.len() } else { 0 };
        let surfaces: Vec<_> = known().chain((0..unknown).map(|_| None)).collect();
        let free = Free::new(&self.solids, &room, &self.scale, surfaces.into_iter());
        let mut random = ChaCha8Rng::seed_from_u64(scatter.seed);
        for particle in self.state.air.iter_mut().filter(|particle| particle.role == Role::Inside) {
            for _ in 0..SCATTER_TRIES {
                let mut position = particle.position.map(|at| at + reach * (2.0 * random.random::<f64>() - 1.0));
                room.keep(&mut position, &mut [0.0; 3]);
                if room.contains(position) && free.holds(position) {
                    particle.position = position;
                    break;
                }
            }
        }
        self.spread_evenly(scatter.sweeps);
        for particle in self.state.air.iter_mut().filter(|particle| particle.role == Role::Inside) {
            [particle.temperature, particle.vapour] = start(particle.position);
        }
        self.evaluate(0.0);
        self.take_as_rest();
        self.evaluate(0.0);
        self.state.time_step = self.next_step(&[], self.extremes());
        // Inflow and outflow before are no part of the run.
        self.state.water = Account { initial: self.water(), ..Account::default() };
        self.state.energy = Account { initial: self.energy(), ..Account::default() };
        self.state.held_heat.fill(CompensatedSum::default());
    }
}
