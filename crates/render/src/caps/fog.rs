//! Drops too small to be seen one by one: fog on a surface.

use crate::buffer::TEXTURE;
use crate::pipeline::PipelineDescriptor;
use crate::{COLOUR_FORMAT, Renderer, Through, shaders};
use corpuscle_gpu::{Gpu, texture_2d, wgpu};

/// Format of the area that droplets cover.
const COVERED: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;

/// Draws fog; holds its pipelines.
#[derive(Debug)]
pub(super) struct Fog {
    cover: wgpu::RenderPipeline,
    compose: wgpu::RenderPipeline,
    depth_layout: wgpu::BindGroupLayout,
    compose_layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
}

impl Fog {
    pub(super) fn new(renderer: &Renderer, caps_layout: &wgpu::BindGroupLayout) -> Self {
        let gpu = renderer.gpu();
        let layout = |label, types: &[wgpu::BindingType]| {
            let entry = |(binding, ty): (usize, &wgpu::BindingType)| wgpu::BindGroupLayoutEntry {
                binding: binding as u32,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: *ty,
                count: None,
            };
            let entries: Vec<_> = types.iter().enumerate().map(entry).collect();
            gpu.device
                .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
        };
        let texture = |sample_type| wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let depth_layout = layout("fog's depth", &[texture(wgpu::TextureSampleType::Depth)]);
        let filtered = texture(wgpu::TextureSampleType::Float { filterable: true });
        let sampler_type = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let compose_layout = layout("fog", &[TEXTURE, filtered, sampler_type]);
        let module = shaders::module(gpu, "fog", include_str!("fog.wgsl"));
        let cover = PipelineDescriptor {
            label: "fog",
            module: &module,
            groups: &[renderer.view_layout(), caps_layout, &depth_layout],
            buffers: &[],
            topology: wgpu::PrimitiveTopology::TriangleStrip,
        }
        .added(gpu, COVERED);
        let module = shaders::module(gpu, "fog_compose", include_str!("fog_compose.wgsl"));
        let compose = PipelineDescriptor {
            label: "fog compose",
            module: &module,
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
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let covered =
            texture_2d(frame.gpu, "fog", frame.size, COVERED, usage).expect("as large as the target, which is there");
        let covered = covered.create_view(&wgpu::TextureViewDescriptor::default());
        let depth = group(frame.gpu, &self.depth_layout, &[wgpu::BindingResource::TextureView(frame.behind_depth)]);
        {
            let mut pass = begin(frame, &covered, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT));
            pass.set_pipeline(&self.cover);
            pass.set_bind_group(1, caps, &[]);
            pass.set_bind_group(2, &depth, &[]);
            pass.draw(0..4, 0..count);
        }
        let resources = [
            wgpu::BindingResource::TextureView(&covered),
            wgpu::BindingResource::TextureView(frame.behind_colour),
            wgpu::BindingResource::Sampler(&self.sampler),
        ];
        let compose = group(frame.gpu, &self.compose_layout, &resources);
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

fn group(gpu: &Gpu, layout: &wgpu::BindGroupLayout, resources: &[wgpu::BindingResource<'_>]) -> wgpu::BindGroup {
    let entries: Vec<_> = (0..)
        .zip(resources)
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource: resource.clone() })
        .collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("fog"), layout, entries: &entries })
}
