//! The flooded extent against an observed one.

use super::wet_area;
use crate::OutputError;
use corpuscle_scene::read_text;
use corpuscle_terrain::{Polygon, Terrain, polygons_of_geojson};
use serde::{Deserialize, Serialize};
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
    let text = read_text(observed).map_err(OutputError::read(observed))?;
    let polygons = polygons_of_geojson(&text).map_err(|error| OutputError::content(observed, error))?;
    let polygons = terrain.polygons_to_own(polygons);
    let mut observed_wet = draw(&polygons, terrain).map_err(|what| OutputError::content(observed, what))?;
    // Where the terrain has no data nothing is computed.
    let columns = terrain.map_grid().columns;
    let cells = observed_wet.iter_mut().enumerate();
    cells.for_each(|(cell, wet)| *wet &= terrain.is_valid_cell(cell % columns, cell / columns));
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

/// The farthest corner that is drawn, cells from the first.
const FARTHEST: f64 = 1e12;
/// Most crossings of sides and rows: those of polygons round every other cell of the largest grids are fewer.
const MOST_CROSSINGS: usize = 100_000_000;

/// The cells of the terrain's map grid whose centres are inside one of the polygons.
fn draw(polygons: &[Polygon], terrain: &Terrain) -> Result<Vec<bool>, String> {
    let grid = terrain.map_grid();
    let mut sides = Vec::new();
    for (number, polygon) in polygons.iter().enumerate() {
        for ring in polygon {
            let cells: Vec<[f64; 2]> = ring.iter().map(|position| grid.georeference.position(*position)).collect();
            let is_far = |cell: &[f64; 2]| !cell.iter().all(|along| along.abs() <= FARTHEST);
            if let Some(corner) = cells.iter().position(is_far) {
                let [x, y] = ring[corner];
                return Err(format!("a polygon has a corner at ({x:e}, {y:e}), too far from the terrain; correct it"));
            }
            let ends = cells.iter().zip(cells.iter().cycle().skip(1));
            sides.extend(ends.filter_map(|(a, b)| Side::between(*a, *b, number, grid.rows)));
        }
    }
    let crossings = sides.iter().fold(0_usize, |sum, side| sum.saturating_add(side.end - side.first));
    if crossings > MOST_CROSSINGS {
        return Err(format!(
            "its polygons have {} sides, which cross the rows of the terrain's cells {crossings} times; {MOST_CROSSINGS} are \
             possible. Simplify them",
            sides.len()
        ));
    }
    let mut wet = vec![false; grid.columns * grid.rows];
    fill(sides, polygons.len(), grid.columns, &mut wet);
    Ok(wet)
}

/// A side of a polygon that crosses rows.
struct Side {
    polygon: usize,
    /// The rows that it crosses, from `first` to before `end`.
    first: usize,
    end: usize,
    /// (column, row) of its ends, whole at the centres of cells; the first has the lower row.
    low: [f64; 2],
    high: [f64; 2],
}

impl Side {
    /// The side from one corner to another; none where it crosses no row.
    fn between(a: [f64; 2], b: [f64; 2], polygon: usize, rows: usize) -> Option<Self> {
        let (low, high) = if a[1] < b[1] { (a, b) } else { (b, a) };
        // Rows in [low, high): an end that lies on a row counts for one of its two sides only.
        let [first, end] = [low, high].map(|end| end[1].ceil().clamp(0.0, rows as f64) as usize);
        (first < end).then_some(Self { polygon, first, end, low, high })
    }

    fn column_at(&self, row: usize) -> f64 {
        let along = (row as f64 - self.low[1]) / (self.high[1] - self.low[1]);
        self.low[0] + along * (self.high[0] - self.low[0])
    }
}

/// Sets the cells whose centres are inside a polygon by the even-odd rule. Row by row with the sides that cross it.
fn fill(mut sides: Vec<Side>, polygons: usize, columns: usize, wet: &mut [bool]) {
    sides.sort_by_key(|side| side.first);
    let mut waiting = sides.into_iter().peekable();
    let mut crossing: Vec<Side> = Vec::new();
    let mut crossings: Vec<(f64, usize)> = Vec::new();
    let mut is_inside = vec![false; polygons];
    for (row, cells) in wet.chunks_exact_mut(columns).enumerate() {
        crossing.retain(|side| row < side.end);
        while let Some(side) = waiting.next_if(|side| side.first <= row) {
            crossing.push(side);
        }
        crossings.clear();
        crossings.extend(crossing.iter().map(|side| (side.column_at(row), side.polygon)));
        crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut around, mut from) = (0_usize, 0);
        for (column, polygon) in &crossings {
            let to = column.ceil().clamp(0.0, columns as f64) as usize;
            let before = around;
            is_inside[*polygon] ^= true;
            around = if is_inside[*polygon] { around + 1 } else { around - 1 };
            match (before, around) {
                (0, _) => from = to,
                (_, 0) => cells[from..to].fill(true),
                _ => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_terrain::Bounds;
    use std::fs;

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
    fn cells_of_any_of_several_polygons_are_wet_once() {
        let square = |low: f64, high: f64| format!("[[[{low},0],[{high},0],[{high},10],[{low},10],[{low},0]]]");
        let area = |squares: &[[f64; 2]]| {
            let all: Vec<String> = squares.iter().map(|[low, high]| square(*low, *high)).collect();
            let text = format!(r#"{{"type":"MultiPolygon","coordinates":[{}]}}"#, all.join(","));
            compare(&text, &depths(|_, _| true)).unwrap().observed_area_m2
        };
        assert_eq!(area(&[[0.0, 8.0], [4.0, 12.0]]), 120.0);
        assert_eq!(area(&[[0.0, 20.0], [4.0, 8.0]]), 200.0);
        assert_eq!(area(&[[0.0, 4.0], [12.0, 16.0], [4.0, 8.0]]), 120.0);
        assert_eq!(area(&[[-1e9, 4.0], [16.0, 1e9]]), 80.0);
    }

    /// A terrain of many rows, and sides that cross all of them.
    #[test]
    fn sides_take_no_memory_for_each_row() {
        let bounds = Bounds { x_min: 0.0, x_max: 4.0, y_min: 0.0, y_max: 10_000.0 };
        let tall = Terrain::gridded(bounds, 1.0, |_, _| 0.0);
        let zigzag = |sides: usize| (0..sides).map(|side| [2.0, if side % 2 == 0 { -1e4 } else { 2e4 }]).collect();
        let rows = tall.map_grid().rows;
        let drawn = draw(&[vec![zigzag(2000)]], &tall).unwrap();
        assert!(!drawn.contains(&true));
        let error = draw(&[vec![zigzag(MOST_CROSSINGS / rows + 2)]], &tall).unwrap_err();
        assert!(error.contains("Simplify"), "{error}");
    }

    #[test]
    fn corners_that_are_absurdly_far_are_refused() {
        for corner in ["[1e300,0]", "[0,-1e308]", "[1e15,1e15]"] {
            let error =
                compare(&WEST_HALF.replacen("[10,0]", corner, 1), &depths(|_, _| true)).unwrap_err().to_string();
            assert!(error.contains("observed.geojson") && error.contains("too far from the terrain"), "{error}");
        }
    }

    #[test]
    fn unusable_files_are_refused() {
        let elsewhere = WEST_HALF.replace("10", "-10");
        assert!(compare(&elsewhere, &depths(|_, _| true)).unwrap_err().to_string().contains("covers a cell"));
        assert!(compare("{]", &depths(|_, _| true)).unwrap_err().to_string().contains("observed.geojson"));
    }
}
