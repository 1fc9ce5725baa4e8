//! Water swinging in a paraboloid.

use super::super::thacker;
use super::profile::numbers;
use corpuscle_model::ModelError;
use std::path::Path;

pub(super) fn curved(path: &Path, spacing: f64) -> Result<f64, ModelError> {
    error(path, spacing, thacker::curved, std::f64::consts::TAU / thacker::omega())
}

pub(super) fn plane(path: &Path, spacing: f64) -> Result<f64, ModelError> {
    error(path, spacing, thacker::plane, 2.0 * std::f64::consts::TAU / thacker::omega())
}

/// The error after three periods, where the file has the solution; its origin is a corner, not the middle.
fn error(path: &Path, spacing: f64, exact: thacker::Exact, period: f64) -> Result<f64, ModelError> {
    let flood = thacker::swing(exact, 3.0 * period, spacing)?;
    let (mut wrong, mut right) = (0.0, 0.0);
    for row in numbers(path)? {
        let [x, y, depth, ..] = row[..] else { continue };
        wrong += (flood.sample(x - 2.0, y - 2.0).depth - depth).abs();
        right += depth;
    }
    Ok(wrong / right)
}
