//! Rain given by a function, as the shaders have it: its rate in each cell of the ground at even times.

use crate::rain::{Ground, Intensity};
use corpuscle_gpu::{Gpu, GpuError, storage, wgpu};
use rayon::prelude::*;

/// Numbers before all rates: the first time by the clock, s, times a second, and how many times there are. See `flood_wet.wgsl`.
const HEADER: usize = 3;

/// Times that the card knows at once, and rates in all, at most.
const MOST_TIMES: usize = 129;
const MOST_RATES: usize = 1 << 22;

/// Rates on the device.
#[derive(Debug)]
pub(super) struct Rates {
    pub buffer: wgpu::Buffer,
    /// None where no function says how it rains.
    times: usize,
}

impl Rates {
    /// For the cells of the ground.
    pub fn new(gpu: &Gpu, ground: &Ground) -> Result<Self, GpuError> {
        let cells = ground.factor.len();
        let is_function = matches!(ground.intensity, Intensity::Function(_));
        let times = if is_function { (MOST_RATES / cells.max(1)).clamp(2, MOST_TIMES) } else { 0 };
        Ok(Self { buffer: storage::<f32>(gpu, "rates of rain", HEADER + times * cells)?, times })
    }

    /// Tells of the rain from `since` s before the time `now`, s, to `horizon` s after it. It holds on from then, where the card does not
    /// come back before.
    pub fn tell(&self, gpu: &Gpu, ground: &Ground, now: f64, since: f64, horizon: f64) {
        let Intensity::Function(rain) = &ground.intensity else { return };
        let interval = (since + horizon) / (self.times - 1) as f64;
        let centres: Vec<[f64; 2]> = ground.centres().collect();
        let mut numbers = vec![-since as f32, (1.0 / interval) as f32, self.times as f32];
        for number in 0..self.times {
            let time = now - since + number as f64 * interval;
            numbers.par_extend(centres.par_iter().map(|[x, y]| rain(*x, *y, time) as f32));
        }
        gpu.queue.write_buffer(&self.buffer, 0, bytemuck::cast_slice(&numbers));
    }
}
