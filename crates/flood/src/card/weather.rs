//! The ground that rain falls on, as the shaders have it.

use super::layout::{DEPTH, Parameters, Patch};
use super::rates::Rates;
use crate::infiltration::Law;
use crate::rain::{Ground, Wetness};
use corpuscle_gpu::{Gpu, GpuError, THREADS, read, storage, wgpu};

/// Cells of the ground on the device.
#[derive(Debug)]
pub(super) struct Weather {
    pub ground: wgpu::Buffer,
    pub tallies: wgpu::Buffer,
    pub laws: wgpu::Buffer,
    pub sums: wgpu::Buffer,
    pub rates: Rates,
    /// As they are at the start: dry.
    patches: Vec<Patch>,
}

impl Weather {
    /// For `count` particles at most. `h_over_spacing` is that of the particles that come of films.
    pub fn new(
        gpu: &Gpu,
        ground: &Ground,
        count: usize,
        h_over_spacing: f64,
        parameters: &mut Parameters,
    ) -> Result<Self, GpuError> {
        let size = ground.size();
        parameters.patches_per_metre = size.map(|length| (1.0 / length) as f32);
        parameters.patches = [ground.columns as u32, ground.rows as u32];
        parameters.patch_area = ground.area as f32;
        parameters.film = ground.film as f32;
        parameters.drop_h = (h_over_spacing * (size[0] * size[1]).sqrt()) as f32;
        let patch =
            |(factor, law): (&f64, &u16)| Patch { factor: *factor as f32, law: u32::from(*law), ..Patch::default() };
        let patches: Vec<Patch> = ground.factor.iter().zip(&ground.law).map(patch).collect();
        let laws: Vec<[f32; 4]> = ground.laws.iter().map(|law| law.map_or([0.0; 4], Law::numbers)).collect();
        let groups = |count: usize| count.div_ceil(THREADS as usize);
        let weather = Self {
            ground: storage::<Patch>(gpu, "cells of the ground", patches.len())?,
            tallies: storage::<[u32; 2]>(gpu, "tallies of the ground", patches.len())?,
            laws: storage::<[f32; 4]>(gpu, "laws of infiltration", laws.len())?,
            sums: storage::<[f32; 4]>(gpu, "sums of the weather", groups(patches.len()) + groups(count))?,
            rates: Rates::new(gpu, ground)?,
            patches,
        };
        gpu.queue.write_buffer(&weather.laws, 0, bytemuck::cast_slice(&laws));
        Ok(weather)
    }

    /// Bytes held.
    pub fn bytes(&self) -> u64 {
        [&self.ground, &self.tallies, &self.laws, &self.sums, &self.rates.buffer]
            .into_iter()
            .map(wgpu::Buffer::size)
            .sum()
    }

    /// Hands over what stands on the ground and in it.
    pub fn begin(&self, gpu: &Gpu, wetness: &Wetness) {
        let wet = self.patches.iter().zip(&wetness.film).zip(&wetness.soaked);
        let sent: Vec<Patch> = wet
            .map(|((patch, film), soaked)| {
                let sum = *soaked as f32;
                Patch { film: *film as f32, soaked: [sum, (f64::from(sum) - soaked) as f32], ..*patch }
            })
            .collect();
        gpu.queue.write_buffer(&self.ground, 0, bytemuck::cast_slice(&sent));
        gpu.queue.write_buffer(&self.tallies, 0, &vec![0; 8 * sent.len()]);
    }

    /// Brings that back.
    pub fn fetch(&self, gpu: &Gpu, wetness: &mut Wetness) -> Result<(), GpuError> {
        let patches: Vec<Patch> = read(gpu, &self.ground, self.patches.len())?;
        let tallies: Vec<[u32; 2]> = read(gpu, &self.tallies, self.patches.len())?;
        for (cell, (patch, tally)) in patches.iter().zip(&tallies).enumerate() {
            let [sum, lacking] = patch.soaked.map(f64::from);
            wetness.film[cell] = f64::from(patch.film);
            wetness.soaked[cell] = sum - lacking + f64::from(tally[1]) / DEPTH;
        }
        Ok(())
    }
}
