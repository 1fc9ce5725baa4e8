//! What makes pictures look like what they show: ripples, reflections, caustics, foam, wet ground, lenses, fog, windows, haze. Each is drawn with and without what it comes from.

use corpuscle_gpu::{Gpu, Image, require_gpu};
use corpuscle_model::SolidShape;
use corpuscle_render::{
    BallPainter, BallStyle, Camera, Cap, CapPainter, ColourTable, Drawable, Droplet, FluidPainter, FluidStyle,
    FogPatch, HeightField, Lens, Light, Renderer, Solid, SolidStyle, Stage, Target, Terrain, natural_colours,
};
use glam::DVec3;
use std::sync::Arc;

const SIZE: [u32; 2] = [320, 200];
const ASPECT: f64 = 1.6;

struct Table {
    renderer: Renderer,
    target: Target,
}

impl Table {
    fn open(test: &str) -> Option<Self> {
        let gpu = require_gpu(test)?;
        Some(Self { renderer: Renderer::new(&gpu), target: Target::new(&gpu, SIZE, 1).unwrap() })
    }

    fn gpu(&self) -> &Gpu {
        self.renderer.gpu()
    }

    fn draw(&self, stage: &Stage, camera: &Camera, light: &Light, things: &mut [&mut dyn Drawable]) -> Image {
        self.renderer.draw(&self.target, stage, camera, light, things, None);
        self.renderer.read(&self.target).unwrap()
    }
}

/// Mean brightness of the pixels of a part of a picture, from 0 to 255: from `[left, top]` to `[right, bottom]`, parts of its sides.
fn brightness(image: &Image, [left, top]: [f64; 2], [right, bottom]: [f64; 2]) -> f64 {
    let span = |from: f64, to: f64, size: u32| (from * f64::from(size)) as u32..(to * f64::from(size)) as u32;
    let mut sum = (0.0, 0.0);
    for y in span(top, bottom, image.height) {
        for x in span(left, right, image.width) {
            let [red, green, blue, _] = image.pixel(x, y).map(f64::from);
            sum = (sum.0 + (red + green + blue) / 3.0, sum.1 + 1.0);
        }
    }
    sum.0 / sum.1
}

/// How much brightness differs from pixel to pixel across a part of a picture: mean of the differences of neighbours.
fn roughness(image: &Image, [left, top]: [f64; 2], [right, bottom]: [f64; 2]) -> f64 {
    let span = |from: f64, to: f64, size: u32| (from * f64::from(size)) as u32..(to * f64::from(size)) as u32;
    let grey = |x: u32, y: u32| image.pixel(x, y)[..3].iter().map(|part| f64::from(*part)).sum::<f64>() / 3.0;
    let mut sum = (0.0, 0.0);
    for y in span(top, bottom, image.height) {
        for x in span(left, right, image.width - 1) {
            sum = (sum.0 + (grey(x + 1, y) - grey(x, y)).abs(), sum.1 + 1.0);
        }
    }
    sum.0 / sum.1
}

fn pond_stage() -> Stage {
    Stage::new([0.0, 0.0, -1.0], [40.0, 25.0, 8.0])
}

fn pond_camera() -> Camera {
    Camera::orbit(&pond_stage(), [-1.57, 0.35], 0.5, ASPECT, 0.0)
}

/// A level pond 1 m deep from x = 0 to 40 m and y = 0 to 25 m, with a flow, m/s, foam and distance between particles, m.
fn pond(flow: impl Fn(f64) -> [f64; 2], foam: f64, spacing: f64) -> Vec<Droplet> {
    let [columns, rows] = [40.0, 25.0].map(|length| (length / spacing) as usize);
    let column = |index: usize| {
        let at = [index % columns, index / columns].map(|at| (at as f64 + 0.5) * spacing);
        Droplet {
            position: [at[0], at[1], -0.17],
            radius: 1.4 * spacing,
            normal: [0.0, 0.0, 1.0],
            flatness: 0.12,
            volume: spacing * spacing,
            reach: 2.0 * spacing,
            foam,
            flow: flow(at[0]),
            id: index as u64,
        }
    };
    (0..columns * rows).map(column).collect()
}

/// A picture of a pond over a level bed, with what stands behind it.
fn pond_picture(table: &Table, style: FluidStyle, time: f64, droplets: Vec<Droplet>, wall: bool) -> Image {
    pond_picture_in(table, &Light::day(), style, time, droplets, wall)
}

fn pond_picture_in(
    table: &Table,
    light: &Light,
    style: FluidStyle,
    time: f64,
    droplets: Vec<Droplet>,
    wall: bool,
) -> Image {
    let (gpu, stage) = (table.gpu(), pond_stage());
    let mut fluid = FluidPainter::new(&table.renderer).fluid(gpu, &stage, style).unwrap();
    fluid.fill(gpu, droplets);
    fluid.set_time(gpu, time);
    let painter = BallPainter::new(&table.renderer);
    let bed = [([20.0, 12.0, -301.0], 300.0, 0.0)];
    let mut bed = painter.balls(gpu, &stage, &BallStyle::new(ColourTable::plain([150, 140, 120])), bed);
    // A row of black balls along the far shore.
    let row = (0..20).filter(|_| wall).map(|k| ([2.0 * f64::from(k) + 1.0, 26.5, 1.5], 1.6, 0.0));
    let mut row = painter.balls(gpu, &stage, &BallStyle::new(ColourTable::plain([5; 3])), row);
    table.draw(&stage, &pond_camera(), light, &mut [&mut bed, &mut row, &mut fluid])
}

fn still(_: f64) -> [f64; 2] {
    [0.0; 2]
}

/// Parts of the picture that are water: the left and the right half of it.
const WEST: [[f64; 2]; 2] = [[0.25, 0.5], [0.45, 0.7]];
const EAST: [[f64; 2]; 2] = [[0.55, 0.5], [0.75, 0.7]];

#[test]
fn water_that_flows_has_ripples_that_go_with_it_and_calm_water_has_none() {
    let Some(table) = Table::open("ripples") else { return };
    let style = FluidStyle::water(0.5);
    let flow = |x: f64| if x < 20.0 { [0.0; 2] } else { [1.5, 0.0] };
    let draw =
        |steepness, time| pond_picture(&table, FluidStyle { steepness, ..style }, time, pond(flow, 0.0, 1.0), false);
    let (rippled, smooth, later) = (draw(style.steepness, 3.0), draw(0.0, 3.0), draw(style.steepness, 3.4));
    let of = |image: &Image, [from, to]: [[f64; 2]; 2]| roughness(image, from, to);
    println!("{} {} {}", of(&rippled, EAST), of(&smooth, EAST), of(&rippled, WEST));
    assert!(of(&rippled, EAST) > 4.0 * of(&smooth, EAST) + 0.5);
    assert!(of(&rippled, WEST) < 1.2 * of(&smooth, WEST) + 0.05);
    assert_ne!(rippled, later);
    assert_eq!(draw(0.0, 3.0), draw(0.0, 9.0));
}

#[test]
fn water_mirrors_what_stands_on_its_far_shore() {
    let Some(table) = Table::open("reflections") else { return };
    // Without shadows: that of the wall would darken the water too.
    let light = Light::day().without_shadows();
    let draw = |wall| pond_picture_in(&table, &light, FluidStyle::water(0.5), 0.0, pond(still, 0.0, 1.0), wall);
    // Just before the far shore, where the sky would be mirrored.
    let [[_, top], _] = [pond_camera().project(&pond_stage(), ASPECT, [20.0, 24.0, 0.0]).unwrap(), [0.0; 2]];
    let strip = |image: &Image| brightness(image, [0.35, top], [0.65, top + 0.04]);
    let (open, walled) = (strip(&draw(false)), strip(&draw(true)));
    println!("{open} {walled}");
    assert!(walled < 0.93 * open, "{open} {walled}");
}

#[test]
fn foam_is_laced_and_the_more_there_is_the_more_it_covers() {
    let Some(table) = Table::open("foam") else { return };
    let draw = |foam| pond_picture(&table, FluidStyle::water(0.5), 1.0, pond(|_| [1.0, 0.0], foam, 1.0), false);
    let [none, some, much] = [0.0, 0.3, 1.0].map(|foam| {
        let image = draw(foam);
        [brightness(&image, EAST[0], EAST[1]), roughness(&image, EAST[0], EAST[1])]
    });
    println!("{none:?} {some:?} {much:?}");
    assert!(none[0] + 2.0 < some[0] && some[0] + 10.0 < much[0]);
    assert!(much[1] > 1.5 * none[1]);
}

#[test]
fn waves_gather_light_on_a_shallow_bed() {
    let Some(table) = Table::open("caustics") else { return };
    // Ripples too flat to be seen by themselves.
    let style = FluidStyle { absorption: [0.05; 3], ..FluidStyle::water(0.5) };
    let shallow = |steepness| {
        let mut droplets = pond(|_| [1.0, 0.0], 0.0, 1.0);
        droplets.iter_mut().for_each(|droplet| droplet.volume *= 0.3);
        pond_picture(&table, FluidStyle { steepness, ..style }, 1.0, droplets, false)
    };
    let [lit, plain] = [1e-6, 0.0].map(|steepness| roughness(&shallow(steepness), EAST[0], EAST[1]));
    println!("{lit} {plain}");
    assert!(lit > 2.0 * plain + 0.5);
}

#[test]
fn ground_beside_water_is_darker_where_it_is_wet() {
    let Some(table) = Table::open("wet ground") else { return };
    let (stage, gpu) = (pond_stage(), table.gpu());
    let camera = Camera::plan(&stage, ASPECT, [0.0; 4]);
    let grey = Image { width: 1, height: 1, rgba: vec![150, 150, 150, 255] };
    let field = HeightField::sampled([0.0; 2], [40.0, 25.0], [41, 26], |_, _| -1.0);
    let draw = |droplets: Vec<Droplet>| {
        let mut ground = Terrain::new(&table.renderer, &stage, field.clone(), &grey, -1.0).unwrap();
        let mut fluid = FluidPainter::new(&table.renderer).fluid(gpu, &stage, FluidStyle::water(0.5)).unwrap();
        fluid.fill(gpu, droplets);
        table.draw(&stage, &camera, &Light::day().without_shadows(), &mut [&mut ground, &mut fluid])
    };
    let west: Vec<Droplet> = pond(still, 0.0, 1.0).into_iter().filter(|droplet| droplet.position[0] < 20.0).collect();
    let (dry, wet) = (draw(Vec::new()), draw(west));
    let at = |image: &Image, x: f64| {
        let [u, v] = camera.project(&stage, ASPECT, [x, 12.0, -1.0]).unwrap();
        brightness(image, [u, v - 0.1], [u + 0.008, v + 0.1])
    };
    let beside: Vec<f64> = [20.6, 21.0, 21.4].map(|x| at(&wet, x) / at(&dry, x)).into();
    println!("{beside:?}");
    assert!(beside.iter().any(|part| *part < 0.85));
    assert!((at(&wet, 25.0) / at(&dry, 25.0) - 1.0).abs() < 0.01);
}

/// A slope towards the north, up which water stood, and from which it has run off to the south.
#[test]
fn ground_that_was_under_water_is_darker_until_it_has_dried() {
    let Some(table) = Table::open("ground that dries") else { return };
    let (stage, gpu) = (pond_stage(), table.gpu());
    let camera = Camera::plan(&stage, ASPECT, [0.0; 4]);
    let grey = Image { width: 1, height: 1, rgba: vec![150, 150, 150, 255] };
    let field = HeightField::sampled([0.0; 2], [40.0, 25.0], [41, 26], |_, y| 0.08 * (y - 12.5));
    let mut ground = Terrain::new(&table.renderer, &stage, field, &grey, -1.0).unwrap();
    let style = FluidStyle { drying: 100.0, ..FluidStyle::water(0.5) };
    let mut fluid = FluidPainter::new(&table.renderer).fluid(gpu, &stage, style).unwrap();
    let mut draw = |time, high: bool| {
        // Discs reach beyond the shore, as those of particles on a slope do.
        let is_wet = |droplet: &Droplet| droplet.position[1] < if high { 13.5 } else { 5.0 };
        fluid.fill(gpu, pond(still, 0.0, 1.0).into_iter().filter(is_wet));
        fluid.set_time(gpu, time);
        table.draw(&stage, &camera, &Light::day().without_shadows(), &mut [&mut ground, &mut fluid])
    };
    let at = |image: &Image, y: f64| {
        let [u, v] = camera.project(&stage, ASPECT, [20.0, y, 0.0]).unwrap();
        brightness(image, [u - 0.1, v], [u + 0.1, v + 0.01])
    };
    let first = draw(0.0, false);
    let (dry, above) = (at(&first, 10.0), at(&first, 20.0));
    draw(10.0, true);
    // At once, after one time of drying, and after many.
    let left = [10.0, 110.0, 900.0].map(|time| {
        let image = draw(time, false);
        // Where no water was nothing is soaked.
        assert!((at(&image, 20.0) / above - 1.0).abs() < 0.02, "{time}");
        1.0 - at(&image, 10.0) / dry
    });
    println!("darker by {left:?}");
    assert!(left[0] > 0.12 && left[0] < 0.35 && left[2].abs() < 0.01, "{left:?}");
    assert!((left[1] / left[0] - (-1f64).exp()).abs() < 0.08, "{left:?}");
    // A film that begins again has no memory of what comes later.
    draw(2000.0, true);
    assert!((at(&draw(0.0, false), 10.0) / dry - 1.0).abs() < 0.01);
}

/// A pane in the plane y = 0, seen from the south before a dim room.
fn pane_picture(table: &Table, caps: &[Cap], fog: &[FogPatch]) -> Image {
    let stage = Stage::new([0.0, -1.0, 0.0], [4.0, 1.0, 4.0]);
    let shape = SolidShape {
        distance: Arc::new(|[x, y, z]| (x - 2.0).abs().max((z - 2.0).abs()).max((y - 0.2).abs() + 1.8) - 2.0),
        bounds: [[0.0, 0.0, 0.0], [4.0, 0.4, 4.0]],
    };
    let mut pane = Solid::new(&table.renderer, &stage, &shape, SolidStyle::Glass([255; 3]));
    let mut drops =
        CapPainter::new(&table.renderer).caps(table.gpu(), &stage, caps.iter().copied(), fog.iter().copied());
    let camera = Camera {
        eye: DVec3::new(2.0, -9.0, 3.8),
        target: DVec3::new(2.0, 0.0, 2.0),
        up: DVec3::Z,
        lens: Lens::Perspective { field_of_view: 0.45 },
    };
    let light = Light::dim_room().from_azimuth(-2.2);
    table.draw(&stage, &camera, &light, &mut [&mut pane, &mut drops])
}

#[test]
fn a_drop_turns_the_street_behind_it_upside_down() {
    let Some(table) = Table::open("lenses") else { return };
    let cap = Cap { position: [2.0, 0.0, 2.0], radius: 1.2, normal: [0.0, -1.0, 0.0], height: 0.7 };
    let (bare, wet) = (pane_picture(&table, &[], &[]), pane_picture(&table, &[cap], &[]));
    let halves =
        |image: &Image| [[0.3, 0.4], [0.6, 0.7]].map(|[top, bottom]| brightness(image, [0.42, top], [0.58, bottom]));
    let ([sky, road], [upper, lower]) = (halves(&bare), halves(&wet));
    println!("behind {sky} {road}, in the drop {upper} {lower}");
    // The sky above is brighter than the road below; in the drop it is below.
    assert!(sky > road + 10.0, "{sky} {road}");
    assert!(lower > upper + 10.0, "{upper} {lower}");
}

#[test]
fn patches_of_unseen_drops_are_fog_as_much_as_they_cover() {
    let Some(table) = Table::open("fog") else { return };
    let fog = |covered: f64| -> Vec<FogPatch> {
        let patch = |k: usize| FogPatch {
            position: [0.1 + 0.2 * (k % 10) as f64, 0.0, 0.1 + 0.2 * (k / 10) as f64],
            half_width: 0.1,
            normal: [0.0, -1.0, 0.0],
            covered,
        };
        (0..200).map(patch).collect()
    };
    let bare = pane_picture(&table, &[], &[]);
    let changed = |image: &Image, from: [f64; 2], to: [f64; 2]| {
        let pixels = |image: &Image| brightness(image, from, to);
        (pixels(image) - pixels(&bare)).abs()
    };
    // The western half of the pane is fogged, low down before the dark road.
    let (west, east) = ([[0.36, 0.6], [0.46, 0.72]], [[0.54, 0.6], [0.64, 0.72]]);
    let [little, more] = [0.1, 0.5].map(|covered| pane_picture(&table, &[], &fog(covered)));
    let of = |image: &Image, [from, to]: [[f64; 2]; 2]| changed(image, from, to);
    println!("{} {} {}", of(&little, west), of(&more, west), of(&more, east));
    assert!(of(&little, west) > 1.0 && of(&more, west) > 2.5 * of(&little, west));
    assert!(of(&more, east) < 0.2 && of(&more, [[0.0, 0.5], [0.15, 0.9]]) == 0.0);
}

#[test]
fn buildings_have_windows_and_roofs_of_their_own() {
    let Some(table) = Table::open("buildings") else { return };
    let stage = Stage::new([0.0; 3], [20.0, 20.0, 9.0]);
    let shape = SolidShape {
        distance: Arc::new(|[x, y, z]| (x - 10.0).abs().max((y - 10.0).abs()).max((z - 4.5).abs() + 3.5) - 8.0),
        bounds: [[2.0, 2.0, 0.0], [18.0, 18.0, 9.0]],
    };
    let camera = Camera::orbit(&stage, [-1.2, 0.45], 0.5, ASPECT, 0.0);
    let draw = |style| {
        let mut solid = Solid::new(&table.renderer, &stage, &shape, style);
        table.draw(&stage, &camera, &Light::day(), &mut [&mut solid])
    };
    let (block, house) = (draw(SolidStyle::Opaque([206; 3], 0.1)), draw(SolidStyle::Building([206; 3], [160, 60, 40])));
    let [x, y] = camera.project(&stage, ASPECT, [10.0, 10.0, 8.0]).unwrap();
    let [red, _, blue, _] = house.pixel((x * f64::from(SIZE[0])) as u32, (y * f64::from(SIZE[1])) as u32);
    assert!(red > blue + 40, "{red} {blue}");
    let [x, y] = camera.project(&stage, ASPECT, [10.0, 2.0, 4.0]).unwrap();
    let of = |image: &Image| roughness(image, [x - 0.1, y - 0.1], [x + 0.1, y + 0.1]);
    println!("{} {}", of(&block), of(&house));
    assert!(of(&house) > 4.0 * of(&block) + 1.0);
}

#[test]
fn ground_far_away_is_hazed_by_the_length_of_the_way_through_the_air() {
    let Some(table) = Table::open("haze") else { return };
    // The same hills, two and twenty kilometres wide.
    let draw = |width: f64| {
        let stage = Stage::new([0.0; 3], [width, width, 0.1 * width]);
        let height = |x: f64, y: f64| 0.05 * width * (7.0 * x / width).sin() * (5.0 * y / width).cos() + 0.05 * width;
        let field = HeightField::sampled([0.0; 2], [width, width], [65, 65], height);
        let black = Image { width: 1, height: 1, rgba: vec![0, 0, 0, 255] };
        let mut ground = Terrain::new(&table.renderer, &stage, field, &black, 0.0).unwrap();
        ground.drape(table.gpu(), &black).unwrap();
        let camera = Camera::orbit(&stage, [-1.2, 0.5], 0.5, ASPECT, 0.0);
        brightness(&table.draw(&stage, &camera, &Light::day(), &mut [&mut ground]), [0.4, 0.45], [0.6, 0.55])
    };
    let (near, far) = (draw(2000.0), draw(20000.0));
    println!("{near} {far}");
    assert!(near < 0.6 * far && far > 100.0, "{near} {far}");
}

#[test]
fn natural_ground_has_grain_and_a_picture_on_it_has_none() {
    let Some(table) = Table::open("natural ground") else { return };
    let stage = Stage::new([0.0; 3], [40.0, 40.0, 4.0]);
    let field = HeightField::sampled([0.0; 2], [40.0, 40.0], [41, 41], |x, _| 0.02 * x);
    let camera = Camera::orbit(&stage, [-1.2, 0.8], 0.5, ASPECT, 0.0);
    let draw = |is_draped: bool| {
        let colours = natural_colours(&field);
        let mut ground = Terrain::new(&table.renderer, &stage, field.clone(), &colours, -1.0).unwrap();
        if is_draped {
            let grey = Image { width: 1, height: 1, rgba: vec![120, 120, 120, 255] };
            ground.drape(table.gpu(), &grey).unwrap();
        }
        // Soft shadows have a grain of their own.
        let image = table.draw(&stage, &camera, &Light::day().without_shadows(), &mut [&mut ground]);
        roughness(&image, [0.4, 0.45], [0.6, 0.6])
    };
    let (natural, draped) = (draw(false), draw(true));
    println!("{natural} {draped}");
    assert!(natural > 1.0 && draped < 0.5, "{natural} {draped}");
}
