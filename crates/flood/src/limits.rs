//! Limits of scenes: no more particles than fit in memory, and no deeper water than there is.

use crate::error::setup;
use crate::extent::check_inside;
use crate::initial_water::{InitialWater, initial_water};
use crate::setup::lattice;
use corpuscle_model::ModelError;
use corpuscle_scene::Flood;
use corpuscle_terrain::Terrain;
use std::path::Path;

/// More particles than this do not fit in the memory of usual machines.
const MOST_PARTICLES: f64 = 2e8;

/// Particles of scheme voronoi were all the terrain wet: there is a list of tiles, about 1000 particles each.
const MOST_CELLS_OF_TERRAIN: f64 = 1e11;

/// Water is not deeper than this on average, m: nine times the deepest sea.
const MOST_DEPTH: f64 = 1e5;

/// Refuses bodies of water and blocks that would take too many particles of `volume` m3, `spacing` m apart in blocks.
pub(crate) fn check_count(
    scene: &Flood,
    bodies: &[InitialWater],
    terrain: &Terrain,
    spacing: f64,
    volume: f64,
) -> Result<(), ModelError> {
    let standing: f64 = bodies.iter().map(|body| body.volume(terrain.bounds()) / volume).sum();
    check_particles(standing + falling(scene, terrain, spacing))
}

fn check_particles(count: f64) -> Result<(), ModelError> {
    if count <= MOST_PARTICLES {
        return Ok(());
    }
    Err(setup(format!(
        "the water at the start would take about {count:.1e} particles, more than the {MOST_PARTICLES:.0e} that fit in memory; \
         take a larger flood.spacing_m, or less water ([[flood.water]])",
    )))
}

/// Particles of the blocks in the air.
fn falling(scene: &Flood, terrain: &Terrain, spacing: f64) -> f64 {
    let blocks = scene.water.iter().filter_map(|water| water.block.as_ref());
    let particles = blocks.map(|block| {
        let [columns, rows] = lattice(block, terrain, spacing);
        columns * rows * block.layers as f64
    });
    particles.sum()
}

/// Refuses particles of scheme voronoi so close that not even the list of where they might come to be fits in memory.
pub(crate) fn check_cells(scene: &Flood, terrain: &Terrain) -> Result<(), ModelError> {
    let [east, north] = terrain.bounds().size();
    let count = scene.spacing_m.map_or(0.0, |spacing| east * north / spacing.powi(2));
    if count <= MOST_CELLS_OF_TERRAIN {
        return Ok(());
    }
    Err(setup(format!(
        "all of the terrain under water would be {count:.1e} particles, and at most {MOST_CELLS_OF_TERRAIN:.0e} are possible; take a larger \
         flood.spacing_m"
    )))
}

/// Refuses water at the start that is deeper than any on Earth: where particles do not hold a volume each, no count of them does.
pub(crate) fn check_depths(scene: &Flood, terrain: &Terrain, folder: &Path) -> Result<(), ModelError> {
    // Rasters are data, and reading them takes its time.
    let mut written = scene.clone();
    written.water.retain(|water| water.depth_raster.is_none());
    for body in initial_water(&written, terrain, folder)? {
        let mean = body.volume(terrain.bounds()) / body.area(terrain.bounds());
        if mean > MOST_DEPTH {
            return Err(setup(format!(
                "the water at the start would be {mean:.1e} m deep, and at most {MOST_DEPTH:.0e} m are possible; check level_m and depth_m of \
                 [[flood.water]], which are in m"
            )));
        }
    }
    Ok(())
}

/// Refuses blocks that reach beyond the terrain, where there is no ground for them to fall onto, and those of too many particles.
pub(crate) fn check_blocks(scene: &Flood, terrain: &Terrain) -> Result<(), ModelError> {
    for (number, water) in scene.water.iter().enumerate() {
        let Some(block) = &water.block else { continue };
        check_inside(&format!("flood.water.{number}.block"), &[block.from, block.to], terrain)?;
    }
    scene.spacing_m.map_or(Ok(()), |spacing| check_particles(falling(scene, terrain, spacing)))
}
