//! Sources of heat of solids as the shaders see them: see `dew_sources.wgsl`.

use super::layout::{self, Account, CardRow};
use super::origin::Origin;
use super::solids::filled;
use crate::dew::Dew;
use crate::humid_air::ZERO_CELSIUS;
use crate::solids::sources::{HeatSources, Part, STEFAN_BOLTZMANN, Share, Surroundings};
use bytemuck::{Pod, Zeroable};
use corpuscle_gpu::{Gpu, GpuError, read, storage, wgpu};
use corpuscle_scene::Table;

/// Twin of `Surroundings`.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
struct CardSurroundings {
    transfer: f32,
    radiance: f32,
    air_first: u32,
    air_end: u32,
    seen_first: u32,
    seen_end: u32,
}

/// Twin of `Source`.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
struct CardSource {
    heated: f32,
    unused: f32,
    power_first: u32,
    power_end: u32,
    outside: CardSurroundings,
    radiation: CardSurroundings,
    given: [Account; 3],
}

/// Twin of `Share`.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
struct CardShare {
    heater: f32,
    unused: f32,
    outside: [f32; 2],
    radiation: [f32; 2],
}

/// Sources of heat on the device.
#[derive(Debug)]
pub(super) struct CardSources {
    pub shares: wgpu::Buffer,
    pub rows: wgpu::Buffer,
    pub sources: wgpu::Buffer,
    told: Vec<CardSource>,
    /// Times, s, and values: W or K from the ambient air's temperature.
    values: Vec<[f64; 2]>,
    /// Heat given until the last batch, J.
    before: Vec<[f64; 3]>,
}

impl CardSources {
    /// None where no solid has any.
    pub fn new(gpu: &Gpu, dew: &Dew, origin: Origin) -> Result<Option<Self>, GpuError> {
        let sources = &dew.sources;
        if sources.shares.is_empty() {
            return Ok(None);
        }
        let part = |part: Part| [part.area as f32, part.resistance as f32];
        let share = |share: &Share| CardShare {
            heater: share.heater as f32,
            unused: 0.0,
            outside: part(share.outside),
            radiation: part(share.radiation),
        };
        let shares: Vec<CardShare> = sources.shares.iter().map(share).collect();
        let mut values = Vec::new();
        let told: Vec<CardSource> = sources
            .bodies
            .iter()
            .zip(&sources.heated)
            .map(|(of, &heated)| source(of, heated, origin, &mut values))
            .collect();
        Ok(Some(Self {
            shares: filled(gpu, "shares of sources", &shares)?,
            rows: storage::<CardRow>(gpu, "rows of sources", values.len())?,
            sources: filled(gpu, "sources of heat", &told)?,
            before: vec![[0.0; 3]; told.len()],
            told,
            values,
        }))
    }

    /// Tells when, counted from the time of a state, s, and forgets what was given.
    pub fn send(&mut self, gpu: &Gpu, time: f64) {
        let row =
            |&[at, value]: &[f64; 2]| CardRow { time: layout::account(at - time), value: value as f32, unused: 0.0 };
        let rows: Vec<CardRow> = self.values.iter().map(row).collect();
        gpu.queue.write_buffer(&self.rows, 0, bytemuck::cast_slice(&rows));
        gpu.queue.write_buffer(&self.sources, 0, bytemuck::cast_slice(&self.told));
        self.before.fill([0.0; 3]);
    }

    /// Heat that each solid got since the last time, J.
    pub fn given(&mut self, gpu: &Gpu) -> Result<Vec<[f64; 3]>, GpuError> {
        let now: Vec<CardSource> = read(gpu, &self.sources, self.told.len())?;
        let now: Vec<[f64; 3]> = now.iter().map(|source| source.given.map(layout::value)).collect();
        let since = |(now, before): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|kind| now[kind] - before[kind]);
        let given = now.iter().zip(&self.before).map(since).collect();
        self.before = now;
        Ok(given)
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

fn source(of: &HeatSources, heated: f64, origin: Origin, values: &mut Vec<[f64; 2]>) -> CardSource {
    let mut source = CardSource { heated: heated as f32, ..CardSource::default() };
    if let Some((table, _)) = &of.heater {
        [source.power_first, source.power_end] = append(table, 0.0, values);
    }
    if let Some((_, around)) = &of.outside {
        source.outside = surroundings(around, origin, values);
    }
    if let Some(around) = &of.radiation {
        source.radiation = surroundings(around, origin, values);
    }
    source
}

fn surroundings(around: &Surroundings, origin: Origin, values: &mut Vec<[f64; 2]>) -> CardSurroundings {
    let zero = origin.temperature - ZERO_CELSIUS;
    let [air_first, air_end] = append(&around.air, zero, values);
    let [seen_first, seen_end] = append(&around.seen, zero, values);
    let radiance = (around.emissivity * STEFAN_BOLTZMANN) as f32;
    CardSurroundings { transfer: around.transfer as f32, radiance, air_first, air_end, seen_first, seen_end }
}
