//! How fast a graphics card copies its own memory: what the passes of a step are measured against.

use crate::{Bench, BenchOptions, Rate};
use corpuscle_gpu::{Gpu, GpuError, read, storage, wgpu};
use std::time::Instant;

pub(crate) const BENCHES: &[Bench] = &[Bench {
    name: "card/copy",
    about: "The card copies a buffer to another: bytes read and bytes written, both counted.",
    needs_card: true,
    run: |options| options.gpu.iter().flat_map(|gpu| rate(gpu, options)).collect(),
}];

/// Bytes of the buffers, at most: far more than a card keeps near.
const BYTES: u64 = 1 << 30;

/// Copies that are ordered at once.
const COPIES: u32 = 16;

fn rate(gpu: &Gpu, options: &BenchOptions) -> Option<Rate> {
    measure(gpu, if options.quick { 0.2 } else { 1.0 }).inspect_err(|error| eprintln!("left out: {error}")).ok()
}

fn measure(gpu: &Gpu, seconds: f64) -> Result<Rate, GpuError> {
    let words = BYTES.min(gpu.most_bytes()) / 4;
    let [from, to] = ["copied", "copy"].map(|name| storage::<u32>(gpu, name, words as usize));
    let (from, to) = (from?, to?);
    let copy = || {
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("copies") });
        for _ in 0..COPIES {
            encoder.copy_buffer_to_buffer(&from, 0, &to, 0, from.size());
        }
        gpu.queue.submit([encoder.finish()]);
        // Waits for what is done.
        read::<u32>(gpu, &to, 1)
    };
    copy()?;
    let (began, mut times) = (Instant::now(), 0);
    while times == 0 || began.elapsed().as_secs_f64() < seconds {
        copy()?;
        times += COPIES;
    }
    Ok(Rate {
        name: "card/copy".into(),
        particles: 0,
        dimensions: 0,
        packing: None,
        threads: 0,
        device: Some(gpu.name.clone()),
        rate: f64::from(times) * 2.0 * from.size() as f64 / began.elapsed().as_secs_f64(),
        rate_unit: "bytes_per_s".into(),
        bytes_per_particle: 0.0,
        passes: Vec::new(),
    })
}
