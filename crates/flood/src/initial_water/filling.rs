//! Water at the start by what fills cells: a depth or a level, inside a polygon.

use crate::error::setup;
use crate::fields::{self, OfPosition};
use crate::polygon::is_inside;
use corpuscle_model::ModelError;
use corpuscle_scene::{Flood, Water};
use corpuscle_terrain::{RasterField, Terrain};
use std::path::Path;

/// How much water there is.
pub enum Filling<'a> {
    /// Depth, m; a cell holds its mean times the cell's area.
    Depth(OfPosition<'a, f64>),
    /// Level, m; a cell holds its mean less the mean ground, so that a level lake is level.
    Level(OfPosition<'a, f64>),
}

/// Water that is there at the start.
pub struct StartWater<'a> {
    /// How much.
    pub filling: Filling<'a>,
    /// Only inside this polygon of corners in model coordinates, m: a cell that it cuts holds the part inside. None: everywhere.
    pub polygon: Option<Vec<[f64; 2]>>,
    /// Velocity `[east, north]`, m/s.
    pub velocity: OfPosition<'a, [f64; 2]>,
}

/// The bodies of water that a scene fills at the start (blocks in the air apart).
pub(crate) fn of_scene<'a>(
    scene: &Flood,
    terrain: &'a Terrain,
    folder: &Path,
) -> Result<Vec<StartWater<'a>>, ModelError> {
    fields::check(scene, terrain)?;
    let standing = scene.water.iter().enumerate().filter(|(_, water)| water.block.is_none());
    standing.map(|(number, water)| body(water, number, terrain, folder)).collect()
}

fn body<'a>(water: &Water, number: usize, terrain: &'a Terrain, folder: &Path) -> Result<StartWater<'a>, ModelError> {
    let filling = if let Some(level) = &water.level_m {
        Filling::Level(fields::of_position(level, terrain))
    } else if let Some(depth) = &water.depth_m {
        Filling::Depth(fields::of_position(depth, terrain))
    } else if let Some(path) = &water.depth_raster {
        let raster = RasterField::open(folder.join(path), terrain).map_err(setup)?;
        Filling::Depth(Box::new(move |x, y| raster.bilinear(x, y).filter(|depth| depth.is_finite()).unwrap_or(0.0)))
    } else {
        return Err(setup(format!("flood.water.{number} says neither level, depth, raster nor block")));
    };
    let corners = |polygon: &Vec<[f64; 2]>| polygon.iter().map(|&corner| terrain.to_model(corner)).collect();
    let velocity = fields::velocity(&water.velocity_m_per_s, terrain, folder)?;
    Ok(StartWater { filling, polygon: water.polygon.as_ref().map(corners), velocity })
}

impl StartWater<'_> {
    /// Whether there may be water near a position: in a cell about `reach` m wide round it.
    pub(crate) fn may_be_at(&self, [x, y]: [f64; 2], ground: f64, reach: f64) -> bool {
        if let Some(polygon) = &self.polygon
            && !is_inside(polygon, x, y)
            && distance_to(polygon, [x, y]) > reach
        {
            return false;
        }
        match &self.filling {
            Filling::Depth(depth) => depth(x, y) > 0.0,
            Filling::Level(level) => level(x, y) > ground,
        }
    }
}

/// Distance of a position from the outline of a polygon, m.
fn distance_to(polygon: &[[f64; 2]], [x, y]: [f64; 2]) -> f64 {
    let from_side = |k: usize| {
        let [a, b] = [polygon[k], polygon[(k + 1) % polygon.len()]];
        let along = [b[0] - a[0], b[1] - a[1]];
        let to = [x - a[0], y - a[1]];
        let part = (to[0] * along[0] + to[1] * along[1]) / (along[0] * along[0] + along[1] * along[1]).max(1e-300);
        let part = part.clamp(0.0, 1.0);
        (to[0] - part * along[0]).hypot(to[1] - part * along[1])
    };
    (0..polygon.len()).map(from_side).fold(f64::INFINITY, f64::min)
}
