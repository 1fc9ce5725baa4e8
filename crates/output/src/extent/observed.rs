//! The flooded extent against an observed one.

use super::wet_area;
use crate::OutputError;
use corpuscle_terrain::{Polygon, Terrain, polygons_of_geojson};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;

/// How a flooded extent compares with an observed one. Areas count, not cells: with A wet in both, B wet only as
/// computed and C wet only as observed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ExtentScores {
    /// Part of the observed area that is also computed wet: A / (A + C).
    pub hit_rate: f64,
    /// Part of the computed area that was not observed wet: B / (A + B), 0 where nothing is computed wet.
    pub false_alarm_ratio: f64,
    /// Critical success index: A / (A + B + C).
    pub critical_success_index: f64,
    /// Area computed wet, m2.
    pub simulated_area_m2: f64,
    /// Area observed wet within the terrain, m2.
    pub observed_area_m2: f64,
}

/// Compares the wet cells of `max_depth` (a value for each cell of the terrain's map grid, not-a-number where dry)
/// with the polygons of a GeoJSON file, drawn on the same grid: a cell is observed wet when its centre is inside.
///
/// Coordinates are longitude and latitude as RFC 7946 asks; numbers that cannot be those, and any numbers on a
/// terrain without reference system, are the terrain's own coordinates.
///
/// # Errors
/// [`OutputError::Read`], or [`OutputError::Content`] for a file that is no GeoJSON or has no polygon on the terrain.
pub fn compare_extent(observed: &Path, terrain: &Terrain, max_depth: &[f32]) -> Result<ExtentScores, OutputError> {
    let text = fs::read_to_string(observed).map_err(OutputError::read(observed))?;
    let polygons = polygons_of_geojson(&text).map_err(|error| OutputError::content(observed, error))?;
    let polygons = terrain.polygons_to_own(polygons);
    let observed_wet = draw(&polygons, terrain);
    if !observed_wet.contains(&true) {
        let count = polygons.len();
        let what = format!(
            "none of its {count} polygons covers a cell of the terrain; give polygons in longitude and latitude (or in \
             the terrain's own coordinates) that overlap it"
        );
        return Err(OutputError::content(observed, what));
    }
    let both: Vec<[bool; 2]> =
        max_depth.iter().map(|depth| !depth.is_nan()).zip(observed_wet).map(Into::into).collect();
    Ok(scores(&both, terrain))
}

/// Scores of `[computed, observed]` cells.
fn scores(cells: &[[bool; 2]], terrain: &Terrain) -> ExtentScores {
    let area = |wanted: [bool; 2]| wet_area(terrain, &cells.iter().map(|cell| *cell == wanted).collect::<Vec<_>>());
    let [hit, false_alarm, miss] = [[true, true], [true, false], [false, true]].map(area);
    ExtentScores {
        hit_rate: hit / (hit + miss),
        false_alarm_ratio: if hit + false_alarm > 0.0 { false_alarm / (hit + false_alarm) } else { 0.0 },
        critical_success_index: hit / (hit + false_alarm + miss),
        simulated_area_m2: hit + false_alarm,
        observed_area_m2: hit + miss,
    }
}

/// The cells of the terrain's map grid whose centres are inside one of the polygons.
fn draw(polygons: &[Polygon], terrain: &Terrain) -> Vec<bool> {
    let grid = terrain.map_grid();
    let mut wet = vec![false; grid.columns * grid.rows];
    for polygon in polygons {
        let rings: Vec<Vec<[f64; 2]>> =
            polygon.iter().map(|ring| ring.iter().map(|place| grid.georeference.position(*place)).collect()).collect();
        fill(&rings, grid.columns, &mut wet);
    }
    wet
}

/// Sets the cells whose centres are inside the rings by the even-odd rule. Places are (column, row), whole at centres.
fn fill(rings: &[Vec<[f64; 2]>], columns: usize, wet: &mut [bool]) {
    let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); wet.len() / columns];
    for ring in rings {
        for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            let (low, high) = if a[1] < b[1] { (a, b) } else { (b, a) };
            // Rows in [low, high): an end that lies on a row counts for one of its two edges only.
            let first = low[1].ceil().max(0.0) as usize;
            let end = high[1].ceil().clamp(0.0, crossings.len() as f64) as usize;
            for (row, crossings) in crossings.iter_mut().enumerate().take(end).skip(first) {
                let along = (row as f64 - low[1]) / (high[1] - low[1]);
                crossings.push(low[0] + along * (high[0] - low[0]));
            }
        }
    }
    for (row, mut crossings) in crossings.into_iter().enumerate() {
        crossings.sort_by(f64::total_cmp);
        for pair in crossings.chunks_exact(2) {
            let [from, to] = [pair[0], pair[1]].map(|x| x.ceil().clamp(0.0, columns as f64) as usize);
            wet[row * columns + from..row * columns + to].fill(true);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_terrain::Bounds;

    /// 10 x 5 cells of 2 m.
    fn terrain() -> Terrain {
        Terrain::gridded(Bounds { x_min: 0.0, x_max: 20.0, y_min: 0.0, y_max: 10.0 }, 2.0, |_, _| 0.0)
    }

    fn depths(wet: impl Fn(usize, usize) -> bool) -> Vec<f32> {
        (0..50).map(|cell| if wet(cell % 10, cell / 10) { 1.0 } else { f32::NAN }).collect()
    }

    fn compare(text: &str, depths: &[f32]) -> Result<ExtentScores, OutputError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("observed.geojson");
        fs::write(&path, text).unwrap();
        compare_extent(&path, &terrain(), depths)
    }

    const WEST_HALF: &str = r#"{"type":"Polygon","coordinates":[[[0,0],[10,0],[10,10],[0,10],[0,0]]]}"#;

    #[test]
    fn scores_count_areas() {
        let same = compare(WEST_HALF, &depths(|column, _| column < 5)).unwrap();
        assert_eq!((same.hit_rate, same.false_alarm_ratio, same.critical_success_index), (1.0, 0.0, 1.0));
        assert_eq!((same.simulated_area_m2, same.observed_area_m2), (100.0, 100.0));
        let shifted = compare(WEST_HALF, &depths(|column, _| (1..6).contains(&column))).unwrap();
        assert_eq!((shifted.hit_rate, shifted.false_alarm_ratio), (0.8, 0.2));
        assert!((shifted.critical_success_index - 4.0 / 6.0).abs() < 1e-15);
        let dry = compare(WEST_HALF, &depths(|_, _| false)).unwrap();
        assert_eq!((dry.hit_rate, dry.false_alarm_ratio, dry.critical_success_index), (0.0, 0.0, 0.0));
    }

    #[test]
    fn holes_are_not_wet() {
        let ring = r#"{"type":"Feature","properties":{},"geometry":{"type":"MultiPolygon","coordinates":
            [[[[0,0],[20,0],[20,10],[0,10],[0,0]],[[4,4],[4,6],[6,6],[6,4],[4,4]]]]}}"#;
        assert_eq!(compare(ring, &depths(|_, _| true)).unwrap().observed_area_m2, 200.0 - 4.0);
    }

    #[test]
    fn unusable_files_are_refused() {
        let elsewhere = WEST_HALF.replace("10", "-10");
        assert!(compare(&elsewhere, &depths(|_, _| true)).unwrap_err().to_string().contains("covers a cell"));
        assert!(compare("{]", &depths(|_, _| true)).unwrap_err().to_string().contains("observed.geojson"));
    }
}
