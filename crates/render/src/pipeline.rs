//! Pipelines that draw into a frame.

use crate::shaders::Shader;
use crate::{COLOUR_FORMAT, DEPTH_FORMAT};
use corpuscle_gpu::{Gpu, GroupLayout, wgpu};

/// Description of a pipeline. Its shader has entry points `vertex` and, unless another is named, `fragment`.
pub(crate) struct PipelineDescriptor<'a> {
    /// Its label.
    pub label: &'a str,
    /// The shader.
    pub shader: &'a Shader<'a>,
    /// Layouts of its groups; the first is that of the view.
    pub groups: &'a [&'a GroupLayout],
    /// Layouts of its vertex buffers.
    pub buffers: &'a [wgpu::VertexBufferLayout<'a>],
    /// Triangles, one by one or in a strip.
    pub topology: wgpu::PrimitiveTopology,
}

impl PipelineDescriptor<'_> {
    /// A pipeline that draws into colour and depth; nearer hides farther.
    pub(crate) fn opaque(&self, gpu: &Gpu) -> wgpu::RenderPipeline {
        self.build(gpu, "fragment", &[COLOUR_FORMAT.into()], Some(wgpu::CompareFunction::GreaterEqual))
    }

    /// The same with another fragment entry point.
    pub(crate) fn opaque_by(&self, gpu: &Gpu, entry: &str) -> wgpu::RenderPipeline {
        self.build(gpu, entry, &[COLOUR_FORMAT.into()], Some(wgpu::CompareFunction::GreaterEqual))
    }

    /// A pipeline that draws into the sun's depth map; `entry` is its fragment entry point.
    pub(crate) fn cast(&self, gpu: &Gpu, entry: &str) -> wgpu::RenderPipeline {
        self.build(gpu, entry, &[], Some(wgpu::CompareFunction::GreaterEqual))
    }

    /// A pipeline that draws into colours of a format, without depth.
    pub(crate) fn flat(&self, gpu: &Gpu, format: wgpu::TextureFormat) -> wgpu::RenderPipeline {
        self.build(gpu, "fragment", &[format.into()], None)
    }

    /// A pipeline that draws into colours of a format, and keeps what is nearest.
    pub(crate) fn nearest(&self, gpu: &Gpu, format: wgpu::TextureFormat) -> wgpu::RenderPipeline {
        self.build(gpu, "fragment", &[format.into()], Some(wgpu::CompareFunction::Greater))
    }

    /// A pipeline that adds to colours of formats.
    pub(crate) fn added(&self, gpu: &Gpu, formats: &[wgpu::TextureFormat]) -> wgpu::RenderPipeline {
        let add = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::One,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        };
        let blend = Some(wgpu::BlendState { color: add, alpha: add });
        let target = |format: &wgpu::TextureFormat| wgpu::ColorTargetState {
            format: *format,
            blend,
            write_mask: wgpu::ColorWrites::ALL,
        };
        self.build(gpu, "fragment", &formats.iter().map(target).collect::<Vec<_>>(), None)
    }

    /// The pipeline; a device compiles the same one once. The layouts of its groups follow from its shader.
    fn build(
        &self,
        gpu: &Gpu,
        fragment: &str,
        colours: &[wgpu::ColorTargetState],
        depth: Option<wgpu::CompareFunction>,
    ) -> wgpu::RenderPipeline {
        let Self { label, topology, buffers, .. } = self;
        let groups = self.groups.len();
        let rest = format!("{label} {groups} {fragment} {colours:?} {depth:?} {topology:?} {buffers:?}");
        gpu.drawing(format!("{rest} {}", self.shader.key()), |_| {
            let module = self.shader.module(gpu);
            let groups: Vec<_> = self.groups.iter().map(|group| Some(group.layout())).collect();
            let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(self.label),
                bind_group_layouts: &groups,
                immediate_size: 0,
            });
            let buffers: Vec<_> = self.buffers.iter().cloned().map(Some).collect();
            let targets: Vec<_> = colours.iter().cloned().map(Some).collect();
            gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(self.label),
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("vertex"),
                    compilation_options: self.shader.options(),
                    buffers: &buffers,
                },
                primitive: wgpu::PrimitiveState { topology: self.topology, ..wgpu::PrimitiveState::default() },
                depth_stencil: depth.map(|compare| wgpu::DepthStencilState {
                    format: DEPTH_FORMAT,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(compare),
                    stencil: wgpu::StencilState::default(),
                    bias: wgpu::DepthBiasState::default(),
                }),
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some(fragment),
                    compilation_options: self.shader.options(),
                    targets: &targets,
                }),
                multiview_mask: None,
                cache: None,
            })
        })
    }
}
