//! Memory of the device.

use crate::{Gpu, GpuError};
use bytemuck::{NoUninit, Pod};
use futures_channel::oneshot;
use wgpu::BufferUsages;

/// Memory for shaders to work on and to draw from, filled with zeros; it can be written and read from outside. At least one element long, as no
/// device binds nothing.
///
/// # Errors
/// [`GpuError::Memory`] where it is more than one binding of the device holds.
pub fn storage<T>(gpu: &Gpu, label: &'static str, length: usize) -> Result<wgpu::Buffer, GpuError> {
    let bytes = (length.max(1) * size_of::<T>()).next_multiple_of(4) as u64;
    let most = gpu.most_bytes();
    if bytes > most {
        return Err(GpuError::Memory { name: gpu.name.clone(), what: label, bytes, most });
    }
    let indirect = BufferUsages::INDIRECT | BufferUsages::VERTEX;
    let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC | indirect;
    let buffer = buffer(gpu, label, bytes, usage);
    gpu.check()?;
    Ok(buffer)
}

/// The same with values in it.
///
/// # Errors
/// [`GpuError::Memory`].
pub fn filled<T: NoUninit>(gpu: &Gpu, label: &'static str, values: &[T]) -> Result<wgpu::Buffer, GpuError> {
    let buffer = storage::<T>(gpu, label, values.len())?;
    gpu.queue.write_buffer(&buffer, 0, bytemuck::cast_slice(values));
    Ok(buffer)
}

/// Numbers that shaders read and nothing but the host changes.
pub fn uniform<T: NoUninit>(gpu: &Gpu, label: &'static str, value: &T) -> wgpu::Buffer {
    let bytes = size_of::<T>().next_multiple_of(16) as u64;
    // Software takes it as storage: see `Kernel`.
    let usage = BufferUsages::UNIFORM | BufferUsages::STORAGE | BufferUsages::COPY_DST;
    let buffer = buffer(gpu, label, bytes, usage);
    gpu.queue.write_buffer(&buffer, 0, bytemuck::bytes_of(value));
    buffer
}

/// Reads the first `length` elements back: see [`wait_for`].
///
/// # Errors
/// [`GpuError::Lost`].
pub async fn read<T: Pod>(gpu: &Gpu, buffer: &wgpu::Buffer, length: usize) -> Result<Vec<T>, GpuError> {
    let [elements] = read_together(gpu, [(buffer, length * size_of::<T>())], bytemuck::pod_collect_to_vec).await?;
    Ok(elements)
}

/// Reads the first bytes of several buffers back, of each the given number, and waits for the device once: see [`wait_for`].
///
/// # Errors
/// [`GpuError::Lost`].
pub async fn read_together<T, const COUNT: usize>(
    gpu: &Gpu,
    parts: [(&wgpu::Buffer, usize); COUNT],
    taken_as: fn(&[u8]) -> T,
) -> Result<[T; COUNT], GpuError> {
    let lengths = parts.map(|(_, bytes)| bytes.next_multiple_of(4) as u64);
    let all: u64 = lengths.iter().sum();
    if all == 0 {
        return Ok(std::array::from_fn(|_| taken_as(&[])));
    }
    let copy = self::buffer(gpu, "read back", all, BufferUsages::COPY_DST | BufferUsages::MAP_READ);
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("read back") });
    let mut starts = [0; COUNT];
    let mut start = 0;
    for ((begin, (buffer, _)), length) in starts.iter_mut().zip(parts).zip(lengths) {
        *begin = start as usize;
        if length > 0 {
            encoder.copy_buffer_to_buffer(buffer, 0, &copy, start, length);
        }
        start += length;
    }
    let mapped = Mapping::begin(gpu, copy, encoder).filled().await?;
    Ok(std::array::from_fn(|part| taken_as(&mapped[starts[part]..starts[part] + parts[part].1])))
}

/// Runs what reads back from a device to its end, on this thread. Outside a browser every read-back waits for the device itself, so that this
/// adds nothing; in a browser no thread may wait, and read-backs are to be awaited instead.
pub fn wait_for<T>(reading: impl Future<Output = T>) -> T {
    pollster::block_on(reading)
}

/// A read-back that has begun: the device was given what fills a buffer of usage `MAP_READ`.
pub(crate) struct Mapping {
    gpu: Gpu,
    buffer: wgpu::Buffer,
    filled: wgpu::SubmissionIndex,
    answer: oneshot::Receiver<Result<(), wgpu::BufferAsyncError>>,
}

impl Mapping {
    /// Has the device do what fills the buffer.
    pub fn begin(gpu: &Gpu, buffer: wgpu::Buffer, filling: wgpu::CommandEncoder) -> Self {
        let filled = gpu.queue.submit([filling.finish()]);
        let (done, answer) = oneshot::channel();
        buffer.slice(..).map_async(wgpu::MapMode::Read, move |result| {
            // Nobody waits for a read-back that was given up.
            let _ = done.send(result);
        });
        Self { gpu: gpu.clone(), buffer, filled, answer }
    }

    /// What the buffer holds then. Waits for that, and not for what others order after it.
    ///
    /// # Errors
    /// [`GpuError::Lost`].
    pub async fn filled(mut self) -> Result<wgpu::BufferView, GpuError> {
        // Does nothing in a browser, whose answer comes when it is awaited.
        let wait = wgpu::PollType::Wait { submission_index: Some(self.filled.clone()), timeout: None };
        self.gpu.device.poll(wait).map_err(|error| self.gpu.failed(error))?;
        let answer = (&mut self.answer).await;
        self.gpu.check()?;
        answer.map_err(|error| self.gpu.failed(error))?.map_err(|error| self.gpu.failed(error))?;
        self.buffer.slice(..).get_mapped_range().map_err(|error| self.gpu.failed(error))
    }
}

fn buffer(gpu: &Gpu, label: &str, size: u64, usage: BufferUsages) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
}
