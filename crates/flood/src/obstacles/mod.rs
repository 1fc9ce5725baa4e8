//! Rigid obstacles of a scene: buildings and walls that water flows around.

mod clip;
mod lines;
mod open;
mod outline;
mod shapefile;
mod shapes;

pub(crate) use clip::{side_within, surroundings};
pub(crate) use lines::{Line, lines};
pub(crate) use open::{check_overlap, open, polygons};
#[cfg(feature = "gpu")]
pub(crate) use outline::OutlineCells;
pub(crate) use outline::{Outline, Outlines};
pub use shapes::{LineWall, line_walls, obstacle_shapes};

use corpuscle_model::GaugeColumn;

/// Gauge columns of an obstacle: the force on it, and its sum over time.
pub(crate) fn force_columns(name: &str) -> [GaugeColumn; 4] {
    let column = |quantity, unit| GaugeColumn { gauge: name.into(), quantity, unit };
    [
        column("force_east", "N"),
        column("force_north", "N"),
        column("impulse_east", "N_s"),
        column("impulse_north", "N_s"),
    ]
}
