//! Heat sources of solids on the GPU, for `dew_sources.wgsl`.

use crate::humid_air::ZERO_CELSIUS;
use crate::origin::Origin;
use crate::shared::{self, Memory};
use crate::solids::sources::{BodySources, HeatSources, ParticleShare, STEFAN_BOLTZMANN, SurfacePart, Surroundings};
use corpuscle_gpu::{Gpu, GpuError, from_pair, read};
use corpuscle_scene::Table;

/// Sources of heat.
#[derive(Debug)]
pub(crate) struct GpuSources {
    /// Of each particle of the solids and each cell of walls.
    pub shares: Vec<shared::Share>,
    /// Of each solid and wall, before it has supplied anything.
    pub initial: Vec<shared::Source>,
    /// Heat supplied until the last batch, J.
    before: Vec<[f64; 3]>,
}

impl GpuSources {
    /// None where no solid has any. Their values over time, W or K from the ambient air's temperature, come after those of `values`.
    pub fn new(sources: &HeatSources, origin: Origin, values: &mut Vec<[f64; 2]>) -> Option<Self> {
        if sources.shares.is_empty() {
            return None;
        }
        let part = |part: SurfacePart| shared::Part { area: part.area as f32, resistance: part.resistance as f32 };
        let share = |share: &ParticleShare| shared::Share {
            heater: share.heater as f32,
            unused: 0.0,
            outside: part(share.outside),
            radiation: part(share.radiation),
        };
        let bodies = sources.bodies.iter().zip(&sources.power_factors);
        let initial: Vec<_> = bodies.map(|(of, &factor)| source(of, factor, origin, values)).collect();
        Some(Self {
            shares: sources.shares.iter().map(share).collect(),
            before: vec![[0.0; 3]; initial.len()],
            initial,
        })
    }

    /// Sets what was supplied to nothing.
    pub fn reset(&mut self, gpu: &Gpu, memory: &Memory) {
        gpu.queue.write_buffer(&memory.sources, 0, bytemuck::cast_slice(&self.initial));
        self.before.fill([0.0; 3]);
    }

    /// Downloads the heat that each solid and wall got since the last time, J.
    pub async fn download_supplied(&mut self, gpu: &Gpu, memory: &Memory) -> Result<Vec<[f64; 3]>, GpuError> {
        let now: Vec<shared::Source> = read(gpu, &memory.sources, self.initial.len()).await?;
        let now: Vec<[f64; 3]> = now.iter().map(|source| source.supplied.map(from_pair)).collect();
        let since = |(now, before): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|kind| now[kind] - before[kind]);
        let supplied = now.iter().zip(&self.before).map(since).collect();
        self.before = now;
        Ok(supplied)
    }
}

/// Appends a table to the values, less `zero`, and returns where it is.
pub(crate) fn append(table: &Table, zero: f64, values: &mut Vec<[f64; 2]>) -> [u32; 2] {
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
