//! Many balls are drawn in another way than few; that must not be seen.

use corpuscle_gpu::{Image, require_gpu};
use corpuscle_render::{BallPainter, BallStyle, Balls, Camera, ColourTable, Drawable, Light, Renderer, Stage, Target};

const SIZE: [u32; 2] = [160, 90];
const SIDE: usize = 32;

#[test]
fn many_balls_look_as_few_do() {
    let Some(gpu) = require_gpu("many balls") else { return };
    let renderer = Renderer::new(&gpu);
    let painter = BallPainter::new(&renderer);
    let target = Target::new(&gpu, SIZE, 2).unwrap();
    let stage = Stage::new([0.0; 3], [SIDE as f64; 3]);
    let camera = Camera::orbit(&stage, [-1.0, 0.4], 0.5, 16.0 / 9.0, 0.05);
    let colours = ColourTable { low: 0.0, high: 1.0, colours: vec![[68, 1, 84], [253, 231, 37]] };
    let ball = |k: usize| {
        let at = [k % SIDE, k / SIDE % SIDE, k / SIDE / SIDE].map(|along| along as f64 + 0.5);
        (at, 0.4 + 0.1 * (k % 2) as f64, (k * 7 % 13) as f64 / 12.0)
    };
    let all = SIDE * SIDE * SIDE;
    let some =
        |from: usize, to: usize| painter.balls(&gpu, &stage, &BallStyle::new(colours.clone()), (from..to).map(ball));
    let draw = |sets: &mut [Balls]| -> Image {
        let mut things: Vec<&mut dyn Drawable> = sets.iter_mut().map(|set| set as &mut dyn Drawable).collect();
        renderer.draw(&target, &stage, &camera, &Light::studio(), &mut things, None);
        renderer.read(&target).unwrap()
    };
    let together = draw(&mut [some(0, all)]);
    // Too few in each set for the other way.
    let in_parts = draw(&mut [some(0, all / 2), some(all / 2, all)]);
    let off = together.rgba.iter().zip(&in_parts.rgba).filter(|(a, b)| a.abs_diff(**b) > 2).count();
    assert!(off < together.rgba.len() / 1000, "{off} of {} bytes differ", together.rgba.len());
    let bare = draw(&mut []);
    let changed = together.rgba.iter().zip(&bare.rgba).filter(|(a, b)| a != b).count();
    assert!(changed > together.rgba.len() / 10, "{changed}");
}
