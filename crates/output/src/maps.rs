//! `maps/`: fields on the terrain's own grid, as GeoTIFF.

use crate::OutputError;
use crate::number::Shortest;
use crate::whole::write_whole;
use corpuscle_terrain::{MapGrid, Survey, survey, write_geotiff};
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
        SNAPSHOT
    }

    /// Grid on which all of them are.
    ///
    /// # Errors
    /// [`OutputError::Map`] where the first file cannot be read.
    pub fn grid(&self) -> Result<Survey, OutputError> {
        Ok(survey(match self.names.first() {
            Some(name) => self.path(name),
            None => snapshot_path(&self.folder, 0),
        })?)
    }

    /// Reads a map of the whole run: values row by row from the north-west, not-a-number where there is no data.
    ///
    /// # Errors
    /// [`OutputError::Content`], naming the file.
    pub fn read(&self, name: &str) -> Result<Vec<f32>, OutputError> {
        read_map(&self.path(name))
    }

    /// Reads a map of one of the times, as [`MapFiles::read`] does.
    ///
    /// # Errors
    /// [`OutputError::Content`], naming the file.
    pub fn read_at(&self, index: usize) -> Result<Vec<f32>, OutputError> {
        read_map(&snapshot_path(&self.folder, index))
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
    let number_in = |name: &String| name.strip_prefix(SNAPSHOT)?.strip_prefix('_')?.parse::<usize>().ok();
    let is_snapshot = |name: &String| number_in(name).is_some();
    let mut names: Vec<String> = entries.flatten().filter_map(name).filter(|name| !is_snapshot(name)).collect();
    names.sort();
    Ok(names)
}

/// File of the times of the depth maps.
pub(crate) const TIMES: &str = "times.csv";

/// File of the depth map of a frame.
pub(crate) fn snapshot_path(folder: &Path, index: usize) -> PathBuf {
    folder.join(format!("{SNAPSHOT}_{index:06}.tif"))
}

/// Writes [`TIMES`]: which depth map shows which time.
pub(crate) fn write_times(folder: &Path, times: &[f64]) -> Result<(), OutputError> {
    write_whole(&folder.join(TIMES), |file| {
        writeln!(file, "file,time_s")?;
        times
            .iter()
            .enumerate()
            .try_for_each(|(index, time)| writeln!(file, "{SNAPSHOT}_{index:06}.tif,{}", Shortest(*time)))
    })
}

/// Reads the times of the depth maps from [`TIMES`]; none where there is no such file.
pub(crate) fn read_times(folder: &Path) -> Result<Vec<f64>, OutputError> {
    let path = folder.join(TIMES);
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
