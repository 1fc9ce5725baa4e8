//! Deferred shading of many balls: first the number of the nearest ball is drawn for each sample, then visible samples are shaded once.

use crate::pipeline::PipelineDescriptor;
use crate::shaders::Shader;
use crate::{Before, DEPTH_FORMAT, Renderer, shaders};
use corpuscle_gpu::{GroupLayout, texture_2d, wgpu};

/// Format of the numbers.
const NUMBERS: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;

/// The pipelines.
#[derive(Debug)]
pub(super) struct SeenPainter {
    find: wgpu::RenderPipeline,
    shade: wgpu::RenderPipeline,
    layout: GroupLayout,
}

/// Which balls are seen where in a picture.
#[derive(Debug)]
pub(super) struct Seen {
    group: wgpu::BindGroup,
}

impl SeenPainter {
    pub(super) fn new(renderer: &Renderer, balls: &GroupLayout) -> Self {
        let gpu = renderer.gpu();
        let [.., numbered, seen] = super::SHADERS;
        let layout = shaders::layout(gpu, "balls seen", 2, &[seen]);
        let find = PipelineDescriptor {
            label: "balls numbered",
            shader: &Shader::new(numbered.0, numbered.1).outdoors(),
            groups: &[renderer.view_layout(), balls],
            buffers: &[],
            topology: wgpu::PrimitiveTopology::TriangleList,
        }
        .nearest(gpu, NUMBERS);
        let shade = PipelineDescriptor {
            label: "balls seen",
            shader: &Shader::new(seen.0, seen.1).outdoors(),
            groups: &[renderer.view_layout(), balls, &layout],
            buffers: &[],
            topology: wgpu::PrimitiveTopology::TriangleList,
        }
        .opaque(gpu);
        Self { find, shade, layout }
    }

    /// Finds the nearest of `count` balls for each sample.
    pub(super) fn find(&self, frame: &mut Before<'_>, balls: &wgpu::BindGroup, count: u32) -> Seen {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let texture = |format| {
            let texture = texture_2d(frame.gpu, "balls seen", frame.size, format, usage);
            texture
                .expect("as large as the target, which is there")
                .create_view(&wgpu::TextureViewDescriptor::default())
        };
        let (numbers, depth) = (texture(NUMBERS), texture(DEPTH_FORMAT));
        let mut pass = frame.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("balls numbered"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &numbers,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations::default(),
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard }),
                stencil_ops: None,
            }),
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_bind_group(0, frame.view, &[]);
        pass.set_bind_group(1, balls, &[]);
        pass.set_pipeline(&self.find);
        pass.draw(0..super::CORNERS * count, 0..1);
        let numbers = wgpu::BindingResource::TextureView(&numbers);
        let group = self.layout.bind(&frame.gpu.device, &[("numbers", numbers)]);
        Seen { group }
    }

    /// Shades what was found.
    pub(super) fn shade(&self, pass: &mut wgpu::RenderPass<'_>, balls: &wgpu::BindGroup, seen: &Seen) {
        pass.set_pipeline(&self.shade);
        pass.set_bind_group(1, balls, &[]);
        pass.set_bind_group(2, &seen.group, &[]);
        pass.draw(0..3, 0..1);
    }
}
