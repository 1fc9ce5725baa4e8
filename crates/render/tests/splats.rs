//! Water whose particles compute shaders draw, against the same water drawn by raster units.

use corpuscle_gpu::{DeviceParticle, DeviceParticles, Gpu, Image, require_gpu};
use corpuscle_render::{
    Camera, DeviceWater, Drawable, Droplet, Fluid, FluidPainter, FluidStyle, HeightField, Light, Renderer, Smoothing,
    Stage, Target,
};

/// Width is odd, so that thickness has half a pixel more.
const SIZE: [u32; 2] = [321, 200];
/// Raster units have corners on a grid of 1/256 pixel and add up numbers of 11 bits: channels may be off by so much, of 255 ...
const OFF: u8 = 2;
/// ... but in this share of all pixels, which lie on rims of discs.
const RIMS: f64 = 0.0005;

fn stage() -> Stage {
    Stage::new([-1.0, -1.0, -0.3], [1.0, 1.0, 0.5])
}

/// Water with waves, foam on a part of it, and drops in the air.
fn pond() -> Vec<Droplet> {
    let column = |index: i32| {
        let (x, y) = (0.05 * f64::from(index % 41 - 20), 0.05 * f64::from(index / 41 - 20));
        Droplet {
            position: [x, y, 0.05 * (5.0 * x).sin() * (4.0 * y).cos()],
            radius: 0.0625,
            normal: [-0.25 * (5.0 * x).cos() * (4.0 * y).cos(), 0.2 * (5.0 * x).sin() * (4.0 * y).sin(), 1.0],
            flatness: 0.1,
            volume: 0.05 * 0.05 * 0.3,
            reach: 0.1,
            foam: if x > 0.5 { 0.6 } else { 0.0 },
            flow: [0.3 - y, -1.4 * x],
            id: index as u64,
        }
    };
    let drops = [Droplet::ball([-0.3, -0.8, 0.25], 0.08), Droplet::ball([0.2, 0.1, 0.3], 0.02)];
    (0..41 * 41).map(column).chain(drops).collect()
}

/// A camera so many times as far away as all of the stage needs.
fn from(distance: f64) -> Camera {
    let camera = Camera::orbit(&stage(), [-1.4, 0.5], 0.6, 1.6, 0.0);
    Camera { eye: camera.target + distance * (camera.eye - camera.target), ..camera }
}

fn picture(gpu: &Gpu, splats: bool, camera: &Camera, stage: &Stage, fill: impl FnOnce(&mut Fluid)) -> Image {
    let style = FluidStyle { smoothing: Smoothing::None, steepness: 0.0, ..FluidStyle::water(0.05) };
    picture_of(gpu, style, splats, camera, stage, fill)
}

fn picture_of(
    gpu: &Gpu,
    style: FluidStyle,
    splats: bool,
    camera: &Camera,
    stage: &Stage,
    fill: impl FnOnce(&mut Fluid),
) -> Image {
    let renderer = Renderer::new(gpu);
    let mut fluid = FluidPainter::new(&renderer).fluid(gpu, stage, style).unwrap();
    fluid.set_time(gpu, 1.3);
    fluid.splat(splats);
    fill(&mut fluid);
    let target = Target::new(gpu, SIZE, 1).unwrap();
    let things: &mut [&mut dyn Drawable] = &mut [&mut fluid];
    gpu.check().unwrap();
    renderer.draw(&target, stage, camera, &Light::day(), things, None);
    let image = renderer.read(&target).unwrap();
    gpu.check().unwrap();
    image
}

/// Share of pixels of which a channel is off by more than `OFF`.
fn apart(one: &Image, other: &Image) -> f64 {
    let pixels = one.rgba.as_chunks::<4>().0.iter().zip(other.rgba.as_chunks::<4>().0);
    let off = pixels.filter(|(one, other)| one.iter().zip(*other).any(|(one, other)| one.abs_diff(*other) > OFF));
    off.count() as f64 / f64::from(SIZE[0] * SIZE[1])
}

fn compare(gpu: &Gpu, what: &str, camera: &Camera, droplets: &[Droplet]) {
    let draw = |splats, droplets: &[Droplet]| {
        picture(gpu, splats, camera, &stage(), |fluid| fluid.fill(gpu, droplets.iter().copied()))
    };
    let (splats, sprites) = (draw(true, droplets), draw(false, droplets));
    let water = apart(&sprites, &draw(false, &[]));
    let apart = apart(&splats, &sprites);
    println!("{what}: {:.3} % of pixels off, {:.1} % are water", 100.0 * apart, 100.0 * water);
    assert!(apart < RIMS, "{what}: {apart}");
    assert!(water > 0.01, "{what}: nothing is seen");
}

#[test]
fn splats_look_as_sprites_do() {
    let Some(gpu) = require_gpu("splats") else { return };
    // Far away discs are smaller than pixels; near they are larger than one thread draws, some off screen and some behind the eye.
    for (what, distance) in [("middling", 1.0), ("far", 4.0), ("near", 0.3), ("within", 0.05)] {
        compare(&gpu, what, &from(distance), &pond());
    }
    compare(&gpu, "from above", &Camera::plan(&stage(), 1.6, [0.0; 4]), &pond());
    compare(&gpu, "a large ball", &from(1.0), &[Droplet::ball([0.0; 3], 0.9)]);
}

/// Mean difference of two pictures, of 255.
fn mean_apart(one: &Image, other: &Image) -> f64 {
    let sum: u64 = one.rgba.iter().zip(&other.rgba).map(|(one, other)| u64::from(one.abs_diff(*other))).sum();
    sum as f64 / one.rgba.len() as f64
}

/// Sprites add up the flow in numbers of 11 bits, by which ripples are a little elsewhere.
#[test]
fn splats_have_the_ripples_of_sprites() {
    let Some(gpu) = require_gpu("splats") else { return };
    let style = FluidStyle { smoothing: Smoothing::None, ..FluidStyle::water(0.05) };
    let draw = |splats: bool, turned: f64| {
        let turn = |droplet: Droplet| Droplet { flow: droplet.flow.map(|along| turned * along), ..droplet };
        picture_of(&gpu, style, splats, &from(1.0), &stage(), |fluid| fluid.fill(&gpu, pond().into_iter().map(turn)))
    };
    let (splats, sprites) = (draw(true, 1.0), draw(false, 1.0));
    let apart = [mean_apart(&splats, &sprites), mean_apart(&draw(true, -1.0), &sprites)];
    println!("{apart:?} of 255");
    // A fiftieth of what the opposite flow changes.
    assert!(apart[0] < 0.02 * apart[1], "{apart:?}");
}

#[test]
fn the_same_splats_give_the_same_picture() {
    let Some(gpu) = require_gpu("splats") else { return };
    for distance in [0.3, 6.0] {
        let draw = || picture(&gpu, true, &from(distance), &stage(), |fluid| fluid.fill(&gpu, pond()));
        assert_eq!(draw(), draw());
    }
}

#[test]
fn no_water_and_water_that_is_not_seen_leave_no_trace() {
    let Some(gpu) = require_gpu("splats") else { return };
    let draw = |droplets: &[Droplet]| {
        picture(&gpu, true, &from(1.0), &stage(), |fluid| fluid.fill(&gpu, droplets.iter().copied()))
    };
    let nothing = picture(&gpu, false, &from(1.0), &stage(), |_| ());
    let camera = from(1.0);
    let behind: [f64; 3] = (camera.eye + 0.5 * (camera.eye - camera.target)).into();
    assert_eq!(draw(&[]), nothing);
    assert_eq!(draw(&[Droplet::ball(behind, 0.1)]), nothing);
    assert_eq!(draw(&[Droplet::ball([40.0, 0.0, 0.0], 0.1)]), nothing);
}

#[test]
fn splats_from_the_device_look_as_sprites_do() {
    let Some(gpu) = require_gpu("splats from the device") else { return };
    let stage = Stage::new([0.0; 3], [80.0, 50.0, 20.0]);
    let field = HeightField::sampled([0.0, 0.0], [80.0, 50.0], [41, 26], |x, _| 0.05 * x);
    let particles = DeviceParticles::new(&gpu, 4100, [40.0, 25.0, 0.0], 1.0).unwrap();
    let mut water = DeviceWater::new(&gpu, &stage, &field, 1.0).unwrap();
    let camera = Camera::orbit(&stage, [-1.2, 0.6], 0.6, 1.6, 0.0);
    for count in [4000_u32, 130, 0] {
        let sent: Vec<DeviceParticle> = (0..count)
            .map(|index| {
                let [x, y] = [(index % 80) as f32, (index / 80) as f32];
                DeviceParticle {
                    position: [x - 40.0, y - 25.0, 0.05 * x + 1.0 + 0.2 * (0.4 * x).sin()],
                    spacing: 1.0,
                    depth: 1.0,
                    volume: 1.0,
                    id: index,
                    ..DeviceParticle::default()
                }
            })
            .collect();
        particles.write(&gpu, &sent);
        water.update(&gpu, 0.0, &particles).unwrap();
        let draw = |splats| picture(&gpu, splats, &camera, &stage, |fluid| fluid.draw_from(&water));
        let (splats, sprites) = (draw(true), draw(false));
        let wet = apart(&sprites, &picture(&gpu, false, &camera, &stage, |_| ()));
        println!("{count}: {:.3} % of pixels off, {:.1} % are water", 100.0 * apart(&splats, &sprites), 100.0 * wet);
        assert!(apart(&splats, &sprites) < RIMS);
        assert!((wet > 0.0) == (count > 0));
    }
}
