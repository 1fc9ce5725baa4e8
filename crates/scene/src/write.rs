//! From a scene to text.

use crate::dew::{Dew, Shape};
use crate::{
    Edge, FloodScene, Gas, Manning, ModelScene, Motion, Scene, SceneError, Series, StartVelocity, Terrain, Wall,
};
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
        // The folder of `scene.toml` alone is empty, which `absolute` refuses.
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        // Where the current folder is gone the path stays relative, and opening the file says so.
        let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
        let paths = match &mut self.model {
            ModelScene::Flood(scene) => flood_paths(scene),
            ModelScene::Gas(gas) => gas_paths(gas),
            ModelScene::Dew(dew) => dew_paths(dew),
        };
        for path in paths {
            *path = folder.join(&*path);
        }
    }
}

fn flood_paths(scene: &mut FloodScene) -> Vec<&mut PathBuf> {
    let FloodScene { terrain, flood } = scene;
    let mut paths = Vec::new();
    match terrain {
        Terrain::File(file) => paths.push(&mut file.path),
        Terrain::Tiles(tiles) => paths.extend(&mut tiles.paths),
        _ => {}
    }
    if let Manning::Raster { raster } = &mut flood.manning {
        paths.push(raster);
    }
    let edges = [&mut flood.edges.west, &mut flood.edges.east, &mut flood.edges.south, &mut flood.edges.north];
    let parts = flood.edge_part.iter_mut().map(|part| &mut part.edge);
    let lines = flood.edge_line.iter_mut().map(|line| &mut line.edge);
    for edge in edges.into_iter().chain(parts).chain(lines) {
        let series = match edge {
            Edge::Stage(series) | Edge::Discharge(series) | Edge::Paddle(series) => [Some(series), None],
            Edge::Wave(wave) => [wave.level_m.as_mut(), wave.velocity_m_per_s.as_mut()],
            Edge::Open | Edge::Wall | Edge::Periodic | Edge::NormalDepth(_) | Edge::Rating(_) => [None, None],
        };
        for series in series.into_iter().flatten() {
            if let Series::File { csv, .. } = series {
                paths.push(csv);
            }
        }
    }
    paths.extend(flood.finer.iter_mut().filter_map(|finer| finer.file.as_mut()));
    for inflow in &mut flood.inflow {
        if let Series::File { csv, .. } = &mut inflow.discharge_m3_per_s {
            paths.push(csv);
        }
    }
    for water in &mut flood.water {
        paths.extend(&mut water.depth_raster);
        if let StartVelocity::Rasters(rasters) = &mut water.velocity_m_per_s {
            paths.extend([&mut rasters.east, &mut rasters.north]);
        }
    }
    for stage in &mut flood.stage {
        if let Series::File { csv, .. } = &mut stage.level_m {
            paths.push(csv);
        }
    }
    if let Some(rain) = &mut flood.rain {
        if let Series::File { csv, .. } = &mut rain.intensity_mm_per_h {
            paths.push(csv);
        }
        paths.extend(rain.raster.as_mut());
    }
    paths.extend(flood.obstacle.iter_mut().filter_map(|obstacle| obstacle.file.as_mut()));
    paths.extend(flood.land_use.as_mut().map(|land_use| &mut land_use.raster));
    paths.extend(flood.observed_extent.as_mut());
    paths
}

fn gas_paths(gas: &mut Gas) -> Vec<&mut PathBuf> {
    let walls = &mut gas.walls;
    let always = [&mut walls.x_min, &mut walls.x_max, &mut walls.y_min, &mut walls.y_max];
    let all = always.into_iter().chain(walls.z_min.as_mut()).chain(walls.z_max.as_mut());
    all.filter_map(|wall| match wall {
        Wall::Motion(Motion::Displacement(Series::File { csv, .. })) => Some(csv),
        _ => None,
    })
    .collect()
}

fn dew_paths(dew: &mut Dew) -> Vec<&mut PathBuf> {
    let mut paths = Vec::new();
    for solid in &mut dew.solid {
        if let Shape::Mesh(mesh) = &mut solid.shape {
            paths.push(&mut mesh.path);
        }
        if let Series::File { csv, .. } = &mut solid.temperature_c {
            paths.push(csv);
        }
    }
    paths
}
