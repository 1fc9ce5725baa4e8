//! How far species are mixed.

use super::Snapshot;
use crate::functions::{ln, pow};

/// Balls in a cell, about, in which the mixing is measured.
const PER_CELL: f64 = 25.0;

/// Entropy of mixing in units of Boltzmann's constant: minus the sum over balls of ln(part of their own set in their cell), with the
/// bias of small counts taken off (Miller 1955): 0 apart, N ln 2 for two equal parts fully mixed.
pub(crate) fn mixing_entropy<const D: usize>(snapshot: &Snapshot<D>, sets: usize) -> f64 {
    let balls = snapshot.position.len();
    // An even number, so that the middle of the box, where halves meet, is not within cells.
    let across = (2 * (pow(balls as f64 / PER_CELL, 1.0 / D as f64) / 2.0).round() as usize).max(1);
    let cells = across.pow(D as u32);
    let mut counts = vec![0.0; cells * sets];
    for (position, &set) in snapshot.position.iter().zip(&snapshot.set) {
        let cell = (0..D).fold(0, |cell, axis| {
            let [low, high] = snapshot.extent[axis];
            let along = ((position[axis] - low) / (high - low) * across as f64).max(0.0) as usize;
            cell * across + along.min(across - 1)
        });
        counts[cell * sets + set as usize] += 1.0;
    }
    let mut entropy = 0.0;
    for cell in counts.chunks_exact(sets) {
        let total: f64 = cell.iter().sum();
        let kinds = cell.iter().filter(|&&count| count > 0.0);
        entropy += kinds.clone().map(|&count| -count * ln(count / total)).sum::<f64>();
        entropy += 0.5 * (kinds.count() as f64 - 1.0).max(0.0);
    }
    entropy
}
