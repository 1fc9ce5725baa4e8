//! Water at the start, from a scene: by its depths, or for cells by what fills them.

mod filling;

pub(crate) use filling::of_scene;
pub use filling::{Filling, StartWater};

use crate::error::setup;
use crate::extent::span;
use crate::fields;
use crate::polygon::{is_inside, rectangle_round};
use corpuscle_model::ModelError;
use corpuscle_scene::{Flood, Water};
use corpuscle_terrain::{Bounds, RasterField, Terrain};
use std::path::Path;

/// Samples of the depth along each side of a body of water, from which its volume is computed.
const DEPTH_SAMPLES_PER_SIDE: usize = 200;

/// Water that is there at the start, as functions of the position in model coordinates.
pub struct InitialWater<'a> {
    /// Depth, m; 0 or less where there is none. Goes on beyond `inside` where it can: the rim of the body is then cut out
    /// of a larger arrangement and stands as close as its middle.
    pub depth: Box<dyn Fn(f64, f64) -> f64 + Sync + 'a>,
    /// Whether a position belongs to this body of water.
    pub inside: Box<dyn Fn(f64, f64) -> bool + Sync + 'a>,
    /// A rectangle round it.
    pub within: Bounds,
    /// Velocity, m/s.
    pub velocity: Box<dyn Fn(f64, f64) -> [f64; 2] + Sync + 'a>,
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

impl InitialWater<'_> {
    /// Area of the rectangle round it within bounds, m2.
    pub(crate) fn area(&self, bounds: Bounds) -> f64 {
        let east = self.within.x_max.min(bounds.x_max) - self.within.x_min.max(bounds.x_min);
        east * (self.within.y_max.min(bounds.y_max) - self.within.y_min.max(bounds.y_min))
    }

    /// About how much water it holds, m3.
    pub(crate) fn volume(&self, bounds: Bounds) -> f64 {
        let low = [self.within.x_min.max(bounds.x_min), self.within.y_min.max(bounds.y_min)];
        let high = [self.within.x_max.min(bounds.x_max), self.within.y_max.min(bounds.y_max)];
        let part = [0, 1].map(|axis| (high[axis] - low[axis]) / DEPTH_SAMPLES_PER_SIDE as f64);
        let at = |axis: usize, sample: usize| low[axis] + (sample as f64 + 0.5) * part[axis];
        let positions = (0..DEPTH_SAMPLES_PER_SIDE * DEPTH_SAMPLES_PER_SIDE)
            .map(|sample| [at(0, sample % DEPTH_SAMPLES_PER_SIDE), at(1, sample / DEPTH_SAMPLES_PER_SIDE)]);
        let depths = positions.filter(|[x, y]| (self.inside)(*x, *y)).map(|[x, y]| (self.depth)(x, y).max(0.0));
        depths.sum::<f64>() * part[0] * part[1]
    }
}

/// The mean depth of the water at the start over the positions it covers, m; none where there is no water.
pub(crate) fn mean_depth(bodies: &[InitialWater], terrain: &Terrain) -> Option<f64> {
    let grid = terrain.map_grid();
    let (mut sum, mut count) = (0.0, 0_u32);
    for row in 0..grid.rows {
        for column in 0..grid.columns {
            let [x, y] = grid.centre(column, row);
            for body in bodies {
                if (body.inside)(x, y) && (body.depth)(x, y) > 0.0 {
                    sum += (body.depth)(x, y);
                    count += 1;
                }
            }
        }
    }
    (count > 0).then(|| sum / f64::from(count))
}

/// How close particles of `volume` m3 stand where the water at the start is deepest, at most `spacing`, m.
pub(crate) fn closest(bodies: &[InitialWater], terrain: &Terrain, spacing: f64, volume: f64) -> f64 {
    let grid = terrain.map_grid();
    let cells = (0..grid.rows).flat_map(|row| (0..grid.columns).map(move |column| (column, row)));
    let depth = |(column, row)| {
        let [x, y] = grid.centre(column, row);
        let depths = bodies.iter().filter(|body| (body.inside)(x, y)).map(|body| (body.depth)(x, y));
        depths.fold(0.0, f64::max)
    };
    let deepest = cells.map(depth).fold(0.0, f64::max);
    if deepest > 0.0 { (volume / deepest).sqrt().min(spacing) } else { spacing }
}
