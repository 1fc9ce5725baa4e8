//! What a scene says of the water at the start as functions of the position in model coordinates, m: numbers, expressions, rasters.

use crate::error::setup;
use crate::polygon::is_inside;
use corpuscle_model::ModelError;
use corpuscle_scene::{Field, Flood, StartVelocity, Water};
use corpuscle_terrain::{RasterField, Terrain};
use std::path::Path;

/// A function of the position in model coordinates, m.
pub type OfPosition<'a, T> = Box<dyn Fn(f64, f64) -> T + Sync + 'a>;

/// An expression is tried in so many positions at most.
const MOST_TRIALS: usize = 250_000;

/// A number, or an expression, which takes the terrain's own coordinates.
pub(crate) fn of_position<'a>(field: &Field, terrain: &'a Terrain) -> OfPosition<'a, f64> {
    match field.clone() {
        Field::Number(number) => Box::new(move |_, _| number),
        Field::Expression(expression) => Box::new(move |x, y| {
            let [x, y] = terrain.to_own([x, y]);
            expression.at(x, y)
        }),
    }
}

/// Velocity at the start `[east, north]`, m/s; 0 where rasters have no data.
pub(crate) fn velocity<'a>(
    velocity: &StartVelocity,
    terrain: &'a Terrain,
    folder: &Path,
) -> Result<OfPosition<'a, [f64; 2]>, ModelError> {
    let rasters = match velocity {
        StartVelocity::Components(components) => return Ok(of_components(components, terrain)),
        StartVelocity::Rasters(rasters) => rasters,
    };
    let open = |path: &Path| RasterField::open(folder.join(path), terrain).map_err(setup);
    let [east, north] = [open(&rasters.east)?, open(&rasters.north)?];
    Ok(Box::new(move |x, y| {
        [&east, &north].map(|raster| raster.bilinear(x, y).filter(|value| value.is_finite()).unwrap_or(0.0))
    }))
}

fn of_components<'a>(components: &[Field; 2], terrain: &'a Terrain) -> OfPosition<'a, [f64; 2]> {
    let [east, north] = [0, 1].map(|axis| of_position(&components[axis], terrain));
    Box::new(move |x, y| [east(x, y), north(x, y)])
}

/// Velocity at the start of a block in the air, m/s; it has no rasters.
pub(crate) fn block_velocity<'a>(velocity: &StartVelocity, terrain: &'a Terrain) -> OfPosition<'a, [f64; 2]> {
    match velocity {
        StartVelocity::Components(components) => of_components(components, terrain),
        StartVelocity::Rasters(_) => Box::new(|_, _| [0.0; 2]),
    }
}

/// Refuses expressions that are not a finite number somewhere: at the centres of the terrain's cells, or of some of them, inside the body's polygon.
pub(crate) fn check(scene: &Flood, terrain: &Terrain) -> Result<(), ModelError> {
    let bodies = scene.water.iter().enumerate();
    bodies.into_iter().try_for_each(|(number, water)| check_body(&format!("flood.water.{number}"), water, terrain))
}

fn check_body(key: &str, water: &Water, terrain: &Terrain) -> Result<(), ModelError> {
    let components = match &water.velocity_m_per_s {
        StartVelocity::Components(components) => components.as_slice(),
        StartVelocity::Rasters(_) => &[],
    };
    let velocity = components.iter().enumerate().map(|(axis, field)| (format!("velocity_m_per_s.{axis}"), field));
    let amounts = [("level_m", &water.level_m), ("depth_m", &water.depth_m)];
    let amounts = amounts.into_iter().filter_map(|(name, field)| Some((name.to_owned(), field.as_ref()?)));
    for (name, field) in amounts.chain(velocity) {
        let Field::Expression(expression) = field else { continue };
        if let Some([x, y]) = first_not_finite(field, water, terrain) {
            return Err(setup(format!(
                "{key}.{name} = \"{expression}\" is not a finite number at [{x}, {y}]: limit it there, as in max(0, ...), or give a polygon \
                 without that position"
            )));
        }
    }
    Ok(())
}

/// The first position, in the terrain's own coordinates, at which a field is not a finite number.
fn first_not_finite(field: &Field, water: &Water, terrain: &Terrain) -> Option<[f64; 2]> {
    let polygon: Option<Vec<[f64; 2]>> =
        water.polygon.as_ref().map(|polygon| polygon.iter().map(|&corner| terrain.to_model(corner)).collect());
    let grid = terrain.map_grid();
    let stride = ((grid.columns * grid.rows) as f64 / MOST_TRIALS as f64).sqrt().ceil().max(1.0) as usize;
    let rows = (0..grid.rows).step_by(stride);
    let mut centres =
        rows.flat_map(|row| (0..grid.columns).step_by(stride).map(move |column| grid.centre(column, row)));
    centres.find_map(|[x, y]| {
        let is_in = polygon.as_ref().is_none_or(|polygon| is_inside(polygon, x, y));
        let own = terrain.to_own([x, y]);
        (is_in && !field.at(own[0], own[1]).is_finite()).then_some(own)
    })
}
