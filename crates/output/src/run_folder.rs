//! A run's folder while the run goes on.

use crate::charts::{read_paths, write_chart, write_paths};
use crate::checkpoint::{Progress, checksum};
use crate::finite::{check_frame, check_map, check_surface};
use crate::frames::{FrameFormat, write_pvd, write_surface};
use crate::gauges::GaugeWriter;
use crate::maps::{self, MAP_OVER_TIME};
use crate::whole::{write_bytes, write_whole};
use crate::{Clock, OutputError, Summary, write_extent, write_run_up};
use corpuscle_atomic_file::clear_unfinished;
use corpuscle_model::{Chart, Container, Frame, GaugeColumn, Map, Surface};
use corpuscle_scene::read_text;
use corpuscle_terrain::Terrain;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A run's folder while the run goes on. Everything in it is readable at any time: files appear whole, and the gauge
/// table grows row by row.
#[derive(Debug)]
pub struct RunFolder {
    path: PathBuf,
    scene_text: String,
    frame_format: FrameFormat,
    frame_times: Vec<f64>,
    map_times: Vec<f64>,
    gauges: GaugeWriter,
    log: File,
}

/// Makes the first of the folders `<parent>/<scene>-1`, `-2`, ... that does not exist yet, and gives its path.
///
/// # Errors
/// [`OutputError::Write`].
pub fn next_run_folder(parent: &Path, scene: &str) -> Result<PathBuf, OutputError> {
    fs::create_dir_all(parent).map_err(OutputError::write(parent))?;
    let mut number = 1;
    loop {
        let path = parent.join(format!("{scene}-{number}"));
        // Made at once, so that two runs started together get different folders.
        match fs::create_dir(&path) {
            Ok(()) => return Ok(path),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => number += 1,
            Err(error) => return Err(OutputError::write(&path)(error)),
        }
    }
}

/// Trajectories of the particles that a run followed, from its folder; none where it followed none.
///
/// # Errors
/// [`OutputError::Content`] where `path.csv` is damaged.
pub fn followed_paths(run: &Path) -> Result<Vec<corpuscle_model::Path>, OutputError> {
    read_paths(run)
}

impl RunFolder {
    /// Starts a run's folder: a new one, or an empty one that is there.
    ///
    /// `scene_text` is the scene as run, with all defaults, as TOML.
    ///
    /// # Errors
    /// [`OutputError::Exists`] where the folder holds anything, [`OutputError::Write`].
    pub fn create(
        path: &Path,
        scene_text: &str,
        gauges: &[GaugeColumn],
        frame_format: FrameFormat,
    ) -> Result<Self, OutputError> {
        fs::create_dir_all(path).map_err(OutputError::write(path))?;
        if fs::read_dir(path).map_err(OutputError::read(path))?.next().is_some() {
            return Err(OutputError::Exists { path: path.to_owned() });
        }
        let begin = || -> Result<_, OutputError> {
            write_bytes(&path.join("scene.toml"), scene_text.as_bytes())?;
            Ok((GaugeWriter::create(&path.join("gauges.csv"), gauges)?, open_log(path)?))
        };
        let (gauges, log) = begin().inspect_err(|_| clear_beginning(path))?;
        Ok(Self {
            path: path.to_owned(),
            scene_text: scene_text.to_owned(),
            frame_format,
            frame_times: Vec::new(),
            map_times: Vec::new(),
            gauges,
            log,
        })
    }

    /// Opens the folder of an interrupted run at its checkpoint: returns the folder, truncated to what had been
    /// written then, the progress of the run, and the model's state.
    ///
    /// # Errors
    /// [`OutputError::NoCheckpoint`], [`OutputError::Checkpoint`] where it is damaged or the scene was changed,
    /// [`OutputError::Read`], [`OutputError::Write`].
    pub fn resume(path: &Path) -> Result<(Self, Clock, Vec<u8>), OutputError> {
        let scene_path = path.join("scene.toml");
        let scene_text = read_text(&scene_path).map_err(OutputError::read(&scene_path))?;
        let checkpoint = checkpoint_path(path);
        if !checkpoint.exists() {
            return Err(OutputError::NoCheckpoint { path: path.to_owned() });
        }
        let (progress, state) = Progress::read(&checkpoint, &scene_text)?;
        let folder = Self {
            gauges: GaugeWriter::resume(&path.join("gauges.csv"), progress.gauge_rows)?,
            path: path.to_owned(),
            scene_text,
            frame_format: progress.frame_format,
            frame_times: progress.frame_times,
            map_times: progress.map_times,
            log: open_log(path)?,
        };
        folder.truncate()?;
        Ok((folder, progress.clock, state))
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// True where there is a checkpoint to resume from.
    pub fn has_checkpoint(&self) -> bool {
        checkpoint_path(&self.path).exists()
    }

    /// Format of the particle files.
    pub fn frame_format(&self) -> FrameFormat {
        self.frame_format
    }

    /// Times of the frames written so far, s.
    pub fn frame_times(&self) -> &[f64] {
        &self.frame_times
    }

    /// Gauge rows written so far.
    pub fn gauge_rows(&self) -> usize {
        self.gauges.rows()
    }

    /// Adds a particle frame: `frames/frame_NNNNNN.vtp` and `frames.pvd`, or `.csv`, or `.xyz`, numbered from 0. `container` is the box round the particles.
    ///
    /// # Errors
    /// [`OutputError::Write`]; [`OutputError::NotFinite`].
    pub fn write_frame(&mut self, frame: &Frame, container: Option<&Container>) -> Result<(), OutputError> {
        if self.frame_format != FrameFormat::None {
            check_frame(frame)?;
            let folder = self.subfolder("frames")?;
            self.frame_format.write(&folder, self.frame_times.len(), frame, container)?;
        }
        self.frame_times.push(frame.time);
        self.write_pvd()
    }

    /// Adds a row to `gauges.csv`. It is in the file when this returns.
    ///
    /// # Errors
    /// [`OutputError::Write`]; [`OutputError::GaugeCount`].
    pub fn append_gauges(&mut self, time: f64, values: &[f64]) -> Result<(), OutputError> {
        self.gauges.append(time, values)
    }

    /// Adds the map `depth` of this time, s: `maps/depth_NNNNNN.tif`, numbered from 0, and its time to
    /// `maps/times.csv`. A model without this map writes none.
    ///
    /// # Errors
    /// [`OutputError::Write`]; [`OutputError::NotFinite`].
    pub fn write_snapshot(&mut self, time: f64, maps: &[Map], terrain: &Terrain) -> Result<(), OutputError> {
        let Some(map) = maps.iter().find(|map| map.name == MAP_OVER_TIME) else { return Ok(()) };
        check_map(map)?;
        let folder = self.subfolder("maps")?;
        maps::write_map(&maps::snapshot_path(&folder, self.map_times.len()), terrain.map_grid(), &map.values)?;
        self.map_times.push(time);
        maps::write_times(&folder, &self.map_times)
    }

    /// Writes the maps that stand for the whole run (all but `depth`), `maps/max_depth.tif` and so on, and the flooded
    /// extent `maps/extent.geojson` and its run-up line `maps/run_up.geojson`.
    ///
    /// # Errors
    /// [`OutputError::Write`]; [`OutputError::NotFinite`].
    pub fn write_final_maps(&self, maps: &[Map], terrain: &Terrain) -> Result<(), OutputError> {
        maps.iter().try_for_each(check_map)?;
        let folder = self.subfolder("maps")?;
        for map in maps.iter().filter(|map| map.name != MAP_OVER_TIME) {
            maps::write_map(&folder.join(format!("{}.tif", map.name)), terrain.map_grid(), &map.values)?;
        }
        match maps.iter().find(|map| map.name == "max_depth") {
            Some(depth) => {
                write_extent(&folder.join("extent.geojson"), terrain, &depth.values)?;
                write_run_up(&folder.join("run_up.geojson"), terrain, &depth.values)
            }
            None => Ok(()),
        }
    }

    /// Writes the values on the surfaces of solids: `maps/NAME.vtp` for each, spaces of its name as `_`. A model without solids
    /// writes none.
    ///
    /// # Errors
    /// [`OutputError::Write`]; [`OutputError::NotFinite`].
    pub fn write_surfaces(&self, surfaces: &[Surface]) -> Result<(), OutputError> {
        if surfaces.is_empty() {
            return Ok(());
        }
        let folder = self.subfolder("maps")?;
        surfaces.iter().try_for_each(check_surface)?;
        surfaces.iter().try_for_each(|surface| {
            let name = format!("{}.vtp", surface.name.replace(' ', "_"));
            write_whole(&folder.join(name), |file| write_surface(file, surface))
        })
    }

    /// Writes charts as tables, `charts/NAME.csv`, and paths, `path.csv`. A model without them writes none.
    ///
    /// # Errors
    /// [`OutputError::Write`].
    pub fn write_charts(&self, charts: &[Chart], paths: &[corpuscle_model::Path]) -> Result<(), OutputError> {
        if !charts.is_empty() {
            let folder = self.subfolder("charts")?;
            charts.iter().try_for_each(|chart| write_chart(&folder, chart))?;
        }
        if paths.is_empty() { Ok(()) } else { write_paths(&self.path, paths) }
    }

    /// Writes the checkpoint over the one before.
    ///
    /// # Errors
    /// [`OutputError::Write`]; the checkpoint before stays.
    pub fn write_checkpoint(&self, clock: Clock, state: &[u8]) -> Result<(), OutputError> {
        self.subfolder("checkpoint")?;
        // It counts their rows.
        self.gauges.sync()?;
        let progress = Progress {
            version: env!("CARGO_PKG_VERSION").into(),
            scene_sha256: checksum(&[self.scene_text.as_bytes()]),
            clock,
            frame_format: self.frame_format,
            frame_times: self.frame_times.clone(),
            map_times: self.map_times.clone(),
            gauge_rows: self.gauges.rows(),
        };
        progress.write(&checkpoint_path(&self.path), state)
    }

    /// Adds a line to `log.txt`.
    ///
    /// # Errors
    /// [`OutputError::Write`].
    pub fn log(&mut self, line: &str) -> Result<(), OutputError> {
        self.log.write_all(format!("{line}\n").as_bytes()).map_err(OutputError::write(&self.path.join("log.txt")))
    }

    /// Writes `summary.json`.
    ///
    /// # Errors
    /// [`OutputError::Write`].
    pub fn finish(&self, summary: &Summary) -> Result<(), OutputError> {
        summary.write(&self.path)
    }

    fn subfolder(&self, name: &str) -> Result<PathBuf, OutputError> {
        let path = self.path.join(name);
        fs::create_dir_all(&path).map_err(OutputError::write(&path))?;
        Ok(path)
    }

    fn write_pvd(&self) -> Result<(), OutputError> {
        match self.frame_format {
            FrameFormat::Vtp => write_pvd(&self.path.join("frames"), &self.frame_times),
            _ => Ok(()),
        }
    }

    /// Removes what was written after the checkpoint.
    fn truncate(&self) -> Result<(), OutputError> {
        for folder in FOLDERS.map(|name| self.path.join(name)) {
            clear_unfinished(&folder).map_err(OutputError::write(&folder))?;
        }
        let frames = self.path.join("frames");
        remove_numbered(&frames, "frame_", self.frame_times.len())?;
        if frames.exists() {
            self.write_pvd()?;
        }
        let maps = self.path.join("maps");
        remove_numbered(&maps, "depth_", self.map_times.len())?;
        if maps.join(maps::TIMES).exists() {
            maps::write_times(&maps, &self.map_times)?;
        }
        let summary = self.path.join("summary.json");
        match fs::remove_file(&summary) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(OutputError::write(&summary)(error)),
            _ => Ok(()),
        }
    }
}

/// Where a run writes files.
const FOLDERS: [&str; 6] = ["", "frames", "maps", "charts", "pictures", "checkpoint"];

fn checkpoint_path(folder: &Path) -> PathBuf {
    folder.join("checkpoint").join("state")
}

/// Removes the files of a run that could not begin, so that it can be started again in the same folder.
fn clear_beginning(folder: &Path) {
    for name in ["scene.toml", "gauges.csv", "log.txt"] {
        let _ = fs::remove_file(folder.join(name));
    }
    // Stays where anything else is in it.
    let _ = fs::remove_dir(folder);
}

fn open_log(folder: &Path) -> Result<File, OutputError> {
    let path = folder.join("log.txt");
    OpenOptions::new().create(true).append(true).open(&path).map_err(OutputError::write(&path))
}

/// Removes files `<prefix>NNNNNN.<any>` whose number is `first` or more.
fn remove_numbered(folder: &Path, prefix: &str, first: usize) -> Result<(), OutputError> {
    let Ok(entries) = fs::read_dir(folder) else { return Ok(()) };
    for path in entries.flatten().map(|entry| entry.path()) {
        let number = path.file_stem().and_then(|stem| stem.to_str()?.strip_prefix(prefix)?.parse::<usize>().ok());
        if number.is_some_and(|number| number >= first) {
            fs::remove_file(&path).map_err(OutputError::write(&path))?;
        }
    }
    Ok(())
}
