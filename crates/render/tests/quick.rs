//! What is drawn quickly looks as what is drawn with all care, as far as it shows the same.

use corpuscle_gpu::{Gpu, Image, read_rgba8, require_gpu, texture_2d, wgpu};
use corpuscle_render::{
    BallPainter, BallStyle, Balls, Camera, ColourTable, Drawable, InlayPainter, Light, Renderer, Shading, Stage, Target,
};

const SIZE: [u32; 2] = [160, 90];
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

struct Table {
    gpu: Gpu,
    renderer: Renderer,
    stage: Stage,
    camera: Camera,
    target: Target,
}

impl Table {
    fn new(gpu: Gpu) -> Self {
        let stage = Stage::new([0.0; 3], [16.0, 9.0, 4.0]);
        let camera = Camera::orbit(&stage, [-1.0, 0.6], 0.5, 16.0 / 9.0, 0.05);
        let target = Target::new(&gpu, SIZE, 1).unwrap();
        Self { renderer: Renderer::new(&gpu), stage, camera, target, gpu }
    }

    /// Balls of all colours of a table from black to white, and some of one colour.
    fn balls(&self, shading: Shading) -> Balls {
        let painter = BallPainter::new(&self.renderer);
        let colours = ColourTable { low: 0.0, high: 1.0, colours: vec![[0, 0, 0], [253, 231, 37], [255, 255, 255]] };
        let style = BallStyle { gloss: 0.0, shading, ..BallStyle::new(colours) };
        let ball = |k: usize| {
            let at = [k % 16, k / 16 % 9, k / 144].map(|along| along as f64 + 0.5);
            (at, 0.3 + 0.2 * (k % 2) as f64, (k * 7 % 29) as f64 / 28.0)
        };
        painter.balls(&self.gpu, &self.stage, &style, (0..576).map(ball))
    }

    fn finished(&self, light: &Light, shading: Shading) -> Image {
        let mut balls = self.balls(shading);
        let mut things: [&mut dyn Drawable; 1] = [&mut balls];
        self.renderer.draw(&self.target, &self.stage, &self.camera, light, &mut things, None);
        self.renderer.read(&self.target).unwrap()
    }

    fn inlaid(&self, light: &Light, shading: Shading) -> Image {
        let mut balls = self.balls(shading);
        let mut things: [&mut dyn Drawable; 1] = [&mut balls];
        self.renderer.draw_light(&self.target, &self.stage, &self.camera, light, &mut things);
        let inlay = InlayPainter::new(&self.gpu, FORMAT).light(&self.gpu, &self.target, light.is_lit());
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let window = texture_2d(&self.gpu, "window", SIZE, FORMAT, usage).unwrap();
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let view = window.create_view(&wgpu::TextureViewDescriptor::default());
        let attachment = wgpu::RenderPassColorAttachment {
            view: &view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations::default(),
        };
        inlay.draw(&mut encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(attachment)],
            ..wgpu::RenderPassDescriptor::default()
        }));
        self.gpu.queue.submit([encoder.finish()]);
        read_rgba8(&self.gpu, &window).unwrap()
    }
}

/// How many bytes differ by more than this.
fn off(one: &Image, other: &Image, by: u8) -> usize {
    one.rgba.iter().zip(&other.rgba).filter(|(a, b)| a.abs_diff(**b) > by).count()
}

#[test]
fn a_picture_laid_into_a_window_has_the_colours_of_a_finished_one() {
    let Some(gpu) = require_gpu("pictures laid into a window") else { return };
    let table = Table::new(gpu);
    let paper = Light::paper_of([0.9, 0.9, 0.8]);
    let (finished, inlaid) = (table.finished(&paper, Shading::Discs), table.inlaid(&paper, Shading::Discs));
    assert_eq!(off(&finished, &inlaid, 1), 0);
    // Lit, the finished one has softened edges besides.
    let day = Light::day().without_shadows();
    let (finished, inlaid) = (table.finished(&day, Shading::Matt), table.inlaid(&day, Shading::Matt));
    let differ = off(&finished, &inlaid, 1);
    assert!(differ < finished.rgba.len() / 4, "{differ} of {}", finished.rgba.len());
    assert!(inlaid.rgba.chunks(4).any(|pixel| pixel[0] < 40) && inlaid.rgba.chunks(4).any(|pixel| pixel[0] > 200));
}

#[test]
fn matt_balls_look_as_balls_without_shine_and_shadows() {
    let Some(gpu) = require_gpu("matt balls") else { return };
    let table = Table::new(gpu);
    let day = Light::day().without_shadows();
    let (full, matt) = (table.inlaid(&day, Shading::Full), table.inlaid(&day, Shading::Matt));
    // A ball is cut by its neighbour where it stands in it, a matt one is not, and its outline may be a pixel off.
    let differ = off(&full, &matt, 6);
    assert!(differ < full.rgba.len() / 20, "{differ} of {}", full.rgba.len());
}
