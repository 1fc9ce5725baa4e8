//! Steps that a device takes in batches: the host says until when to go on, the device decides after each step whether there is another, and the host reads what they
//! did once for all of a batch.
//!
//! A batch begins with the host writing the status with [`BATCH_START`]. Each pass runs with as many groups of threads as the device has noted; where the batch ends early
//! it notes none, so the passes of the steps that are left do nothing.

use crate::{Gpu, GpuError, Pass, PassTiming, Stopwatch, submit, wgpu};
use bytemuck::NoUninit;
use web_time::Instant;

crate::declare! {
    constants {
        /// The batch goes on.
        pub const GOING: u32 = 0;
        /// The host has just started a batch.
        pub const BATCH_START: u32 = 1;
        /// The requested time is reached.
        pub const ARRIVED: u32 = 2;
        /// The host is to do something first: make cells, or room.
        pub const NEEDS_HOST: u32 = 3;
        /// A value is not finite, or the step is too short to go on.
        pub const BROKEN: u32 = 4;
        /// Larger than any value: where the search for a minimum starts.
        pub const FAR: f32 = 3.0e38;
        /// Cells of a search are taken to be this part thicker than they are: a particle on their border may be in either.
        pub const CELL_BORDER: f32 = 0.01;
        /// Threads of a group.
        pub const GROUP: u32 = crate::THREADS;
        /// Cells whose counts one group of the sort adds up.
        pub const SORT_BLOCK: u32 = crate::sort::BLOCK as u32;
    }
    structs {}

    /// What all models that take steps share with their shaders: whether a batch goes on, and the threads of a group. To be included by their declarations.
    pub piece Stepping;
}

/// Steps of a batch at most.
pub const MOST_STEPS: u32 = 64;

/// Longest wall time of a batch, about, s: after it the host checks whether to stop.
const MAX_BATCH_SECONDS: f64 = 0.2;

/// Why a batch ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Halt {
    /// All its steps are done.
    Full,
    /// The requested time is reached.
    Arrived,
    /// The host is to do something first.
    NeedsHost,
    /// What was computed is no longer a number, or breaks the model's limits.
    Broken,
}

impl Halt {
    /// Why a batch ended, by the number that the device has noted: [`GOING`] and those after it.
    pub fn of(noted: u32) -> Self {
        match noted {
            ARRIVED => Self::Arrived,
            NEEDS_HOST => Self::NeedsHost,
            BROKEN => Self::Broken,
            _ => Self::Full,
        }
    }
}

/// What submits batches of steps, times them, and finds how many steps fit into one.
#[derive(Debug)]
pub struct Batches {
    gpu: Gpu,
    /// What the device's tools show.
    label: &'static str,
    /// Steps of the next batch at most.
    size: u32,
    seconds: f64,
    stopwatch: Option<Stopwatch>,
}

impl Batches {
    /// Batches of a model of this name; the first has one step.
    pub fn new(gpu: Gpu, label: &'static str) -> Self {
        Self { gpu, label, size: 1, seconds: 0.0, stopwatch: None }
    }

    /// Batches of the same model after its memory on the device was made anew: those before, with what they measured, where it is the same device.
    pub fn after(self, before: Option<Self>) -> Self {
        before.filter(|before| before.gpu.device == self.gpu.device).unwrap_or(self)
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Wall-clock time of all batches, s.
    pub fn seconds(&self) -> f64 {
        self.seconds
    }

    /// Times each pass from now on, where the device has a clock.
    pub fn time_passes(&mut self) {
        self.stopwatch = Stopwatch::new(&self.gpu);
    }

    /// What each pass has taken since, by its name; nothing where passes are not timed.
    pub fn pass_times(&self) -> Vec<(&'static str, PassTiming)> {
        self.stopwatch.iter().flat_map(Stopwatch::taken).collect()
    }

    /// The number of steps of the next batch for `left` s in steps of about `step` s: 1 at least, and `most` or fewer.
    pub fn steps(&self, left: f64, step: f64, most: u64) -> u32 {
        let planned = (left / step).ceil().clamp(1.0, f64::from(MOST_STEPS)) as u32;
        u64::from(planned.min(self.size)).min(most) as u32
    }

    /// Submits work that is no batch of steps.
    pub fn submit(&mut self, work: impl FnOnce(&mut Pass<'_>)) {
        submit(&self.gpu, self.label, self.stopwatch.as_mut(), work);
    }

    /// Runs a batch of `count` steps or fewer: uploads the status, records the passes of `work`, and downloads by `read` what they did.
    ///
    /// # Errors
    /// Those of `read`, and [`GpuError::Lost`].
    pub async fn run<T>(
        &mut self,
        count: u32,
        (status, uploaded): (&wgpu::Buffer, &impl NoUninit),
        work: impl FnOnce(&mut Pass<'_>),
        read: impl AsyncFnOnce(&Gpu) -> Result<T, GpuError>,
    ) -> Result<T, GpuError> {
        let began = Instant::now();
        self.gpu.queue.write_buffer(status, 0, bytemuck::bytes_of(uploaded));
        self.submit(work);
        let done = read(&self.gpu).await?;
        let took = began.elapsed().as_secs_f64();
        self.seconds += took;
        self.adapt_size(count, took);
        if let Some(stopwatch) = &mut self.stopwatch {
            stopwatch.read(&self.gpu).await?;
        }
        Ok(done)
    }

    /// Finds the size of the next batch after one of `count` steps that took so long, s.
    fn adapt_size(&mut self, count: u32, took: f64) {
        let next = if took < 0.5 * MAX_BATCH_SECONDS { 2 * count.max(self.size / 2) } else { count / 2 };
        self.size = next.clamp(1, MOST_STEPS);
    }
}

/// A number in double precision as shaders keep it: a value in single precision and its error term, to be added.
pub fn to_pair(number: f64) -> [f32; 2] {
    let value = number as f32;
    [value, (number - f64::from(value)) as f32]
}

/// The number that shaders keep as a pair: see [`to_pair`].
pub fn from_pair([value, error]: [f32; 2]) -> f64 {
    f64::from(value) + f64::from(error)
}

/// A count of which shaders keep the low and the high half.
pub fn from_halves([low, high]: [u32; 2]) -> u64 {
    (u64::from(high) << 32) + u64::from(low)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_keep_what_single_precision_drops() {
        for number in [300.000_000_123, -1e-9, 0.0, 123_456_789.123_456] {
            assert!((from_pair(to_pair(number)) - number).abs() <= 4e-15 * number.abs(), "{number}");
        }
        assert_eq!(from_halves([7, 2]), 7 + (2 << 32));
    }
}
