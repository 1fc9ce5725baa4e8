//! Water swinging in a paraboloid.

use super::super::thacker::{self, swing};
use super::numbers;
use corpuscle_model::ModelError;
use std::f64::consts::TAU;
use std::path::Path;

pub(super) fn curved(path: &Path, spacing: f64, seed: u64) -> Result<f64, ModelError> {
    error(path, thacker::curved, TAU / thacker::omega(), spacing, seed)
}

pub(super) fn plane(path: &Path, spacing: f64, seed: u64) -> Result<f64, ModelError> {
    error(path, thacker::plane, 2.0 * TAU / thacker::omega(), spacing, seed)
}

/// The error after three periods, where the file has the solution; its origin is a corner, not the middle.
fn error(path: &Path, exact: thacker::Exact, period: f64, spacing: f64, seed: u64) -> Result<f64, ModelError> {
    let flood = swing(exact, 3.0 * period, spacing, seed)?;
    let (mut wrong, mut right) = (0.0, 0.0);
    for row in numbers(path)? {
        let [x, y, depth, ..] = row[..] else { continue };
        wrong += (flood.sample(x - 2.0, y - 2.0).depth - depth).abs();
        right += depth;
    }
    Ok(wrong / right)
}
