//! A flood and the ground that it runs over: what a flood adds to a scene.

use super::{Edge, Flood, Manning, StartVelocity};
use crate::check::{Check, Checked};
use crate::model::{ReadError, Tables};
use crate::{ModelScene, Problem, Run, Series, Terrain};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A flood and the ground that it runs over.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FloodScene {
    /// The ground.
    pub terrain: Terrain,
    /// The flood model.
    pub flood: Flood,
}

const GROUND: &str = " is missing: give the ground, as in [terrain.file] with path = \"dem.tif\", or one of [terrain.tiles], \
                      [terrain.fetch], [terrain.valley], [terrain.rough-hills], [terrain.plane], [terrain.bump], [terrain.bowl]";
const WATER: &str = " is missing: give a table [flood] with spacing_m and the water of the scene";

impl ModelScene for FloodScene {
    const NAME: &'static str = "flood";
    const TABLES: &'static [&'static str] = &["terrain", "flood"];

    fn read(tables: &mut Tables<'_>) -> Result<Self, ReadError> {
        for (name, what) in [("terrain", GROUND), ("flood", WATER)] {
            if !tables.has(name) {
                return Err(ReadError::Problem(Problem::new(name, what)));
            }
        }
        Ok(Self { terrain: tables.read("terrain")?, flood: tables.read("flood")? })
    }

    fn tables(&self) -> Vec<&dyn erased_serde::Serialize> {
        vec![&self.terrain, &self.flood]
    }

    fn check(&self, check: &Check) -> Checked {
        check.terrain(&self.terrain)?;
        check.flood(&self.flood)
    }

    fn resolve_defaults(&mut self, run: &Run) {
        self.flood.map_every_s.get_or_insert(run.gauge_period_s());
    }

    fn paths(&mut self) -> Vec<&mut PathBuf> {
        let Self { terrain, flood } = self;
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
}
