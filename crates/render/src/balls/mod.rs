//! Balls: shaded spheres in space, flat discs on paper. Millions of them.

mod device;
mod seen;

use crate::buffer::{storage, uniform};
use crate::pipeline::PipelineDescriptor;
use crate::shaders::Shader;
use crate::shared::{BallInstance, BallUniforms};
use crate::{Before, Camera, ColourTable, Drawable, Renderer, Stage, shaders};
use corpuscle_gpu::{Gpu, GroupLayout, Kernel, wgpu};
pub use device::{BallsOfDevice, ValueOfDevice};
use seen::{Seen, SeenPainter};
use std::sync::{Arc, OnceLock};

/// Corners that are drawn for a ball: one triangle.
const CORNERS: u32 = 3;
/// Balls in one buffer at most: within the floor's 128 MiB.
const MOST: usize = 6 << 20;
/// From so many on, one before the other, they are shaded only where they are seen.
const MANY: u32 = 20_000;

/// Shading of balls.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Shading {
    /// As the light: glazed with shadows, or discs on paper.
    #[default]
    Full,
    /// Matt, without shadows.
    Matt,
    /// Discs with a rim, whatever the light.
    Discs,
}

/// Style of balls.
#[derive(Debug, Clone, PartialEq)]
pub struct BallStyle {
    /// Colours of the numbers.
    pub colours: ColourTable,
    /// Gloss of the surface: 0 matt, 1 glazed.
    pub gloss: f32,
    /// Their shading.
    pub shading: Shading,
    /// Smaller balls are drawn with this radius, samples, so that none falls between pixels.
    pub least_radius: f32,
}

impl BallStyle {
    /// Glazed balls of the colours of a table.
    pub fn new(colours: ColourTable) -> Self {
        Self { colours, gloss: 1.0, shading: Shading::Full, least_radius: 0.75 }
    }
}

/// Draws balls; holds the pipelines of all.
#[derive(Debug)]
pub struct BallPainter {
    layout: GroupLayout,
    opaque: wgpu::RenderPipeline,
    matt: wgpu::RenderPipeline,
    discs: wgpu::RenderPipeline,
    cast: wgpu::RenderPipeline,
    seen: Arc<SeenPainter>,
    /// The kernel that makes balls of particles in GPU memory, once it is needed.
    maker: OnceLock<Kernel<device::Memory>>,
}

/// Balls of one style, on the device.
#[derive(Debug)]
pub struct Balls {
    opaque: wgpu::RenderPipeline,
    cast: wgpu::RenderPipeline,
    /// Groups of the shaders, and how many balls are in each.
    parts: Vec<(wgpu::BindGroup, u32)>,
    painter: Arc<SeenPainter>,
    /// True where shading is as cheap as the test of visibility.
    quick: bool,
    /// Which balls are seen where, in a picture of many.
    seen: Option<Seen>,
}

/// Shaders that share the balls' group: those that draw balls in full, matt, as discs, that find the nearest, and that shade it.
const SHADERS: [(&str, &str); 5] = [
    ("balls", include_str!("balls.wgsl")),
    ("matt", include_str!("matt.wgsl")),
    ("discs", include_str!("discs.wgsl")),
    ("balls_numbered", include_str!("balls_numbered.wgsl")),
    ("balls_seen", include_str!("balls_seen.wgsl")),
];

impl BallPainter {
    /// A painter for a renderer.
    pub fn new(renderer: &Renderer) -> Self {
        let gpu = renderer.gpu();
        let layout = shaders::layout(gpu, "balls", 1, &SHADERS);
        let shader = |(name, text): (&'static str, &str)| Shader::new(name, text).outdoors();
        let [balls, matt, discs, ..] = SHADERS;
        let descriptor = PipelineDescriptor {
            label: "balls",
            shader: &shader(balls),
            groups: &[renderer.view_layout(), &layout],
            buffers: &[],
            topology: wgpu::PrimitiveTopology::TriangleList,
        };
        let seen = SeenPainter::new(renderer, &layout).into();
        Self {
            opaque: descriptor.opaque(gpu),
            cast: descriptor.cast(gpu, "throw_shadow"),
            matt: PipelineDescriptor { shader: &shader(matt), ..descriptor }.opaque(gpu),
            discs: PipelineDescriptor { shader: &shader(discs), ..descriptor }.opaque(gpu),
            layout,
            seen,
            maker: OnceLock::new(),
        }
    }

    /// Balls at positions with radii, m, each with the number that its colour shows. What has no finite position is left out.
    pub fn balls(
        &self,
        gpu: &Gpu,
        stage: &Stage,
        style: &BallStyle,
        balls: impl IntoIterator<Item = ([f64; 3], f64, f64)>,
    ) -> Balls {
        let instance = |(position, radius, value): ([f64; 3], f64, f64)| {
            let [x, y, z] = stage.position(position).into();
            BallInstance { x, y, z, radius: stage.length(radius), value: value as f32 }
        };
        let drawn = |ball: &BallInstance| [ball.x, ball.y, ball.z, ball.radius].iter().all(|number| number.is_finite());
        let all: Vec<BallInstance> = balls.into_iter().map(instance).filter(drawn).collect();
        let part = |part: &[BallInstance]| (storage(gpu, "balls", part), part.len() as u32);
        let parts: Vec<_> = all.chunks(MOST).map(part).collect();
        self.balls_in(gpu, style, parts.iter().map(|(buffer, count)| (buffer, *count)))
    }

    /// Balls that are on the device, so many in each buffer.
    fn balls_in<'a>(
        &self,
        gpu: &Gpu,
        style: &BallStyle,
        parts: impl IntoIterator<Item = (&'a wgpu::Buffer, u32)>,
    ) -> Balls {
        let ColourTable { low, high, .. } = style.colours;
        let uniforms = BallUniforms { low, high, gloss: style.gloss, least: style.least_radius };
        let settings = uniform(gpu, "balls", &uniforms);
        let colours = style.colours.upload(gpu);
        let part = |(buffer, count): (&wgpu::Buffer, u32)| {
            let resources = [
                ("style", settings.as_entire_binding()),
                ("colours", wgpu::BindingResource::TextureView(&colours)),
                ("balls", buffer.as_entire_binding()),
            ];
            (self.layout.bind(&gpu.device, &resources), count)
        };
        let parts = parts.into_iter().map(part).collect();
        let opaque = match style.shading {
            Shading::Full => &self.opaque,
            Shading::Matt => &self.matt,
            Shading::Discs => &self.discs,
        };
        let quick = style.shading != Shading::Full;
        Balls { opaque: opaque.clone(), cast: self.cast.clone(), parts, painter: self.seen.clone(), quick, seen: None }
    }
}

impl Balls {
    fn paint(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline) {
        pass.set_pipeline(pipeline);
        for (group, count) in &self.parts {
            pass.set_bind_group(1, group, &[]);
            pass.draw(0..CORNERS * count, 0..1);
        }
    }
}

impl Drawable for Balls {
    fn prepare(&mut self, _gpu: &Gpu, _stage: &Stage, _camera: &Camera, _size: [u32; 2]) {
        self.seen = None;
    }

    fn cast(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.paint(pass, &self.cast);
    }

    fn draw_before(&mut self, frame: &mut Before<'_>) {
        // Numbers go by part; so many balls that there are two parts are drawn one by one.
        if let [(group, count)] = self.parts.as_slice()
            && *count >= MANY
            && !self.quick
        {
            self.seen = Some(self.painter.find(frame, group, *count));
        }
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        match (&self.seen, self.parts.as_slice()) {
            (Some(seen), [(group, _)]) => self.painter.shade(pass, group, seen),
            _ => self.paint(pass, &self.opaque),
        }
    }
}
