//! The flooded extent: polygons of the wet cells, and how they compare with what was observed.

mod observed;
mod outline;
mod run_up;

pub use observed::{ExtentScores, compare_extent};
pub use run_up::write_run_up;

use crate::OutputError;
use crate::whole::write_whole;
use corpuscle_terrain::Terrain;
use outline::{Outline, outlines};
use serde_json::{Value, json};
use std::io::Write;
use std::path::Path;

/// Writes the wet cells of `max_depth` (a value for each cell of the terrain's map grid, not-a-number where dry) as
/// GeoJSON: one MultiPolygon with holes along the outlines of the cells. In longitude and latitude on WGS 84 as RFC
/// 7946 asks; a terrain without reference system gives its own coordinates, and a note in the file says so.
///
/// # Errors
/// [`OutputError::Write`].
pub fn write_extent(path: &Path, terrain: &Terrain, max_depth: &[f32]) -> Result<(), OutputError> {
    let grid = terrain.map_grid();
    let wet: Vec<bool> = max_depth.iter().map(|depth| !depth.is_nan()).collect();
    let outlines = outlines(&wet, grid.columns, grid.rows);
    let with_system = has_system(terrain);
    let position = |vertex: [usize; 2]| position_of(terrain, vertex, with_system);
    let polygons: Vec<Value> = outlines.iter().map(|outline| polygon(outline, position)).collect();
    let mut properties = json!({
        "name": "flooded extent",
        "area_m2": wet_area(terrain, &wet),
    });
    note_of_system(&mut properties, with_system);
    let collection = feature_collection(&properties, &json!({ "type": "MultiPolygon", "coordinates": polygons }));
    write_whole(path, |file| writeln!(file, "{collection}"))
}

/// A GeoJSON collection of one feature.
fn feature_collection(properties: &Value, geometry: &Value) -> Value {
    let feature = json!({ "type": "Feature", "properties": properties, "geometry": geometry });
    json!({ "type": "FeatureCollection", "features": [feature] })
}

/// Whether positions on the terrain have a longitude and latitude.
fn has_system(terrain: &Terrain) -> bool {
    let corner = terrain.map_grid().georeference.corner;
    terrain.to_lon_lat(terrain.to_model(corner)).is_ok()
}

fn note_of_system(properties: &mut Value, with_system: bool) {
    if !with_system {
        properties["note"] =
            "The terrain has no reference system: coordinates are its own, not longitude and latitude.".into();
    }
}

/// Area of the wet cells, m2.
pub(crate) fn wet_area(terrain: &Terrain, wet: &[bool]) -> f64 {
    let grid = terrain.map_grid();
    let cells = wet.iter().enumerate().filter(|(_, wet)| **wet);
    cells.map(|(index, _)| grid.cell_area(index % grid.columns, index / grid.columns)).sum()
}

fn polygon(outline: &Outline, position: impl Fn([usize; 2]) -> [f64; 2]) -> Value {
    let ring = |ring: &Vec<[usize; 2]>| -> Vec<[f64; 2]> {
        // GeoJSON repeats the first position at the end.
        ring.iter().chain(ring.first()).map(|vertex| position(*vertex)).collect()
    };
    json!(std::iter::once(&outline.outer).chain(&outline.holes).map(ring).collect::<Vec<_>>())
}

/// The position of a corner of cells: longitude and latitude to the millimetre, or the terrain's own coordinates.
fn position_of(terrain: &Terrain, [column, row]: [usize; 2], has_system: bool) -> [f64; 2] {
    let georeference = &terrain.map_grid().georeference;
    let own = [
        georeference.corner[0] + column as f64 * georeference.cell[0],
        georeference.corner[1] - row as f64 * georeference.cell[1],
    ];
    match terrain.to_lon_lat(terrain.to_model(own)) {
        Ok(lon_lat) if has_system => lon_lat.map(|degrees| (degrees * 1e8).round() / 1e8),
        _ => own,
    }
}
