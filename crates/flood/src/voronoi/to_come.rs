//! An estimate of the cells that will become wet.

use super::VoronoiFlood;
use crate::spacing::{DEPTH_OF_INFLOW, highest_level, inflow_volume};
use corpuscle_model::ModelError;

/// Samples of the ground along each side of the terrain.
const DRY_SAMPLES_PER_SIDE: usize = 200;

impl VoronoiFlood {
    /// About how many cells get wet from `from` to `until`, s, beside those that are wet now: all ground where it rains, dry ground below the highest level
    /// that is held, and the area on which what flows in stands a metre deep. Water that spreads by itself is not counted. 0 where a file of the
    /// scene can no longer be read.
    pub fn particles_to_come(&self, from: f64, until: f64) -> f64 {
        let mesh = &self.solver.mesh;
        let made: f64 = mesh.area.iter().sum();
        // Cells that are not made yet are taken to be as fine as those that are.
        let cells_per_area = if made > 0.0 { mesh.len() as f64 / made } else { mesh.layout.spacing().powi(-2) };
        let area = if until > from { self.area_to_come(from, until).unwrap_or(0.0) } else { 0.0 };
        area * cells_per_area
    }

    /// Ground that is to get wet, m2.
    fn area_to_come(&self, from: f64, until: f64) -> Result<f64, ModelError> {
        let highest = match &self.settings.rain {
            Some(_) => f64::INFINITY,
            None => highest_level(&self.settings, &self.folder, from, until)?,
        };
        let below = if highest > f64::NEG_INFINITY { self.dry_below(highest) } else { 0.0 };
        let coming = inflow_volume(&self.settings, &self.folder, from, until)? / DEPTH_OF_INFLOW;
        let [east, north] = self.terrain.bounds().size();
        let wet: f64 = self.wet_cells().map(|cell| cell.area).sum();
        Ok((below + coming).min(east * north - wet).max(0.0))
    }

    /// Dry ground below a level, m2.
    fn dry_below(&self, level: f64) -> f64 {
        let bounds = self.terrain.bounds();
        let [east, north] = bounds.size();
        let at = |k: usize| (k as f64 + 0.5) / DRY_SAMPLES_PER_SIDE as f64;
        let is_dry = |k: &usize| {
            let [x, y] = [
                bounds.x_min + at(k % DRY_SAMPLES_PER_SIDE) * east,
                bounds.y_min + at(k / DRY_SAMPLES_PER_SIDE) * north,
            ];
            self.terrain.has_data_at(x, y) && self.terrain.height(x, y) < level && self.sample(x, y).depth <= 0.0
        };
        east * north * (0..DRY_SAMPLES_PER_SIDE * DRY_SAMPLES_PER_SIDE).filter(is_dry).count() as f64
            / (DRY_SAMPLES_PER_SIDE * DRY_SAMPLES_PER_SIDE) as f64
    }
}
