//! Pictures as a user of the crate draws them.

use corpuscle_gpu::{Image, require_gpu};
use corpuscle_render::{Camera, Light, Renderer, Stage, Target};

fn picture(light: &Light, overlay: Option<&Image>) -> Option<Image> {
    let gpu = require_gpu("pictures")?;
    let renderer = Renderer::new(&gpu);
    let target = Target::new(&gpu, [64, 48], 2).unwrap();
    let stage = Stage::new([0.0; 3], [2.0, 2.0, 1.0]);
    let camera = Camera::orbit(&stage, [-1.5, 0.05], 0.9, 4.0 / 3.0, 0.0);
    renderer.draw(&target, &stage, &camera, light, &mut [], overlay);
    Some(renderer.read(&target).unwrap())
}

#[test]
fn the_sky_is_blue_above_and_the_ground_below_is_not() {
    let Some(image) = picture(&Light::day(), None) else { return };
    let [top, bottom] = [image.pixel(32, 1), image.pixel(32, 46)];
    assert!(top[2] > top[0] + 30, "{top:?}");
    assert!(2 * (bottom[2] - bottom[0]) < top[2] - top[0], "{bottom:?}");
}

#[test]
fn paper_keeps_its_colour_and_the_overlay_lies_over_it() {
    let mut overlay = Image { width: 64, height: 48, rgba: vec![0; 4 * 64 * 48] };
    overlay.rgba[..4].copy_from_slice(&[100, 0, 0, 128]);
    let Some(image) = picture(&Light::paper(), Some(&overlay)) else { return };
    assert_eq!(image.pixel(1, 0), [255; 4]);
    assert_eq!(image.pixel(0, 0), [227, 127, 127, 255]);
}
