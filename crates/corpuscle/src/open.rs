//! From a scene to a model.

use crate::{Error, Simulation};
use corpuscle_flood::Flood;
use corpuscle_record::compare_extent;
use corpuscle_scene::Scene;
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;

impl Simulation {
    /// Makes a scene ready to run: reads its ground and sets up its model. Relative paths are taken from `folder`.
    ///
    /// # Errors
    /// Where the scene, its ground or a file that it names cannot be used.
    pub fn open(mut scene: Scene, folder: &Path) -> Result<Self, Error> {
        scene.check()?;
        scene.resolve_paths(folder);
        scene.resolve_defaults();
        let terrain = Arc::new(Terrain::open(&scene.terrain, scene.seed, folder)?);
        check_observed_extent(&scene, &terrain)?;
        let flood = Flood::new(&scene, folder, terrain.clone())?;
        let scene = flood.resolved_scene().clone();
        Ok(Self::new(scene, terrain, Box::new(flood)))
    }
}

/// Finds out before the run, not at its end, that the observed extent cannot be used.
fn check_observed_extent(scene: &Scene, terrain: &Terrain) -> Result<(), Error> {
    if let Some(observed) = &scene.flood.observed_extent {
        let grid = terrain.map_grid();
        compare_extent(observed, terrain, &vec![f32::NAN; grid.columns * grid.rows])?;
    }
    Ok(())
}
