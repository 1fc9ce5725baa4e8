//! The terrain of a flood.

use crate::Error;
use corpuscle_terrain::Terrain;
use std::path::Path;

/// The terrain of a scene; that of `[terrain.fetch]` from the cache, or over the network at first use.
pub(crate) fn ground(scene: &corpuscle_scene::Terrain, seed: u64, folder: &Path) -> Result<Terrain, Error> {
    #[cfg(feature = "fetch")]
    if let corpuscle_scene::Terrain::Fetch(scene) = scene {
        let fetched = fetched(scene, &corpuscle_fetch::FetchObserver::none())?;
        return Ok(Terrain::from_raster(fetched.raster, Path::new("Copernicus GLO-30"), scene.no_data)?);
    }
    Ok(Terrain::open(scene, seed, folder)?)
}

/// Downloads the terrain of a scene that has `[terrain.fetch]` into the cache, so that opening it needs no network; returns
/// the bytes downloaded. Nothing happens for other scenes.
///
/// # Errors
/// [`Error::Fetch`], for which see there.
#[cfg(feature = "fetch")]
pub fn fetch_terrain(scene: &corpuscle_scene::Scene, observer: &corpuscle_fetch::FetchObserver) -> Result<u64, Error> {
    match scene.flood().map(|scene| &scene.terrain) {
        Some(corpuscle_scene::Terrain::Fetch(scene)) => Ok(fetched(scene, observer)?.bytes),
        _ => Ok(0),
    }
}

#[cfg(feature = "fetch")]
fn fetched(
    scene: &corpuscle_scene::TerrainFetch,
    observer: &corpuscle_fetch::FetchObserver,
) -> Result<corpuscle_fetch::Fetched, Error> {
    let part = corpuscle_terrain::MapBox::new(scene.bbox).map_err(corpuscle_fetch::FetchError::Box)?;
    Ok(corpuscle_fetch::fetch(&corpuscle_fetch::Source::from_environment()?, &part, observer)?)
}
