//! Cases of the flood model.

pub(crate) mod bench;
mod channel;
mod dam_break;
mod device;
mod ea_test5;
mod error_cost;
mod isolated_building;
mod lake;
mod malpasset;
mod measured;
mod refinement;
mod rough_terrain;
mod solids;
mod structures;
mod swashes;
mod thacker;
mod time_steps;
mod triangular_obstacle;
mod voronoi;
mod weather;

use crate::Case;
use crate::device::{is_reduced, rows, sized};
use corpuscle_flood::{Flood, InitialWater};
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::{Edge, Edges, Flood as Settings, Manning, Scene, Scheme, builtin};
use corpuscle_terrain::{Bounds, Terrain};
use device::ready;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Acceleration of gravity, m/s2.
const GRAVITY: f64 = 9.81;

pub(crate) const CASES: &[Case] = &[
    lake::LAKE_AT_REST,
    dam_break::STOKER,
    dam_break::RITTER,
    thacker::RADIAL,
    thacker::PLANAR,
    channel::BUMP,
    channel::MACDONALD,
    malpasset::MALPASSET,
    swashes::SWASHES,
    weather::RAIN_ON_A_PLANE,
    weather::INFILTRATION,
    weather::LEDGER,
    refinement::REFINEMENT,
    structures::STRUCTURES,
    structures::TIDE,
    isolated_building::ISOLATED_BUILDING,
    triangular_obstacle::TRIANGULAR_OBSTACLE,
    ea_test5::EA_TEST5,
    rough_terrain::ROUGH_TERRAIN,
    solids::CUBOID,
    solids::CYLINDER,
    voronoi::BLOCKS,
    voronoi::ISLANDS,
    voronoi::JACKSBORO,
    voronoi::STOKER,
    voronoi::RITTER,
    voronoi::PLANAR,
    voronoi::RADIAL,
    voronoi::WAVES,
    voronoi::VORTEX,
    voronoi::SHEETS,
    voronoi::RAIN,
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

/// Seed of where particles stand at the start.
const SEED: u64 = 1;

/// Water without friction with the given particle distance, at full size, in the given depth; its maps look two hundred times. Scheme balanced,
/// unless a case says otherwise.
fn settings(until_s: f64, spacing_m: f64, depth: f64, edges: Edges) -> Settings {
    Settings {
        scheme: Scheme::Balanced,
        spacing_m: Some(sized(spacing_m)),
        spacing_depth_m: Some(depth),
        gravity_m_per_s2: GRAVITY,
        manning: Manning::Number(0.0),
        map_every_s: Some(until_s / 200.0),
        edges,
        ..Settings::default()
    }
}

/// The spacing of settings, m, which every case gives.
fn spacing_of(settings: &Settings) -> f64 {
    settings.spacing_m.unwrap_or(1.0)
}

/// Edges of a strip: `ends` in the west and east, periodic across.
fn strip(ends: &Edge) -> Edges {
    Edges { west: ends.clone(), east: ends.clone(), south: Edge::Periodic, north: Edge::Periodic }
}

/// Water everywhere, with the given depth and velocity.
fn water_everywhere<'a>(
    bounds: Bounds,
    depth: impl Fn(f64, f64) -> f64 + Sync + 'a,
    velocity: impl Fn(f64, f64) -> [f64; 2] + Sync + 'a,
) -> InitialWater<'a> {
    InitialWater { depth: Box::new(depth), inside: Box::new(|_, _| true), within: bounds, velocity: Box::new(velocity) }
}

/// Sets up a flood and runs it to `time` s.
fn run(settings: &Settings, terrain: &Arc<Terrain>, water: &[InitialWater], time: f64) -> Result<Flood, ModelError> {
    let mut flood = ready(Flood::with_water(settings, SEED, Path::new("."), Arc::clone(terrain), water)?)?;
    flood.advance_to(time, &AtomicBool::new(false))?;
    Ok(flood)
}

/// A built-in scene of scheme sph-swe with changes of it, and its ground; at the reduced size particles are farther apart, and have as many
/// neighbours.
fn built_in(name: &str, changes: &[(&str, &str)]) -> Result<(Scene, Settings, Arc<Terrain>), ModelError> {
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
