//! Balls: shaded spheres in space, flat discs on paper. Millions of them.

use crate::buffer::{instances, uniform};
use crate::pipeline::Recipe;
use crate::{ColourTable, Drawable, Renderer, Stage, shaders};
use corpuscle_gpu::{Gpu, wgpu};

/// Balls in one buffer at most: within the floor's 256 MiB.
const MOST: usize = 8 << 20;

/// A ball as the device has it.
#[repr(C)]
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Instance {
    /// Place and radius, in stage coordinates.
    ball: [f32; 4],
    /// The number that its colour shows.
    value: f32,
}

/// How balls look.
#[derive(Debug, Clone, PartialEq)]
pub struct BallStyle {
    /// Colours of the numbers.
    pub colours: ColourTable,
    /// How much the surface shines: 0 matt, 1 glazed.
    pub gloss: f32,
    /// Smaller balls are drawn with this radius, samples, so that none falls between pixels.
    pub least_radius: f32,
}

impl BallStyle {
    /// Glazed balls of the colours of a table.
    pub fn new(colours: ColourTable) -> Self {
        Self { colours, gloss: 1.0, least_radius: 0.75 }
    }
}

/// Draws balls; holds what all of them share.
#[derive(Debug)]
pub struct BallPainter {
    layout: wgpu::BindGroupLayout,
    opaque: wgpu::RenderPipeline,
    cast: wgpu::RenderPipeline,
}

/// Balls of one style, on the device.
#[derive(Debug)]
pub struct Balls {
    opaque: wgpu::RenderPipeline,
    cast: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    /// Buffers, and how many balls are in each.
    buffers: Vec<(wgpu::Buffer, u32)>,
}

impl BallPainter {
    /// A painter for a renderer.
    pub fn new(renderer: &Renderer) -> Self {
        let gpu = renderer.gpu();
        let layout = layout(gpu);
        let attributes = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32];
        let recipe = Recipe {
            label: "balls",
            module: &shaders::module(gpu, "balls", include_str!("balls.wgsl")),
            groups: &[renderer.view_layout(), &layout],
            buffers: &[wgpu::VertexBufferLayout {
                array_stride: size_of::<Instance>() as u64,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes: &attributes,
            }],
            topology: wgpu::PrimitiveTopology::TriangleStrip,
        };
        Self { opaque: recipe.opaque(gpu), cast: recipe.cast(gpu, "throw_shadow"), layout }
    }

    /// Balls at places with radii, m, each with the number that its colour shows. What has no finite place is left out.
    pub fn balls(
        &self,
        gpu: &Gpu,
        stage: &Stage,
        style: &BallStyle,
        balls: impl IntoIterator<Item = ([f64; 3], f64, f64)>,
    ) -> Balls {
        let instance = |(place, radius, value): ([f64; 3], f64, f64)| {
            let [x, y, z] = stage.place(place).into();
            Instance { ball: [x, y, z, stage.length(radius)], value: value as f32 }
        };
        let drawn = |instance: &Instance| instance.ball.iter().all(|number| number.is_finite());
        let all: Vec<Instance> = balls.into_iter().map(instance).filter(drawn).collect();
        let buffers = all.chunks(MOST).map(|part| (instances(gpu, "balls", part), part.len() as u32)).collect();
        let numbers = [style.colours.low, style.colours.high, style.gloss, style.least_radius];
        let settings = uniform(gpu, "balls", &numbers);
        let colours = style.colours.upload(gpu);
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("balls"),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: settings.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&colours) },
            ],
        });
        Balls { opaque: self.opaque.clone(), cast: self.cast.clone(), group, buffers }
    }
}

impl Balls {
    fn paint(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline) {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(1, &self.group, &[]);
        for (buffer, count) in &self.buffers {
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.draw(0..4, 0..*count);
        }
    }
}

impl Drawable for Balls {
    fn cast(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.paint(pass, &self.cast);
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.paint(pass, &self.opaque);
    }
}

fn layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("balls"),
        entries: &[
            wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                ty: crate::buffer::UNIFORM,
                count: None,
            },
            wgpu::BindGroupLayoutEntry {
                binding: 1,
                visibility: wgpu::ShaderStages::VERTEX,
                ty: crate::buffer::TEXTURE,
                count: None,
            },
        ],
    })
}
