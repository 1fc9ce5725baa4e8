//! Particle files read back.

mod columns;
mod csv;
mod vtp;
mod xyz;

use crate::OutputError;
use corpuscle_model::Frame;
use corpuscle_scene::read_text;
use quick_xml::Reader;
use quick_xml::events::Event;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// The particle files of a run, in order of time.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameFiles {
    files: Vec<(f64, PathBuf)>,
}

impl FrameFiles {
    /// The particle files in a run's folder. Times of VTK files stand in `frames.pvd`; those of others come from
    /// `time_of`, which is given the number of the frame.
    ///
    /// # Errors
    /// [`OutputError::NoFrames`] where the run wrote none; [`OutputError::Read`], [`OutputError::Content`] where `frames.pvd`
    /// cannot be used.
    pub fn list(run: &Path, time_of: impl Fn(usize) -> f64) -> Result<Self, OutputError> {
        let folder = run.join("frames");
        let collection = folder.join("frames.pvd");
        let files = if collection.exists() {
            let text = read_text(&collection).map_err(OutputError::read(&collection))?;
            let files = collected(&text).map_err(|what| OutputError::content(&collection, what))?;
            files.into_iter().map(|(time, name)| (time, folder.join(name))).collect()
        } else {
            let ending = if folder.join("frame_000000.xyz").exists() { "xyz" } else { "csv" };
            let path = |index: usize| folder.join(format!("frame_{index:06}.{ending}"));
            (0..)
                .take_while(|index| path(*index).exists())
                .map(|index| (time_of(index), path(index)))
                .collect::<Vec<_>>()
        };
        if files.is_empty() { Err(OutputError::NoFrames { path: run.to_owned() }) } else { Ok(Self { files }) }
    }

    /// Times of the frames, s.
    pub fn times(&self) -> impl ExactSizeIterator<Item = f64> {
        self.files.iter().map(|(time, _)| *time)
    }

    /// The files.
    pub fn paths(&self) -> impl ExactSizeIterator<Item = &Path> {
        self.files.iter().map(|(_, path)| path.as_path())
    }

    /// Number of the frame nearest to a time, s.
    pub fn nearest(&self, time: f64) -> usize {
        let distance = |index: &usize| (self.files[*index].0 - time).abs();
        (0..self.files.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
    }

    /// Reads a frame: as it was written, to the bit (of a table: but for the payload of what is no number, and sets without
    /// particles). Units do not stand in these files; columns have none.
    ///
    /// # Errors
    /// [`OutputError::Read`], [`OutputError::Content`] where a file is damaged or not one of these.
    ///
    /// # Panics
    /// Where there is no frame of this number.
    pub fn read(&self, index: usize) -> Result<Frame, OutputError> {
        let (time, path) = &self.files[index];
        let text = read_text(path).map_err(OutputError::read(path))?;
        let frame = match path.extension().and_then(OsStr::to_str) {
            Some("csv") => csv::read(&text, *time),
            Some("xyz") => xyz::read(&text),
            _ => vtp::read(&text),
        };
        frame.map_err(|what| OutputError::content(path, what))
    }
}

/// Times and names of the files in a collection. A name with a folder in it is refused: these files stand beside it.
fn collected(text: &str) -> Result<Vec<(f64, String)>, String> {
    let mut reader = Reader::from_str(text);
    let mut files = Vec::new();
    loop {
        match reader.read_event().map_err(|error| error.to_string())? {
            Event::Empty(element) | Event::Start(element) if element.name().as_ref() == b"DataSet" => {
                let time = vtp::attribute(&element, "timestep")?;
                let time = time.parse().map_err(|_| format!("the time `{time}` is not a number"))?;
                let name = vtp::attribute(&element, "file")?;
                // Of `/` and `..`, too, there is one component, and `a/.` has the one of `a`.
                if Path::new(&name).file_name() != Some(OsStr::new(&name)) {
                    return Err(format!("the file `{name}` does not stand beside it"));
                }
                files.push((time, name));
            }
            Event::Eof => return Ok(files),
            _ => {}
        }
    }
}
