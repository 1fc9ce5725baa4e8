//! The water at any position, from the cells round it.

use super::mesh::Mesh;
use super::reconstruction;
use super::water::{DEPTH, EAST, LEVEL, Slopes, Water, slope};
use crate::sampling::Sample;
use corpuscle_terrain::Terrain;

/// Cells with water that `water` gives.
pub(crate) struct Sampler<'a, W: Fn(usize) -> Water> {
    pub mesh: &'a Mesh,
    pub terrain: &'a Terrain,
    pub water: W,
}

impl<W: Fn(usize) -> Water> Sampler<'_, W> {
    /// The water at a position; dry outside the cells.
    pub fn at(&self, x: f64, y: f64) -> Sample {
        self.mesh.cell_at([x, y]).map_or_else(Sample::default, |cell| self.in_cell(cell, x, y))
    }

    /// The water at a position in a cell. Where the level varies little beside the depth, as in lakes and rivers, the depth is that of the level over
    /// the ground just there; in a sheet on a slope it is the depth of the cell with its slope.
    pub fn in_cell(&self, cell: usize, x: f64, y: f64) -> Sample {
        let here = (self.water)(cell);
        if here.depth <= 0.0 {
            return Sample::default();
        }
        let size = self.mesh.layout.bounds.size();
        let to = [0, 1].map(|axis| {
            let to = [x, y][axis] - self.mesh.centroid[cell][axis];
            if self.mesh.layout.periodic[axis] { to - (to / size[axis]).round() * size[axis] } else { to }
        });
        let (slopes, range) = self.slopes(cell, &here);
        let change = |quantity: usize| {
            let [x, y] = slope(&slopes, quantity);
            x * to[0] + y * to[1]
        };
        let clamped = |value: f64, k: usize| (value + change(k)).clamp(range[k][0], range[k][1]);
        let width = self.mesh.area[cell].sqrt();
        let [east, north] = slope(&slopes, LEVEL);
        let variation = east.hypot(north) * width / here.depth;
        let level_share = 1.0 / (1.0 + variation * variation);
        let by_level = (clamped(here.level, LEVEL) - self.terrain.height(x, y)).max(0.0);
        let depth = level_share * by_level + (1.0 - level_share) * clamped(here.depth, DEPTH).max(0.0);
        if depth <= 0.0 {
            return Sample::default();
        }
        Sample { depth, velocity: [0, 1].map(|axis| clamped(here.velocity[axis], EAST + axis)) }
    }

    /// Slopes of a cell, and between what its own values and those of its wet neighbours lie.
    fn slopes(&self, cell: usize, here: &Water) -> (Slopes, [[f64; 2]; 4]) {
        let of = |water: &Water| [water.depth, water.level, water.velocity[0], water.velocity[1]];
        let mut range = of(here).map(|value| [value, value]);
        for other in self.mesh.links_of(cell).iter().filter_map(|link| link.cell()) {
            let there = (self.water)(other);
            if there.depth > 0.0 {
                for (range, value) in range.iter_mut().zip(of(&there)) {
                    *range = [range[0].min(value), range[1].max(value)];
                }
            }
        }
        (reconstruction::slopes(self.mesh, &self.water, cell), range)
    }
}
