//! What the water did in each cell, and the maps of it on the terrain's own grid.

use super::domain::Domain;
use super::mesh::Mesh;
use super::sampling::Sampler;
use super::solver::Solver;
use super::water::{Column, Water};
use crate::sampling::Sample;
use corpuscle_model::Map;
use corpuscle_terrain::Terrain;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// What the water did in a cell.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Record {
    /// m.
    pub max_depth: f32,
    /// Velocity `[east, north]` at the highest speed, m/s, where it was deep enough to be wet.
    pub fastest: [f32; 2],
    /// Largest depth x (speed + 0.5), m2/s.
    pub hazard: f32,
    /// When the depth first rose above that of wet ground, s; not-a-number before.
    pub arrival: f32,
    /// For how long it was above it, s.
    pub duration: f32,
}

/// The record of a cell that was never wet.
pub(crate) const DRY: Record =
    Record { max_depth: 0.0, fastest: [0.0; 2], hazard: 0.0, arrival: f32::NAN, duration: 0.0 };

/// Records the water after a step of `step` s, or of steps of their own of cells, that ended at `time` s. The time at which a depth was passed is found on the straight line between
/// the depths before and after.
pub(crate) fn record(solver: &Solver, records: &mut [Record], time: f64, step: f64, wet_depth: f64) {
    solver.for_wet_chunks(records, |cell, record| {
        let water = &solver.water[cell];
        if let Some((step, before)) = solver.ended(cell, step) {
            record.see(water, before / solver.mesh.area[cell], time, step, wet_depth);
        }
    });
}

impl Record {
    /// The water at the start.
    pub fn start(water: &Water, wet_depth: f64) -> Self {
        let mut record = DRY;
        record.see(water, water.depth, 0.0, 0.0, wet_depth);
        record
    }

    /// m/s.
    pub fn max_speed(&self) -> f32 {
        self.fastest[0].hypot(self.fastest[1])
    }

    #[inline]
    fn see(&mut self, water: &Water, before: f64, time: f64, step: f64, wet_depth: f64) {
        let depth = water.depth;
        if depth <= wet_depth && before <= wet_depth {
            return;
        }
        let risen = if before >= wet_depth { 0.0 } else { (wet_depth - before) / (depth - before) };
        let fallen = if depth >= wet_depth { 1.0 } else { (before - wet_depth) / (before - depth) };
        if self.arrival.is_nan() {
            self.arrival = (time - (1.0 - risen) * step) as f32;
        }
        self.duration += ((fallen - risen).max(0.0) * step) as f32;
        if depth > wet_depth {
            let (depth, speed) = (depth as f32, water.speed() as f32);
            self.max_depth = self.max_depth.max(depth);
            let velocity = water.velocity.map(|component| component as f32);
            if velocity[0].hypot(velocity[1]) > self.max_speed() {
                self.fastest = velocity;
            }
            self.hazard = self.hazard.max(depth * (speed + 0.5));
        }
    }
}

/// What the maps show at the pixels that were ever wet: they take memory one by one.
pub(crate) struct Wet {
    /// Columns and rows.
    size: [usize; 2],
    /// Pixels, each with its value in each of the maps.
    pixels: Vec<(usize, [f32; NAMES.len()])>,
}

impl Wet {
    /// The maps whose names are wanted, one after another.
    pub fn each_map(&self, is_wanted: &dyn Fn(&str) -> bool, take: &mut dyn FnMut(Map)) {
        let [columns, rows] = self.size;
        for (k, [name, title, unit]) in NAMES.into_iter().enumerate().filter(|(_, [name, ..])| is_wanted(name)) {
            let mut values = vec![f32::NAN; columns * rows];
            self.pixels.iter().for_each(|(pixel, of_pixel)| values[*pixel] = of_pixel[k]);
            take(Map { name, title, unit, columns, rows, values });
        }
    }
}

/// What the maps show as they stand, with the water now given by `water`, `rest` s before the end of the last step; of several processes at the first, none at others.
pub(crate) fn wet(
    mesh: &Mesh,
    terrain: &Terrain,
    records: &[Record],
    water: &(impl Fn(usize) -> Water + Sync),
    rest: f64,
    wet_depth: f64,
    domain: Option<&Domain>,
) -> Option<Wet> {
    let grid = terrain.map_grid();
    let (columns, rows) = (grid.columns, grid.rows);
    let highest = |cell: usize| {
        let depth = f64::from(records[cell].max_depth);
        Water { depth, level: mesh.level(cell, depth), velocity: [0.0; 2] }
    };
    let pixel = |column: usize, row: usize| {
        let [x, y] = grid.centre(column, row);
        if !terrain.is_valid_cell(column, row) || !mesh.layout.bounds.contains(x, y) {
            return None;
        }
        let owns = |cell: &usize| domain.is_none_or(|domain| domain.owns(*cell));
        let cell = mesh.cell_at([x, y]).filter(owns)?;
        let record = &records[cell];
        if record.max_depth <= 0.0 {
            return None;
        }
        let is_wet = |sample: Sample| (sample.depth > wet_depth).then_some(sample);
        let now = is_wet(Sampler { mesh, terrain, water }.in_cell(cell, x, y));
        let most = is_wet(Sampler { mesh, terrain, water: highest }.in_cell(cell, x, y));
        let depths = [now, most].map(|sample| sample.map_or(f32::NAN, |sample| sample.depth as f32));
        let velocity = now.map_or([f32::NAN; 2], |now| now.velocity.map(|component| component as f32));
        let mut values = [f32::NAN; NAMES.len()];
        values[0] = depths[0];
        [values[7], values[8]] = velocity;
        let most = depths[0].max(depths[1]);
        if most.is_nan() {
            return None;
        }
        let level = (terrain.height(x, y) + f64::from(most)) as f32;
        let hazard = record.hazard * (most / record.max_depth).min(1.0);
        let to_come = if now.is_some() { rest as f32 } else { 0.0 };
        let duration = (record.duration - to_come).max(0.0);
        let history = [most, record.max_speed(), record.arrival, duration, hazard, level];
        values[1..7].copy_from_slice(&history);
        [values[9], values[10]] = record.fastest;
        Some((row * columns + column, values))
    };
    let of_row = |row: usize| (0..columns).filter_map(|column| pixel(column, row)).collect::<Vec<_>>();
    let pixels: Vec<(usize, [f32; NAMES.len()])> = (0..rows).into_par_iter().flat_map_iter(of_row).collect();
    Domain::gathered(domain, pixels).map(|pixels| Wet { size: [columns, rows], pixels })
}

/// Name, title and unit of the maps.
const NAMES: [[&str; 3]; 11] = [
    ["depth", "Depth", "m"],
    ["max_depth", "Maximum depth", "m"],
    ["max_speed", "Maximum speed", "m/s"],
    ["arrival_s", "Arrival", "s"],
    ["duration_s", "Duration", "s"],
    ["hazard", "Hazard: depth x (speed + 0.5)", "m2/s"],
    ["max_level", "Highest level", "m"],
    ["velocity_east", "Velocity at the end, eastwards", "m/s"],
    ["velocity_north", "Velocity at the end, northwards", "m/s"],
    ["fastest_east", "Velocity at the highest speed, eastwards", "m/s"],
    ["fastest_north", "Velocity at the highest speed, northwards", "m/s"],
];

/// Water of a cell between two columns: `share` of the way from the first to the second.
pub(crate) fn between(mesh: &Mesh, cell: usize, [before, after]: [&Column; 2], share: f64) -> Water {
    let mix = |a: f64, b: f64| a + share * (b - a);
    let mut column = Column {
        volume: mix(before.volume, after.volume),
        momentum: [0, 1].map(|axis| mix(before.momentum[axis], after.momentum[axis])),
    };
    mesh.water(cell, &mut column)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrival_and_duration_are_those_of_the_straight_line() {
        let water = |depth: f64| Water { depth, level: depth, velocity: [3.0, 4.0] };
        let mut record = DRY;
        record.see(&water(0.03), 0.0, 10.0, 3.0, 0.01);
        assert!((record.arrival - 8.0).abs() < 1e-6 && (record.duration - 2.0).abs() < 1e-6);
        record.see(&water(0.0), 0.03, 13.0, 3.0, 0.01);
        assert!(
            (record.duration - 4.0).abs() < 1e-6
                && record.max_depth == 0.03
                && record.fastest == [3.0, 4.0]
                && record.max_speed() == 5.0
        );
        assert!((record.hazard - 0.03 * 5.5).abs() < 1e-6);
    }
}
