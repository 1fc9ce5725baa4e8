//! The graphics card: which one, within which limits, pictures off screen and back, shaders joined from pieces.
//!
//! Everything here keeps to the portable floor, so that the same shaders run in a browser: WebGPU's default limits (8 storage
//! buffers a stage, 256 threads a group, 65535 groups a dimension, 128 MiB a binding), no optional feature.

mod device;
mod error;
mod image;
mod shader;
mod texture;

pub use device::{Gpu, GpuKind, require_gpu};
pub use error::{GpuError, ImportError};
pub use image::Image;
pub use shader::{ShaderLibrary, join};
pub use texture::{read_rgba8, texture_2d};
pub use wgpu;
