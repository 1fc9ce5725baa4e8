//! A small picture of a pond against its reference.

use super::{Droplet, FluidPainter, FluidPass, FluidStyle};
use crate::{Backdrop, BallPainter, BallStyle, Camera, ColourTable, Drawable, Light, Renderer, Stage, Target};
use corpuscle_gpu::{Image, require_gpu};
use std::path::PathBuf;

const SIZE: [u32; 2] = [160, 100];
/// Difference from the reference, of 255, above which a picture is another: drivers round differently.
const SAME: f64 = 1.0;

/// A light of its own: the reference is of the water, not of the sky in fashion.
const LIGHT: Light = Light {
    // Low and before the eye, so that waves glitter.
    sun: [2.3, 0.5],
    sunlight: [1.6, 1.5, 1.4],
    softness: 0.02,
    ambient: 0.75,
    backdrop: Backdrop::Studio { above: [0.2, 0.4, 0.8], horizon: [0.8, 0.85, 0.9], below: [0.3; 3] },
    shadows: true,
};

/// Shallow water with waves round a sunken and a dry ball, foam on a part of it, and a drop in the air.
fn droplets() -> Vec<Droplet> {
    let height = |x: f64, y: f64| 0.05 * (5.0 * x).sin() * (4.0 * y).cos();
    let column = |index: i32| {
        let (x, y) = (0.05 * f64::from(index % 41 - 20), 0.05 * f64::from(index / 41 - 20));
        Droplet {
            position: [x, y, height(x, y) - 0.006],
            radius: 0.0625,
            normal: [-0.25 * (5.0 * x).cos() * (4.0 * y).cos(), 0.2 * (5.0 * x).sin() * (4.0 * y).sin(), 1.0],
            flatness: 0.1,
            volume: 0.05 * 0.05 * 0.3,
            reach: 0.1,
            foam: if x > 0.5 { 0.6 } else { 0.0 },
            flow: if y > 0.0 { [0.0; 2] } else { [1.0, 0.3] },
            id: index as u64,
        }
    };
    (0..41 * 41).map(column).chain([Droplet::ball([-0.3, -0.8, 0.25], 0.08)]).collect()
}

fn draw(skipped: Option<FluidPass>) -> Option<Image> {
    let gpu = require_gpu("a picture of a fluid")?;
    let renderer = Renderer::new(&gpu);
    let stage = Stage::new([-1.0, -1.0, -0.3], [1.0, 1.0, 0.5]);
    let camera = Camera::orbit(&stage, [-1.4, 0.5], 0.6, 1.6, 0.0);
    let style = FluidStyle { absorption: [1.4, 0.5, 0.4], exponent: 60.0, ..FluidStyle::water(0.05) };
    let mut fluid = FluidPainter::new(&renderer).fluid(&gpu, &stage, style).unwrap();
    fluid.skipped = skipped;
    fluid.fill(&gpu, droplets());
    let ground = [([0.3, 0.3, 0.0], 0.3, 0.9), ([-0.4, -0.2, -0.3], 0.25, 0.6), ([0.0, 0.0, -30.25], 30.0, 0.8)];
    let mut ground =
        BallPainter::new(&renderer).balls(&gpu, &stage, &BallStyle::new(ColourTable::plain([190, 160, 120])), ground);
    let target = Target::new(&gpu, SIZE, 1).unwrap();
    let things: &mut [&mut dyn Drawable] = &mut [&mut ground, &mut fluid];
    renderer.draw(&target, &stage, &camera, &LIGHT, things, None);
    Some(renderer.read(&target).unwrap())
}

/// Mean difference of two pictures, of 255.
fn difference(one: &Image, other: &Image) -> f64 {
    let sum: u64 = one.rgba.iter().zip(&other.rgba).map(|(one, other)| u64::from(one.abs_diff(*other))).sum();
    sum as f64 / one.rgba.len() as f64
}

fn reference() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/reference/fluid.png")
}

fn read(path: &PathBuf) -> Image {
    let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut rgba = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut rgba).unwrap();
    Image { width: info.width, height: info.height, rgba }
}

fn write(path: &PathBuf, image: &Image) {
    let mut encoder = png::Encoder::new(std::fs::File::create(path).unwrap(), image.width, image.height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.write_header().unwrap().write_image_data(&image.rgba).unwrap();
}

#[test]
fn the_picture_is_the_one_that_was_looked_at() {
    let Some(image) = draw(None) else { return };
    // To make it anew after a change that was meant: CORPUSCLE_NEW_REFERENCE=1. Then look at it.
    if std::env::var_os("CORPUSCLE_NEW_REFERENCE").is_some() {
        write(&reference(), &image);
    }
    let difference = difference(&image, &read(&reference()));
    assert!(difference < SAME, "differs by {difference}");
}

#[test]
fn the_same_particles_give_the_same_picture() {
    let (Some(one), Some(other)) = (draw(None), draw(None)) else { return };
    assert_eq!(one, other);
}

#[test]
fn no_pass_can_be_left_out() {
    // What is wet now is seen in the next picture: see `ground_that_was_under_water_is_darker_until_it_has_dried`.
    for pass in FluidPass::ALL.into_iter().filter(|pass| *pass != FluidPass::Wetting) {
        let Some(image) = draw(Some(pass)) else { return };
        let difference = difference(&image, &read(&reference()));
        println!("without {pass:?}: {difference:.1}");
        assert!(difference > 2.0 * SAME, "{pass:?} can be left out: the picture differs by {difference}");
    }
}
