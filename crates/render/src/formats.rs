//! Formats of the textures that a picture is drawn into.

use corpuscle_gpu::wgpu;

/// Format of colours while a picture is drawn: linear light.
pub const COLOUR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Format of depth: 1 near, 0 far.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Format of the finished picture: sRGB bytes.
pub(crate) const PICTURE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
