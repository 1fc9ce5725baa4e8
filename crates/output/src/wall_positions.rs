//! Positions of the moving walls of a box over a run.

use crate::{GaugeTable, OutputError};
use corpuscle_model::Container;
use std::path::Path;

/// Positions of the moving walls, from a run's gauges.
#[derive(Debug, Clone, PartialEq)]
pub struct WallPositions {
    times: Vec<f64>,
    walls: Vec<MovingWall>,
}

/// A wall across an axis, at its smaller or larger end, and its positions.
#[derive(Debug, Clone, PartialEq)]
struct MovingWall {
    axis: usize,
    is_upper: bool,
    positions: Vec<f64>,
}

impl WallPositions {
    /// Reads the positions of a run from its gauges; empty where no wall moves.
    ///
    /// # Errors
    /// [`OutputError::Read`], [`OutputError::Content`] where `gauges.csv` cannot be used.
    pub fn read(run: &Path) -> Result<Self, OutputError> {
        Ok(Self::of(&GaugeTable::read(&run.join("gauges.csv"))?))
    }

    fn of(gauges: &GaugeTable) -> Self {
        let wall = |axis: usize, is_upper: bool| {
            let name = format!("{}_{}.position", ["x", "y", "z"][axis], if is_upper { "max" } else { "min" });
            // With its unit, where the scene has units.
            let column = gauges.columns.iter().find(|column| **column == name || **column == format!("{name}_m"))?;
            Some(MovingWall { axis, is_upper, positions: gauges.column(column)? })
        };
        let walls = (0..3).flat_map(|axis| [false, true].map(|is_upper| wall(axis, is_upper))).flatten().collect();
        Self { times: gauges.times.clone(), walls }
    }

    /// A box as it was at a time, s; straight between two rows. Walls without a position stay where they are in `start`.
    pub fn container(&self, start: Container, time: f64) -> Container {
        let mut container = start;
        for wall in &self.walls {
            let position = between(&self.times, &wall.positions, time);
            let corner = if wall.is_upper { &mut container.to } else { &mut container.from };
            corner[wall.axis] = position.unwrap_or(corner[wall.axis]);
        }
        container
    }
}

/// A quantity at a time by its values at some; none where those are not numbers.
fn between(times: &[f64], values: &[f64], time: f64) -> Option<f64> {
    let after = times.partition_point(|found| *found < time).min(times.len().checked_sub(1)?);
    let before = after.saturating_sub(1);
    let span = times[after] - times[before];
    let part = if span > 0.0 { ((time - times[before]) / span).clamp(0.0, 1.0) } else { 1.0 };
    Some(values[before] + part * (values[after] - values[before])).filter(|position| position.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn walls_stand_where_the_gauges_say() {
        for name in ["x_max.position", "x_max.position_m"] {
            let gauges = GaugeTable {
                columns: vec!["gas.energy".into(), name.into()],
                times: vec![0.0, 10.0, 20.0],
                rows: vec![vec![1.0, 400.0], vec![1.0, 300.0], vec![1.0, 340.0]],
            };
            let walls = WallPositions::of(&gauges);
            let start = Container { from: [0.0; 3], to: [400.0, 200.0, 0.0] };
            for (time, position) in
                [(0.0, 400.0), (5.0, 350.0), (10.0, 300.0), (15.0, 320.0), (20.0, 340.0), (21.0, 340.0)]
            {
                assert_eq!(walls.container(start, time), Container { to: [position, 200.0, 0.0], ..start }, "{time}");
            }
        }
        let nothing = WallPositions::of(&GaugeTable::default());
        let start = Container { from: [0.0; 3], to: [4.0; 3] };
        assert_eq!(nothing.container(start, 3.0), start);
    }
}
