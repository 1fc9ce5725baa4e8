//! Solids: meshes from their signed distances, matt, or of glass.

mod mesh;

use crate::buffer::{instances, uniform};
use crate::colour::linear;
use crate::pipeline::PipelineDescriptor;
use crate::shaders::Shader;
use crate::shared::{SolidUniforms, Vertex, buffer_layout};
use crate::{Drawable, Renderer, Stage, Through, shaders, static_layer};
use corpuscle_gpu::{Gpu, GroupLayout, SharedStruct, wgpu};
use corpuscle_model::SolidShape;

/// Style of a solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SolidStyle {
    /// Opaque: colour (sRGB), and how much the surface shines, from 0 to 1.
    Opaque([u8; 3], f32),
    /// A building of two colours (sRGB), those of its walls and of its roof; windows are hinted where they are seen.
    Building([u8; 3], [u8; 3]),
    /// Glass: the part of each colour that it lets through straight, sRGB.
    Glass([u8; 3]),
}

/// A solid on the device.
#[derive(Debug)]
pub struct Solid {
    pipeline: wgpu::RenderPipeline,
    /// None for glass, which throws no shadow worth drawing.
    cast: Option<wgpu::RenderPipeline>,
    /// Of glass: draws the depth of the faces seen from within.
    far_side: Option<wgpu::RenderPipeline>,
    group: wgpu::BindGroup,
    buffer: wgpu::Buffer,
    count: u32,
    behind: Behind,
    state: u64,
}

/// The faces of a solid of glass that are seen from within, through the solid: fog on them is seen so too.
#[derive(Debug, Clone)]
pub struct FarSide {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    buffer: wgpu::Buffer,
    count: u32,
}

impl FarSide {
    /// Draws its depth.
    pub(crate) fn paint(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(1, &self.group, &[]);
        pass.set_vertex_buffer(0, self.buffer.slice(..));
        pass.draw(0..self.count, 0..1);
    }
}

/// The opaque background of a transparent thing, as a bind group.
#[derive(Debug)]
pub(crate) struct Behind {
    pub(crate) layout: GroupLayout,
    sampler: wgpu::Sampler,
}

impl Behind {
    /// For group 2 of a shader, by its name and text.
    pub(crate) fn new(gpu: &Gpu, shader: (&str, &str)) -> Self {
        let layout = shaders::layout(gpu, "behind", 2, &[shader]);
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("behind"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..wgpu::SamplerDescriptor::default()
        });
        Self { layout, sampler }
    }

    pub(crate) fn group(&self, frame: &Through<'_>) -> wgpu::BindGroup {
        let resources = [
            ("behind", wgpu::BindingResource::TextureView(frame.behind_colour)),
            ("behind_sampler", wgpu::BindingResource::Sampler(&self.sampler)),
        ];
        self.layout.bind(&frame.gpu.device, &resources)
    }
}

impl SolidStyle {
    /// The same as shaders have it.
    fn uniforms(self) -> SolidUniforms {
        let of = |colour: [u8; 3], last: f32| {
            let [r, g, b] = linear(colour);
            [r, g, b, last]
        };
        let (colour, gloss, roof) = match self {
            Self::Opaque(colour, gloss) => (colour, gloss, [0.0; 4]),
            Self::Building(walls, roof) => (walls, 0.1, of(roof, 1.0)),
            Self::Glass(colour) => (colour, 1.0, [0.0; 4]),
        };
        SolidUniforms { colour: of(colour, 1.0), gloss: [gloss, 0.0, 0.0, 0.0], roof }
    }
}

impl Solid {
    /// A solid from its shape.
    pub fn new(renderer: &Renderer, stage: &Stage, shape: &SolidShape, style: SolidStyle) -> Self {
        Self::of_corners(renderer, stage, &mesh::mesh(shape), style)
    }

    /// A solid from the corners of its triangles, three by three: position, m, and unit vector outwards.
    pub fn of_corners(renderer: &Renderer, stage: &Stage, corners: &[([f64; 3], [f64; 3])], style: SolidStyle) -> Self {
        let gpu = renderer.gpu();
        let vertex = |(position, normal): &([f64; 3], [f64; 3])| {
            let [x, y, z] = stage.position(*position).into();
            let [nx, ny, nz] = normal.map(|part| part as f32);
            Vertex { position: [x, y, z, 1.0], normal: [nx, ny, nz, 0.0] }
        };
        let vertices: Vec<Vertex> = corners.iter().map(vertex).collect();
        let is_glass = matches!(style, SolidStyle::Glass(_));
        let settings = uniform(gpu, "solid", &style.uniforms());
        let glass = ("glass", include_str!("glass.wgsl"));
        let shader = if is_glass { glass } else { ("solids", include_str!("solids.wgsl")) };
        let layout = shaders::layout(gpu, "solid", 1, &[shader]);
        let group = layout.bind(&gpu.device, &[("style", settings.as_entire_binding())]);
        let of_vertices = Vertex::layout();
        let attributes = of_vertices.vertex_attributes();
        let buffers = [buffer_layout(&of_vertices, wgpu::VertexStepMode::Vertex, &attributes)];
        let behind = Behind::new(gpu, glass);
        let groups = [renderer.view_layout(), &layout, &behind.layout];
        let mut whole = Shader::new(shader.0, shader.1);
        if matches!(style, SolidStyle::Building(..)) {
            whole = whole.outdoors();
        }
        let descriptor = PipelineDescriptor {
            label: shader.0,
            shader: &whole,
            groups: if is_glass { &groups } else { &groups[..2] },
            buffers: &buffers,
            topology: wgpu::PrimitiveTopology::TriangleList,
        };
        let far_side = || PipelineDescriptor { groups: &groups[..2], ..descriptor }.cast(gpu, "far_side");
        Self {
            pipeline: descriptor.opaque(gpu),
            cast: (!is_glass).then(|| descriptor.cast(gpu, "throw_shadow")),
            far_side: is_glass.then(far_side),
            group,
            buffer: instances(gpu, "solid", &vertices),
            count: vertices.len() as u32,
            behind,
            state: static_layer::new_state(),
        }
    }

    /// Its far side, where it is of glass.
    pub fn far_side(&self) -> Option<FarSide> {
        let Self { far_side, group, buffer, count, .. } = self;
        let pipeline = far_side.clone()?;
        Some(FarSide { pipeline, group: group.clone(), buffer: buffer.clone(), count: *count })
    }

    fn paint(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline) {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(1, &self.group, &[]);
        pass.set_vertex_buffer(0, self.buffer.slice(..));
        pass.draw(0..self.count, 0..1);
    }
}

impl Drawable for Solid {
    fn static_state(&self) -> Option<u64> {
        self.cast.is_some().then_some(self.state)
    }

    fn cast(&self, pass: &mut wgpu::RenderPass<'_>) {
        if let Some(pipeline) = &self.cast {
            self.paint(pass, pipeline);
        }
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        if self.cast.is_some() {
            self.paint(pass, &self.pipeline);
        }
    }

    fn lets_light_through(&self) -> bool {
        self.cast.is_none()
    }

    fn draw_through(&mut self, frame: &mut Through<'_>) {
        let behind = self.behind.group(frame);
        let mut pass = frame.begin("glass");
        pass.set_bind_group(2, &behind, &[]);
        self.paint(&mut pass, &self.pipeline);
    }
}
