//! Buffers.

use corpuscle_gpu::{Gpu, wgpu};

/// A vertex buffer of instances or vertices.
pub(crate) fn instances<T: bytemuck::NoUninit>(gpu: &Gpu, label: &str, all: &[T]) -> wgpu::Buffer {
    filled(gpu, label, bytemuck::cast_slice(all), wgpu::BufferUsages::VERTEX)
}

/// A uniform buffer.
pub(crate) fn uniform<T: bytemuck::NoUninit>(gpu: &Gpu, label: &str, value: &T) -> wgpu::Buffer {
    filled(gpu, label, bytemuck::bytes_of(value), wgpu::BufferUsages::UNIFORM)
}

/// A buffer of things that shaders read by their number.
pub(crate) fn storage<T: bytemuck::NoUninit>(gpu: &Gpu, label: &str, all: &[T]) -> wgpu::Buffer {
    // A binding holds one element at least.
    let bytes = bytemuck::cast_slice(all);
    let nothing = [0; 64];
    filled(gpu, label, if bytes.is_empty() { &nothing } else { bytes }, wgpu::BufferUsages::STORAGE)
}

/// An index buffer.
pub(crate) fn indices(gpu: &Gpu, label: &str, all: &[u32]) -> wgpu::Buffer {
    filled(gpu, label, bytemuck::cast_slice(all), wgpu::BufferUsages::INDEX)
}

pub(crate) fn filled(gpu: &Gpu, label: &str, bytes: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: (bytes.len() as u64).max(16),
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    gpu.queue.write_buffer(&buffer, 0, bytes);
    buffer
}
