//! What a raster file holds, in numbers.

use crate::conversion::Conversion;
use crate::files::choose_system;
use crate::frame::Frame;
use crate::system::{ReferenceSystem, WGS_84};
use crate::{MapBox, MapGrid, Raster, Survey, TerrainError, read_raster, read_raster_part, survey};
use std::path::Path;
use std::sync::Arc;

/// Cells that are read at once.
const AT_ONCE: usize = 1 << 24;

/// What a raster file holds.
#[derive(Debug, Clone)]
pub struct Summary {
    /// What it says of itself.
    pub survey: Survey,
    /// Size of a cell in its middle `[east, north]`, m.
    pub cell_m: [f64; 2],
    /// The rectangle round it in longitude and latitude on WGS 84, where its position on Earth is known.
    pub lon_lat: Option<MapBox>,
    /// The lowest and the highest value, m; none where there is no data at all.
    pub heights_m: Option<[f64; 2]>,
    /// Cells without data.
    pub no_data: u64,
    /// Warnings about it, in sentences.
    pub warnings: Vec<String>,
}

/// Reads a raster file of any size. `crs` is its reference system where it names none.
///
/// # Errors
/// As [`read_raster`], but for its size and for one without any data.
pub fn summarize(path: impl AsRef<Path>, crs: Option<&str>) -> Result<Summary, TerrainError> {
    let path = path.as_ref();
    let mut survey = survey(path)?;
    let mut warnings = choose_system(&mut survey.georeference, crs, path)?;
    let mut heights = Heights::default();
    for part in parts(&survey) {
        let raster = match part {
            Some(part) => read_raster_part(path, &part)?,
            None => read_raster(path)?,
        };
        heights.add(&raster);
        let new: Vec<_> = raster.warnings.into_iter().filter(|warning| !warnings.contains(warning)).collect();
        warnings.extend(new);
    }
    let grid = grid(&survey).map_err(|what| TerrainError::unusable(path, what))?;
    let wgs_84 = ReferenceSystem::parse(WGS_84)?;
    let lon_lat = survey.georeference.system.as_ref().and_then(|own| {
        Conversion::between(Some(own), Some(&wgs_84)).and_then(|conversion| conversion.map_box(&survey.outline())).ok()
    });
    let heights_m = (heights.lowest <= heights.highest).then_some([heights.lowest, heights.highest]);
    Ok(Summary { cell_m: grid.cell_size(), survey, lon_lat, heights_m, no_data: heights.no_data, warnings })
}

/// Rows that are read together, as boxes; all of a text, which is read from its beginning every time.
fn parts(survey: &Survey) -> Vec<Option<MapBox>> {
    let Survey { columns, rows, georeference, .. } = survey;
    let together = (AT_ONCE / columns).max(2);
    if survey.format != "GeoTIFF" || *rows <= together {
        return vec![None];
    }
    let outline = survey.outline();
    // The last part has two rows at least.
    let starts: Vec<usize> = (0..rows - 1).step_by(together).collect();
    let latitude = |row: usize| outline.north - row as f64 * georeference.cell[1];
    let ends = starts.iter().skip(1).copied().chain([*rows]);
    let part = |(start, end)| Some(MapBox { north: latitude(start), south: latitude(end), ..outline });
    starts.iter().copied().zip(ends).map(part).collect()
}

/// The file's grid with its position on Earth.
fn grid(survey: &Survey) -> Result<MapGrid, String> {
    let Survey { columns, rows, georeference, .. } = survey.clone();
    let middle = georeference.point([0.5 * columns as f64 - 0.5, 0.5 * rows as f64 - 0.5]);
    let frame = match &georeference.system {
        Some(system) => Frame::of(system, middle)?,
        None => Frame::plain(),
    };
    Ok(MapGrid { columns, rows, georeference, frame: Arc::new(frame) })
}

struct Heights {
    lowest: f64,
    highest: f64,
    no_data: u64,
}

impl Default for Heights {
    fn default() -> Self {
        Self { lowest: f64::INFINITY, highest: f64::NEG_INFINITY, no_data: 0 }
    }
}

impl Heights {
    fn add(&mut self, raster: &Raster) {
        for height in &raster.values {
            // Both ignore not-a-number.
            self.lowest = self.lowest.min(*height);
            self.highest = self.highest.max(*height);
            self.no_data += u64::from(height.is_nan());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Georeference;

    fn survey_of(columns: usize, rows: usize) -> Survey {
        Survey {
            columns,
            rows,
            georeference: Georeference::plain([0.0, 1000.0], [10.0, 10.0]),
            format: "GeoTIFF",
            samples: String::new(),
            height_unit_m: 1.0,
        }
    }

    #[test]
    fn every_row_is_in_one_part() {
        for rows in [2, 5, 16, 17, 33, 34] {
            let survey = survey_of(AT_ONCE / 16, rows);
            let parts = parts(&survey);
            let windows: Vec<_> = parts
                .iter()
                .map(|part| match part {
                    Some(part) => crate::Window::within(&survey.georeference, [survey.columns, rows], part).unwrap(),
                    None => crate::Window::whole([survey.columns, rows]),
                })
                .collect();
            let mut next = 0;
            for window in windows {
                assert!(window.first == [0, next] && window.size[0] == survey.columns && window.size[1] >= 2);
                next += window.size[1];
            }
            assert_eq!(next, rows);
        }
    }
}
