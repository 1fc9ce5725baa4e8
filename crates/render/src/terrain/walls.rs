//! The upright sides of the block of ground.

use super::HeightField;
use super::field::Edge;
use crate::buffer::instances;
use crate::pipeline::PipelineDescriptor;
use crate::shaders::Shader;
use crate::shared::{Vertex, buffer_layout};
use crate::{Renderer, Stage};
use corpuscle_gpu::{SharedStruct, wgpu};

/// The upright sides: at the border, and round what has no heights.
#[derive(Debug)]
pub(super) struct Walls {
    opaque: wgpu::RenderPipeline,
    cast: wgpu::RenderPipeline,
    buffer: wgpu::Buffer,
    count: u32,
}

impl Walls {
    /// Sides of a field down to `base`, m.
    pub(super) fn new(renderer: &Renderer, stage: &Stage, field: &HeightField, base: f64) -> Self {
        let gpu = renderer.gpu();
        let layout = Vertex::layout();
        let attributes = layout.vertex_attributes();
        let descriptor = PipelineDescriptor {
            label: "sides of the ground",
            shader: &Shader::new("walls", include_str!("walls.wgsl")),
            groups: &[renderer.view_layout()],
            buffers: &[buffer_layout(&layout, wgpu::VertexStepMode::Vertex, &attributes)],
            topology: wgpu::PrimitiveTopology::TriangleList,
        };
        let all = vertices(stage, field, base);
        Self {
            opaque: descriptor.opaque(gpu),
            cast: descriptor.cast(gpu, "throw_shadow"),
            buffer: instances(gpu, "sides of the ground", &all),
            count: all.len() as u32,
        }
    }

    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.paint(pass, &self.opaque);
    }

    pub(super) fn cast(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.paint(pass, &self.cast);
    }

    fn paint(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline) {
        pass.set_pipeline(pipeline);
        pass.set_vertex_buffer(0, self.buffer.slice(..));
        pass.draw(0..self.count, 0..1);
    }
}

/// Two triangles below each edge at which the ground ends.
fn vertices(stage: &Stage, field: &HeightField, base: f64) -> Vec<Vertex> {
    let mut all = Vec::new();
    for Edge { nodes: [a, b], outwards: [x, y] } in field.edges() {
        let vertex = |index: usize, is_low: bool| {
            let [east, north] = field.position(index);
            let height = f64::from(field.heights[index]);
            let [px, py, pz] = stage.position([east, north, if is_low { base } else { height }]).into();
            let deep = if is_low { stage.length(height - base) } else { 0.0 };
            Vertex { position: [px, py, pz, deep], normal: [x, y, 0.0, 0.0] }
        };
        all.extend(
            [(a, false), (b, false), (a, true), (a, true), (b, false), (b, true)].map(|(node, low)| vertex(node, low)),
        );
    }
    all
}
