//! A floor that only its shadows show.

use crate::buffer::uniform;
use crate::pipeline::PipelineDescriptor;
use crate::shaders::Shader;
use crate::{Camera, Drawable, Renderer, Stage, shaders, shared, static_layer};
use corpuscle_gpu::{Gpu, wgpu};

/// Part of the light that the darkest shadow takes.
const DARKNESS: f32 = 0.38;

/// A level floor without end, of the backdrop's colours, with the shadows of what stands on it.
#[derive(Debug)]
pub struct Floor {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    uniforms: wgpu::Buffer,
    height: f64,
    /// Another one at each height.
    state: u64,
}

impl Floor {
    /// A floor at a height, m.
    pub fn new(renderer: &Renderer, height: f64) -> Self {
        let gpu = renderer.gpu();
        let shader = ("floor", include_str!("floor.wgsl"));
        let layout = shaders::layout(gpu, "floor", 1, &[shader]);
        let descriptor = PipelineDescriptor {
            label: "floor",
            shader: &Shader::new(shader.0, shader.1),
            groups: &[renderer.view_layout(), &layout],
            buffers: &[],
            topology: wgpu::PrimitiveTopology::TriangleList,
        };
        let uniforms = uniform(gpu, "floor", &shared::Floor { darkness: DARKNESS, ..shared::Floor::default() });
        let group = layout.bind(&gpu.device, &[("plane", uniforms.as_entire_binding())]);
        Self { pipeline: descriptor.opaque(gpu), group, uniforms, height, state: static_layer::new_state() }
    }

    /// Moves it to another height, m.
    pub fn lay_at(&mut self, height: f64) {
        if height != self.height {
            (self.height, self.state) = (height, static_layer::new_state());
        }
    }
}

impl Drawable for Floor {
    fn prepare(&mut self, gpu: &Gpu, stage: &Stage, _camera: &Camera, _size: [u32; 2]) {
        let [x, y, _] = stage.centre().into();
        let height = stage.position([x, y, self.height]).z;
        gpu.queue.write_buffer(&self.uniforms, 0, &height.to_le_bytes());
    }

    fn static_state(&self) -> Option<u64> {
        Some(self.state)
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(1, &self.group, &[]);
        pass.draw(0..3, 0..1);
    }
}
