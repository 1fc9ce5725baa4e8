//! What `ffprobe` says of a film, where the machine has it.

use std::path::Path;
use std::process::Command;

/// What it read.
#[derive(Debug)]
pub struct Probed {
    pub codec: String,
    pub size: [u32; 2],
    pub seconds: f64,
    pub rate: f64,
    /// Pictures that it could decode.
    pub pictures: usize,
}

/// Asks `ffprobe`; none where there is none and `CORPUSCLE_REQUIRE_FFPROBE` is not set.
pub fn read(path: &Path) -> Option<Probed> {
    let asked = ["-v", "error", "-count_frames", "-show_streams", "-of", "json"];
    let output = match Command::new("ffprobe").args(asked).arg(path).output() {
        Ok(output) => output,
        Err(_) if std::env::var_os("CORPUSCLE_REQUIRE_FFPROBE").is_none() => {
            eprintln!("skipped: no ffprobe on this machine");
            return None;
        }
        Err(error) => panic!("CORPUSCLE_REQUIRE_FFPROBE is set, but ffprobe cannot be run: {error}"),
    };
    assert!(output.status.success() && output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    let answer: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let stream = &answer["streams"][0];
    let text = |name: &str| stream[name].as_str().unwrap().to_owned();
    let side = |name: &str| stream[name].as_u64().unwrap() as u32;
    let (over, under) = stream["avg_frame_rate"].as_str().unwrap().split_once('/').unwrap();
    Some(Probed {
        codec: text("codec_name"),
        size: [side("width"), side("height")],
        seconds: text("duration").parse().unwrap(),
        rate: over.parse::<f64>().unwrap() / under.parse::<f64>().unwrap(),
        pictures: text("nb_read_frames").parse().unwrap(),
    })
}
