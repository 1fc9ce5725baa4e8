//! Particle files.

use super::{path_of, written};
use crate::Target;
use corpuscle_output::{FrameFiles, FrameFormat};
use std::fs;

pub(super) const TARGETS: &[Target] = &[
    Target {
        name: "vtp",
        about: "particle files, VTK",
        corpus: "vtp",
        read: vtp,
        more: || written::file("frames/frame_000001.vtp", FrameFormat::Vtp),
    },
    Target {
        name: "frames-csv",
        about: "particle files, CSV",
        corpus: "frames-csv",
        read: csv,
        more: || written::file("frames/frame_000001.csv", FrameFormat::Csv),
    },
    Target {
        name: "xyz",
        about: "particle files, extended XYZ",
        corpus: "xyz",
        read: xyz,
        more: || written::file("frames/frame_000001.xyz", FrameFormat::Xyz),
    },
    Target {
        name: "pvd",
        about: "collections of particle files",
        corpus: "pvd",
        read: pvd,
        more: || written::file("frames/frames.pvd", FrameFormat::Vtp),
    },
];

const PVD: &[u8] = b"<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"0\" file=\"frame_000000.vtp\"/></Collection></VTKFile>";

/// A run's folder of one frame, called after its format.
fn frame(run: &str, name: &str, bytes: &[u8]) -> Result<String, String> {
    let run = path_of(run);
    let folder = run.join("frames");
    fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
    if name.ends_with("vtp") {
        fs::write(folder.join("frames.pvd"), PVD).map_err(|error| error.to_string())?;
    }
    fs::write(folder.join(name), bytes).map_err(|error| error.to_string())?;
    let files = FrameFiles::list(&run, |_| 0.0).map_err(|error| error.to_string())?;
    let frame = files.read(0).map_err(|error| error.to_string().replace(&run.display().to_string(), ""))?;
    for set in &frame.sets {
        let lengths = [set.position.len(), set.velocity.len(), set.radius.len(), set.mass.len()];
        assert!(lengths.iter().all(|length| *length == set.len()), "columns of different lengths");
    }
    Ok(format!("{} sets", frame.sets.len().min(3)))
}

fn vtp(bytes: &[u8]) -> Result<String, String> {
    frame("vtp", "frame_000000.vtp", bytes)
}

fn csv(bytes: &[u8]) -> Result<String, String> {
    frame("csv", "frame_000000.csv", bytes)
}

fn xyz(bytes: &[u8]) -> Result<String, String> {
    frame("xyz", "frame_000000.xyz", bytes)
}

fn pvd(bytes: &[u8]) -> Result<String, String> {
    let run = path_of("pvd");
    let folder = run.join("frames");
    fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
    fs::write(folder.join("frames.pvd"), bytes).map_err(|error| error.to_string())?;
    let files =
        FrameFiles::list(&run, |_| 0.0).map_err(|error| error.to_string().replace(&run.display().to_string(), ""))?;
    assert!(
        files.paths().all(|path| path.parent() == Some(folder.as_path()) || path.file_name().is_none()),
        "a file elsewhere"
    );
    files.nearest(1.0);
    Ok("a collection".into())
}
