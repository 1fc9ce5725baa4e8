//! The painter of fluids: pipelines and layouts.

use super::layers::{DISTANCE, FLOW, THICKNESS};
use super::{Fluid, FluidStyle};
use crate::pipeline::PipelineDescriptor;
use crate::shaders::Shader;
use crate::shared::{DropletInstance, buffer_layout};
use crate::{RenderError, Renderer, Stage, shaders};
use corpuscle_gpu::{Gpu, GroupLayout, SharedStruct, wgpu};

/// Draws fluids; holds the pipelines of all.
#[derive(Debug, Clone)]
pub struct FluidPainter {
    pub(super) depth: wgpu::RenderPipeline,
    pub(super) thickness: wgpu::RenderPipeline,
    pub(super) splat_depth: Filter,
    pub(super) splat_nearest: Filter,
    pub(super) splat_thickness: Filter,
    pub(super) splat_added: Filter,
    pub(super) bilateral: Filter,
    pub(super) narrow_range: Filter,
    pub(super) square: Filter,
    pub(super) normals: Filter,
    pub(super) wet_mark: Filter,
    pub(super) shading: Filter,
    pub(super) composing: wgpu::RenderPipeline,
    pub(super) composed: GroupLayout,
    /// Of the style alone.
    pub(super) settings: GroupLayout,
    pub(super) sampler: wgpu::Sampler,
}

/// A compute shader over the pixels of a target, and the layout of its group 1.
#[derive(Debug, Clone)]
pub(super) struct Filter {
    pub pipeline: wgpu::ComputePipeline,
    pub layout: GroupLayout,
}

impl FluidPainter {
    /// A painter for a renderer.
    pub fn new(renderer: &Renderer) -> Self {
        let (gpu, view) = (renderer.gpu(), renderer.view_layout());
        let settings = shaders::layout(gpu, "fluid", 1, &SPRITES);
        let [depth, thickness] = sprites(gpu, view, &settings);
        let narrow = ("narrow_range", include_str!("narrow_range.wgsl"));
        let filter = |(name, text), entry| Filter::new(gpu, view, &Shader::new(name, text), entry);
        let shading = Shader::new("fluid_shade", include_str!("fluid_shade.wgsl")).outdoors();
        let composing = ("fluid_compose", include_str!("fluid_compose.wgsl"));
        let composed = shaders::layout(gpu, "composing", 1, &[composing]);
        Self {
            depth,
            thickness,
            splat_depth: filter(("splat_depth", include_str!("splat_depth.wgsl")), "main"),
            splat_nearest: filter(("splat_nearest", include_str!("splat_nearest.wgsl")), "main"),
            splat_thickness: filter(("splat_thickness", include_str!("splat_thickness.wgsl")), "main"),
            splat_added: filter(("splat_added", include_str!("splat_added.wgsl")), "main"),
            bilateral: filter(("bilateral", include_str!("bilateral.wgsl")), "along"),
            narrow_range: filter(narrow, "along"),
            square: filter(narrow, "square"),
            normals: filter(("fluid_normals", include_str!("fluid_normals.wgsl")), "main"),
            wet_mark: filter(("wet_mark", include_str!("wet_ground/wet_mark.wgsl")), "main"),
            shading: Filter::new(gpu, view, &shading, "main"),
            composing: PipelineDescriptor {
                label: "composing",
                shader: &Shader::new(composing.0, composing.1),
                groups: &[view, &composed],
                buffers: &[],
                topology: wgpu::PrimitiveTopology::TriangleList,
            }
            .opaque(gpu),
            composed,
            settings,
            sampler: gpu.device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("fluid"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..wgpu::SamplerDescriptor::default()
            }),
        }
    }

    /// A fluid of this style, still without particles.
    ///
    /// # Errors
    /// [`RenderError::Gpu`] where there is no memory for the record of wet ground.
    pub fn fluid(&self, gpu: &Gpu, stage: &Stage, style: FluidStyle) -> Result<Fluid, RenderError> {
        Fluid::new(self.clone(), gpu, *stage, style)
    }
}

impl Filter {
    fn new(gpu: &Gpu, view: &GroupLayout, shader: &Shader<'static>, entry: &str) -> Self {
        let layout = shader.group(gpu, 1);
        let pipeline = gpu.computing(format!("{entry} of {}", shader.key()), |_| {
            let both = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(shader.name),
                bind_group_layouts: &[Some(view.layout()), Some(layout.layout())],
                immediate_size: 0,
            });
            gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(shader.name),
                layout: Some(&both),
                module: &shader.module(gpu),
                entry_point: Some(entry),
                compilation_options: shader.options(),
                cache: None,
            })
        });
        Self { pipeline, layout }
    }
}

/// Shaders that draw particles: the nearest distance, and thickness.
const SPRITES: [(&str, &str); 2] =
    [("fluid_depth", include_str!("fluid_depth.wgsl")), ("fluid_thickness", include_str!("fluid_thickness.wgsl"))];

/// The pipelines that draw particles: nearest depth, and thickness.
fn sprites(gpu: &Gpu, view: &GroupLayout, settings: &GroupLayout) -> [wgpu::RenderPipeline; 2] {
    let layout = DropletInstance::layout();
    let attributes = layout.vertex_attributes();
    let buffers = [buffer_layout(&layout, wgpu::VertexStepMode::Instance, &attributes)];
    let groups = [view, settings];
    let descriptor = |label, shader| PipelineDescriptor {
        label,
        shader,
        groups: &groups,
        buffers: &buffers,
        topology: wgpu::PrimitiveTopology::TriangleStrip,
    };
    let [nearest, added] = SPRITES.map(|(name, text)| Shader::new(name, text));
    [
        descriptor("depth", &nearest).nearest(gpu, DISTANCE),
        descriptor("thickness", &added).added(gpu, &[THICKNESS, FLOW]),
    ]
}
