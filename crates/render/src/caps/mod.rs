//! Drops on solids as caps of spheres.

use crate::buffer::instances;
use crate::pipeline::Recipe;
use crate::solids::Behind;
use crate::{Drawable, Renderer, Stage, Through, shaders};
use corpuscle_gpu::{Gpu, wgpu};

/// A drop: a cap on a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cap {
    /// Middle of the disc that it covers, m.
    pub position: [f64; 3],
    /// Radius of that disc, m.
    pub radius: f64,
    /// The way out of the surface, of length 1.
    pub normal: [f64; 3],
    /// Height above the surface, m.
    pub height: f64,
}

/// A cap as the device has it, in stage coordinates.
#[repr(C)]
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Instance {
    disc: [f32; 4],
    cap: [f32; 4],
}

/// Draws drops; holds what all of them share.
#[derive(Debug)]
pub struct CapPainter {
    pipeline: wgpu::RenderPipeline,
    behind: std::sync::Arc<Behind>,
}

/// Drops on the device.
#[derive(Debug)]
pub struct Caps {
    pipeline: wgpu::RenderPipeline,
    behind: std::sync::Arc<Behind>,
    buffer: wgpu::Buffer,
    count: u32,
}

impl CapPainter {
    /// A painter for a renderer.
    pub fn new(renderer: &Renderer) -> Self {
        let gpu = renderer.gpu();
        let behind = Behind::new(gpu);
        let attributes = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4];
        let pipeline = Recipe {
            label: "caps",
            module: &shaders::module(gpu, "caps", include_str!("caps.wgsl")),
            groups: &[renderer.view_layout(), &behind.layout],
            buffers: &[wgpu::VertexBufferLayout {
                array_stride: size_of::<Instance>() as u64,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes: &attributes,
            }],
            topology: wgpu::PrimitiveTopology::TriangleStrip,
        }
        .opaque(gpu);
        Self { pipeline, behind: behind.into() }
    }

    /// Drops; those without height are left out.
    pub fn caps(&self, gpu: &Gpu, stage: &Stage, caps: impl IntoIterator<Item = Cap>) -> Caps {
        let instance = |cap: Cap| {
            let ([x, y, z], normal) = (<[f32; 3]>::from(stage.place(cap.position)), cap.normal.map(|part| part as f32));
            let height = stage.length(cap.height);
            Instance { disc: [x, y, z, stage.length(cap.radius)], cap: [normal[0], normal[1], normal[2], height] }
        };
        let drawn = |instance: &Instance| {
            instance.disc.iter().chain(&instance.cap).all(|number| number.is_finite()) && instance.cap[3] > 0.0
        };
        let all: Vec<Instance> = caps.into_iter().map(instance).filter(drawn).collect();
        Caps {
            pipeline: self.pipeline.clone(),
            behind: self.behind.clone(),
            buffer: instances(gpu, "caps", &all),
            count: all.len() as u32,
        }
    }
}

impl Drawable for Caps {
    fn lets_light_through(&self) -> bool {
        self.count > 0
    }

    fn draw_through(&mut self, frame: &mut Through<'_>) {
        let behind = self.behind.group(frame);
        let mut pass = frame.begin("caps");
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(1, &behind, &[]);
        pass.set_vertex_buffer(0, self.buffer.slice(..));
        pass.draw(0..4, 0..self.count);
    }
}
