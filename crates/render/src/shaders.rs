//! The pieces that shaders of this crate import.

use corpuscle_gpu::{Gpu, join, wgpu};

/// Pieces by name: see `#import`.
const LIBRARY: [(&str, &str); 14] = [
    ("view", include_str!("view.wgsl")),
    ("sky", include_str!("sky/sky.wgsl")),
    ("light", include_str!("light.wgsl")),
    ("ball", include_str!("balls/ball.wgsl")),
    ("ball_corner", include_str!("balls/ball_corner.wgsl")),
    ("cap", include_str!("caps/cap.wgsl")),
    ("droplet", include_str!("fluid/droplet.wgsl")),
    ("droplet_depth", include_str!("fluid/droplet_depth.wgsl")),
    ("droplet_matter", include_str!("fluid/droplet_matter.wgsl")),
    ("fluid", include_str!("fluid/fluid.wgsl")),
    ("press", include_str!("tone/press.wgsl")),
    ("smoothing", include_str!("fluid/smoothing.wgsl")),
    ("splat", include_str!("fluid/splat.wgsl")),
    ("splat_sums", include_str!("fluid/splat_sums.wgsl")),
];

/// A shader of this crate, joined from its pieces. `text` is the file of the same name.
pub(crate) fn module(gpu: &Gpu, name: &str, text: &str) -> wgpu::ShaderModule {
    let joined = join(name, text, &LIBRARY).expect("a test joins every shader");
    gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(name),
        source: wgpu::ShaderSource::Wgsl(joined.into()),
    })
}
