//! Settings of pictures from the options of `run` and `render`.

use crate::args::{CameraKind, PictureOptions};
use crate::refusal::refuse;
use anyhow::Result;
use corpuscle::pictures::{GroundStyle, PictureSettings, Viewpoint};
use std::fs;
use std::path::Path;

/// Columns of a camera path; the first four are required.
const COLUMNS: [&str; 6] = ["time_s", "bearing_deg", "height_deg", "zoom", "x", "y"];

/// The settings of pictures of this size that the options give.
pub fn picture_settings(size: [u32; 2], samples: u32, options: &PictureOptions) -> Result<PictureSettings> {
    let viewpoints = match &options.camera_path {
        Some(path) => stations(path)?,
        None => vec![(0.0, viewpoint(options))],
    };
    let ground = match options.ground.as_str() {
        "natural" => GroundStyle::Natural,
        "depth" => GroundStyle::Depth,
        file => GroundStyle::Picture(file.into()),
    };
    Ok(PictureSettings { size, samples, viewpoints, ground, heights: options.heights })
}

fn viewpoint(options: &PictureOptions) -> Viewpoint {
    Viewpoint {
        plan: options.camera == CameraKind::Plan,
        from_deg: options.from,
        centre: options.centre,
        zoom: options.zoom,
    }
}

/// The stations of a camera path, each a time and a viewpoint, from its file.
fn stations(path: &Path) -> Result<Vec<(f64, Viewpoint)>> {
    let wrong = |what: String| refuse(format!("the camera path {}: {what}", path.display()));
    let text = fs::read_to_string(path).map_err(|error| wrong(error.to_string()))?;
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let cells = |line: &str| line.split(',').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
    let header = lines.next().map(|(_, line)| cells(line)).unwrap_or_default();
    if header != COLUMNS && header != COLUMNS[..4] {
        let (few, all) = (COLUMNS[..4].join(","), COLUMNS.join(","));
        return Err(wrong(format!("its first line must be `{few}` or `{all}`")));
    }
    let mut stations = Vec::new();
    for (number, line) in lines {
        let numbers: Option<Vec<f64>> =
            cells(line).iter().map(|cell| cell.parse().ok().filter(|number: &f64| number.is_finite())).collect();
        let row = numbers.filter(|row| row.len() == header.len());
        let row = row.ok_or_else(|| wrong(format!("line {} must be {} numbers", number + 1, header.len())))?;
        if !(-5.0..=89.0).contains(&row[2]) || !(0.01..=1000.0).contains(&row[3]) {
            let limits = "a height from -5 to 89 degrees and a zoom from 0.01 to 1000";
            return Err(wrong(format!("line {} must have {limits}", number + 1)));
        }
        let centre = row.get(4..6).map(|position| [position[0], position[1]]);
        stations.push((row[0], Viewpoint { plan: false, from_deg: Some([row[1], row[2]]), centre, zoom: row[3] }));
    }
    if stations.is_empty() { Err(wrong("it has no stations".into())) } else { Ok(stations) }
}
