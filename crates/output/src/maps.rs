//! `maps/`: fields on the terrain's own grid, as GeoTIFF.

use crate::OutputError;
use crate::number::Shortest;
use crate::whole::write_whole;
use corpuscle_terrain::{MapGrid, write_geotiff};
use geotiff_reader::GeoTiffFile;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Value of cells without data: less than any depth, level, velocity or time.
const NO_DATA: f32 = -9999.0;

/// The map that is written for each frame; of the others only the last, which covers the whole run.
pub(crate) const SNAPSHOT: &str = "depth";

/// Writes a map (not-a-number where there is nothing).
pub(crate) fn write_map(path: &Path, grid: &MapGrid, values: &[f32]) -> Result<(), OutputError> {
    Ok(write_geotiff(path, grid, values, NO_DATA)?)
}

/// Reads a map that [`write_map`] wrote: values row by row, not-a-number where there is no data. Unlike terrain, a map
/// may be without any data: nothing is wet.
pub(crate) fn read_map(path: &Path) -> Result<Vec<f32>, OutputError> {
    let read = || {
        let file = GeoTiffFile::open(path)?;
        file.read_band::<f32>(0)
    };
    let values = read().map_err(|error| OutputError::content(path, error))?;
    Ok(values.iter().map(|value| if *value == NO_DATA { f32::NAN } else { *value }).collect())
}

/// File of the depth map of a frame.
pub(crate) fn snapshot_path(folder: &Path, index: usize) -> PathBuf {
    folder.join(format!("{SNAPSHOT}_{index:06}.tif"))
}

/// Writes `times.csv`: which depth map shows which time.
pub(crate) fn write_times(folder: &Path, times: &[f64]) -> Result<(), OutputError> {
    write_whole(&folder.join("times.csv"), |file| {
        writeln!(file, "file,time_s")?;
        times
            .iter()
            .enumerate()
            .try_for_each(|(index, time)| writeln!(file, "{SNAPSHOT}_{index:06}.tif,{}", Shortest(*time)))
    })
}

/// Reads the times of the depth maps from `times.csv`; none where there is no such file.
pub(crate) fn read_times(folder: &Path) -> Result<Vec<f64>, OutputError> {
    let path = folder.join("times.csv");
    let text = match fs::read_to_string(&path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        text => text.map_err(OutputError::read(&path))?,
    };
    let time = |line: &str| line.split_once(',').and_then(|(_, time)| time.parse().ok());
    let line_or_error = |(number, line)| {
        time(line).ok_or_else(|| OutputError::content(&path, format!("line {}: `{line}` has no time", number + 1)))
    };
    text.lines().enumerate().skip(1).map(line_or_error).collect()
}
