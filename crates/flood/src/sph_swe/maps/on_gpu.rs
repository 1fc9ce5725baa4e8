//! Maps that the device keeps: it samples the water in each of their cells itself.

use super::{Maps, Record};
use crate::sph_swe::gpu::shared::{MAPS, MapCell};
use crate::sph_swe::gpu::tasks::{Shader, task};
use crate::sph_swe::gpu::upload::Origin;
use crate::sph_swe::gpu::{MOST_CELLS, OnGpu};
use crate::sph_swe::obstacles::Obstacles;
use corpuscle_gpu::{Gpu, GpuError, Pass, Task, read, storage, to_pair, wgpu};
use corpuscle_terrain::Terrain;

/// Sample times that are uploaded to the device at once, at most.
pub(in crate::sph_swe) const MAX_MAP_TIMES: usize = 64;

pub(in crate::sph_swe) const SHADER: Shader = ("sph_maps", include_str!("sph_maps.wgsl"));

/// Maps on the device.
#[derive(Debug)]
pub(in crate::sph_swe) struct GpuMaps {
    /// The cells that may become wet, by their numbers in the maps, and where they are.
    numbers: Vec<u32>,
    positions: Vec<[f32; 2]>,
    pub wet_depth: f64,
    task: Task,
}

impl GpuMaps {
    /// Cells that may become wet.
    pub fn count(&self) -> usize {
        self.numbers.len()
    }

    /// Has the device sample the maps, if it is time to.
    pub fn sample(&self, pass: &mut Pass<'_>, groups: &wgpu::Buffer) {
        self.task.dispatch_indirect(pass, groups, MAPS);
    }

    /// The cells in the device's format.
    fn packed(&self, maps: &Maps) -> Vec<MapCell> {
        let cell = |(number, position): (&u32, &[f32; 2])| {
            let record = maps.record(*number as usize);
            MapCell {
                position: *position,
                max_depth: record.max_depth,
                max_speed: record.max_speed,
                hazard: record.hazard,
                // A negative number stands for not-a-number, which shaders need not handle.
                arrival: if record.arrival.is_nan() { -1.0 } else { record.arrival },
                duration: record.duration,
                unused: 0.0,
            }
        };
        self.numbers.iter().zip(&self.positions).map(cell).collect()
    }

    async fn download(&self, gpu: &Gpu, cells: &wgpu::Buffer, maps: &mut Maps) -> Result<(), GpuError> {
        let cells: Vec<MapCell> = read(gpu, cells, self.numbers.len()).await?;
        for (number, cell) in self.numbers.iter().zip(cells) {
            let MapCell { max_depth, max_speed, hazard, arrival, duration, .. } = cell;
            let arrival = if arrival < 0.0 { f32::NAN } else { arrival };
            *maps.record_mut(*number as usize) = Record { max_depth, max_speed, hazard, arrival, duration };
        }
        Ok(())
    }
}

/// The cells of the maps that may become wet, and where they are.
fn cells<'a>(
    terrain: &'a Terrain,
    obstacles: &'a Obstacles,
    origin: Origin,
) -> impl Iterator<Item = (u32, [f32; 2])> + 'a {
    let grid = terrain.map_grid();
    let all = (0..grid.rows).flat_map(move |row| (0..grid.columns).map(move |column| (column, row)));
    all.filter(|&(column, row)| terrain.is_valid_cell(column, row)).filter_map(move |(column, row)| {
        let centre = grid.centre(column, row);
        let number = (row * grid.columns + column) as u32;
        (!obstacles.hold(centre)).then(|| (number, origin.relative(centre)))
    })
}

impl OnGpu {
    /// Keeps maps on the device from now on, if memory and threads suffice.
    pub fn keep_maps(&mut self, terrain: &Terrain, obstacles: &Obstacles, maps: &Maps) -> Result<(), GpuError> {
        let (numbers, positions): (Vec<u32>, Vec<[f32; 2]>) = cells(terrain, obstacles, self.origin).unzip();
        let cells = match storage::<MapCell>(self.gpu(), "cells of maps", numbers.len()) {
            Err(GpuError::Memory { .. }) => return Ok(()),
            cells => cells?,
        };
        if numbers.len() > MOST_CELLS {
            return Ok(());
        }
        self.tasks.memory.map_cells = cells;
        let task = task(self.gpu(), SHADER, &self.tasks.memory);
        self.tasks.maps = Some(GpuMaps { numbers, positions, wet_depth: maps.wet_depth(), task });
        Ok(())
    }

    /// Whether the device samples the maps itself.
    pub fn keeps_maps(&self) -> bool {
        self.tasks.maps.is_some()
    }

    /// Uploads the maps.
    pub(in crate::sph_swe) fn upload_maps(&self, maps: &Maps) {
        if let Some(kept) = &self.tasks.maps {
            let cells = kept.packed(maps);
            self.gpu().queue.write_buffer(&self.tasks.memory.map_cells, 0, bytemuck::cast_slice(&cells));
        }
    }

    /// Downloads the maps.
    pub async fn download_maps(&self, maps: &mut Maps) -> Result<(), GpuError> {
        let cells = &self.tasks.memory.map_cells;
        match &self.tasks.maps {
            Some(kept) => kept.download(self.gpu(), cells, maps).await,
            None => Ok(()),
        }
    }

    /// Uploads the times of the next samples, s, and that of the last.
    pub(in crate::sph_swe) fn upload_map_times(&mut self, map_times: &[f64], last_sample: f64) {
        let times: Vec<[f32; 2]> = map_times.iter().map(|&time| to_pair(time - self.clock_began)).collect();
        self.gpu().queue.write_buffer(&self.tasks.memory.map_times, 0, bytemuck::cast_slice(&times));
        let maps = self.tasks.maps.as_ref();
        self.status.map_times_uploaded = times.len() as u32;
        self.status.map_times_taken = 0;
        self.status.last_sample = to_pair(last_sample - self.clock_began);
        self.status.map_cells = maps.map_or(0, |maps| maps.count() as u32);
        self.status.wet_depth = maps.map_or(0.0, |maps| maps.wet_depth as f32);
    }
}
