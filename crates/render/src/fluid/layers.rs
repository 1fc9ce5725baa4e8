//! Intermediate textures between the passes.

use crate::shared::SUMS;
use crate::{DEPTH_FORMAT, RenderError};
use corpuscle_gpu::{Gpu, GpuError, storage, texture_2d, wgpu};
use wgpu::{TextureFormat, TextureUsages as Usage};

/// Distance along the line of sight of the picture's middle; 0 where there is no fluid.
pub(super) const DISTANCE: TextureFormat = TextureFormat::R32Float;
/// Water, m; foam; what foam is to be divided by; how well particles cover the position.
pub(super) const THICKNESS: TextureFormat = TextureFormat::Rgba16Float;
/// Velocity eastwards and northwards, m/s, times how well particles cover the position.
pub(super) const FLOW: TextureFormat = TextureFormat::Rgba16Float;
/// A direction, packed.
pub(super) const NORMAL: TextureFormat = TextureFormat::R32Uint;
/// Linear light.
pub(super) const SHADED: TextureFormat = TextureFormat::Rgba16Float;

/// Intermediate textures between the passes, for one size of target.
#[derive(Debug)]
pub(super) struct Layers {
    pub size: [u32; 2],
    /// Depth is drawn into the first; each filter reads one and writes the other.
    pub distances: [wgpu::Texture; 2],
    pub nearest: wgpu::Texture,
    pub thickness: wgpu::Texture,
    pub flow: wgpu::Texture,
    pub normals: wgpu::Texture,
    pub shaded: wgpu::Texture,
    /// Once they are needed.
    pub splats: Option<Splats>,
}

/// Buffers into which compute shaders draw particles, for one size of target.
#[derive(Debug)]
pub(super) struct Splats {
    /// A number a pixel: see splat_depth.wgsl.
    pub nearest: wgpu::Buffer,
    /// So many numbers a pixel of the thickness: see splat_sums.wgsl.
    pub sums: wgpu::Buffer,
}

impl Splats {
    pub(super) fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self, GpuError> {
        let pixels = |[width, height]: [u32; 2]| width as usize * height as usize;
        Ok(Self {
            nearest: storage::<u32>(gpu, "splats", pixels(size))?,
            sums: storage::<[u32; SUMS as usize]>(gpu, "sums of splats", pixels(half(size)))?,
        })
    }
}

/// Thickness has no edges: half as many pixels each way are enough.
fn half(size: [u32; 2]) -> [u32; 2] {
    size.map(|length| length.div_ceil(2))
}

impl Layers {
    pub(super) fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self, RenderError> {
        let texture = |label, format, usage| texture_2d(gpu, label, size, format, usage | Usage::TEXTURE_BINDING);
        let distances =
            || texture("distances", DISTANCE, Usage::RENDER_ATTACHMENT | Usage::STORAGE_BINDING | Usage::COPY_SRC);
        let drawn = Usage::RENDER_ATTACHMENT | Usage::STORAGE_BINDING | Usage::TEXTURE_BINDING;
        Ok(Self {
            size,
            distances: [distances()?, distances()?],
            nearest: texture("nearest", DEPTH_FORMAT, Usage::RENDER_ATTACHMENT)?,
            thickness: texture_2d(gpu, "thickness", half(size), THICKNESS, drawn)?,
            flow: texture_2d(gpu, "flow", half(size), FLOW, drawn)?,
            normals: texture("normals", NORMAL, Usage::STORAGE_BINDING | Usage::COPY_SRC)?,
            shaded: texture("shaded", SHADED, Usage::STORAGE_BINDING)?,
            splats: None,
        })
    }
}

/// All of a texture.
pub(super) fn whole(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
