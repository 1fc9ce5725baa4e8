//! Results of a run in other formats: maps as NetCDF, gauges as Parquet, particles as VTKHDF or extended XYZ.
//!
//! All is read from the run's folder, so that a run can be exported at any time, also one that was interrupted. Maps and frames
//! are read and written one after another: a file may be larger than the memory.

mod error;
mod gauges;
mod hdf5;
mod maps;
mod particles;
mod run;

pub use error::ExportError;

use run::Run;
use std::fmt;
use std::path::Path;

/// A format of exported files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Maps as NetCDF-4 with the CF conventions.
    NetCdf,
    /// Gauges as Parquet.
    Parquet,
    /// Particles of all frames as VTKHDF.
    VtkHdf,
    /// Particles of all frames as extended XYZ.
    Xyz,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 4] = [Self::NetCdf, Self::Parquet, Self::VtkHdf, Self::Xyz];

    /// The format that the ending of a file's name says.
    ///
    /// # Errors
    /// [`ExportError::Ending`] for any other ending.
    pub fn of(file: &Path) -> Result<Self, ExportError> {
        let ending = file.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_ascii_lowercase();
        let format = Self::ALL.into_iter().find(|format| format.ending() == ending);
        format.ok_or_else(|| ExportError::Ending { path: file.to_owned() })
    }

    /// Ending of its files, without the dot.
    pub fn ending(self) -> &'static str {
        match self {
            Self::NetCdf => "nc",
            Self::Parquet => "parquet",
            Self::VtkHdf => "vtkhdf",
            Self::Xyz => "xyz",
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NetCdf => "maps as NetCDF",
            Self::Parquet => "gauges as Parquet",
            Self::VtkHdf => "particles as VTKHDF",
            Self::Xyz => "particles as extended XYZ",
        })
    }
}

/// Writes a part of a run's results into a file, whole or not at all. Its ending says the format, and the format says which part.
/// A file that is there is replaced.
///
/// # Errors
/// [`ExportError`] where the folder holds no run, the run lacks what is to be written, a file of it is damaged, or the file cannot be
/// written.
pub fn export(run: &Path, file: &Path) -> Result<Format, ExportError> {
    let format = Format::of(file)?;
    let run = Run::open(run)?;
    match format {
        Format::NetCdf => maps::write(&run, file)?,
        Format::Parquet => gauges::write(&run, file)?,
        Format::VtkHdf => particles::write_vtkhdf(&run, file)?,
        Format::Xyz => particles::write_xyz(&run, file)?,
    }
    Ok(format)
}
