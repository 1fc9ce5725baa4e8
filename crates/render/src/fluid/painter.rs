//! The painter of fluids: pipelines and layouts.

use super::bindings::{CHANGED, DEPTH, MIXED, PLAIN, READ, SAMPLER, UNIFORM, WHOLE, layout, written};
use super::layers::{DISTANCE, NORMAL, SHADED, THICKNESS};
use super::{Fluid, FluidStyle};
use crate::pipeline::PipelineDescriptor;
use crate::shared::{DropletInstance, buffer_layout};
use crate::{Renderer, Stage, shaders};
use corpuscle_gpu::{Gpu, SharedStruct, wgpu};
use wgpu::ShaderStages;

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
    pub(super) shading: Filter,
    pub(super) composing: wgpu::RenderPipeline,
    pub(super) composed: wgpu::BindGroupLayout,
    /// Of the style alone.
    pub(super) settings: wgpu::BindGroupLayout,
    pub(super) sampler: wgpu::Sampler,
}

/// A compute shader over the pixels of a target, and the layout of its group 1.
#[derive(Debug, Clone)]
pub(super) struct Filter {
    pub pipeline: wgpu::ComputePipeline,
    pub layout: wgpu::BindGroupLayout,
}

impl FluidPainter {
    /// A painter for a renderer.
    pub fn new(renderer: &Renderer) -> Self {
        let (gpu, view) = (renderer.gpu(), renderer.view_layout());
        let settings = layout(gpu, "fluid", ShaderStages::FRAGMENT, &[UNIFORM]);
        let [depth, thickness] = sprites(gpu, view, &settings);
        let splat_depth = shaders::module(gpu, "splat_depth", include_str!("splat_depth.wgsl"));
        let splat_nearest = shaders::module(gpu, "splat_nearest", include_str!("splat_nearest.wgsl"));
        let splat_thickness = shaders::module(gpu, "splat_thickness", include_str!("splat_thickness.wgsl"));
        let splat_added = shaders::module(gpu, "splat_added", include_str!("splat_added.wgsl"));
        let splatted = [UNIFORM, READ, READ, CHANGED];
        let bilateral = shaders::module(gpu, "bilateral", include_str!("bilateral.wgsl"));
        let narrow = shaders::module(gpu, "narrow_range", include_str!("narrow_range.wgsl"));
        let normals = shaders::module(gpu, "fluid_normals", include_str!("fluid_normals.wgsl"));
        let shading = shaders::module(gpu, "fluid_shade", include_str!("fluid_shade.wgsl"));
        let smoothing = [UNIFORM, PLAIN, written(DISTANCE), UNIFORM];
        let shaded = [UNIFORM, PLAIN, WHOLE, MIXED, MIXED, DEPTH, SAMPLER, written(SHADED)];
        let composed = layout(gpu, "composing", ShaderStages::VERTEX_FRAGMENT, &[UNIFORM, PLAIN, PLAIN]);
        Self {
            depth,
            thickness,
            splat_depth: Filter::new(gpu, view, &splat_depth, "main", &splatted),
            splat_nearest: Filter::new(gpu, view, &splat_nearest, "main", &[READ, written(DISTANCE)]),
            splat_thickness: Filter::new(gpu, view, &splat_thickness, "main", &splatted),
            splat_added: Filter::new(gpu, view, &splat_added, "main", &[READ, written(THICKNESS)]),
            bilateral: Filter::new(gpu, view, &bilateral, "along", &smoothing),
            narrow_range: Filter::new(gpu, view, &narrow, "along", &smoothing),
            square: Filter::new(gpu, view, &narrow, "square", &smoothing),
            normals: Filter::new(gpu, view, &normals, "main", &[UNIFORM, PLAIN, written(NORMAL)]),
            shading: Filter::new(gpu, view, &shading, "main", &shaded),
            composing: PipelineDescriptor {
                label: "composing",
                module: &shaders::module(gpu, "fluid_compose", include_str!("fluid_compose.wgsl")),
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
    pub fn fluid(&self, gpu: &Gpu, stage: &Stage, style: FluidStyle) -> Fluid {
        Fluid::new(self.clone(), gpu, *stage, style)
    }
}

impl Filter {
    fn new(
        gpu: &Gpu,
        view: &wgpu::BindGroupLayout,
        module: &wgpu::ShaderModule,
        entry: &str,
        bindings: &[wgpu::BindingType],
    ) -> Self {
        let layout = layout(gpu, entry, ShaderStages::COMPUTE, bindings);
        let both = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(entry),
            bind_group_layouts: &[Some(view), Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(entry),
            layout: Some(&both),
            module,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        Self { pipeline, layout }
    }
}

/// The pipelines that draw particles: nearest depth, and thickness.
fn sprites(gpu: &Gpu, view: &wgpu::BindGroupLayout, settings: &wgpu::BindGroupLayout) -> [wgpu::RenderPipeline; 2] {
    let layout = DropletInstance::layout();
    let attributes = layout.vertex_attributes();
    let buffers = [buffer_layout(&layout, wgpu::VertexStepMode::Instance, &attributes)];
    let groups = [view, settings];
    let descriptor = |label, module| PipelineDescriptor {
        label,
        module,
        groups: &groups,
        buffers: &buffers,
        topology: wgpu::PrimitiveTopology::TriangleStrip,
    };
    let nearest = shaders::module(gpu, "fluid_depth", include_str!("fluid_depth.wgsl"));
    let added = shaders::module(gpu, "fluid_thickness", include_str!("fluid_thickness.wgsl"));
    [descriptor("depth", &nearest).nearest(gpu, DISTANCE), descriptor("thickness", &added).added(gpu, THICKNESS)]
}
