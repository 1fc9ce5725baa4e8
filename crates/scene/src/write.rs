//! From a scene to text.

use crate::{Edge, Manning, Scene, SceneError, Series, Terrain};
use std::path::{Path, PathBuf};

impl Scene {
    /// The scene as TOML with everything written out; reading it again gives an equal scene.
    ///
    /// # Errors
    /// [`SceneError::Unwritable`] where a path is not Unicode or the seed is beyond TOML's integers.
    pub fn to_toml(&self) -> Result<String, SceneError> {
        toml::to_string(self).map_err(|error| SceneError::Unwritable(error.to_string()))
    }

    /// Makes every path absolute; relative ones are taken from `folder`, the folder of the scene's file.
    pub fn resolve_paths(&mut self, folder: &Path) {
        // Where the current folder is gone the path stays relative, and opening the file says so.
        let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
        for path in self.paths() {
            *path = folder.join(&*path);
        }
    }

    /// Every path in the scene.
    fn paths(&mut self) -> Vec<&mut PathBuf> {
        let flood = &mut self.flood;
        let mut paths = Vec::new();
        if let Terrain::File(file) = &mut self.terrain {
            paths.push(&mut file.path);
        }
        if let Manning::Raster { raster } = &mut flood.manning {
            paths.push(raster);
        }
        let edges = [&mut flood.edges.west, &mut flood.edges.east, &mut flood.edges.south, &mut flood.edges.north];
        for edge in edges {
            if let Edge::Stage(Series::File { csv }) = edge {
                paths.push(csv);
            }
        }
        for inflow in &mut flood.inflow {
            if let Series::File { csv } = &mut inflow.discharge_m3_per_s {
                paths.push(csv);
            }
        }
        paths.extend(flood.water.iter_mut().filter_map(|water| water.depth_raster.as_mut()));
        paths.extend(flood.observed_extent.as_mut());
        paths
    }
}
