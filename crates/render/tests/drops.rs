//! Drops on a pane: those that nearly touch flow together, and fine ones scatter what is behind.

use corpuscle_gpu::{Image, require_gpu};
use corpuscle_render::{
    BallPainter, BallStyle, Camera, Cap, CapPainter, Caps, ColourTable, Drawable, Lens, Light, Renderer, Stage, Target,
};
use glam::DVec3;

const PIXELS: u32 = 160;

/// A pane of 4 m x 4 m, seen straight from the front; a wall of dark and bright balls stands behind it.
struct Table {
    renderer: Renderer,
    painter: CapPainter,
    target: Target,
    stage: Stage,
}

impl Table {
    fn open(test: &str) -> Option<Self> {
        let gpu = require_gpu(test)?;
        let renderer = Renderer::new(&gpu);
        let painter = CapPainter::new(&renderer);
        let target = Target::new(&gpu, [PIXELS; 2], 2).unwrap();
        Some(Self { renderer, painter, target, stage: Stage::new([0.0, -1.0, 0.0], [4.0, 1.0, 4.0]) })
    }

    fn caps(&self, caps: impl IntoIterator<Item = Cap>) -> Caps {
        self.painter.caps(self.renderer.gpu(), &self.stage, caps, [])
    }

    fn draw(&self, caps: &mut [Caps]) -> Image {
        let balls = BallPainter::new(&self.renderer);
        let wall = |bright: usize| {
            let all = (0..256).filter(move |k| (k + k / 16) % 2 == bright);
            let ball = |k: usize| ([0.125 + 0.25 * (k % 16) as f64, 0.9, 0.125 + 0.25 * (k / 16) as f64], 0.13, 0.0);
            let colour = ColourTable::plain([[20; 3], [160; 3]][bright]);
            balls.balls(self.renderer.gpu(), &self.stage, &BallStyle::new(colour), all.map(ball))
        };
        let mut walls = [wall(0), wall(1)];
        let camera = Camera {
            eye: DVec3::new(2.0, -9.0, 2.0),
            target: DVec3::new(2.0, 0.0, 2.0),
            up: DVec3::Z,
            lens: Lens::Orthographic { height: 4.0 },
        };
        let light = Light::studio().from_azimuth(-2.2);
        let mut things: Vec<&mut dyn Drawable> = walls.iter_mut().map(|wall| wall as &mut dyn Drawable).collect();
        things.extend(caps.iter_mut().map(|caps| caps as &mut dyn Drawable));
        self.renderer.draw(&self.target, &self.stage, &camera, &light, &mut things, None);
        self.renderer.read(&self.target).unwrap()
    }
}

fn cap(x: f64, z: f64, radius: f64) -> Cap {
    Cap { position: [x, 0.0, z], radius, normal: [0.0, -1.0, 0.0], height: 0.6 * radius }
}

/// Pixels that differ between two pictures.
fn changed(one: &Image, other: &Image) -> usize {
    one.rgba.chunks(4).zip(other.rgba.chunks(4)).filter(|(a, b)| a != b).count()
}

/// Mean and standard deviation of brightness in the middle of a picture.
fn brightness(image: &Image) -> [f64; 2] {
    let range = PIXELS / 4..3 * PIXELS / 4;
    let positions = range.clone().flat_map(|y| range.clone().map(move |x| (x, y)));
    let values: Vec<f64> =
        positions.map(|(x, y)| image.pixel(x, y)[..3].iter().map(|byte| f64::from(*byte)).sum::<f64>() / 3.0).collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let square = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64;
    [mean, square.sqrt()]
}

#[test]
fn drops_that_nearly_touch_flow_together() {
    let Some(table) = Table::open("drops that flow together") else { return };
    let (left, right) = (cap(1.28, 2.0, 0.7), cap(2.72, 2.0, 0.7));
    let bare = table.draw(&mut []);
    let apart = table.draw(&mut [table.caps([left]), table.caps([right])]);
    let joined = table.draw(&mut [table.caps([left, right])]);
    // Between them, 4 cm from each, is a neck, and nothing where they do not know of each other.
    let middle = [PIXELS / 2 - 1, PIXELS / 2];
    let pixel = |image: &Image| image.pixel(middle[0], middle[1]);
    assert_eq!(pixel(&apart), pixel(&bare));
    assert_ne!(pixel(&joined), pixel(&bare));
    // Far from each other they are as they are alone.
    let far = [cap(0.8, 2.0, 0.5), cap(3.2, 2.0, 0.5)];
    let alone = table.draw(&mut [table.caps([far[0]]), table.caps([far[1]])]);
    assert_eq!(changed(&table.draw(&mut [table.caps(far)]), &alone), 0);
}

#[test]
fn fine_droplets_blur_and_whiten_by_the_area_they_cover() {
    let Some(table) = Table::open("fog") else { return };
    // Far smaller than a pixel of 25 mm, on an even grid with `side` of them each way: they cover this part of the pane.
    let fog = |side: usize| {
        let step = 4.0 / side as f64;
        let radius = 4e-3;
        let position = move |k: usize| (k as f64 + 0.5) * step;
        let all = (0..side * side).map(move |k| cap(position(k % side), position(k / side), radius));
        (std::f64::consts::PI * radius * radius / (step * step), table.caps(all))
    };
    let [bare_mean, bare_contrast] = brightness(&table.draw(&mut []));
    let mut before = [bare_mean, bare_contrast];
    for side in [150, 300, 450] {
        let (area, caps) = fog(side);
        let [mean, contrast] = brightness(&table.draw(&mut [caps]));
        // What is not covered (drops lie one partly over the other) keeps its contrast.
        let clear = (-area).exp();
        assert!(contrast < (clear + 0.12) * bare_contrast, "{area:.2}: {contrast:.1} of {bare_contrast:.1}");
        assert!(contrast < before[1] && mean > before[0] + 2.0, "{area:.2}: {mean:.1} after {before:?}");
        before = [mean, contrast];
    }
}
