//! `maps/`: fields on the terrain's own grid, as GeoTIFF.

use crate::OutputError;
use crate::number::Shortest;
use crate::whole::write_whole;
use corpuscle_scene::read_text;
use corpuscle_terrain::{MapGrid, Survey, survey, write_geotiff};
use geotiff_reader::GeoTiffFile;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Value of cells without data: less than any depth, level, velocity or time.
const NO_DATA: f32 = -9999.0;

/// The map that is written for each frame; of the others only the last, which covers the whole run.
pub const MAP_OVER_TIME: &str = "depth";

/// Writes a map (not-a-number where there is nothing).
pub(crate) fn write_map(path: &Path, grid: &MapGrid, values: &[f32]) -> Result<(), OutputError> {
    Ok(write_geotiff(path, grid, values, NO_DATA)?)
}

/// Most bytes of cells for each byte of a file: Deflate, by which maps are written, reaches 1032.
const MOST_UNPACKED: u64 = 2000;

/// Reads a map that [`write_map`] wrote, of so many cells: values row by row, not-a-number where there is no data. Unlike terrain, a map
/// may be without any data: nothing is wet.
pub(crate) fn read_map(path: &Path, cells: usize) -> Result<Vec<f32>, OutputError> {
    let wrong = |error: &dyn std::fmt::Display| OutputError::content(path, error);
    let file = GeoTiffFile::open(path).map_err(|error| wrong(&error))?;
    let own = check_bytes(path, [file.width(), file.height()].map(u64::from))?;
    if own != cells as u64 {
        return Err(wrong(&format!(
            "it has {own} cells where {cells} are needed; it belongs to another terrain or run, move it out of the folder"
        )));
    }
    let values = file.read_band::<f32>(0).map_err(|error| wrong(&error))?;
    Ok(values.iter().map(|value| if *value == NO_DATA { f32::NAN } else { *value }).collect())
}

/// The number of cells of a map, if its file can hold them.
fn check_bytes(path: &Path, [columns, rows]: [u64; 2]) -> Result<u64, OutputError> {
    let bytes = fs::metadata(path).map_err(OutputError::read(path))?.len();
    let cells = columns.saturating_mul(rows);
    if cells.saturating_mul(size_of::<f32>() as u64) > bytes.saturating_mul(MOST_UNPACKED) {
        let what = format!("its header says {columns} x {rows} cells, which its {bytes} bytes cannot hold");
        return Err(OutputError::content(path, what));
    }
    Ok(cells)
}

/// The maps in a run's folder.
#[derive(Debug, Clone, PartialEq)]
pub struct MapFiles {
    folder: PathBuf,
    names: Vec<String>,
    times: Vec<f64>,
}

impl MapFiles {
    /// The maps of a run, finished or not.
    ///
    /// # Errors
    /// [`OutputError::NoMaps`] where the run wrote none; [`OutputError::Read`], [`OutputError::Content`] where `maps/times.csv` cannot be
    /// used.
    pub fn list(run: &Path) -> Result<Self, OutputError> {
        let folder = run.join("maps");
        let times = read_times(&folder)?;
        let names = names_in(&folder)?;
        if times.is_empty() && names.is_empty() {
            return Err(OutputError::NoMaps { path: run.to_owned() });
        }
        Ok(Self { folder, names, times })
    }

    /// Names of the maps of the whole run, sorted: `max_depth`. A run that has not ended has none.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Times of the maps of single times, s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Name of the map of single times.
    pub fn name_over_time(&self) -> &'static str {
        MAP_OVER_TIME
    }

    /// Grid on which all of them are.
    ///
    /// # Errors
    /// [`OutputError::Map`] where the first file cannot be read; [`OutputError::Content`] where it says to have more cells than it can
    /// hold.
    pub fn grid(&self) -> Result<Survey, OutputError> {
        let path = match self.names.first() {
            Some(name) => self.path(name),
            None => snapshot_path(&self.folder, 0),
        };
        let grid = survey(&path)?;
        check_bytes(&path, [grid.columns, grid.rows].map(|count| count as u64))?;
        Ok(grid)
    }

    /// Reads a map of the whole run, of as many cells as its [`MapFiles::grid`]: values row by row from the north-west, not-a-number
    /// where there is no data.
    ///
    /// # Errors
    /// [`OutputError::Content`], naming the file; where it has another number of cells before they are read.
    pub fn read(&self, name: &str, cells: usize) -> Result<Vec<f32>, OutputError> {
        read_map(&self.path(name), cells)
    }

    /// Reads a map of one of the times, as [`MapFiles::read`] does.
    ///
    /// # Errors
    /// [`OutputError::Content`], naming the file.
    pub fn read_at(&self, index: usize, cells: usize) -> Result<Vec<f32>, OutputError> {
        read_map(&snapshot_path(&self.folder, index), cells)
    }

    /// File of a map of the whole run.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.join(format!("{name}.tif"))
    }

    /// File of a map of one of the times.
    pub fn path_at(&self, index: usize) -> PathBuf {
        snapshot_path(&self.folder, index)
    }
}

/// Names of the maps of the whole run in a folder, sorted; none where there is no such folder.
fn names_in(folder: &Path) -> Result<Vec<String>, OutputError> {
    let entries = match fs::read_dir(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        entries => entries.map_err(OutputError::read(folder))?,
    };
    let name = |entry: fs::DirEntry| entry.file_name().to_str()?.strip_suffix(".tif").map(str::to_owned);
    let number_in = |name: &String| name.strip_prefix(MAP_OVER_TIME)?.strip_prefix('_')?.parse::<usize>().ok();
    let is_snapshot = |name: &String| number_in(name).is_some();
    let mut names: Vec<String> = entries.flatten().filter_map(name).filter(|name| !is_snapshot(name)).collect();
    names.sort();
    Ok(names)
}

/// File of the times of the depth maps.
pub(crate) const TIMES: &str = "times.csv";

/// File of the depth map of a frame.
pub(crate) fn snapshot_path(folder: &Path, index: usize) -> PathBuf {
    folder.join(format!("{MAP_OVER_TIME}_{index:06}.tif"))
}

/// Writes [`TIMES`]: which depth map shows which time.
pub(crate) fn write_times(folder: &Path, times: &[f64]) -> Result<(), OutputError> {
    write_whole(&folder.join(TIMES), |file| {
        writeln!(file, "file,time_s")?;
        times
            .iter()
            .enumerate()
            .try_for_each(|(index, time)| writeln!(file, "{MAP_OVER_TIME}_{index:06}.tif,{}", Shortest(*time)))
    })
}

/// Reads the times of the depth maps from [`TIMES`]; none where there is no such file.
pub(crate) fn read_times(folder: &Path) -> Result<Vec<f64>, OutputError> {
    let path = folder.join(TIMES);
    let text = match read_text(&path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        text => text.map_err(OutputError::read(&path))?,
    };
    let time = |line: &str| line.split_once(',').and_then(|(_, time)| time.parse().ok());
    let line_or_error = |(number, line)| {
        time(line).ok_or_else(|| OutputError::content(&path, format!("line {}: `{line}` has no time", number + 1)))
    };
    text.lines().enumerate().skip(1).map(line_or_error).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_terrain::{Bounds, Terrain};

    #[test]
    fn the_size_of_a_map_is_checked_before_its_cells_are_read() {
        let bounds = Bounds { x_min: 0.0, x_max: 400.0, y_min: 0.0, y_max: 300.0 };
        let grid = Terrain::gridded(bounds, 1.0, |_, _| 0.0).map_grid().clone();
        let cells = grid.columns * grid.rows;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("depth.tif");
        write_map(&path, &grid, &vec![1.0; cells]).unwrap();
        assert_eq!(read_map(&path, cells).unwrap().len(), cells);
        let error = read_map(&path, cells + 1).unwrap_err().to_string();
        assert!(error.contains("depth.tif") && error.contains("it belongs to another terrain"), "{error}");
        // Width and height of the first directory, the tags 256 and 257, made huge.
        let mut bytes = fs::read(&path).unwrap();
        for tag in [256_u16, 257] {
            let at = bytes.windows(2).position(|pair| pair == tag.to_le_bytes()).unwrap();
            assert!([3, 4].contains(&bytes[at + 2]), "the tag {tag} stands elsewhere");
            bytes[at + 2..at + 12].copy_from_slice(&[4, 0, 1, 0, 0, 0, 0, 0, 1, 0]);
        }
        fs::write(&path, &bytes).unwrap();
        for wanted in [cells, 1 << 32] {
            let error = read_map(&path, wanted).unwrap_err().to_string();
            assert!(error.contains("65536 x 65536 cells, which its"), "{error}");
        }
    }
}
