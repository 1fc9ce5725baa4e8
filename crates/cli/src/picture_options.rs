//! Settings of pictures from the options of `run` and `render`.

use crate::args::{CameraKind, PictureOptions, Water};
use crate::refusal::refuse;
use anyhow::Result;
use corpuscle::pictures::{GroundStyle, PictureSettings, Viewpoint, WaterColour};
use corpuscle::{CameraStation, camera_path};
use std::path::Path;

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
    let water = match options.water {
        Water::Clear => WaterColour::Clear,
        Water::Blue => WaterColour::Blue,
        Water::Brown => WaterColour::Brown,
    };
    let sun = options.sun.unwrap_or_default();
    let heights = options.heights;
    Ok(PictureSettings { size, samples, viewpoints, ground, heights, water, sun, ..PictureSettings::default() })
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
    let stations = camera_path(path).map_err(|what| refuse(format!("the camera path {}: {what}", path.display())))?;
    let viewpoint = |CameraStation { time_s, from_deg, zoom, centre }| {
        (time_s, Viewpoint { plan: false, from_deg: Some(from_deg), centre, zoom })
    };
    Ok(stations.into_iter().map(viewpoint).collect())
}
