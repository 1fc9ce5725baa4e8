//! From what a scene says to what the model needs.

use crate::fields;
use crate::gauges::{LineGauge, PointGauge};
use crate::limits::{check_inside, span};
use crate::obstacles::Outline;
use crate::zone::{Source, Zone};
use corpuscle_model::ModelError;
use corpuscle_scene::{Block, Flood, Gauge, Section, Series, Table, Water};
use corpuscle_terrain::{Bounds, RasterField, Terrain};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::path::Path;

/// Water that is there at the start, as functions of the place in model coordinates.
pub struct InitialWater<'a> {
    /// Depth, m; 0 or less where there is none. Goes on beyond `inside` where it can: the rim of the body is then cut out
    /// of a larger arrangement and stands as close as its middle.
    pub depth: Box<dyn Fn(f64, f64) -> f64 + Sync + 'a>,
    /// Whether a place belongs to this body of water.
    pub inside: Box<dyn Fn(f64, f64) -> bool + Sync + 'a>,
    /// A rectangle round it.
    pub within: Bounds,
    /// Velocity, m/s.
    pub velocity: Box<dyn Fn(f64, f64) -> [f64; 2] + Sync + 'a>,
}

pub(crate) fn setup(text: impl std::fmt::Display) -> ModelError {
    ModelError::Setup(text.to_string())
}

pub(crate) fn load(series: &Series, folder: &Path) -> Result<Table, ModelError> {
    series.load(folder).map_err(setup)
}

/// The bodies of water that a scene fills at the start (blocks in the air apart).
pub(crate) fn initial_water<'a>(
    scene: &Flood,
    terrain: &'a Terrain,
    folder: &Path,
) -> Result<Vec<InitialWater<'a>>, ModelError> {
    fields::check(scene, terrain)?;
    let standing = scene.water.iter().enumerate().filter(|(_, water)| water.block.is_none());
    standing.map(|(number, water)| body(water, number, terrain, folder)).collect()
}

fn body<'a>(water: &Water, number: usize, terrain: &'a Terrain, folder: &Path) -> Result<InitialWater<'a>, ModelError> {
    let depth: Box<dyn Fn(f64, f64) -> f64 + Sync + 'a> = if let Some(level) = &water.level_m {
        let level = fields::of_position(level, terrain);
        Box::new(move |x, y| level(x, y) - terrain.height_once(x, y))
    } else if let Some(depth) = &water.depth_m {
        fields::of_position(depth, terrain)
    } else if let Some(path) = &water.depth_raster {
        let raster = RasterField::open(folder.join(path), terrain).map_err(setup)?;
        Box::new(move |x, y| raster.bilinear(x, y).unwrap_or(0.0))
    } else {
        return Err(setup(format!("flood.water.{number} says neither level, depth, raster nor block")));
    };
    let bounds = terrain.bounds();
    let velocity = fields::velocity(&water.velocity_m_per_s, terrain, folder)?;
    let Some(polygon) = &water.polygon else {
        return Ok(InitialWater { depth, inside: Box::new(|_, _| true), within: bounds, velocity });
    };
    let polygon: Vec<[f64; 2]> = polygon.iter().map(|&corner| terrain.to_model(corner)).collect();
    let within = rectangle_round(&polygon);
    let apart = within.x_max < bounds.x_min
        || within.x_min > bounds.x_max
        || within.y_max < bounds.y_min
        || within.y_min > bounds.y_max;
    if apart {
        return Err(setup(format!(
            "flood.water.{number}.polygon lies wholly outside the terrain, which spans {}: give its corners in the \
             terrain's own coordinates",
            span(terrain)
        )));
    }
    Ok(InitialWater { depth, inside: Box::new(move |x, y| is_inside(&polygon, x, y)), within, velocity })
}

fn rectangle_round(polygon: &[[f64; 2]]) -> Bounds {
    let start = Bounds { x_min: f64::INFINITY, x_max: -f64::INFINITY, y_min: f64::INFINITY, y_max: -f64::INFINITY };
    polygon.iter().fold(start, |b, &[x, y]| Bounds {
        x_min: b.x_min.min(x),
        x_max: b.x_max.max(x),
        y_min: b.y_min.min(y),
        y_max: b.y_max.max(y),
    })
}

/// Whether a polygon holds a place: an odd number of sides crosses the ray eastwards.
pub(crate) fn is_inside(polygon: &[[f64; 2]], x: f64, y: f64) -> bool {
    let mut inside = false;
    let mut before = polygon[polygon.len() - 1];
    for &corner in polygon {
        let [[x0, y0], [x1, y1]] = [before, corner];
        if (y0 > y) != (y1 > y) && x < x0 + (y - y0) / (y1 - y0) * (x1 - x0) {
            inside = !inside;
        }
        before = corner;
    }
    inside
}

/// The mean depth of the water at the start over the places it covers, m; none where there is no water.
pub(crate) fn mean_depth(bodies: &[InitialWater], terrain: &Terrain) -> Option<f64> {
    let grid = terrain.map_grid();
    let (mut sum, mut places) = (0.0, 0_u32);
    for row in 0..grid.rows {
        for column in 0..grid.columns {
            let [x, y] = grid.centre(column, row);
            for body in bodies {
                if (body.inside)(x, y) && (body.depth)(x, y) > 0.0 {
                    sum += (body.depth)(x, y);
                    places += 1;
                }
            }
        }
    }
    (places > 0).then(|| sum / f64::from(places))
}

/// How close particles of `volume` m3 stand where the water at the start is deepest, at most `spacing`, m.
pub(crate) fn closest(bodies: &[InitialWater], terrain: &Terrain, spacing: f64, volume: f64) -> f64 {
    let grid = terrain.map_grid();
    let places = (0..grid.rows).flat_map(|row| (0..grid.columns).map(move |column| (column, row)));
    let depth = |(column, row)| {
        let [x, y] = grid.centre(column, row);
        let depths = bodies.iter().filter(|body| (body.inside)(x, y)).map(|body| (body.depth)(x, y));
        depths.fold(0.0, f64::max)
    };
    let deepest = places.map(depth).fold(0.0, f64::max);
    if deepest > 0.0 { (volume / deepest).sqrt().min(spacing) } else { spacing }
}

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
        let places: Vec<[f64; 2]> = match (&inflow.at, &inflow.line) {
            (Some(at), _) => vec![*at],
            (_, Some(line)) => line.clone(),
            (None, None) => Vec::new(),
        };
        check_inside(&format!("the inflow '{}'", inflow.name), &places, terrain)?;
        let points: Vec<_> = places.into_iter().map(|place| terrain.to_model(place)).collect();
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
            (None, None) => return Err(setup(format!("the gauge '{}' has no place", gauge.name))),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polygon_holds_its_inside_and_not_its_bay() {
        let polygon = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [5.0, 4.0], [0.0, 10.0]];
        assert!(is_inside(&polygon, 2.0, 2.0));
        assert!(is_inside(&polygon, 9.0, 8.0));
        assert!(!is_inside(&polygon, 5.0, 6.0));
        assert!(!is_inside(&polygon, -1.0, 2.0));
    }
}
