//! Maps over the cells of the terrain: maxima, arrival, duration, hazard.

#[cfg(feature = "gpu")]
pub(super) mod on_gpu;

use super::sampling::Sampler;
use crate::sampling::Sample;
use corpuscle_model::Map;
use corpuscle_terrain::Terrain;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Records over the cells of the terrain, row by row from the north.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Maps {
    /// Depth above which a cell is wet, m.
    wet_depth: f64,
    columns: usize,
    cells: Vec<Record>,
    /// Time of the last sample, s.
    last: f64,
}

/// The maxima and times of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Record {
    /// m.
    pub max_depth: f32,
    /// m/s.
    pub max_speed: f32,
    /// Largest depth x (speed + 0.5), m2/s.
    pub hazard: f32,
    /// When a sample first was wet, s; not-a-number before.
    pub arrival: f32,
    /// Time over which samples were wet since, s.
    pub duration: f32,
}

const DRY: Record = Record { max_depth: 0.0, max_speed: 0.0, hazard: 0.0, arrival: f32::NAN, duration: 0.0 };

impl Maps {
    pub fn new(terrain: &Terrain, wet_depth: f64) -> Self {
        let grid = terrain.map_grid();
        Self { wet_depth, columns: grid.columns, cells: vec![DRY; grid.columns * grid.rows], last: 0.0 }
    }

    /// Whether these are maps of the same ground.
    pub fn fit(&self, other: &Self) -> bool {
        self.columns == other.columns && self.cells.len() == other.cells.len()
    }

    /// The record of a cell, which is uploaded to the GPU and downloaded from there.
    #[cfg(feature = "gpu")]
    pub fn record(&self, cell: usize) -> &Record {
        &self.cells[cell]
    }

    #[cfg(feature = "gpu")]
    pub fn record_mut(&mut self, cell: usize) -> &mut Record {
        &mut self.cells[cell]
    }

    /// Depth above which a cell is wet, m.
    #[cfg(feature = "gpu")]
    pub fn wet_depth(&self) -> f64 {
        self.wet_depth
    }

    /// Time of the last sample, s.
    #[cfg(feature = "gpu")]
    pub fn last(&self) -> f64 {
        self.last
    }

    #[cfg(feature = "gpu")]
    pub fn set_last(&mut self, time: f64) {
        self.last = time;
    }

    /// Samples the water at `time` s. Wet time is counted since the last sample.
    pub fn sample(&mut self, water: &Sampler, time: f64) {
        let (wet_depth, since) = (self.wet_depth, (time - self.last) as f32);
        self.last = time;
        self.cells.par_chunks_mut(self.columns).enumerate().for_each(|(row, cells)| {
            for (column, cell) in cells.iter_mut().enumerate() {
                if let Some(sample) = wet(water, column, row, wet_depth) {
                    cell.add(&sample, time as f32, since);
                }
            }
        });
    }

    /// The maps as they stand, with the depths of `water` now.
    pub fn maps(&self, water: &Sampler) -> Vec<Map> {
        let rows = self.cells.len() / self.columns.max(1);
        let columns = self.columns;
        let mut depth = vec![f32::NAN; self.cells.len()];
        let level = self.levels(water.terrain);
        depth.par_chunks_mut(columns).enumerate().for_each(|(row, cells)| {
            for (column, cell) in cells.iter_mut().enumerate() {
                if let Some(sample) = wet(water, column, row, self.wet_depth) {
                    *cell = sample.depth as f32;
                }
            }
        });
        let map = |name, title, unit, values| Map { name, title, unit, columns, rows, values };
        let of = |value: fn(&Record) -> f32| -> Vec<f32> {
            self.cells.iter().map(|cell| if cell.max_depth > 0.0 { value(cell) } else { f32::NAN }).collect()
        };
        vec![
            map("depth", "Depth", "m", depth),
            map("max_depth", "Maximum depth", "m", of(|cell| cell.max_depth)),
            map("max_speed", "Maximum speed", "m/s", of(|cell| cell.max_speed)),
            map("arrival_s", "Arrival", "s", of(|cell| cell.arrival)),
            map("duration_s", "Duration", "s", of(|cell| cell.duration)),
            map("hazard", "Hazard: depth x (speed + 0.5)", "m2/s", of(|cell| cell.hazard)),
            map("max_level", "Highest level", "m", level),
        ]
    }

    /// The highest level at each cell, m; not-a-number where it was never wet.
    fn levels(&self, terrain: &Terrain) -> Vec<f32> {
        let grid = terrain.map_grid();
        let level = |(index, cell): (usize, &Record)| {
            let [x, y] = grid.centre(index % self.columns, index / self.columns);
            if cell.max_depth > 0.0 { (terrain.height(x, y) + f64::from(cell.max_depth)) as f32 } else { f32::NAN }
        };
        self.cells.par_iter().enumerate().map(level).collect()
    }
}

/// The water in a cell, if it is wet.
fn wet(water: &Sampler, column: usize, row: usize, wet_depth: f64) -> Option<Sample> {
    let [x, y] = water.terrain.map_grid().centre(column, row);
    if !water.may_be_wet(x, y) || !water.terrain.is_valid_cell(column, row) {
        return None;
    }
    Some(water.at(x, y)).filter(|sample| sample.depth > wet_depth)
}

impl Record {
    fn add(&mut self, sample: &Sample, time: f32, since: f32) {
        let (depth, speed) = (sample.depth as f32, sample.speed() as f32);
        self.max_depth = self.max_depth.max(depth);
        self.max_speed = self.max_speed.max(speed);
        self.hazard = self.hazard.max(depth * (speed + 0.5));
        if self.arrival.is_nan() {
            self.arrival = time;
        } else {
            self.duration += since;
        }
    }
}
