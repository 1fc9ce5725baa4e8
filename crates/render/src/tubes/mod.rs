//! Round tubes along lines: trajectories, edges of a box.

use crate::buffer::instances;
use crate::colour::linear;
use crate::pipeline::PipelineDescriptor;
use crate::shaders::Shader;
use crate::shared::{TubeInstance, buffer_layout};
use crate::{Drawable, Renderer, Stage};
use corpuscle_gpu::{Gpu, SharedStruct, wgpu};

/// Style of a tube.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TubeStyle {
    /// Colour, sRGB.
    pub colour: [u8; 3],
    /// Radius, m.
    pub radius: f64,
    /// Thinner tubes are drawn with this radius, samples.
    pub least_radius: f32,
    /// False for the plain colour, and no shadow.
    pub shaded: bool,
}

/// Draws tubes; holds the pipelines of all.
#[derive(Debug)]
pub struct TubePainter {
    opaque: wgpu::RenderPipeline,
    cast: wgpu::RenderPipeline,
}

/// Tubes of one style, on the device.
#[derive(Debug)]
pub struct Tubes {
    opaque: wgpu::RenderPipeline,
    cast: Option<wgpu::RenderPipeline>,
    buffer: wgpu::Buffer,
    count: u32,
}

impl TubePainter {
    /// A painter for a renderer.
    pub fn new(renderer: &Renderer) -> Self {
        let gpu = renderer.gpu();
        let layout = TubeInstance::layout();
        let attributes = layout.vertex_attributes();
        let descriptor = PipelineDescriptor {
            label: "tubes",
            shader: &Shader::new("tubes", include_str!("tubes.wgsl")),
            groups: &[renderer.view_layout()],
            buffers: &[buffer_layout(&layout, wgpu::VertexStepMode::Instance, &attributes)],
            topology: wgpu::PrimitiveTopology::TriangleStrip,
        };
        Self { opaque: descriptor.opaque(gpu), cast: descriptor.cast(gpu, "throw_shadow") }
    }

    /// Tubes along lines through points, m. A point that is not a number parts a line.
    pub fn tubes<'a>(
        &self,
        gpu: &Gpu,
        stage: &Stage,
        style: &TubeStyle,
        lines: impl IntoIterator<Item = &'a [[f64; 3]]>,
    ) -> Tubes {
        let [r, g, b] = linear(style.colour);
        let colour = [r, g, b, f32::from(u8::from(style.shaded))];
        let end = |point: [f64; 3], last: f32| {
            let [x, y, z] = stage.position(point).into();
            [x, y, z, last]
        };
        let piece = |pair: &[[f64; 3]]| TubeInstance {
            from_end: end(pair[0], stage.length(style.radius)),
            to_end: end(pair[1], style.least_radius),
            colour,
        };
        let whole = |pair: &&[[f64; 3]]| pair.as_flattened().iter().all(|number| number.is_finite());
        let pieces: Vec<TubeInstance> =
            lines.into_iter().flat_map(|line| line.windows(2).filter(whole).map(piece).collect::<Vec<_>>()).collect();
        let cast = style.shaded.then(|| self.cast.clone());
        let buffer = instances(gpu, "tubes", &pieces);
        Tubes { opaque: self.opaque.clone(), cast, buffer, count: pieces.len() as u32 }
    }
}

/// The twelve edges of a box between two corners, m; four where it is flat.
pub fn box_edges(from: [f64; 3], to: [f64; 3]) -> Vec<Vec<[f64; 3]>> {
    let corner = |bits: usize| std::array::from_fn(|axis| if bits >> axis & 1 == 1 { to[axis] } else { from[axis] });
    let flat = |bits: usize, axis: usize| from[2] == to[2] && (axis == 2 || bits >> 2 & 1 == 1);
    (0..3)
        .flat_map(|axis| (0..8).map(move |bits| (axis, bits)))
        .filter(|(axis, bits)| bits >> axis & 1 == 0 && !flat(*bits, *axis))
        .map(|(axis, bits)| vec![corner(bits), corner(bits | 1 << axis)])
        .collect()
}

impl Tubes {
    fn paint(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline) {
        pass.set_pipeline(pipeline);
        pass.set_vertex_buffer(0, self.buffer.slice(..));
        pass.draw(0..14, 0..self.count);
    }
}

impl Drawable for Tubes {
    fn cast(&self, pass: &mut wgpu::RenderPass<'_>) {
        if let Some(pipeline) = &self.cast {
            self.paint(pass, pipeline);
        }
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.paint(pass, &self.opaque);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_has_twelve_edges_and_a_flat_one_four() {
        assert_eq!(box_edges([0.0; 3], [1.0, 2.0, 3.0]).len(), 12);
        let flat = box_edges([0.0; 3], [1.0, 2.0, 0.0]);
        assert_eq!(flat.len(), 4);
        assert!(flat.iter().all(|edge| edge[0] != edge[1]));
    }
}
