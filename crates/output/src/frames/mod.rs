//! Particle files: one for each frame, and the collection that ParaView opens.

mod csv;
mod patches;
mod read;
mod vtp;
mod xyz;

pub(crate) use patches::write as write_surface;
pub use read::FrameFiles;
pub use xyz::write as write_extended_xyz;

use crate::OutputError;
use crate::number::Shortest;
use crate::whole::write_whole;
use corpuscle_model::{Container, Frame};
use serde::{Deserialize, Serialize};
use std::io::Write;
use std::path::Path;

/// Format of the particle files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FrameFormat {
    /// VTK XML PolyData, and a collection `frames.pvd`: opens in ParaView.
    #[default]
    Vtp,
    /// One row for each particle.
    Csv,
    /// Extended XYZ: opens in OVITO, VMD and ASE.
    Xyz,
    /// No particle files.
    None,
}

impl FrameFormat {
    /// Name of the file of a frame: `frame_000012.vtp`.
    pub(crate) fn file_name(self, index: usize) -> Option<String> {
        match self {
            Self::Vtp => Some(format!("frame_{index:06}.vtp")),
            Self::Csv => Some(format!("frame_{index:06}.csv")),
            Self::Xyz => Some(format!("frame_{index:06}.xyz")),
            Self::None => None,
        }
    }

    /// Writes one frame into `folder`, whole or not at all; with the box round the particles where the format has one.
    pub(crate) fn write(
        self,
        folder: &Path,
        index: usize,
        frame: &Frame,
        container: Option<&Container>,
    ) -> Result<(), OutputError> {
        let Some(name) = self.file_name(index) else { return Ok(()) };
        write_whole(&folder.join(name), |file| match self {
            Self::Csv => csv::write(file, frame),
            Self::Xyz => xyz::write(file, frame, container),
            Self::Vtp | Self::None => vtp::write(file, frame),
        })
    }
}

/// Writes the collection of all frames so far, with their times in s.
pub(crate) fn write_pvd(folder: &Path, times: &[f64]) -> Result<(), OutputError> {
    write_whole(&folder.join("frames.pvd"), |file| {
        writeln!(file, "<?xml version=\"1.0\"?>")?;
        writeln!(file, "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n  <Collection>")?;
        for (index, &time) in times.iter().enumerate() {
            let time = Shortest(time);
            writeln!(file, "    <DataSet timestep=\"{time}\" part=\"0\" file=\"frame_{index:06}.vtp\"/>")?;
        }
        writeln!(file, "  </Collection>\n</VTKFile>")
    })
}
