//! The sides of the block of ground.

use super::HeightField;
use crate::buffer::instances;
use crate::pipeline::Recipe;
use crate::{Renderer, Stage, shaders};
use corpuscle_gpu::wgpu;

/// A corner as the device has it.
#[repr(C)]
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Vertex {
    /// Place and depth below the surface, in stage units.
    place: [f32; 4],
    normal: [f32; 4],
}

/// The four upright sides.
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
        let attributes = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4];
        let recipe = Recipe {
            label: "sides of the ground",
            module: &shaders::module(gpu, "walls", include_str!("walls.wgsl")),
            groups: &[renderer.view_layout()],
            buffers: &[wgpu::VertexBufferLayout {
                array_stride: size_of::<Vertex>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &attributes,
            }],
            topology: wgpu::PrimitiveTopology::TriangleList,
        };
        let all = vertices(stage, field, base);
        Self {
            opaque: recipe.opaque(gpu),
            cast: recipe.cast(gpu, "throw_shadow"),
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

/// Two triangles below each edge between border nodes that have heights.
fn vertices(stage: &Stage, field: &HeightField, base: f64) -> Vec<Vertex> {
    let [columns, rows] = field.nodes;
    let south: Vec<usize> = (0..columns).collect();
    let west: Vec<usize> = (0..rows).map(|row| row * columns).collect();
    let sides = [
        (south.clone(), [0.0, -1.0]),
        (south.iter().map(|index| index + (rows - 1) * columns).collect(), [0.0, 1.0]),
        (west.clone(), [-1.0, 0.0]),
        (west.iter().map(|index| index + columns - 1).collect(), [1.0, 0.0]),
    ];
    let mut all = Vec::new();
    for (nodes, [x, y]) in sides {
        for pair in nodes.windows(2) {
            if pair.iter().any(|index| field.heights[*index].is_nan()) {
                continue;
            }
            let vertex = |index: usize, is_low: bool| {
                let at = [0, 1].map(|k| field.origin[k] + field.cell[k] * [index % columns, index / columns][k] as f64);
                let height = f64::from(field.heights[index]);
                let [px, py, pz] = stage.place([at[0], at[1], if is_low { base } else { height }]).into();
                let deep = if is_low { stage.length(height - base) } else { 0.0 };
                Vertex { place: [px, py, pz, deep], normal: [x, y, 0.0, 0.0] }
            };
            let [a, b] = [pair[0], pair[1]];
            all.extend(
                [(a, false), (b, false), (a, true), (a, true), (b, false), (b, true)].map(|(i, low)| vertex(i, low)),
            );
        }
    }
    all
}
