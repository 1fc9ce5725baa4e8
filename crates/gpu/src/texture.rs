//! Textures to draw into, and back to main memory.

use crate::buffer::{Mapping, wait_for};
use crate::{Gpu, GpuError, Image};

/// A texture of `size` `[width, height]`, pixels.
///
/// # Errors
/// [`GpuError::TooLarge`].
pub fn texture_2d(
    gpu: &Gpu,
    label: &str,
    [width, height]: [u32; 2],
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> Result<wgpu::Texture, GpuError> {
    let most = gpu.most_pixels();
    if width.max(height) > most {
        return Err(GpuError::TooLarge { width, height, most });
    }
    Ok(gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: width.max(1), height: height.max(1), depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    }))
}

/// Reads a texture of four bytes a pixel (`Rgba8Unorm` and its like, usage `COPY_SRC`) back. Waits for the device.
///
/// # Errors
/// [`GpuError::Lost`].
pub fn read_rgba8(gpu: &Gpu, texture: &wgpu::Texture) -> Result<Image, GpuError> {
    wait_for(read_rgba8_later(gpu, texture))
}

/// [`read_rgba8`] where one may not wait, as in a browser. What the texture holds now is read, whatever is drawn into it meanwhile.
pub fn read_rgba8_later(gpu: &Gpu, texture: &wgpu::Texture) -> impl Future<Output = Result<Image, GpuError>> + use<> {
    let (mapping, size) = begin_reading(gpu, texture);
    async move { Ok(image(&mapping.filled().await?, size)) }
}

/// Bytes of a row in the buffer that a texture is copied to.
fn row(width: u32) -> u32 {
    (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}

fn image(bytes: &[u8], [width, height]: [u32; 2]) -> Image {
    let lines = bytes.chunks_exact(row(width) as usize);
    let rgba = lines.flat_map(|line| &line[..4 * width as usize]).copied().collect();
    Image { width, height, rgba }
}

/// Has the device copy a texture to a buffer; gives its size too.
fn begin_reading(gpu: &Gpu, texture: &wgpu::Texture) -> (Mapping, [u32; 2]) {
    let (width, height) = (texture.width(), texture.height());
    let row = row(width);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read back"),
        size: u64::from(row) * u64::from(height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("read back") });
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: Some(height) };
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
        texture.size(),
    );
    (Mapping::begin(gpu, buffer, encoder), [width, height])
}
