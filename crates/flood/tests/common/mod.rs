//! Floods as tests set them up.
#![allow(dead_code, reason = "each test takes what it needs")]

use corpuscle_flood::{SphSweFlood, VoronoiFlood};
use corpuscle_model::Model;
use corpuscle_scene::{FloodScene, Scene};
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

#[cfg(feature = "gpu")]
pub mod on_gpu;

/// A flood from its text, with values changed as by `--set` and its defaults filled in.
pub fn scene_with(text: &str, changes: &[(&str, &str)]) -> FloodScene {
    let changes: Vec<_> = changes.iter().map(|(path, value)| ((*path).to_owned(), (*value).to_owned())).collect();
    let mut scene = Scene::parse(text, "test", &changes).unwrap();
    scene.resolve_defaults();
    scene.flood().unwrap().clone()
}

/// A flood from its text, its defaults filled in.
pub fn scene(text: &str) -> FloodScene {
    scene_with(text, &[])
}

/// The terrain of a flood.
pub fn terrain(scene: &FloodScene) -> Arc<Terrain> {
    Arc::new(Terrain::open(&scene.terrain, 1, Path::new(".")).unwrap())
}

/// A flood by scheme sph-swe, of seed 1.
pub fn sph_swe(scene: &FloodScene) -> SphSweFlood {
    SphSweFlood::new(&scene.flood, 1, Path::new("."), terrain(scene)).unwrap()
}

/// A flood by scheme voronoi, of seed 1.
pub fn voronoi(scene: &FloodScene) -> VoronoiFlood {
    VoronoiFlood::new(&scene.flood, 1, Path::new("."), terrain(scene)).unwrap()
}

/// Advances to a time, s.
pub fn advance(flood: &mut impl Model, time: f64) {
    flood.advance_to(time, &AtomicBool::new(false)).unwrap();
}
