//! How many balls are at a distance from a ball: g(r).

use super::Snapshot;
use crate::hash::Hash;
use serde::{Deserialize, Serialize};

/// Balls around which others are counted at one time, at most.
const CENTRES: usize = 2000;

/// Counts of distances.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Pairs {
    /// Distance up to which is counted.
    pub reach: f64,
    /// Pairs in shells of equal thickness.
    pub counts: Vec<u64>,
    /// Pairs that there would be, for each unit of area or volume of a shell, if all positions were equally likely.
    pub expected: f64,
}

impl Pairs {
    pub fn new(reach: f64, bins: usize) -> Self {
        Pairs { reach, counts: vec![0; bins], expected: 0.0 }
    }

    /// Counts around balls that are farther from walls than is counted.
    pub fn count<const D: usize>(&mut self, snapshot: &Snapshot<D>) {
        if self.reach <= 0.0 {
            return;
        }
        let low = snapshot.extent.map(|[low, _]| low);
        let length: [f64; D] = snapshot.extent.map(|[low, high]| high - low);
        let balls = snapshot.position.len();
        let mut hash = Hash::new(low, length, snapshot.period, self.reach, balls).slid(snapshot.slid);
        for position in &snapshot.position {
            hash.add(*position, 0.0);
        }
        let inner = |position: &[f64; D]| {
            (0..D).all(|axis| {
                let [low, high] = snapshot.extent[axis];
                let x = position[axis];
                snapshot.period[axis] > 0.0 || (x - low >= self.reach && high - x >= self.reach)
            })
        };
        let stride = balls.div_ceil(CENTRES).max(1);
        // Centres stay a radius away from walls.
        let density = (balls as f64 - 1.0) / snapshot.sample.open;
        for (number, position) in snapshot.position.iter().enumerate().step_by(stride) {
            if !inner(position) {
                continue;
            }
            let (counts, reach) = (&mut self.counts, self.reach);
            hash.near(position, |other, distance| {
                if other != number {
                    super::tally(counts, distance / reach);
                }
            });
            self.expected += density;
        }
    }

    /// Middle of each shell and g there.
    pub fn g<const D: usize>(&self) -> Vec<[f64; 2]> {
        let step = self.reach / self.counts.len() as f64;
        let ball = crate::ball_volume::<D>;
        let shell = |bin: usize| ball((bin + 1) as f64 * step) - ball(bin as f64 * step);
        let point =
            |(bin, &count): (usize, &u64)| [(bin as f64 + 0.5) * step, count as f64 / (self.expected * shell(bin))];
        self.counts.iter().enumerate().map(point).collect()
    }
}
