//! Where pictures are drawn and shown: the window's own device.
//!
//! A picture is laid into the window by a shader of its own. The toolkit's own shader for images filters in two ways and takes one;
//! software in place of a graphics card computes both, and took ten times as long.

use corpuscle::gpu::{Gpu, wgpu};
use egui::PaintCallbackInfo;
use egui_wgpu::{CallbackResources, CallbackTrait};
use std::sync::Arc;

/// The window's device, and how pictures are laid into the window.
#[derive(Clone)]
pub struct Screen {
    /// The device.
    pub gpu: Gpu,
    pipeline: Arc<wgpu::RenderPipeline>,
    layout: Arc<wgpu::BindGroupLayout>,
}

/// A picture on the device, to be shown in the window.
#[derive(Clone)]
pub(crate) struct OnScreen {
    pipeline: Arc<wgpu::RenderPipeline>,
    group: Arc<wgpu::BindGroup>,
}

impl Screen {
    /// The screen of a window that is drawn on a device in a format.
    pub fn new(gpu: Gpu, format: wgpu::TextureFormat) -> Self {
        let device = &gpu.device;
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("picture in the window"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: false },
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
                count: None,
            }],
        });
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("picture in the window"),
            source: wgpu::ShaderSource::Wgsl(include_str!("screen.wgsl").into()),
        });
        let entry = if format.is_srgb() { "fragment_linear" } else { "fragment" };
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("picture in the window"),
            layout: Some(&device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("picture in the window"),
                bind_group_layouts: &[Some(&layout)],
                immediate_size: 0,
            })),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(format.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        Self { gpu, pipeline: Arc::new(pipeline), layout: Arc::new(layout) }
    }

    /// Makes ready to show a picture that lies on the device.
    pub(crate) fn show(&self, view: &wgpu::TextureView) -> OnScreen {
        let group = self.gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("picture in the window"),
            layout: &self.layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(view) }],
        });
        OnScreen { pipeline: self.pipeline.clone(), group: Arc::new(group) }
    }
}

impl CallbackTrait for OnScreen {
    fn paint(&self, _info: PaintCallbackInfo, pass: &mut wgpu::RenderPass<'static>, _resources: &CallbackResources) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &*self.group, &[]);
        pass.draw(0..3, 0..1);
    }
}
