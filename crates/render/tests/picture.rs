//! Pictures as a user of the crate draws them, against those that were looked at (`reference/`).
//!
//! Where a picture changed on purpose: run with `CORPUSCLE_NEW_REFERENCE=1`, look at what changed, and keep it.

use corpuscle_gpu::{Image, require_gpu};
use corpuscle_model::SolidShape;
use corpuscle_render::{
    Axes, BallPainter, BallStyle, Border, Camera, Cap, CapPainter, ColourTable, Drawable, Droplet, Floor, FluidPainter,
    FluidStyle, FogPatch, HeightField, Key, KeyPosition, Light, LineStyle, Mark, Overlay, Renderer, Shading, Solid,
    SolidStyle, Stage, Target, Terrain, TubePainter, TubeStyle, WaterSides, box_edges, natural_colours,
};
use std::path::Path;
use std::sync::Arc;

const SIZE: [u32; 2] = [240, 135];
const ASPECT: f64 = 16.0 / 9.0;
/// Mean difference of two pictures of the same, in steps of a byte: drivers round differently.
const SAME: f64 = 0.15;
/// A part that is missing makes at least this difference.
const OTHER: f64 = 0.4;

/// Mean difference of all bytes.
fn difference(one: &Image, other: &Image) -> f64 {
    assert_eq!([one.width, one.height], [other.width, other.height]);
    let sum: u64 = one.rgba.iter().zip(&other.rgba).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    sum as f64 / one.rgba.len() as f64
}

fn read_png(path: &Path) -> Image {
    let file = std::fs::File::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let mut rgba = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut rgba).unwrap();
    Image { width: info.width, height: info.height, rgba }
}

fn write_png(path: &Path, image: &Image) {
    let mut encoder = png::Encoder::new(std::fs::File::create(path).unwrap(), image.width, image.height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header().unwrap().write_image_data(&image.rgba).unwrap();
}

/// Compares with the reference of a name. The picture that differs is left beside the test's other output.
fn same_as_reference(name: &str, image: &Image) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference").join(format!("{name}.png"));
    if std::env::var_os("CORPUSCLE_NEW_REFERENCE").is_some_and(|value| value == "1") {
        write_png(&path, image);
    }
    let off = difference(image, &read_png(&path));
    if off > SAME {
        let found = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.png"));
        write_png(&found, image);
        panic!("{name} is off by {off:.2}, more than {SAME}: compare {} with {}", found.display(), path.display());
    }
}

/// What a picture is drawn with.
struct Table {
    renderer: Renderer,
    target: Target,
}

impl Table {
    fn open(test: &str) -> Option<Self> {
        let gpu = require_gpu(test)?;
        Some(Self { renderer: Renderer::new(&gpu), target: Target::new(&gpu, SIZE, 2).unwrap() })
    }

    fn draw(
        &self,
        stage: &Stage,
        camera: &Camera,
        light: &Light,
        things: &mut [&mut dyn Drawable],
        overlay: &Overlay,
    ) -> Image {
        let overlay = overlay.image(stage, camera, SIZE).unwrap();
        self.renderer.draw(&self.target, stage, camera, light, things, Some(&overlay));
        self.renderer.read(&self.target).unwrap()
    }
}

fn viridis() -> ColourTable {
    ColourTable { low: 0.0, high: 1.0, colours: vec![[0x44, 0x01, 0x54], [0x21, 0x91, 0x8c], [0xfd, 0xe7, 0x25]] }
}

/// Balls in a box on a floor with the way of one; parts can be left out by their letters: floor, balls, edges, way, overlay,
/// shadows.
fn gas(table: &Table, left_out: &str) -> Image {
    let gpu = table.renderer.gpu();
    let stage = Stage::new([0.0; 3], [8.0, 8.0, 5.0]);
    let camera = Camera::orbit(&stage, [-1.0, 0.4], 0.5, ASPECT, 0.1);
    let position = |k: usize| [0.7 + (k % 5) as f64 * 1.6, 0.7 + (k / 5 % 5) as f64 * 1.6, 0.6 + (k / 25) as f64 * 1.5];
    let balls = (0..75).filter(|k| k % 4 != 1).map(|k| (position(k), 0.6, (k % 11) as f64 / 10.0));
    let style = BallStyle::new(viridis());
    let mut balls = BallPainter::new(&table.renderer).balls(gpu, &stage, &style, balls);
    let tubes = TubePainter::new(&table.renderer);
    let ink = TubeStyle { colour: [70, 82, 94], radius: 0.0, least_radius: 0.8, shaded: false };
    let edges = box_edges([0.0; 3], [8.0, 8.0, 5.0]);
    let mut edges = tubes.tubes(gpu, &stage, &ink, edges.iter().map(Vec::as_slice));
    let way = [[1.0, 1.0, 4.8], [7.0, 2.0, 4.0], [4.0, 1.0, 1.0], [7.5, 4.0, 4.6]];
    let red = TubeStyle { colour: [194, 24, 91], radius: 0.2, least_radius: 0.8, shaded: true };
    let mut way = tubes.tubes(gpu, &stage, &red, [way.as_slice()]);
    let mut floor = Floor::new(&table.renderer, 0.0);
    let mut things: Vec<&mut dyn Drawable> = Vec::new();
    let all: [(char, &mut dyn Drawable); 4] =
        [('f', &mut floor), ('b', &mut balls), ('e', &mut edges), ('w', &mut way)];
    things.extend(all.into_iter().filter(|(letter, _)| !left_out.contains(*letter)).map(|(_, thing)| thing));
    let overlay = match left_out.contains('o') {
        true => Overlay::default(),
        false => Overlay {
            title: "Gas".into(),
            time: "t = 3".into(),
            key: Some(Key::Values("Speed".into(), viridis())),
            axes: Some(Axes { from: [0.0; 3], to: [8.0, 8.0, 5.0], unit: "m".into(), heights: 1.0 }),
            ..Overlay::default()
        },
    };
    let mut light = Light::studio().from_azimuth(-1.9);
    if left_out.contains('s') {
        // Straight from above through the opening of the sun: shadows fall elsewhere.
        light.sun = [-1.9, 1.57];
    }
    table.draw(&stage, &camera, &light, &mut things, &overlay)
}

/// Ground under the sky with a pane of glass on it and drops on the pane; parts left out: terrain, glass, caps.
fn dew_on_a_hill(table: &Table, left_out: &str) -> Image {
    let gpu = table.renderer.gpu();
    let stage = Stage::new([0.0, 0.0, -1.0], [10.0, 8.0, 4.0]);
    let camera = Camera::orbit(&stage, [-1.2, 0.35], 0.6, ASPECT, 0.0);
    let field = HeightField::sampled([0.0; 2], [10.0, 8.0], [90, 70], |x, y| 0.5 * (0.9 * x).sin() * (1.1 * y).cos());
    let colours = natural_colours(&field);
    let mut terrain = Terrain::new(&table.renderer, &stage, field, &colours, -1.0).unwrap();
    let (low, high) = ([2.0, 2.0, 0.6], [8.0, 2.3, 3.8]);
    let shape = SolidShape {
        bounds: [low, high],
        distance: Arc::new(move |at| {
            (0..3).map(|k| (low[k] - at[k]).max(at[k] - high[k])).fold(f64::NEG_INFINITY, f64::max)
        }),
    };
    let mut glass = Solid::new(&table.renderer, &stage, &shape, SolidStyle::Glass([225, 240, 232]));
    let cap = |k: usize| Cap {
        position: [2.6 + 1.2 * (k % 5) as f64, 2.0, 1.2 + 1.0 * (k / 5) as f64],
        radius: 0.25 + 0.04 * (k % 4) as f64,
        normal: [0.0, -1.0, 0.0],
        height: 0.2,
    };
    let mut caps = CapPainter::new(&table.renderer).caps(gpu, &stage, (0..15).map(cap), []);
    let mut things: Vec<&mut dyn Drawable> = Vec::new();
    let all: [(char, &mut dyn Drawable); 3] = [('t', &mut terrain), ('g', &mut glass), ('c', &mut caps)];
    things.extend(all.into_iter().filter(|(letter, _)| !left_out.contains(*letter)).map(|(_, thing)| thing));
    table.draw(&stage, &camera, &Light::day().from_azimuth(-2.2), &mut things, &Overlay::default())
}

/// Flat discs on paper, to scale, in a cylinder with a piston; parts left out: borders, marks, what lines mean.
fn plan(table: &Table, left_out: &str) -> Image {
    let gpu = table.renderer.gpu();
    let stage = Stage::new([0.0; 3], [16.0, 9.0, 0.0]);
    let camera = Camera::plan(&stage, ASPECT, [0.1; 4]);
    let discs = (0..40).map(|k| ([1.0 + 2.0 * (k % 8) as f64, 1.0 + 1.8 * (k / 8) as f64, 0.0], 0.7, k as f64 / 39.0));
    let style = BallStyle { shading: Shading::Discs, ..BallStyle::new(viridis()) };
    let mut balls = BallPainter::new(&table.renderer).balls(gpu, &stage, &style, discs);
    let line = |style, ends: [[f64; 2]; 2], outwards| Border::Line { style, ends, outwards };
    let borders = vec![
        line(LineStyle::Wall, [[0.0, 0.0], [16.0, 0.0]], [0.0, -1.0]),
        line(LineStyle::ThermalWall, [[0.0, 0.0], [0.0, 9.0]], [-1.0, 0.0]),
        line(LineStyle::Periodic, [[0.0, 9.0], [16.0, 9.0]], [0.0, 1.0]),
        line(LineStyle::Partition, [[8.0, 0.0], [8.0, 3.0]], [0.0, 0.0]),
        Border::Piston { ends: [[12.0, 0.0], [12.0, 9.0]], outwards: [1.0, 0.0], rod: 3.0 },
    ];
    let marks = |position: [f64; 3]| [Mark::Ring(position, 0.7), Mark::Start([position[0] + 1.0, position[1], 0.0])];
    let whole = Overlay {
        scale_bar: Some("m".into()),
        key_position: KeyPosition::Corner,
        lines: [
            LineStyle::Trajectory,
            LineStyle::Wall,
            LineStyle::ThermalWall,
            LineStyle::Periodic,
            LineStyle::Partition,
        ]
        .map(|style| (style, format!("what is drawn as {style:?}")))
        .into(),
        borders,
        marks: (0..5).flat_map(|k| marks([5.0, 1.0 + 1.8 * k as f64, 0.0])).collect(),
        axes: Some(Axes { from: [0.0; 3], to: [16.0, 9.0, 0.0], unit: "m".into(), heights: 1.0 }),
        ..Overlay::default()
    };
    let overlay = Overlay {
        borders: if left_out.contains('b') { Vec::new() } else { whole.borders },
        marks: if left_out.contains('m') { Vec::new() } else { whole.marks },
        lines: if left_out.contains('l') { Vec::new() } else { whole.lines },
        ..whole
    };
    table.draw(&stage, &camera, &Light::paper(), &mut [&mut balls], &overlay)
}

#[test]
fn pictures_are_as_they_were_when_they_were_looked_at() {
    let Some(table) = Table::open("reference pictures") else { return };
    same_as_reference("gas", &gas(&table, ""));
    same_as_reference("dew-on-a-hill", &dew_on_a_hill(&table, ""));
    same_as_reference("plan", &plan(&table, ""));
}

#[test]
fn a_part_that_is_left_out_is_missed() {
    let Some(table) = Table::open("parts of pictures") else { return };
    let (whole_gas, whole_dew) = (gas(&table, ""), dew_on_a_hill(&table, ""));
    for part in ["f", "b", "e", "w", "o", "s"] {
        let off = difference(&gas(&table, part), &whole_gas);
        assert!(off > OTHER, "gas without {part}: {off:.2}");
    }
    let whole_plan = plan(&table, "");
    for part in ["b", "m", "l"] {
        // Lines cover little of a picture.
        let off = difference(&plan(&table, part), &whole_plan);
        assert!(off > SAME, "plan without {part}: {off:.2}");
    }
    for part in ["t", "g", "c"] {
        let off = difference(&dew_on_a_hill(&table, part), &whole_dew);
        assert!(off > OTHER, "dew without {part}: {off:.2}");
    }
}

#[test]
fn the_same_frame_twice_is_the_same_picture() {
    let (Some(one), Some(other)) = (Table::open("the same twice"), Table::open("the same twice")) else { return };
    assert!(gas(&one, "") == gas(&one, ""));
    assert!(gas(&one, "") == gas(&other, ""));
    assert!(dew_on_a_hill(&one, "") == dew_on_a_hill(&other, ""));
}

#[test]
fn what_stands_is_kept_until_something_changes() {
    let Some(table) = Table::open("what stands") else { return };
    let gpu = table.renderer.gpu();
    let stage = Stage::new([0.0, 0.0, -1.0], [10.0, 8.0, 2.0]);
    let field = HeightField::sampled([0.0; 2], [10.0, 8.0], [90, 70], |x, y| 0.5 * (0.9 * x).sin() * (1.1 * y).cos());
    let grey = |value| Image { width: 1, height: 1, rgba: vec![value, value, value, 255] };
    let mut ground = Terrain::new(&table.renderer, &stage, field, &grey(90), -1.0).unwrap();
    let painter = BallPainter::new(&table.renderer);
    let light = Light::day().without_shadows();
    // A ball that goes over the ground and sinks into it, drawn at a table that kept the ground and at one that has drawn nothing yet.
    let draw = |table: &Table, ground: &mut Terrain, turn: f64, at: f64| {
        let camera = Camera::orbit(&stage, [turn, 0.4], 0.6, ASPECT, 0.0);
        let mut ball = painter.balls(gpu, &stage, &BallStyle::new(viridis()), [([at, 4.0, 0.3], 0.5, 0.8)]);
        table.draw(&stage, &camera, &light, &mut [&mut ball, ground], &Overlay::default())
    };
    let fresh = || Table { renderer: Renderer::new(gpu), target: Target::new(gpu, SIZE, 2).unwrap() };
    for (turn, value) in [(-1.2, 90), (-1.2, 200), (-0.7, 200)] {
        if value == 200 && turn == -1.2 {
            ground.drape(gpu, &grey(200)).unwrap();
        }
        let pictures = [1.0, 3.0, 5.0, 7.0].map(|at| {
            let kept = draw(&table, &mut ground, turn, at);
            assert!(kept == draw(&fresh(), &mut ground, turn, at), "turned by {turn}, {value}, ball at {at}");
            kept
        });
        assert!(pictures[2] != pictures[3]);
    }
}

#[test]
fn a_picture_without_background_shows_the_same_things() {
    let Some(table) = Table::open("a picture without background") else { return };
    let gpu = table.renderer.gpu();
    let target = Target::new(gpu, SIZE, 2).unwrap().without_background(true);
    let bare = Table { renderer: Renderer::new(gpu), target };
    // Without floor, which would be all round, and without overlay.
    let (whole, alone) = (gas(&table, "fo"), gas(&bare, "fo"));
    let pixels = || (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y)));
    let mut counts = [0; 3];
    for (x, y) in pixels() {
        let [shown, own] = [whole.pixel(x, y), alone.pixel(x, y)];
        match own[3] {
            0 => counts[0] += 1,
            255 => {
                counts[1] += 1;
                assert_eq!(shown, own, "at {x}, {y}");
            }
            _ => counts[2] += 1,
        }
    }
    assert_eq!(alone.pixel(2, 2)[3], 0);
    assert!(counts.iter().all(|count| *count > 500), "{counts:?}");
}

/// A pane between two balls, half of it fogged, the other half on its far side, with drops on it; parts left out: ball, fog, away (fog on the far side), glass, caps.
fn pane_alone(table: &Table, left_out: &str) -> Image {
    let gpu = table.renderer.gpu();
    let stage = Stage::new([0.0, 0.0, 0.0], [10.0, 8.0, 4.0]);
    let camera = Camera::orbit(&stage, [-1.2, 0.2], 0.6, ASPECT, 0.0);
    let shape = |low: [f64; 3], high: [f64; 3]| SolidShape {
        bounds: [low, high],
        distance: Arc::new(move |at| {
            (0..3).map(|k| (low[k] - at[k]).max(at[k] - high[k])).fold(f64::NEG_INFINITY, f64::max)
        }),
    };
    let glass = SolidStyle::Glass([225, 240, 232]);
    let mut glass = Solid::new(&table.renderer, &stage, &shape([2.0, 2.0, 0.2], [8.0, 2.3, 3.8]), glass);
    let style = BallStyle::new(viridis());
    let balls = [([4.5, 6.0, 2.0], 1.2, 0.8), ([3.5, 0.5, 1.2], 0.5, 0.2)];
    let mut ball = BallPainter::new(&table.renderer).balls(gpu, &stage, &style, balls);
    let cap = |k: usize| Cap {
        position: [2.6 + 1.2 * (k % 5) as f64, 2.0, 1.2 + 1.0 * (k / 5) as f64],
        radius: 0.25,
        normal: [0.0, -1.0, 0.0],
        height: 0.2,
    };
    let patch = |k: usize, [x, y]: [f64; 2], outwards: f64| FogPatch {
        position: [x + 0.5 * (k % 6) as f64, y, 0.45 + 0.5 * (k / 6) as f64],
        half_width: 0.25,
        normal: [0.0, outwards, 0.0],
        covered: 0.5,
    };
    let painter = CapPainter::new(&table.renderer);
    let mut caps = painter.caps(gpu, &stage, (0..5).map(cap), []);
    let mut fog = painter.caps(gpu, &stage, [], (0..42).map(|k| patch(k, [5.25, 2.0], -1.0)));
    let far = painter.caps(gpu, &stage, [], (0..42).map(|k| patch(k, [2.25, 2.3], 1.0)));
    let mut far = far.on_far_sides(glass.far_side());
    let all: [(char, &mut dyn Drawable); 5] =
        [('b', &mut ball), ('a', &mut far), ('g', &mut glass), ('f', &mut fog), ('c', &mut caps)];
    let mut things: Vec<&mut dyn Drawable> = Vec::new();
    things.extend(all.into_iter().filter(|(letter, _)| !left_out.contains(*letter)).map(|(_, thing)| thing));
    table.draw(&stage, &camera, &Light::dim_room().from_azimuth(-2.2), &mut things, &Overlay::default())
}

/// The opacities of all pixels.
fn opacities(image: &Image) -> Vec<u8> {
    image.rgba.chunks(4).map(|pixel| pixel[3]).collect()
}

#[test]
fn fog_on_the_far_side_of_glass_is_seen_through_it_and_nowhere_else() {
    let Some(table) = Table::open("fog on the far side") else { return };
    let differing = |one: &str, other: &str| -> Vec<usize> {
        let (one, other) = (pane_alone(&table, one), pane_alone(&table, other));
        let pairs = one.rgba.chunks(4).zip(other.rgba.chunks(4)).enumerate();
        pairs.filter(|(_, (a, b))| (0..3).any(|k| a[k].abs_diff(b[k]) > 2)).map(|(at, _)| at).collect()
    };
    let fogged = differing("fc", "fca");
    let pane = differing("bfca", "bfcag");
    let ball = differing("fcag", "bfcag");
    // On the pane alone, but for the ball behind it, which is seen blurred.
    // A clear pane's outermost pixels hardly differ from what is behind, so its neighbours count as pane.
    let is_beside_pane = |at: usize| pane.contains(&(at - 1)) || pane.contains(&at) || pane.contains(&(at + 1));
    let outside: Vec<_> = fogged.iter().filter(|at| !is_beside_pane(**at) && !ball.contains(at)).collect();
    assert!(fogged.len() > 1500 && outside.is_empty(), "{} and {outside:?}", fogged.len());
    // The ball before the pane hides it.
    let stage = Stage::new([0.0, 0.0, 0.0], [10.0, 8.0, 4.0]);
    let camera = Camera::orbit(&stage, [-1.2, 0.2], 0.6, ASPECT, 0.0);
    let [u, v] = camera.project(&stage, ASPECT, [3.5, 0.5, 1.2]).unwrap();
    let middle = (v * f64::from(SIZE[1])) as usize * SIZE[0] as usize + (u * f64::from(SIZE[0])) as usize;
    assert!(pane.contains(&(middle + 30)) && !fogged.contains(&middle), "at {u:.3}, {v:.3}");
}

#[test]
fn glass_and_fog_without_background_let_through_what_is_behind() {
    let Some(table) = Table::open("glass without background") else { return };
    let target = Target::new(table.renderer.gpu(), SIZE, 2).unwrap().without_background(true);
    let bare = Table { renderer: Renderer::new(table.renderer.gpu()), target };
    let whole = pane_alone(&bare, "");
    same_as_reference("pane-alone", &whole);
    let [glass, fogged, nothing] = ["bafc", "bac", "bagfc"].map(|left_out| opacities(&pane_alone(&bare, left_out)));
    // The clear pane lets most light through, fog less, and both hide something.
    assert!(nothing.iter().all(|opacity| *opacity == 0));
    let seen: Vec<usize> = (0..glass.len()).filter(|at| glass[*at] > 0).collect();
    let faint = seen.iter().filter(|at| glass[**at] < 128).count();
    assert!(seen.len() > 3000 && 4 * faint > 3 * seen.len(), "{faint} of {}", seen.len());
    let denser: Vec<usize> = seen.into_iter().filter(|at| fogged[*at] > glass[*at] + 20).collect();
    assert!(denser.len() > 1000 && denser.iter().all(|at| fogged[*at] < 255), "{}", denser.len());
    for part in ["b", "a", "g", "f", "c"] {
        let off = difference(&pane_alone(&bare, part), &whole);
        assert!(off > OTHER, "the pane without {part}: {off:.2}");
    }
}

#[test]
fn what_stands_and_its_shadows_are_kept_while_only_water_moves() {
    let Some(table) = Table::open("what stands in the sun") else { return };
    let gpu = table.renderer.gpu();
    let stage = Stage::new([0.0, 0.0, -1.0], [10.0, 8.0, 2.0]);
    let field = HeightField::sampled([0.0; 2], [10.0, 8.0], [90, 70], |x, y| 0.5 * (0.9 * x).sin() * (1.1 * y).cos());
    let grey = Image { width: 1, height: 1, rgba: vec![90, 90, 90, 255] };
    let mut ground = Terrain::new(&table.renderer, &stage, field.clone(), &grey, -1.0).unwrap();
    let mut floor = Floor::new(&table.renderer, -1.0);
    let mut sides = WaterSides::new(&table.renderer, &stage);
    let fluids = FluidPainter::new(&table.renderer);
    let painter = BallPainter::new(&table.renderer);
    let mut draw = |table: &Table, sun: f64, height: f64, at: f64, with_ball: bool| {
        let camera = Camera::orbit(&stage, [-1.2, 0.4], 0.6, ASPECT, 0.0);
        let mut water = fluids.fluid(gpu, &stage, FluidStyle::water(0.5)).unwrap();
        water.fill(gpu, [Droplet::ball([at, 4.0, 0.6], 0.5)]);
        let mut ball = painter.balls(gpu, &stage, &BallStyle::new(viridis()), [([at, 2.0, 1.0], 0.5, 0.8)]);
        floor.lay_at(height);
        let at_border = Droplet { volume: 1.0, reach: 2.0, ..Droplet::ball([at, 0.5, 0.6], 0.5) };
        sides.fill(gpu, &field, &[at_border]);
        let mut things: Vec<&mut dyn Drawable> = vec![&mut ground, &mut floor, &mut sides, &mut water];
        if with_ball {
            things.push(&mut ball);
        }
        let light = Light::day().from_azimuth(sun);
        table.draw(&stage, &camera, &light, &mut things, &Overlay::default())
    };
    let fresh = || Table { renderer: Renderer::new(gpu), target: Target::new(gpu, SIZE, 2).unwrap() };
    for (sun, height, with_ball) in [(-1.0, -1.0, false), (-1.0, -1.0, true), (-1.0, -1.3, false), (0.5, -1.3, false)] {
        let pictures = [1.0, 3.0, 5.0, 7.0].map(|at| {
            let kept = draw(&table, sun, height, at, with_ball);
            assert!(kept == draw(&fresh(), sun, height, at, with_ball), "{sun}, {height}, ball {with_ball}, at {at}");
            kept
        });
        assert!(pictures[2] != pictures[3]);
    }
}

#[test]
fn a_plan_keeps_colours_and_scale() {
    let Some(table) = Table::open("a plan") else { return };
    let image = plan(&table, "l");
    // The first disc: 1 m from the left and the bottom, of the first colour; beside it paper.
    let pixels_per_metre = f64::from(SIZE[1]) * 0.8 / 9.0;
    let at = |x: f64, y: f64| {
        let [px, py] = [(x - 8.0) * pixels_per_metre + 120.0, (4.5 - y) * pixels_per_metre + 67.5];
        image.pixel(px as u32, py as u32)
    };
    assert_eq!(at(1.0, 1.0), [0x44, 0x01, 0x54, 255]);
    assert_eq!(at(1.0, 1.9), [255; 4]);
    assert_ne!(at(1.55, 1.0), [255; 4]);
    assert_eq!(at(1.9, 1.0), [255; 4]);
}

#[test]
fn ground_without_heights_is_cut_out_and_water_has_a_face_at_its_border() {
    let Some(table) = Table::open("ground with a hole") else { return };
    let gpu = table.renderer.gpu();
    let stage = Stage::new([0.0, 0.0, -1.0], [16.0, 9.0, 1.0]);
    let flat = HeightField::sampled([0.0; 2], [16.0, 9.0], [65, 37], |x, y| {
        if (x - 8.0).hypot(y - 4.5) < 2.0 { f64::NAN } else { 0.0 }
    });
    let green = Image { width: 1, height: 1, rgba: vec![40, 200, 40, 255] };
    let mut ground = Terrain::new(&table.renderer, &stage, flat.clone(), &green, -1.0).unwrap();
    let plan = Camera::plan(&stage, ASPECT, [0.0; 4]);
    let image = table.draw(&stage, &plan, &Light::day(), &mut [&mut ground], &Overlay::default());
    let is_green = |x: u32, y: u32| {
        let [red, green, blue, _] = image.pixel(x, y).map(u32::from);
        green > red / 2 + blue
    };
    assert!(is_green(20, 20) && is_green(200, 110) && !is_green(120, 67) && !is_green(110, 67));

    // Water one metre deep in the southern half, seen from the south.
    let camera = Camera::orbit(&stage, [-1.57, 0.3], 0.5, ASPECT, 0.0);
    let column = |index: u64| {
        let [x, y] = [0.25 + 0.5 * (index % 32) as f64, 0.25 + 0.5 * (index / 32) as f64];
        Droplet { volume: 0.25, reach: 1.0, flatness: 0.1, id: index, ..Droplet::ball([x, y, 0.93], 0.7) }
    };
    let droplets: Vec<Droplet> = (0..32 * 9).map(column).collect();
    let mut sides = WaterSides::new(&table.renderer, &stage);
    sides.fill(gpu, &flat, &droplets);
    let draw =
        |things: &mut [&mut dyn Drawable]| table.draw(&stage, &camera, &Light::day(), things, &Overlay::default());
    let dry = draw(&mut [&mut ground]);
    let wet = draw(&mut [&mut ground, &mut sides]);
    // A position half way up the face in the middle, and one on the ground before the hole.
    let seen = |position| camera.project(&stage, ASPECT, position).map(|[x, y]| [x * 240.0, y * 135.0]).unwrap();
    let [x, y] = seen([8.0, 0.0, 0.5]);
    let [red, _, blue, _] = wet.pixel(x as u32, y as u32);
    assert!(blue > red.saturating_add(30) && wet.pixel(x as u32, y as u32) != dry.pixel(x as u32, y as u32));
    let [x, y] = seen([8.0, 0.0, -0.5]);
    assert_eq!(wet.pixel(x as u32, y as u32), dry.pixel(x as u32, y as u32));
}

#[test]
fn edges_are_soft_with_one_sample_a_pixel() {
    let Some(gpu) = require_gpu("edges with one sample") else { return };
    let table = Table { renderer: Renderer::new(&gpu), target: Target::new(&gpu, SIZE, 1).unwrap() };
    let stage = Stage::new([0.0, 0.0, -1.0], [16.0, 9.0, 1.0]);
    let flat = HeightField::sampled([0.0; 2], [16.0, 9.0], [9, 5], |_, _| 0.0);
    let red = Image { width: 1, height: 1, rgba: vec![220, 0, 0, 255] };
    let mut ground = Terrain::new(&table.renderer, &stage, flat, &red, -1.0).unwrap();
    // From straight above, a little turned: grainy red and the sky, and between them nothing but edges.
    let turned = Camera { up: glam::DVec3::new(0.3, 1.0, 0.0), ..Camera::plan(&stage, ASPECT, [0.2; 4]) };
    let image = table.draw(&stage, &turned, &Light::day(), &mut [&mut ground], &Overlay::default());
    let greens: Vec<u8> = image.rgba.chunks_exact(4).map(|pixel| pixel[1]).collect();
    let (low, high) = (greens.iter().min().unwrap(), greens.iter().max().unwrap());
    let part = |green: &&u8| (f64::from(**green) - f64::from(*low)) / f64::from(high - low);
    let between = greens.iter().filter(|green| (0.35..0.85).contains(&part(green))).count();
    assert!(between > 100, "{between}");
}

#[test]
fn the_overlay_lies_over_the_picture_by_its_opacity() {
    let Some(Table { renderer, target }) = Table::open("the overlay") else { return };
    let stage = Stage::new([0.0; 3], [2.0, 2.0, 1.0]);
    let mut overlay = Image { width: SIZE[0], height: SIZE[1], rgba: vec![0; 4 * (SIZE[0] * SIZE[1]) as usize] };
    overlay.rgba[..4].copy_from_slice(&[100, 0, 0, 128]);
    renderer.draw(&target, &stage, &Camera::plan(&stage, ASPECT, [0.0; 4]), &Light::paper(), &mut [], Some(&overlay));
    let image = renderer.read(&target).unwrap();
    assert_eq!([image.pixel(1, 0), image.pixel(0, 0)], [[255; 4], [227, 127, 127, 255]]);
}

#[test]
fn a_picture_too_large_for_the_device_is_refused_in_words() {
    let Some(gpu) = require_gpu("a picture too large") else { return };
    let error = Target::new(&gpu, [70_000, 40], 2).unwrap_err().to_string();
    assert!(error.contains("140000 x 80"), "{error}");
}
