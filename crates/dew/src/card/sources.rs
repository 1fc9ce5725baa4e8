//! Heat sources of solids on the GPU: layouts and buffers of `dew_sources.wgsl`.

use super::origin::Origin;
use super::shared;
use super::solids::filled;
use crate::dew::Dew;
use crate::humid_air::ZERO_CELSIUS;
use crate::solids::sources::{BodySources, ParticleShare, STEFAN_BOLTZMANN, SurfacePart, Surroundings};
use corpuscle_gpu::{Gpu, GpuError, read, storage, wgpu};
use corpuscle_scene::Table;

/// Sources of heat on the device.
#[derive(Debug)]
pub(super) struct CardSources {
    pub shares: wgpu::Buffer,
    pub rows: wgpu::Buffer,
    pub sources: wgpu::Buffer,
    /// Of each solid, before it has supplied anything.
    initial: Vec<shared::Source>,
    /// Times, s, and values: W or K from the ambient air's temperature.
    values: Vec<[f64; 2]>,
    /// Heat supplied until the last batch, J.
    before: Vec<[f64; 3]>,
}

impl CardSources {
    /// None where no solid has any.
    pub fn new(gpu: &Gpu, dew: &Dew, origin: Origin) -> Result<Option<Self>, GpuError> {
        let sources = &dew.sources;
        if sources.shares.is_empty() {
            return Ok(None);
        }
        let part = |part: SurfacePart| shared::Part { area: part.area as f32, resistance: part.resistance as f32 };
        let share = |share: &ParticleShare| shared::Share {
            heater: share.heater as f32,
            unused: 0.0,
            outside: part(share.outside),
            radiation: part(share.radiation),
        };
        let shares: Vec<shared::Share> = sources.shares.iter().map(share).collect();
        let mut values = Vec::new();
        let initial: Vec<shared::Source> = sources
            .bodies
            .iter()
            .zip(&sources.power_factors)
            .map(|(of, &factor)| source(of, factor, origin, &mut values))
            .collect();
        Ok(Some(Self {
            shares: filled(gpu, "shares of sources", &shares)?,
            rows: storage::<shared::Row>(gpu, "rows of sources", values.len())?,
            sources: filled(gpu, "sources of heat", &initial)?,
            before: vec![[0.0; 3]; initial.len()],
            initial,
            values,
        }))
    }

    /// Uploads the rows, counted from the time of a state, s, and sets what was supplied to nothing.
    pub fn upload(&mut self, gpu: &Gpu, time: f64) {
        let rows: Vec<shared::Row> = self.values.iter().map(|&row| shared::Row::new(row, time, 0.0)).collect();
        gpu.queue.write_buffer(&self.rows, 0, bytemuck::cast_slice(&rows));
        gpu.queue.write_buffer(&self.sources, 0, bytemuck::cast_slice(&self.initial));
        self.before.fill([0.0; 3]);
    }

    /// Downloads the heat that each solid got since the last time, J.
    pub fn download_supplied(&mut self, gpu: &Gpu) -> Result<Vec<[f64; 3]>, GpuError> {
        let now: Vec<shared::Source> = read(gpu, &self.sources, self.initial.len())?;
        let now: Vec<[f64; 3]> = now.iter().map(|source| source.supplied.map(shared::Account::value)).collect();
        let since = |(now, before): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|kind| now[kind] - before[kind]);
        let supplied = now.iter().zip(&self.before).map(since).collect();
        self.before = now;
        Ok(supplied)
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        [&self.shares, &self.rows, &self.sources].map(wgpu::Buffer::size).iter().sum()
    }
}

/// Appends a table to the values, less `zero`, and tells where it is.
fn append(table: &Table, zero: f64, values: &mut Vec<[f64; 2]>) -> [u32; 2] {
    let first = values.len() as u32;
    values.extend(table.rows().iter().map(|&[time, value]| [time, value - zero]));
    [first, values.len() as u32]
}

fn source(of: &BodySources, factor: f64, origin: Origin, values: &mut Vec<[f64; 2]>) -> shared::Source {
    let mut source = shared::Source { power_factor: factor as f32, ..shared::Source::default() };
    if let Some((table, _)) = &of.heater {
        [source.power_first, source.power_end] = append(table, 0.0, values);
    }
    if let Some(outside) = &of.outside {
        source.outside = surroundings(&outside.surroundings, origin, values);
    }
    if let Some(around) = &of.radiation {
        source.radiation = surroundings(around, origin, values);
    }
    source
}

fn surroundings(around: &Surroundings, origin: Origin, values: &mut Vec<[f64; 2]>) -> shared::Surroundings {
    let zero = origin.temperature - ZERO_CELSIUS;
    let [air_first, air_end] = append(&around.air_temperature, zero, values);
    let [radiant_first, radiant_end] = append(around.radiant(), zero, values);
    shared::Surroundings {
        transfer_coefficient: around.transfer_coefficient as f32,
        emissivity_sigma: (around.emissivity * STEFAN_BOLTZMANN) as f32,
        air_first,
        air_end,
        radiant_first,
        radiant_end,
    }
}
