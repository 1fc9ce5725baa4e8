//! Particles as VTKHDF: vertices with all columns as point data, and steps of time.
//!
//! Format: the page on VTKHDF of the VTK documentation, PolyData with steps. Arrays of all frames stand one after another in
//! datasets that grow; `Steps` says where each frame begins. Vertices are the same in all frames but for their number, so they
//! stand there once, for the largest.

use super::columns::Rows;
use crate::ExportError;
use crate::error::Failed;
use crate::hdf5::{HasAttributes, create};
use crate::run::Run;
use corpuscle_atomic_file::write_whole_by_path;
use corpuscle_model::{Frame, ParticleSet, Values};
use corpuscle_output::FrameFiles;
use rust_hdf5::{H5File, H5Group, H5Type};
use std::path::Path;

/// Version of the format.
const VERSION: [i64; 2] = [2, 0];

/// The kinds of cells of PolyData, in the order of their columns in `Steps`.
const CELLS: [&str; 4] = ["Vertices", "Lines", "Polygons", "Strips"];

/// Writes the particles of a run.
pub(crate) fn write(run: &Run, file: &Path) -> Result<(), ExportError> {
    let frames = run.frames()?;
    write_whole_by_path(file, |path| {
        let file = create(path)?;
        write_frames(&file, run, &frames)?;
        Ok(file.close()?)
    })
    .map_err(Failed::at(file))
}

fn write_frames(file: &H5File, run: &Run, frames: &FrameFiles) -> Result<(), Failed> {
    let root = file.create_group("VTKHDF")?;
    root.set_attr_array_numeric("Version", &VERSION)?;
    root.text("Type", "PolyData")?;
    file.text("title", &run.title())?;
    file.text("source", &run.source())?;
    let mut particles = Particles::create(root.create_group("PointData")?, Rows::create::<f64>(&root, "Points", 3)?)?;
    let mut counts = Vec::new();
    let mut times = Vec::new();
    for index in 0..frames.times().len() {
        let frame = frames.read(index)?;
        counts.push(particles.append(&frame)?);
        times.push(frame.time);
    }
    let names: Vec<&str> = particles.sets.iter().map(String::as_str).collect();
    root.set_attr_string_array("set_names", &names)?;
    array(&root, "NumberOfPoints", &counts)?;
    write_cells(&root, &counts)?;
    write_steps(&root, &times, &counts, &particles)
}

/// The vertices: particle by particle, written once for the frame with most of them.
fn write_cells(root: &H5Group, counts: &[i64]) -> Result<(), Failed> {
    let most = counts.iter().copied().max().unwrap_or(0);
    for kind in CELLS {
        let group = root.create_group(kind)?;
        let (counts, most) = if kind == "Vertices" { (counts.to_vec(), most) } else { (vec![0; counts.len()], 0) };
        array(&group, "NumberOfCells", &counts)?;
        array(&group, "NumberOfConnectivityIds", &counts)?;
        for (name, end) in [("Connectivity", most), ("Offsets", most + 1)] {
            let numbers: Vec<i64> = (0..end).collect();
            Rows::create::<i64>(&group, name, 1)?.append(&numbers)?;
        }
    }
    Ok(())
}

/// The times of the frames, and where their arrays begin.
fn write_steps(root: &H5Group, times: &[f64], counts: &[i64], particles: &Particles) -> Result<(), Failed> {
    let steps = root.create_group("Steps")?;
    let starts: Vec<i64> = counts.iter().scan(0, |next, count| Some(std::mem::replace(next, *next + count))).collect();
    let numbers: Vec<i64> = (0..times.len() as i64).collect();
    steps.set_attr_numeric("NSteps", &(times.len() as i64))?;
    array(&steps, "Values", times)?;
    array(&steps, "NumberOfParts", &vec![1_i64; times.len()])?;
    array(&steps, "PartOffsets", &numbers)?;
    array(&steps, "PointOffsets", &starts)?;
    for name in ["CellOffsets", "ConnectivityIdOffsets"] {
        let offsets = steps.new_dataset::<i64>().shape([times.len(), CELLS.len()]).create(name)?;
        offsets.write_raw(&vec![0_i64; times.len() * CELLS.len()])?;
    }
    let of_data = steps.create_group("PointDataOffsets")?;
    particles.names().try_for_each(|name| array(&of_data, name, &starts))
}

/// Writes a small array.
fn array<T: H5Type>(group: &H5Group, name: &str, values: &[T]) -> Result<(), Failed> {
    Ok(group.new_dataset::<T>().shape([values.len()]).create(name)?.write_raw(values)?)
}

/// The arrays of the particles as they grow.
struct Particles {
    group: H5Group,
    points: Rows,
    set: Rows,
    id: Rows,
    /// Velocity, radius, mass, then the model's own columns in order of first appearance: name, values in a row, dataset.
    numbers: Vec<(String, usize, Rows)>,
    /// Names of the sets, by number.
    sets: Vec<String>,
    /// Particles so far.
    count: usize,
}

impl Particles {
    fn create(group: H5Group, points: Rows) -> Result<Self, Failed> {
        let set = Rows::create::<i32>(&group, "set", 1)?;
        let id = Rows::create::<u64>(&group, "id", 1)?;
        let mut particles = Self { group, points, set, id, numbers: Vec::new(), sets: Vec::new(), count: 0 };
        for (name, width) in [("velocity", 3), ("radius", 1), ("mass", 1)] {
            particles.add(name, width)?;
        }
        Ok(particles)
    }

    /// Names of all arrays but the points.
    fn names(&self) -> impl Iterator<Item = &str> {
        ["set", "id"].into_iter().chain(self.numbers.iter().map(|(name, ..)| name.as_str()))
    }

    /// Adds a column; it holds no number for the particles so far.
    fn add(&mut self, name: &str, width: usize) -> Result<(), Failed> {
        let rows = Rows::create::<f64>(&self.group, name, width)?;
        rows.append_nothing(self.count)?;
        self.numbers.push((name.to_owned(), width, rows));
        Ok(())
    }

    /// Adds the particles of a frame; gives their number.
    fn append(&mut self, frame: &Frame) -> Result<i64, Failed> {
        for column in frame.sets.iter().flat_map(|set| &set.columns) {
            if !self.names().any(|name| name == column.name) {
                self.add(column.name, width(&column.values))?;
            }
        }
        for set in &frame.sets {
            self.append_set(set)?;
        }
        Ok(frame.sets.iter().map(|set| set.len() as i64).sum())
    }

    fn append_set(&mut self, set: &ParticleSet) -> Result<(), Failed> {
        let number = self.number_of(&set.name);
        self.points.append(set.position.as_flattened())?;
        self.set.append(&vec![number; set.len()])?;
        self.id.append(&set.id)?;
        for (name, width, rows) in &self.numbers {
            match values(set, name) {
                Some(values) if values.len() == width * set.len() => rows.append(values)?,
                _ => rows.append_nothing(set.len())?,
            }
        }
        self.count += set.len();
        Ok(())
    }

    /// Number of a set.
    fn number_of(&mut self, name: &str) -> i32 {
        let known = self.sets.iter().position(|set| set == name);
        known.unwrap_or_else(|| {
            self.sets.push(name.to_owned());
            self.sets.len() - 1
        }) as i32
    }
}

/// Values in a row of a column.
fn width(values: &Values) -> usize {
    match values {
        Values::Scalar(_) => 1,
        Values::Vector(_) => 3,
    }
}

/// The numbers of a column of a set, row by row; none where the set has no such column.
fn values<'a>(set: &'a ParticleSet, name: &str) -> Option<&'a [f64]> {
    match name {
        "velocity" => Some(set.velocity.as_flattened()),
        "radius" => Some(&set.radius),
        "mass" => Some(&set.mass),
        _ => set.columns.iter().find(|column| column.name == name).map(|column| match &column.values {
            Values::Scalar(values) => values.as_slice(),
            Values::Vector(values) => values.as_flattened(),
        }),
    }
}
