//! Tasks one after the other, and what each of them takes.

use crate::{Gpu, GpuError, buffer};
use std::collections::BTreeMap;
use std::time::Duration;

/// Times that one set of queries holds (WebGPU's own limit).
const MOST_MARKS: u32 = wgpu::QUERY_SET_MAX_QUERIES;

/// A compute pass in which tasks run one after the other, timed on request.
#[derive(Debug)]
pub struct Pass<'a> {
    pub(crate) pass: wgpu::ComputePass<'a>,
    stopwatch: Option<&'a mut Stopwatch>,
}

impl<'a> Pass<'a> {
    /// Begins a pass; with a stopwatch, each of its tasks is timed.
    pub fn begin(encoder: &'a mut wgpu::CommandEncoder, stopwatch: Option<&'a mut Stopwatch>) -> Self {
        let pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        let mut begun = Self { pass, stopwatch };
        begun.mark("");
        begun
    }

    /// Notes the time at which the task of this name ends, which is when the next begins.
    pub(crate) fn mark(&mut self, name: &'static str) {
        if let Some(stopwatch) = &mut self.stopwatch
            && stopwatch.marks.len() < MOST_MARKS as usize
        {
            self.pass.write_timestamp(&stopwatch.queries, stopwatch.marks.len() as u32);
            stopwatch.marks.push(name);
        }
    }
}

/// Has the device do tasks one after the other, timed by a stopwatch where there is one.
pub fn submit(gpu: &Gpu, label: &str, mut stopwatch: Option<&mut Stopwatch>, work: impl FnOnce(&mut Pass<'_>)) {
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some(label) });
    let mut pass = Pass::begin(&mut encoder, stopwatch.as_deref_mut());
    work(&mut pass);
    drop(pass);
    stopwatch.iter().for_each(|stopwatch| stopwatch.end(&mut encoder));
    gpu.queue.submit([encoder.finish()]);
}

/// What a kernel has taken on the device.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PassTiming {
    /// How often it was timed.
    pub times: u32,
    /// All of them together.
    pub total: Duration,
}

/// Times tasks by the device's own clock. What is timed waits for what was before it, so that all takes a little longer.
#[derive(Debug)]
pub struct Stopwatch {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    /// The names of the tasks that ended, in the order of their times.
    marks: Vec<&'static str>,
    taken: BTreeMap<&'static str, PassTiming>,
}

impl Stopwatch {
    /// A stopwatch; none where the device has no clock.
    pub fn new(gpu: &Gpu) -> Option<Self> {
        if !gpu.device.features().contains(Gpu::TIMING) {
            return None;
        }
        let queries = gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("times"),
            ty: wgpu::QueryType::Timestamp,
            count: MOST_MARKS,
        });
        let resolved = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("times"),
            size: u64::from(MOST_MARKS) * size_of::<u64>() as u64,
            usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        Some(Self { queries, resolved, marks: Vec::new(), taken: BTreeMap::new() })
    }

    /// To be called after a pass, before its encoder is submitted to the device.
    pub fn end(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.resolve_query_set(&self.queries, 0..self.marks.len() as u32, &self.resolved, 0);
    }

    /// Takes up the times of the last pass: see [`crate::wait_for`].
    ///
    /// # Errors
    /// [`GpuError::Lost`].
    pub async fn read(&mut self, gpu: &Gpu) -> Result<(), GpuError> {
        let ticks: Vec<u64> = buffer::read(gpu, &self.resolved, self.marks.len()).await?;
        let period = f64::from(gpu.queue.get_timestamp_period());
        for (name, ended) in self.marks.drain(..).skip(1).zip(ticks.windows(2)) {
            let taken = self.taken.entry(name).or_default();
            taken.times += 1;
            taken.total += Duration::from_secs_f64(1e-9 * period * ended[1].saturating_sub(ended[0]) as f64);
        }
        Ok(())
    }

    /// What each kernel has taken so far, by name.
    pub fn taken(&self) -> impl Iterator<Item = (&'static str, PassTiming)> {
        self.taken.iter().map(|(&name, &taken)| (name, taken))
    }
}
