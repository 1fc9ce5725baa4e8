//! A floor that only its shadows show.

use crate::buffer::{UNIFORM, uniform};
use crate::pipeline::Recipe;
use crate::{Drawable, Renderer, Stage, shaders};
use corpuscle_gpu::wgpu;

/// Part of the light that the darkest shadow takes.
const DARKNESS: f32 = 0.38;

/// A level floor without end, of the backdrop's colours, with the shadows of what stands on it.
#[derive(Debug)]
pub struct Floor {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
}

impl Floor {
    /// A floor at a height, m.
    pub fn new(renderer: &Renderer, stage: &Stage, height: f64) -> Self {
        let gpu = renderer.gpu();
        let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("floor"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: UNIFORM,
                count: None,
            }],
        });
        let recipe = Recipe {
            label: "floor",
            module: &shaders::module(gpu, "floor", include_str!("floor.wgsl")),
            groups: &[renderer.view_layout(), &layout],
            buffers: &[],
            topology: wgpu::PrimitiveTopology::TriangleList,
        };
        let [x, y, _] = stage.centre().into();
        let buffer = uniform(gpu, "floor", &[stage.place([x, y, height]).z, DARKNESS, 0.0, 0.0]);
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("floor"),
            layout: &layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
        });
        Self { pipeline: recipe.opaque(gpu), group }
    }
}

impl Drawable for Floor {
    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(1, &self.group, &[]);
        pass.draw(0..3, 0..1);
    }
}
