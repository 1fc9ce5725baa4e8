//! Water cut off at the borders of the ground: upright faces from the ground up to its surface.

use super::{DeviceWater, Droplet};
use crate::buffer::instances;
use crate::pipeline::PipelineDescriptor;
use crate::shaders::Shader;
use crate::shared::{Vertex, buffer_layout};
use crate::{Drawable, HeightField, Renderer, Stage};
use corpuscle_gpu::{Gpu, SharedStruct, wgpu};
use glam::{DVec2, DVec3};

/// Least sum of weights of particles at a wet position of the border: half of that at the middle of a shore, since beyond
/// the border there are none.
pub(super) const COVERED: f64 = 0.3;

/// The faces of water at the four borders of the ground, filled in anew for each frame.
#[derive(Debug)]
pub struct WaterSides {
    pipeline: wgpu::RenderPipeline,
    stage: Stage,
    buffer: Option<(wgpu::Buffer, u32)>,
}

/// A border of the ground.
struct Border {
    /// Its nodes, one after the other.
    nodes: Vec<usize>,
    /// The axis it runs along.
    axis: usize,
    outwards: [f32; 2],
}

impl WaterSides {
    /// Faces of a stage, still without water.
    pub fn new(renderer: &Renderer, stage: &Stage) -> Self {
        let gpu = renderer.gpu();
        let layout = Vertex::layout();
        let attributes = layout.vertex_attributes();
        let descriptor = PipelineDescriptor {
            label: "sides of water",
            shader: &Shader::new("sides", include_str!("sides.wgsl")).outdoors(),
            groups: &[renderer.view_layout()],
            buffers: &[buffer_layout(&layout, wgpu::VertexStepMode::Vertex, &attributes)],
            topology: wgpu::PrimitiveTopology::TriangleList,
        };
        Self { pipeline: descriptor.opaque(gpu), stage: *stage, buffer: None }
    }

    /// Replaces the faces by those of these particles at the borders of this terrain.
    pub fn fill(&mut self, gpu: &Gpu, field: &HeightField, droplets: &[Droplet]) {
        let all = faces(&self.stage, field, droplets);
        self.buffer = (!all.is_empty()).then(|| (instances(gpu, "sides of water", &all), all.len() as u32));
    }

    /// Replaces the faces by those of water in GPU memory, in its state when the picture is drawn.
    pub fn draw_from(&mut self, water: &DeviceWater) {
        self.buffer = water.faces();
    }
}

/// The faces of water at the borders, corner by corner.
pub(super) fn faces(stage: &Stage, field: &HeightField, droplets: &[Droplet]) -> Vec<Vertex> {
    let mut all = Vec::new();
    for border in borders(field) {
        let levels = levels(field, &border, droplets);
        for (pair, level) in border.nodes.windows(2).zip(levels.windows(2)) {
            let [Some(from), Some(to)] = [level[0], level[1]] else { continue };
            all.extend(face(stage, field, [(pair[0], from), (pair[1], to)], border.outwards));
        }
    }
    all
}

/// Two triangles between two nodes from the ground to the water's surface.
fn face(stage: &Stage, field: &HeightField, ends: [(usize, f64); 2], [x, y]: [f32; 2]) -> [Vertex; 6] {
    let vertex = |(node, level): (usize, f64), is_low: bool| {
        let [east, north] = field.position(node);
        let ground = f64::from(field.heights[node]).min(level);
        let [px, py, pz] = stage.position([east, north, if is_low { ground } else { level }]).into();
        let deep = if is_low { stage.length(level - ground) } else { 0.0 };
        Vertex { position: [px, py, pz, deep], normal: [x, y, 0.0, 0.0] }
    };
    let [a, b] = ends;
    [(a, false), (b, false), (a, true), (a, true), (b, false), (b, true)].map(|(end, is_low)| vertex(end, is_low))
}

impl Drawable for WaterSides {
    fn throws_shadow(&self) -> bool {
        false
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        let Some((buffer, count)) = &self.buffer else { return };
        pass.set_pipeline(&self.pipeline);
        pass.set_vertex_buffer(0, buffer.slice(..));
        pass.draw(0..*count, 0..1);
    }
}

fn borders(field: &HeightField) -> [Border; 4] {
    let [columns, rows] = field.nodes;
    let row = |row: usize| (0..columns).map(|column| row * columns + column).collect();
    let column = |column: usize| (0..rows).map(|row| row * columns + column).collect();
    [
        Border { nodes: row(0), axis: 0, outwards: [0.0, -1.0] },
        Border { nodes: row(rows - 1), axis: 0, outwards: [0.0, 1.0] },
        Border { nodes: column(0), axis: 1, outwards: [-1.0, 0.0] },
        Border { nodes: column(columns - 1), axis: 1, outwards: [1.0, 0.0] },
    ]
}

/// The water's level at the nodes of a border, m; none where there is no water, or no ground.
fn levels(field: &HeightField, border: &Border, droplets: &[Droplet]) -> Vec<Option<f64>> {
    let mut sums = vec![(0.0, 0.0); border.nodes.len()];
    let [start, cell] = [field.origin[border.axis], field.cell[border.axis]];
    let across = 1 - border.axis;
    let line = field.position(border.nodes[0])[across];
    for droplet in droplets.iter().filter(|droplet| droplet.volume > 0.0) {
        let reach = droplet.reach;
        if (droplet.position[across] - line).abs() >= reach {
            continue;
        }
        let along = droplet.position[border.axis];
        let node = |at: f64| ((at - start) / cell).max(0.0) as usize;
        let (first, end) = (node(along - reach), node(along + reach + cell).min(border.nodes.len()));
        for (node, sums) in border.nodes.iter().zip(&mut sums).take(end).skip(first) {
            let away = DVec2::from(field.position(*node)) - DVec3::from(droplet.position).truncate();
            let weight = (1.0 - away.length_squared() / (reach * reach)).max(0.0).powi(3);
            sums.0 += weight;
            sums.1 += weight * droplet.level(away);
        }
    }
    let level = |(node, (weight, sum)): (&usize, (f64, f64))| {
        let ground = f64::from(field.heights[*node]);
        (weight > COVERED && ground.is_finite()).then(|| (sum / weight).max(ground))
    };
    border.nodes.iter().zip(sums).map(level).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_at_a_border_are_those_of_the_water_there() {
        let field = HeightField::sampled([0.0; 2], [40.0, 10.0], [41, 11], |_, _| 1.0);
        let disc = |index: i32| {
            let (x, y) = (f64::from(index % 20) + 0.5, f64::from(index / 20) + 0.5);
            let normal = DVec3::new(-0.1, 0.0, 1.0).normalize();
            let position = DVec3::new(x, y, 3.0 + 0.1 * x) - 0.1 * normal;
            Droplet {
                normal: normal.into(),
                flatness: 0.1,
                volume: 2.0,
                reach: 2.0,
                ..Droplet::ball(position.into(), 1.0)
            }
        };
        let droplets: Vec<Droplet> = (0..200).map(disc).collect();
        let [south, _, _, east] = borders(&field);
        let found = levels(&field, &south, &droplets);
        for (node, level) in found.iter().enumerate().take(18).skip(2) {
            assert!((level.unwrap() - (3.0 + 0.1 * node as f64)).abs() < 0.01, "{node}: {level:?}");
        }
        assert!(found[23..].iter().chain(&levels(&field, &east, &droplets)).all(Option::is_none));
    }
}
