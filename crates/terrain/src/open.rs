//! The ground of a scene.

use crate::TerrainError;
use crate::files::read_rasters;
use crate::generated;
use crate::terrain::Terrain;
use std::path::Path;

impl Terrain {
    /// The ground of a scene. `seed` makes generated ground, `folder` is what a relative path refers to.
    ///
    /// # Errors
    /// A text that says what is wrong with the file or with the numbers of a generated terrain;
    /// [`TerrainError::NotFetched`] for one that comes over a network, which this crate does not access.
    pub fn open(scene: &corpuscle_scene::Terrain, seed: u64, folder: &Path) -> Result<Self, TerrainError> {
        match scene {
            corpuscle_scene::Terrain::File(scene) => {
                let path = folder.join(&scene.path);
                let raster = read_rasters(std::slice::from_ref(&path), scene.crs.as_deref(), None)?;
                Self::from_raster(raster, &path, scene.no_data)
            }
            corpuscle_scene::Terrain::Tiles(scene) => {
                let paths: Vec<_> = scene.paths.iter().map(|path| folder.join(path)).collect();
                let raster = read_rasters(&paths, scene.crs.as_deref(), None)?;
                Self::from_raster(raster, &paths[0], scene.no_data)
            }
            corpuscle_scene::Terrain::Fetch(_) => Err(TerrainError::NotFetched),
            corpuscle_scene::Terrain::Valley(scene) => generated::valley(scene, seed),
            corpuscle_scene::Terrain::RoughHills(scene) => generated::rough_hills(scene, seed),
            corpuscle_scene::Terrain::Plane(scene) => generated::plane(scene),
            corpuscle_scene::Terrain::Bump(scene) => generated::bump(scene),
            corpuscle_scene::Terrain::Bowl(scene) => generated::bowl(scene),
        }
    }
}
