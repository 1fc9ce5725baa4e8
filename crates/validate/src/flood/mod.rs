//! Cases of the flood model.

pub(crate) mod bench;
mod device;
mod error_cost;
mod measured;
mod rough_terrain;
mod solids;
mod time_steps;
mod voronoi;

use crate::Case;
use crate::device::{is_reduced, rows, sized};
use corpuscle_model::ModelError;
use corpuscle_scene::{Edge, Edges, Flood, Scene, builtin};
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;

/// Acceleration of gravity, m/s2.
const GRAVITY: f64 = 9.81;

pub(crate) const CASES: &[Case] = &[
    rough_terrain::ROUGH_TERRAIN,
    solids::CUBOID,
    solids::CYLINDER,
    voronoi::BLOCKS,
    voronoi::ISLANDS,
    voronoi::JACKSBORO,
    voronoi::LONG,
    voronoi::STOKER,
    voronoi::RITTER,
    voronoi::PLANAR,
    voronoi::RADIAL,
    voronoi::WAVES,
    voronoi::VORTEX,
    voronoi::SHEETS,
    voronoi::RAIN,
    voronoi::INFILTRATION,
    voronoi::STRUCTURES,
    voronoi::CYLINDER_FORCE,
    voronoi::MOMENTUM,
    voronoi::LEDGER,
    voronoi::ENERGY,
    voronoi::INVARIANCE,
    voronoi::TIDE,
    voronoi::FINER,
    voronoi::ADAPTIVE,
    voronoi::STORAGE,
    voronoi::MALPASSET,
    voronoi::BEACH,
    voronoi::RUN_UP,
    voronoi::SENT_WAVE,
    voronoi::SWASHES,
    voronoi::TRIANGULAR_OBSTACLE,
    voronoi::ISOLATED_BUILDING,
    voronoi::EA_TEST5,
];

/// Edges of a strip: `ends` in the west and east, periodic across.
fn strip(ends: &Edge) -> Edges {
    Edges { west: ends.clone(), east: ends.clone(), south: Edge::Periodic, north: Edge::Periodic }
}

/// A built-in scene of scheme sph-swe with changes of it, and its ground; at the reduced size particles are farther apart, and have as many
/// neighbours.
fn built_in(name: &str, changes: &[(&str, &str)]) -> Result<(Scene, Flood, Arc<Terrain>), ModelError> {
    let setup = |error: &dyn std::fmt::Display| ModelError::Setup(error.to_string());
    let text = builtin(name).ok_or_else(|| setup(&format!("no built-in scene {name}")))?.text;
    let mut all: Vec<_> = changes.iter().map(|(path, value)| ((*path).to_owned(), (*value).to_owned())).collect();
    if is_reduced() {
        for (path, metres) in [("flood.spacing_m", 1.0), ("flood.sph_swe.smoothing_length_m", 2.66)] {
            all.push((path.to_owned(), sized(metres).to_string()));
        }
    }
    let mut scene = Scene::parse(text, name, &all).map_err(|error| setup(&error))?;
    scene.resolve_defaults();
    let flood = scene.flood().ok_or_else(|| setup(&format!("{name} is no flood")))?;
    let terrain = Terrain::open(&flood.terrain, scene.seed, Path::new(".")).map_err(|error| setup(&error))?;
    let settings = flood.flood.clone();
    Ok((scene, settings, Arc::new(terrain)))
}

/// Order of convergence from the errors at two spacings, the second `ratio` times the first.
fn order(fine: f64, coarse: f64, ratio: f64) -> f64 {
    (coarse / fine).ln() / ratio.ln()
}
