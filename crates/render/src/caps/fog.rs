//! Drops too small to be seen one by one: fog on a surface.

use crate::pipeline::PipelineDescriptor;
use crate::shaders::Shader;
use crate::solids::FarSide;
use crate::{COLOUR_FORMAT, DEPTH_FORMAT, Renderer, Through, shaders};
use corpuscle_gpu::{GroupLayout, texture_2d, wgpu};

/// Format of the area that droplets cover.
const COVERED: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;

/// Draws fog; holds its pipelines.
#[derive(Debug)]
pub(super) struct Fog {
    cover: wgpu::RenderPipeline,
    compose: wgpu::RenderPipeline,
    depth_layout: GroupLayout,
    compose_layout: GroupLayout,
    sampler: wgpu::Sampler,
}

impl Fog {
    pub(super) fn new(renderer: &Renderer, caps_layout: &GroupLayout) -> Self {
        let gpu = renderer.gpu();
        let [_, fog] = super::SHADERS;
        let composing = ("fog_compose", include_str!("fog_compose.wgsl"));
        let depth_layout = shaders::layout(gpu, "fog's depth", 2, &[fog]);
        let compose_layout = shaders::layout(gpu, "fog", 1, &[composing]);
        let shader = Shader::new(fog.0, fog.1);
        let cover = PipelineDescriptor {
            label: "fog",
            shader: &shader,
            groups: &[renderer.view_layout(), caps_layout, &depth_layout],
            buffers: &[],
            topology: wgpu::PrimitiveTopology::TriangleStrip,
        }
        .added(gpu, &[COVERED]);
        let shader = Shader::new(composing.0, composing.1);
        let compose = PipelineDescriptor {
            label: "fog compose",
            shader: &shader,
            groups: &[renderer.view_layout(), &compose_layout],
            buffers: &[],
            topology: wgpu::PrimitiveTopology::TriangleList,
        }
        .flat(gpu, COLOUR_FORMAT);
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("fog"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..wgpu::SamplerDescriptor::default()
        });
        Self { cover, compose, depth_layout, compose_layout, sampler }
    }

    /// Draws the fog of the fine ones among `count` caps over what is behind.
    pub(super) fn draw(&self, frame: &mut Through<'_>, caps: &wgpu::BindGroup, count: u32) {
        let depth = frame.behind_depth;
        self.draw_on(frame, depth, caps, count);
    }

    /// The same on the far sides of glass that is drawn later.
    pub(super) fn draw_on_far_sides(
        &self,
        frame: &mut Through<'_>,
        sides: &[FarSide],
        caps: &wgpu::BindGroup,
        count: u32,
    ) {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let depth = texture_2d(frame.gpu, "far sides", frame.size, DEPTH_FORMAT, usage);
        let depth = depth.expect("as large as the target, which is there");
        let depth = depth.create_view(&wgpu::TextureViewDescriptor::default());
        {
            let mut pass = frame.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("far sides"),
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &depth,
                    depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                    stencil_ops: None,
                }),
                ..wgpu::RenderPassDescriptor::default()
            });
            pass.set_bind_group(0, frame.view, &[]);
            sides.iter().for_each(|side| side.paint(&mut pass));
        }
        self.draw_on(frame, &depth, caps, count);
    }

    /// The same on surfaces of a depth, where nothing hides them.
    fn draw_on(&self, frame: &mut Through<'_>, surfaces: &wgpu::TextureView, caps: &wgpu::BindGroup, count: u32) {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let covered =
            texture_2d(frame.gpu, "fog", frame.size, COVERED, usage).expect("as large as the target, which is there");
        let covered = covered.create_view(&wgpu::TextureViewDescriptor::default());
        let [on, hiding] = [surfaces, frame.behind_depth].map(wgpu::BindingResource::TextureView);
        let depth = self.depth_layout.bind(&frame.gpu.device, &[("behind_depth", on), ("hiding_depth", hiding)]);
        {
            let mut pass = begin(frame, &covered, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT));
            pass.set_pipeline(&self.cover);
            pass.set_bind_group(1, caps, &[]);
            pass.set_bind_group(2, &depth, &[]);
            pass.draw(0..4, 0..count);
        }
        let resources = [
            ("covered", wgpu::BindingResource::TextureView(&covered)),
            ("behind", wgpu::BindingResource::TextureView(frame.behind_colour)),
            ("behind_sampler", wgpu::BindingResource::Sampler(&self.sampler)),
        ];
        let compose = self.compose_layout.bind(&frame.gpu.device, &resources);
        let colour = frame.colour;
        let mut pass = begin(frame, colour, wgpu::LoadOp::Load);
        pass.set_pipeline(&self.compose);
        pass.set_bind_group(1, &compose, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// A pass without depth, with group 0 set.
fn begin<'a>(
    frame: &'a mut Through<'_>,
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
) -> wgpu::RenderPass<'a> {
    let mut pass = frame.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("fog"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
        })],
        ..wgpu::RenderPassDescriptor::default()
    });
    pass.set_bind_group(0, frame.view, &[]);
    pass
}
