//! Camera paths: files of times and directions of view.

use std::path::Path;

/// Columns of a camera path; the first four are required.
const COLUMNS: [&str; 6] = ["time_s", "bearing_deg", "height_deg", "zoom", "x", "y"];

/// A station of a camera path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraStation {
    /// Simulated time, s.
    pub time_s: f64,
    /// Bearing and height from which the camera looks, degrees.
    pub from_deg: [f64; 2],
    /// How many times nearer than from where all is in view.
    pub zoom: f64,
    /// The position in the middle of the picture, in the terrain's own coordinates. Left out: the middle of the scene.
    pub centre: Option<[f64; 2]>,
}

/// The stations of a camera path from its file.
///
/// # Errors
/// What is wrong with the file, with its line.
pub fn camera_path(path: &Path) -> Result<Vec<CameraStation>, String> {
    let text = corpuscle_scene::read_text(path).map_err(|error| error.to_string())?;
    stations(&text)
}

fn stations(text: &str) -> Result<Vec<CameraStation>, String> {
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let cells = |line: &str| line.split(',').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
    let header = lines.next().map(|(_, line)| cells(line)).unwrap_or_default();
    if header != COLUMNS && header != COLUMNS[..4] {
        let (few, all) = (COLUMNS[..4].join(","), COLUMNS.join(","));
        return Err(format!("its first line must be `{few}` or `{all}`"));
    }
    let mut stations = Vec::new();
    for (number, line) in lines {
        let numbers: Option<Vec<f64>> =
            cells(line).iter().map(|cell| cell.parse().ok().filter(|number: &f64| number.is_finite())).collect();
        let row = numbers.filter(|row| row.len() == header.len());
        let row = row.ok_or_else(|| format!("line {} must be {} numbers", number + 1, header.len()))?;
        if !(-5.0..=89.0).contains(&row[2]) || !(0.01..=1000.0).contains(&row[3]) {
            let limits = "a height from -5 to 89 degrees and a zoom from 0.01 to 1000";
            return Err(format!("line {} must have {limits}", number + 1));
        }
        let centre = row.get(4..6).map(|position| [position[0], position[1]]);
        stations.push(CameraStation { time_s: row[0], from_deg: [row[1], row[2]], zoom: row[3], centre });
    }
    if stations.is_empty() { Err("it has no stations".into()) } else { Ok(stations) }
}
