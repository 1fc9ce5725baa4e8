//! The ground as a texture of nodes.

use corpuscle_gpu::{Gpu, GpuError, texture_2d, wgpu};
use corpuscle_terrain::{GroundPatches, Terrain};

/// The nodes of the ground's patches, heights above `level`, and where they lie.
pub(super) fn texture(
    gpu: &Gpu,
    terrain: &Terrain,
    level: f64,
) -> Result<(wgpu::TextureView, GroundPatches), GpuError> {
    let patches = terrain.patches_above(level);
    let [width, height] = patches.size.map(|nodes| nodes as u32);
    let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
    let texture = texture_2d(gpu, "ground", [width, height], wgpu::TextureFormat::Rgba32Float, usage)?;
    let bytes: &[u8] = bytemuck::cast_slice(&patches.nodes);
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(16 * width), rows_per_image: Some(height) };
    gpu.queue.write_texture(texture.as_image_copy(), bytes, layout, texture.size());
    Ok((texture.create_view(&wgpu::TextureViewDescriptor::default()), patches))
}
