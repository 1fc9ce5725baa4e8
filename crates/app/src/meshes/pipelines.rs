//! Pipelines that draw the window's triangles on the device.

use super::shared::{MeshVertex, WindowSize, shader};
use corpuscle::gpu::{Gpu, GroupLayout, SharedStruct, wgpu};
use egui::TextureFilter;
use std::sync::Arc;

/// The shaders for letters and for images, and what they take.
pub(super) struct Pipelines {
    pub letters: wgpu::RenderPipeline,
    pub images: wgpu::RenderPipeline,
    window: GroupLayout,
    image: GroupLayout,
    samplers: [wgpu::Sampler; 2],
}

/// An image of the toolkit on the device.
pub(super) struct Image {
    pub texture: wgpu::Texture,
    pub group: Arc<wgpu::BindGroup>,
}

impl Pipelines {
    pub fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Self {
        let shader = shader();
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("meshes"),
            source: wgpu::ShaderSource::Wgsl(shader.as_str().into()),
        });
        let layout = |label, group| {
            GroupLayout::new(device, label, group, &[&shader]).expect("the shader is valid, as a test says")
        };
        let (window, image) = (layout("size of the window", 0), layout("image", 1));
        let pipeline = |entry| pipeline(device, format, &module, entry, [window.layout(), image.layout()]);
        let sampler = |filter| {
            device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("meshes"),
                mag_filter: filter,
                min_filter: filter,
                ..wgpu::SamplerDescriptor::default()
            })
        };
        Self {
            letters: pipeline("fragment_letters"),
            images: pipeline("fragment_image"),
            samplers: [wgpu::FilterMode::Nearest, wgpu::FilterMode::Linear].map(sampler),
            window,
            image,
        }
    }

    /// An empty image.
    pub fn image(&self, device: &wgpu::Device, size: wgpu::Extent3d, filter: TextureFilter) -> Image {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("image"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let sampler = &self.samplers[usize::from(filter == TextureFilter::Linear)];
        let resources = [
            ("image", wgpu::BindingResource::TextureView(&view)),
            ("image_sampler", wgpu::BindingResource::Sampler(sampler)),
        ];
        let group = self.image.bind(device, &resources);
        Image { texture, group: Arc::new(group) }
    }

    /// The size of the window, points, as the shader takes it.
    pub fn window(&self, gpu: &Gpu, size: [f32; 2]) -> wgpu::BindGroup {
        let size = WindowSize { size, unused: [0.0; 2] };
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("size of the window"),
            size: size_of_val(&size) as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        gpu.queue.write_buffer(&buffer, 0, bytemuck::bytes_of(&size));
        self.window.bind(&gpu.device, &[("window", buffer.as_entire_binding())])
    }
}

/// Triangles laid over what is there, opacity multiplied in.
fn pipeline(
    device: &wgpu::Device,
    format: wgpu::TextureFormat,
    module: &wgpu::ShaderModule,
    entry: &str,
    layouts: [&wgpu::BindGroupLayout; 2],
) -> wgpu::RenderPipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("meshes"),
        bind_group_layouts: &layouts.map(Some),
        immediate_size: 0,
    });
    let corner = MeshVertex::layout();
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("meshes"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: corner.size as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &corner.vertex_attributes(),
            })],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format,
                blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
