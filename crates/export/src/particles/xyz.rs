//! Particles as extended XYZ: the frames one after another.

use crate::ExportError;
use crate::error::Failed;
use crate::run::Run;
use corpuscle_atomic_file::WholeFile;
use corpuscle_output::{FrameFiles, OutputError, write_extended_xyz};
use std::fs::File;
use std::io;
use std::path::Path;

/// Writes the particles of a run. Frames that are extended XYZ already are copied, with the box that they have; others have none.
pub(crate) fn write(run: &Run, file: &Path) -> Result<(), ExportError> {
    let frames = run.frames()?;
    let mut whole = WholeFile::create(file).map_err(ExportError::write(file))?;
    for (index, path) in frames.paths().enumerate() {
        write_frame(&frames, index, path, &mut whole).map_err(Failed::at(file))?;
    }
    whole.finish().map_err(ExportError::write(file))
}

fn write_frame(frames: &FrameFiles, index: usize, path: &Path, file: &mut WholeFile) -> Result<(), Failed> {
    if path.extension().is_some_and(|ending| ending == "xyz") {
        let mut frame = File::open(path).map_err(|source| OutputError::Read { path: path.to_owned(), source })?;
        io::copy(&mut frame, file)?;
        return Ok(());
    }
    Ok(write_extended_xyz(file, &frames.read(index)?, None)?)
}
