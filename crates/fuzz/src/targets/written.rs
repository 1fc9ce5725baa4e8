//! Files of a run that the program itself writes.

use super::path_of;
use corpuscle::{Recorder, Simulation};
use corpuscle_output::FrameFormat;
use corpuscle_scene::Scene;
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

const SCENES: [&str; 2] = [
    "run = { until_s = 0.2, frame_every_s = 0.1, gauge_every_s = 0.05 }\n[gas]\nsize = [20.0, 20.0, 20.0]\nfollow = 0\n\
     ball = [{ name = \"heavy\", position = [10.0, 10.0, 10.0], radius = 2.0, mass = 8.0 }]\n\
     species = [{ name = \"light\", count = 6, radius = 0.5, mass = 1.0, temperature = 1.0 }]\n",
    "run = { until_s = 0.2, frame_every_s = 0.1, gauge_every_s = 0.05 }\n\
     terrain.bump = { extent = { length_m = 20.0, width_m = 20.0, cell_m = 1.0 }, height_m = 1.0, width_m = 5.0 }\n\
     [flood]\nspacing_m = 5.0\nwater = [{ level_m = 0.8 }]\ngauge = [{ name = \"P 1\", at = [3.0, 3.0] }]\n",
];

/// A file of runs of a gas and a flood.
pub(super) fn file(name: &str, format: FrameFormat) -> Vec<Vec<u8>> {
    SCENES.iter().map(|scene| fs::read(run(scene, format).join(name)).unwrap_or_default()).collect()
}

fn run(scene: &str, format: FrameFormat) -> std::path::PathBuf {
    let folder = path_of("written");
    _ = fs::remove_dir_all(&folder);
    let scene = Scene::parse(scene, "scene.toml", &[]).expect("the scene of a target is valid");
    let mut simulation = Simulation::open(scene, Path::new("")).expect("the scene of a target opens");
    let mut recorder = Recorder::create(&folder, &simulation, format).expect("its folder can be written");
    simulation.run(&mut [&mut recorder], &AtomicBool::new(false), &mut |_| {}).expect("the scene of a target runs");
    folder
}
