//! From a scene to a model.

use crate::{Error, Simulation};
use corpuscle_flood::Flood;
use corpuscle_record::compare_extent;
use corpuscle_scene::{Flood as FloodSettings, ModelScene, Scene};
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
        match &mut scene.model {
            ModelScene::Flood(written) => {
                let terrain = Arc::new(Terrain::open(&written.terrain, scene.seed, folder)?);
                check_observed_extent(&written.flood, &terrain)?;
                let flood = Flood::new(&written.flood, scene.seed, folder, terrain.clone())?;
                written.flood = flood.settings().clone();
                Ok(Self::new(scene, Some(terrain), Box::new(flood)))
            }
            ModelScene::Gas(gas) => {
                let model = corpuscle_gas::open(gas, scene.seed, scene.run.until_s, folder)?;
                Ok(Self::new(scene, None, model))
            }
        }
    }
}

/// Finds out before the run, not at its end, that the observed extent cannot be used.
fn check_observed_extent(flood: &FloodSettings, terrain: &Terrain) -> Result<(), Error> {
    if let Some(observed) = &flood.observed_extent {
        let grid = terrain.map_grid();
        compare_extent(observed, terrain, &vec![f32::NAN; grid.columns * grid.rows])?;
    }
    Ok(())
}
