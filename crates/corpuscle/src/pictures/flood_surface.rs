//! How far the drawn surface of a flood is from the model's own water, on built-in scenes.

use super::flood::FloodPicture;
use super::{DrawContext, Moment, PictureSettings, Subject, Viewpoint};
use crate::Simulation;
use corpuscle_gpu::{Gpu, require_gpu};
use corpuscle_scene::{FloodScene, Scene, builtin};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Scenes, the time at which they are looked at, s, their spacing, m, and how far apart the two are at most in the mean, in spacings. Bounds are about
/// a third above what is found: columns of scheme sph-swe are drawn as wide as their water, and rough ground varies within them.
const SCENES: [(&str, f64, &str, f64); 7] = [
    ("flood/dam-break", 4.0, "1", 0.045),
    ("flood/cuboid", 3.0, "1", 0.35),
    ("flood/valley", 300.0, "10", 0.012),
    ("flood/city", 20.0, "3", 0.03),
    ("flood/cloudburst", 900.0, "6", 0.05),
    ("flood/lake-at-rest", 1.0, "1.5", 0.02),
    ("flood/rough-terrain", 3.0, "1", 1.1),
];
/// Of these the tests of every day look at the first ones.
const EVERY_DAY: usize = 2;
const SIZE: [u32; 2] = [1280, 720];
/// Positions each way at which the two are compared.
const POSITIONS: [usize; 2] = [320, 180];
/// Water shallower than this part of the mean depth is not compared: shores are counted by themselves.
const DEEP: f64 = 0.25;

/// What is found in a scene.
struct Found {
    /// Mean depth, m.
    depth: f64,
    /// Mean distance of the two surfaces along the vertical, m, and that below which 95 % of the positions are.
    mean: f64,
    most: f64,
    /// Part of the wet positions where no water is drawn, and of the drawn ones that are dry.
    missing: f64,
    beyond: f64,
}

/// The drawn and the model's levels and depths at positions, seen straight from above.
fn look(gpu: &Gpu, name: &str, time: f64, spacing: &str) -> Found {
    let changes = [("flood.spacing_m".to_owned(), spacing.to_owned())];
    let scene = Scene::parse(builtin(name).unwrap().text, name, &changes).unwrap();
    let mut simulation = Simulation::open(scene, Path::new("")).unwrap();
    simulation.model_mut().advance_to(time, &AtomicBool::new(false)).unwrap();
    let plan = Viewpoint { plan: true, ..Viewpoint::default() };
    let settings =
        PictureSettings { size: SIZE, samples: 1, viewpoints: vec![(0.0, plan)], ..PictureSettings::default() };
    let terrain = simulation.terrain().unwrap().clone();
    let context = DrawContext::new(gpu, &settings, Some(&terrain)).unwrap();
    let FloodScene { flood, .. } = simulation.scene().flood().unwrap();
    let mut picture =
        FloodPicture::new(&context, flood, &terrain, super::flood::drawn_ground(&terrain), &settings).unwrap();
    let frame = simulation.model().frame();
    let moment = Moment { frame: &frame, on_device: None, paths: &[], container: None };
    let shown = picture.draw(&context, "", &moment).unwrap();
    let distances = picture.fluid.as_ref().unwrap().distances(gpu).unwrap();

    let bounds = terrain.bounds();
    let part = |k: usize, of: usize| (k as f64 + 0.5) / of as f64;
    let x = |k: usize| bounds.x_min + part(k, POSITIONS[0]) * (bounds.x_max - bounds.x_min);
    let y = |k: usize| bounds.y_min + part(k, POSITIONS[1]) * (bounds.y_max - bounds.y_min);
    let positions = (0..POSITIONS[1]).flat_map(|row| (0..POSITIONS[0]).map(move |column| [x(column), y(row)]));
    let drawn_at = |[x, y]: [f64; 2]| {
        let at = shown.camera.project(&shown.stage, context.aspect(), [x, y, terrain.height(x, y)])?;
        let [column, row] = [0, 1].map(|k| (at[k] * f64::from(SIZE[k])) as usize);
        let distance = *distances.get(row * SIZE[0] as usize + column)?;
        distance.map(|distance| shown.camera.eye.z - distance)
    };
    let compared: Vec<([f64; 2], f64, Option<f64>)> =
        positions.map(|at| (at, simulation.water_at(at).unwrap().depth, drawn_at(at))).collect();
    let wet: Vec<_> = compared.iter().filter(|(_, depth, _)| *depth > 0.0).collect();
    let depth = wet.iter().map(|(_, depth, _)| depth).sum::<f64>() / wet.len() as f64;
    // A surface below the ground is not seen.
    let seen = |at: &[f64; 2], drawn: Option<f64>| drawn.filter(|level| *level > terrain.height(at[0], at[1]));
    let deep: Vec<_> = wet.iter().filter(|(_, own, _)| *own > DEEP * depth).collect();
    let mut apart: Vec<f64> = deep
        .iter()
        .filter_map(|(at, own, drawn)| Some((seen(at, *drawn)? - terrain.height(at[0], at[1]) - own).abs()))
        .collect();
    apart.sort_by(f64::total_cmp);
    let is_seen = compared.iter().filter(|(at, _, drawn)| seen(at, *drawn).is_some());
    let (of_seen, dry) = is_seen.fold((0, 0), |(all, dry), (_, own, _)| (all + 1, dry + i32::from(*own == 0.0)));
    Found {
        depth,
        mean: apart.iter().sum::<f64>() / apart.len() as f64,
        most: apart[apart.len() * 95 / 100],
        missing: 1.0 - apart.len() as f64 / deep.len() as f64,
        beyond: f64::from(dry) / f64::from(of_seen),
    }
}

fn compare(scenes: &[(&str, f64, &str, f64)]) {
    let Some(gpu) = require_gpu("the drawn surface of floods") else { return };
    for &(name, time, spacing, bound) in scenes {
        let Found { depth, mean, most, missing, beyond } = look(&gpu, name, time, spacing);
        println!(
            "| `{name}`, {time} s | {spacing} m | {depth:.3} m | {mean:.3} m | {most:.3} m | {:.1} % | {:.1} % |",
            100.0 * missing,
            100.0 * beyond
        );
        let spacing: f64 = spacing.parse().unwrap();
        assert!(mean < bound * spacing, "{name}: {mean} m, {} spacings", mean / spacing);
    }
}

#[test]
fn the_drawn_surface_is_that_of_the_model() {
    compare(&SCENES[..EVERY_DAY]);
}

#[test]
#[ignore = "takes half a minute; cargo test --release --workspace --lib drawn_surface -- --ignored --nocapture"]
fn the_drawn_surface_of_all_scenes_is_that_of_the_model() {
    compare(&SCENES);
}
