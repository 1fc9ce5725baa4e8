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

/// How the water varies within a cell.
pub(crate) struct Within {
    /// That of all of the cell.
    pub here: Water,
    slopes: Slopes,
    /// Between what depth, level and velocity of the cell and its wet neighbours lie.
    range: [[f64; 2]; 4],
    /// How much the depth follows from a level that is nearly even: 1 in lakes, 0 in sheets on slopes.
    pub level_share: f64,
}

impl Within {
    /// A quantity ([`DEPTH`], [`LEVEL`], [`EAST`], [`NORTH`](super::water::NORTH)) at a position relative to the centroid.
    pub fn value(&self, quantity: usize, [x, y]: [f64; 2]) -> f64 {
        let Water { depth, level, velocity: [u, v] } = self.here;
        let [along_x, along_y] = slope(&self.slopes, quantity);
        let [low, high] = self.range[quantity];
        ([depth, level, u, v][quantity] + (along_x * x + along_y * y)).clamp(low, high)
    }
}

impl<W: Fn(usize) -> Water> Sampler<'_, W> {
    /// The water at a position; dry outside the cells.
    pub fn at(&self, x: f64, y: f64) -> Sample {
        self.mesh.cell_at([x, y]).map_or_else(Sample::default, |cell| self.in_cell(cell, x, y))
    }

    /// The water at a position in a cell. Where the level varies little beside the depth, as in lakes and rivers, the depth is that of the level over
    /// the ground just there; in a sheet on a slope it is the depth of the cell with its slope.
    pub fn in_cell(&self, cell: usize, x: f64, y: f64) -> Sample {
        let Some(within) = self.within(cell) else { return Sample::default() };
        let size = self.mesh.layout.bounds.size();
        let to = [0, 1].map(|axis| {
            let to = [x, y][axis] - self.mesh.centroid[cell][axis];
            if self.mesh.layout.periodic[axis] { to - (to / size[axis]).round() * size[axis] } else { to }
        });
        let by_level = (within.value(LEVEL, to) - self.terrain.height(x, y)).max(0.0);
        let level_share = within.level_share;
        let depth = level_share * by_level + (1.0 - level_share) * within.value(DEPTH, to).max(0.0);
        if depth <= 0.0 {
            return Sample::default();
        }
        Sample { depth, velocity: [0, 1].map(|axis| within.value(EAST + axis, to)) }
    }

    /// How the water varies within a cell; none where it is dry.
    pub fn within(&self, cell: usize) -> Option<Within> {
        let here = (self.water)(cell);
        if here.depth <= 0.0 {
            return None;
        }
        let (slopes, range) = self.slopes(cell, &here);
        let [east, north] = slope(&slopes, LEVEL);
        let variation = east.hypot(north) * self.mesh.area[cell].sqrt() / here.depth;
        Some(Within { here, slopes, range, level_share: 1.0 / (1.0 + variation * variation) })
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
