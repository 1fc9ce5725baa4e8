//! Generated ground. Its origin is the south-west corner; the same seed gives the same bits on every machine.

mod hills;
mod noise;
mod shapes;
mod valley;

pub(crate) use hills::make as rough_hills;
pub(crate) use shapes::{bowl, bump, plane};
pub(crate) use valley::make as valley;
pub use valley::valley_centre;

use crate::raster::MOST_CELLS;
use crate::{Bounds, TerrainError};
use corpuscle_scene::Extent;

/// The rectangle of generated ground, refusing sizes that make none.
fn bounds(table: &str, extent: &Extent) -> Result<Bounds, TerrainError> {
    let Extent { length_m, width_m, cell_m } = *extent;
    positive(&format!("{table}.extent"), &[("length_m", length_m), ("width_m", width_m), ("cell_m", cell_m)])?;
    let cells = (length_m / cell_m).ceil() * (width_m / cell_m).ceil();
    if cells > MOST_CELLS as f64 {
        return Err(TerrainError::Shape(format!(
            "[terrain.{table}.extent] asks for {cells:.0} cells, more than the {} million that can be used; make \
             cell_m larger",
            MOST_CELLS / 1_000_000
        )));
    }
    if cell_m > 0.5 * length_m.min(width_m) {
        return Err(TerrainError::Shape(format!(
            "[terrain.{table}.extent] has cell_m = {cell_m}, but at least two cells must fit into length_m = {length_m} \
             and width_m = {width_m}"
        )));
    }
    Ok(Bounds { x_min: 0.0, x_max: length_m, y_min: 0.0, y_max: width_m })
}

/// Refuses numbers that are not positive and finite.
fn positive(table: &str, numbers: &[(&str, f64)]) -> Result<(), TerrainError> {
    check(table, numbers, "a positive number", |value| value > 0.0 && value.is_finite())
}

/// Refuses numbers that are negative or not finite.
fn not_negative(table: &str, numbers: &[(&str, f64)]) -> Result<(), TerrainError> {
    check(table, numbers, "a number from 0 up", |value| value >= 0.0 && value.is_finite())
}

/// Refuses numbers that are not finite.
fn finite(table: &str, numbers: &[(&str, f64)]) -> Result<(), TerrainError> {
    check(table, numbers, "a finite number", f64::is_finite)
}

fn check(table: &str, numbers: &[(&str, f64)], wanted: &str, good: fn(f64) -> bool) -> Result<(), TerrainError> {
    match numbers.iter().find(|(_, value)| !good(*value)) {
        None => Ok(()),
        Some((key, value)) => {
            Err(TerrainError::Shape(format!("{key} = {value} in [terrain.{table}] must be {wanted}")))
        }
    }
}
