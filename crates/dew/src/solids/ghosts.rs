//! Ghost samples: random, evenly spread, throughout a solid (Schechter & Bridson, Ghost SPH, 2012).

use super::{Body, distance_squared};
use crate::air::Scale;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::collections::HashMap;

/// Tries to find room for a sample (their section 4).
const TRIES: u32 = 30;

/// Least distance of samples over the spacing of the air: denser than the air.
const NEAREST: f64 = 0.8;

/// Times that every sample looks for a better place.
const SWEEPS: u32 = 3;

/// Samples of a body and the volume that each stands for, m3. None where the body does not tell its surface.
pub fn ghosts(body: &Body, scale: &Scale, seed: u64) -> Option<(Vec<[f64; 3]>, f64)> {
    let surface = body.surface.as_ref()?;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let apart = NEAREST * scale.spacing;
    let mut samples =
        Samples { apart, inside: |place| surface(place) < 0.0, taken: HashMap::new(), places: Vec::new() };
    samples.fill(body, scale.spacing, &mut random);
    samples.relax(&mut random);
    let volume = body.volumes.iter().sum::<f64>() / samples.places.len() as f64;
    Some((samples.places, volume))
}

struct Samples<F> {
    apart: f64,
    inside: F,
    /// Samples in each cell of side `apart`.
    taken: HashMap<[i64; 3], Vec<usize>>,
    places: Vec<[f64; 3]>,
}

impl<F: Fn([f64; 3]) -> bool> Samples<F> {
    fn cell(&self, place: [f64; 3]) -> [i64; 3] {
        place.map(|at| (at / self.apart).floor() as i64)
    }

    /// Throws samples into cells so small that each holds one at most; every cell is tried [`TRIES`] times.
    fn fill(&mut self, body: &Body, spacing: f64, random: &mut ChaCha8Rng) {
        let side = self.apart / 3.0_f64.sqrt();
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for position in &body.positions {
            for axis in 0..3 {
                low[axis] = low[axis].min(position[axis] - spacing);
                high[axis] = high[axis].max(position[axis] + spacing);
            }
        }
        let counts = [0, 1, 2].map(|axis| ((high[axis] - low[axis]) / side).ceil() as u64);
        for number in 0..counts.iter().product() {
            let cell = [number % counts[0], number / counts[0] % counts[1], number / counts[0] / counts[1]];
            for _ in 0..TRIES {
                let place = [0, 1, 2].map(|axis| low[axis] + side * (cell[axis] as f64 + random.random::<f64>()));
                if (self.inside)(place) && self.room(place, None) >= self.apart * self.apart {
                    self.taken.entry(self.cell(place)).or_default().push(self.places.len());
                    self.places.push(place);
                    break;
                }
            }
        }
    }

    /// Square of the distance to the nearest sample but `except`; more than the square of `apart` where none is near.
    fn room(&self, place: [f64; 3], except: Option<usize>) -> f64 {
        let middle = self.cell(place);
        let mut nearest = 4.0 * self.apart * self.apart;
        for which in 0..27_i64 {
            let cell = [which % 3, which / 3 % 3, which / 9];
            let cell = [0, 1, 2].map(|axis| middle[axis] + cell[axis] - 1);
            for &other in self.taken.get(&cell).into_iter().flatten().filter(|&&other| Some(other) != except) {
                nearest = nearest.min(distance_squared(place, self.places[other]));
            }
        }
        nearest
    }

    /// Moves each sample to the roomiest of some random places near it (their algorithm 2).
    fn relax(&mut self, random: &mut ChaCha8Rng) {
        for sweep in 0..SWEEPS {
            let reach = self.apart / f64::from(1 << sweep);
            for number in 0..self.places.len() {
                let from = self.places[number];
                let mut best = (self.room(from, Some(number)), from);
                for _ in 0..TRIES {
                    let place = from.map(|at| at + reach * (2.0 * random.random::<f64>() - 1.0));
                    let room = self.room(place, Some(number));
                    if room > best.0 && (self.inside)(place) {
                        best = (room, place);
                    }
                }
                let (old, new) = (self.cell(from), self.cell(best.1));
                if let Some(cell) = self.taken.get_mut(&old) {
                    cell.retain(|&other| other != number);
                }
                self.taken.entry(new).or_default().push(number);
                self.places[number] = best.1;
            }
        }
    }
}
