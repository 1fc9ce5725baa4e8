//! The checkpoint: a model's state, and the output written so far.
//!
//! One file, written whole: a line with a checksum of all that follows, a line of JSON, the state's bytes.

use crate::OutputError;
use crate::frames::FrameFormat;
use crate::whole::write_whole;
use corpuscle_scene::read_bytes;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::io::Write;
use std::path::Path;

const MAGIC: &str = "corpuscle checkpoint 1 sha256:";

/// Times of a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Clock {
    /// Simulated time, s.
    pub time_s: f64,
    /// Wall-clock time spent so far, over all parts of an interrupted run, s.
    pub wall_time_s: f64,
}

/// The header of a checkpoint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Progress {
    /// Version of Corpuscle that wrote it.
    pub version: String,
    /// Checksum of the scene's text.
    pub scene_sha256: String,
    /// The times of the run.
    pub clock: Clock,
    /// Format of the particle files.
    pub frame_format: FrameFormat,
    /// Times of the frames written, s.
    pub frame_times: Vec<f64>,
    /// Times of the depth maps written, s.
    pub map_times: Vec<f64>,
    /// Rows of gauges written.
    pub gauge_rows: usize,
}

impl Progress {
    /// Writes the checkpoint, whole or not at all.
    pub(crate) fn write(&self, path: &Path, state: &[u8]) -> Result<(), OutputError> {
        let line = serde_json::to_string(self).map_err(|error| OutputError::content(path, error))? + "\n";
        let digest = checksum(&[line.as_bytes(), state]);
        write_whole(path, |file| {
            writeln!(file, "{MAGIC}{digest}")?;
            file.write_all(line.as_bytes())?;
            file.write_all(state)
        })
    }

    /// Reads a checkpoint and its state, and checks that it is sound, of this version and of this scene.
    pub(crate) fn read(path: &Path, scene_text: &str) -> Result<(Self, Vec<u8>), OutputError> {
        let refuse = |what: String| OutputError::Checkpoint { path: path.to_owned(), what };
        let mut bytes = read_bytes(path).map_err(OutputError::read(path))?;
        let (digest, rest) = split_line(&bytes)
            .and_then(|(line, rest)| Some((line.strip_prefix(MAGIC)?, rest)))
            .ok_or_else(|| refuse("it does not begin as a checkpoint of this version does".into()))?;
        if checksum(&[rest]) != digest {
            return Err(refuse("it is damaged (its checksum does not fit)".into()));
        }
        let (line, state) = split_line(rest).ok_or_else(|| refuse("it has no description of the run".into()))?;
        let progress: Self = serde_json::from_str(line).map_err(|error| refuse(error.to_string()))?;
        progress.check(scene_text).map_err(refuse)?;
        let start = bytes.len() - state.len();
        bytes.drain(..start);
        Ok((progress, bytes))
    }

    fn check(&self, scene_text: &str) -> Result<(), String> {
        let version = env!("CARGO_PKG_VERSION");
        if self.version != version {
            return Err(format!("version {} wrote it and this is version {version}", self.version));
        }
        if self.scene_sha256 != checksum(&[scene_text.as_bytes()]) {
            return Err("the folder's scene.toml has been changed since".into());
        }
        Ok(())
    }
}

/// SHA-256 of the parts one after another, in hexadecimal.
pub(crate) fn checksum(parts: &[&[u8]]) -> String {
    let mut hash = Sha256::new();
    parts.iter().for_each(|part| hash.update(part));
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The first line, as text and without its end, and what follows it.
fn split_line(bytes: &[u8]) -> Option<(&str, &[u8])> {
    let end = bytes.iter().position(|&byte| byte == b'\n')?;
    Some((std::str::from_utf8(&bytes[..end]).ok()?, &bytes[end + 1..]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn progress() -> Progress {
        Progress {
            version: env!("CARGO_PKG_VERSION").into(),
            scene_sha256: checksum(&[b"scene"]),
            clock: Clock { time_s: 0.1 + 0.2, wall_time_s: 3.5 },
            frame_format: FrameFormat::Csv,
            frame_times: vec![0.0, 0.1, 0.30000000000000004],
            map_times: vec![0.0],
            gauge_rows: 7,
        }
    }

    #[test]
    fn reads_back_to_the_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state");
        let state: Vec<u8> = (0..=255).cycle().take(5000).collect();
        progress().write(&path, &state).unwrap();
        assert_eq!(Progress::read(&path, "scene").unwrap(), (progress(), state));
    }

    #[test]
    fn any_damage_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state");
        progress().write(&path, b"some state\nwith lines").unwrap();
        let sound = fs::read(&path).unwrap();
        for at in 0..sound.len() {
            let mut damaged = sound.clone();
            damaged[at] ^= 1;
            fs::write(&path, &damaged).unwrap();
            assert!(Progress::read(&path, "scene").is_err(), "byte {at}");
            fs::write(&path, &sound[..at]).unwrap();
            assert!(Progress::read(&path, "scene").is_err(), "cut at {at}");
        }
    }

    #[test]
    fn another_scene_or_version_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state");
        progress().write(&path, b"").unwrap();
        let error = Progress::read(&path, "other").unwrap_err().to_string();
        assert!(error.contains("scene.toml has been changed"), "{error}");
        Progress { version: "0.0.0".into(), ..progress() }.write(&path, b"").unwrap();
        let error = Progress::read(&path, "scene").unwrap_err().to_string();
        assert!(error.contains("version 0.0.0"), "{error}");
    }
}
