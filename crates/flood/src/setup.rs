//! From what a scene says to what the model needs.

use crate::error::setup;
use crate::extent::{check_inside, span};
use crate::gauges::{LineGauge, PointGauge};
use crate::obstacles::Outline;
use crate::zone::{Source, Zone};
use corpuscle_model::ModelError;
use corpuscle_scene::{Block, Flood, Gauge, Section};
use corpuscle_terrain::Terrain;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::path::Path;

/// Columns and rows of particles in each layer of a block.
pub(crate) fn lattice(block: &Block, terrain: &Terrain, spacing: f64) -> [f64; 2] {
    let [from, to] = [block.from, block.to].map(|corner| terrain.to_model(corner));
    [0, 1].map(|axis| ((to[axis] - from[axis]) / spacing).round().max(1.0))
}

pub(crate) fn sources(
    scene: &Flood,
    terrain: &Terrain,
    folder: &Path,
    spacing: f64,
) -> Result<Vec<Source>, ModelError> {
    let source = |inflow: &corpuscle_scene::Inflow| {
        let discharge = inflow.load_discharge(folder).map_err(setup)?;
        let largest = discharge.rows().iter().map(|row| row[1]).fold(0.0, f64::max);
        let positions: Vec<[f64; 2]> = match (&inflow.at, &inflow.line) {
            (Some(at), _) => vec![*at],
            (_, Some(line)) => line.clone(),
            (None, None) => Vec::new(),
        };
        check_inside(&format!("the inflow '{}'", inflow.name), &positions, terrain)?;
        let points: Vec<_> = positions.into_iter().map(|position| terrain.to_model(position)).collect();
        let zone = match points.as_slice() {
            [] => return Err(setup(format!("the inflow '{}' has neither a point nor a line", inflow.name))),
            [at] => Zone::at(*at, largest, spacing),
            _ => Zone::along(points, largest, spacing),
        };
        Ok(Source { zone, discharge, velocity: inflow.velocity_m_per_s })
    };
    scene.inflow.iter().map(source).collect()
}

pub(crate) fn point_gauges(scene: &Flood, terrain: &Terrain) -> Result<Vec<PointGauge>, ModelError> {
    let gauge = |gauge: &Gauge| {
        let at = match (gauge.at, gauge.lon_lat) {
            (Some(at), _) => terrain.to_model(at),
            (None, Some(lon_lat)) => terrain.from_lon_lat(lon_lat).map_err(setup)?,
            (None, None) => return Err(setup(format!("the gauge '{}' has no position", gauge.name))),
        };
        if !terrain.bounds().contains(at[0], at[1]) {
            return Err(setup(format!(
                "the gauge '{}' lies outside the terrain, which spans {}",
                gauge.name,
                span(terrain)
            )));
        }
        Ok(PointGauge { name: gauge.name.clone(), at })
    };
    scene.gauge.iter().map(gauge).collect()
}

/// Warnings of gauges that stand in obstacles over which no water goes, or where there is no ground.
pub(crate) fn warn_of_gauges(
    points: &[PointGauge],
    scene: &Flood,
    outlines: &[Outline],
    terrain: &Terrain,
) -> Vec<String> {
    let warning = |point: &PointGauge| {
        if !terrain.has_data_at(point.at[0], point.at[1]) {
            return Some(format!(
                "The gauge '{}' stands where the terrain has no data: there is no water there.",
                point.name
            ));
        }
        let outline = outlines.iter().find(|outline| outline.contains(point.at))?;
        let obstacle = scene.obstacle.get(outline.obstacle).filter(|obstacle| obstacle.height_m.is_none())?;
        let what =
            format!("The gauge '{}' stands in the obstacle '{}': there is no water there.", point.name, obstacle.name);
        Some(what)
    };
    points.iter().filter_map(warning).collect()
}

pub(crate) fn line_gauges(scene: &Flood, terrain: &Terrain, spacing: f64) -> Result<Vec<LineGauge>, ModelError> {
    let gauge = |section: &Section| {
        check_inside(&format!("the section '{}'", section.name), &section.line, terrain)?;
        let line: Vec<_> = section.line.iter().map(|&point| terrain.to_model(point)).collect();
        Ok(LineGauge::new(section.name.clone(), &line, 0.5 * spacing))
    };
    scene.section.iter().map(gauge).collect()
}

/// The random numbers of one purpose.
pub(crate) fn random(seed: u64, stream: u64) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(stream);
    random
}
