//! Copy bandwidth of a GPU's memory: the reference for the passes of a step.

use crate::{Bench, BenchOptions, Rate};
use corpuscle_gpu::{Gpu, GpuError, Kernel, THREADS, Task, read, storage, submit, wait_for, wgpu};
use std::time::Instant;

pub(crate) const BENCHES: &[Bench] = &[Bench {
    name: "gpu/copy",
    about: "The GPU copies a buffer to another: bytes read and bytes written, both counted.",
    needs_gpu: true,
    is_shared: false,
    run: |options| options.gpu.iter().flat_map(|gpu| rate(gpu, options)).collect(),
}];

/// Most bytes of the buffers: far more than the caches of a GPU.
const BYTES: u64 = 1 << 30;

/// Copies submitted at once.
const COPIES: u32 = 16;

/// Bytes that a thread takes at a time.
const BYTES_AT_ONCE: u64 = size_of::<[u32; 4]>() as u64;

corpuscle_gpu::declare! {
    constants {
        /// Threads of a group.
        const GROUP: u32 = THREADS;
        /// How often a thread copies, so that a gibibyte is within the groups that there can be.
        const EACH: u32 = 16;
    }
    structs {}

    /// The bindings of the copy.
    buffers Memory {
        /// Source.
        storage source: [[u32; 4]],
        /// Destination.
        storage copied: [[u32; 4]],
    }
}

/// A buffer that is copied to another of the same size.
struct Copying {
    task: Task,
    groups: u32,
}

impl Copying {
    fn of(gpu: &Gpu, from: &wgpu::Buffer, to: &wgpu::Buffer) -> Self {
        let kernel = Kernel::new(gpu, "gpu_copy", include_str!("gpu_copy.wgsl"), &[]);
        let groups = to.size().div_ceil(BYTES_AT_ONCE * u64::from(EACH * THREADS)) as u32;
        Self { task: kernel.on(gpu, &Memory { source: from.clone(), copied: to.clone() }), groups }
    }

    /// Submits so many copies.
    fn order(&self, gpu: &Gpu, times: u32) {
        submit(gpu, "copies", None, |pass| (0..times).for_each(|_| self.task.run(pass, self.groups)));
    }
}

fn rate(gpu: &Gpu, options: &BenchOptions) -> Option<Rate> {
    measure(gpu, if options.quick { 0.2 } else { 1.0 }).inspect_err(|error| eprintln!("left out: {error}")).ok()
}

fn measure(gpu: &Gpu, seconds: f64) -> Result<Rate, GpuError> {
    let count = BYTES.min(gpu.most_bytes()) / BYTES_AT_ONCE;
    let [from, to] = ["source", "copy"].map(|name| storage::<[u32; 4]>(gpu, name, count as usize));
    let (from, to) = (from?, to?);
    let copying = Copying::of(gpu, &from, &to);
    let copy = || {
        copying.order(gpu, COPIES);
        // Waits for what is done.
        wait_for(read::<u32>(gpu, &to, 1))
    };
    copy()?;
    let (began, mut times) = (Instant::now(), 0);
    while times == 0 || began.elapsed().as_secs_f64() < seconds {
        copy()?;
        times += COPIES;
    }
    Ok(Rate {
        name: "gpu/copy".into(),
        particles: 0,
        dimensions: 0,
        packing: None,
        threads: 0,
        device: Some(gpu.name.clone()),
        rate: f64::from(times) * 2.0 * from.size() as f64 / began.elapsed().as_secs_f64(),
        rate_unit: "bytes_per_s".into(),
        processes: None,
        bytes_per_particle: 0.0,
        passes: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_gpu::require_gpu;

    #[test]
    fn all_is_copied() {
        let Some(gpu) = require_gpu("a copy on the GPU") else { return };
        // Not a multiple of what a group takes.
        let count = 10_007;
        let [from, to] = ["source", "copy"].map(|name| storage::<[u32; 4]>(&gpu, name, count).unwrap());
        let numbers: Vec<[u32; 4]> = (0..count as u32).map(|k| [k, k + 1, 3 * k, !k]).collect();
        let bytes: Vec<u8> = numbers.iter().flatten().flat_map(|number| number.to_le_bytes()).collect();
        gpu.queue.write_buffer(&from, 0, &bytes);
        Copying::of(&gpu, &from, &to).order(&gpu, 1);
        assert!(wait_for(read::<[u32; 4]>(&gpu, &to, count)).unwrap() == numbers);
    }
}
