//! Tables: time series, gauges, summaries, camera paths, balls at the start.

use super::{none, on_file, path_of, written};
use crate::Target;
use corpuscle::{Simulation, camera_path};
use corpuscle_output::{FrameFormat, GaugeTable, Summary};
use corpuscle_scene::{Scene, Series};
use std::path::Path;

pub(super) const TARGETS: &[Target] = &[
    Target { name: "series", about: "time series in CSV", corpus: "series", read: series, more: none },
    Target {
        name: "gauges",
        about: "gauges.csv",
        corpus: "gauges",
        read: gauges,
        more: || written::file("gauges.csv", FrameFormat::None),
    },
    Target {
        name: "summary",
        about: "summary.json",
        corpus: "summary",
        read: summary,
        more: || written::file("summary.json", FrameFormat::None),
    },
    Target { name: "camera-path", about: "camera paths", corpus: "camera-path", read: camera, more: none },
    Target { name: "balls-xyz", about: "balls at the start, extended XYZ", corpus: "xyz", read: balls_xyz, more: none },
    Target { name: "balls-csv", about: "balls at the start, CSV", corpus: "balls-csv", read: balls_csv, more: none },
];

fn without(message: &str, path: &Path) -> String {
    message.replace(&path.display().to_string(), "")
}

fn series(bytes: &[u8]) -> Result<String, String> {
    on_file("a.csv", bytes, |path| {
        let table = Series::File { csv: path.to_owned(), factor: 1.0 }.load(Path::new(""));
        let table = table.map_err(|error| without(&error.to_string(), path))?;
        for time in [-1.0, 0.0, 0.5, 100.0, 1e9] {
            let value = table.at(time);
            assert!(!value.is_nan(), "a series of finite numbers is not a number at {time} s");
        }
        Ok("a series".into())
    })
}

fn gauges(bytes: &[u8]) -> Result<String, String> {
    on_file("gauges.csv", bytes, |path| {
        let table = GaugeTable::read(path).map_err(|error| without(&error.to_string(), path))?;
        for column in &table.columns {
            assert_eq!(table.column(column).map(|values| values.len()), Some(table.times.len()));
        }
        Ok("gauges".into())
    })
}

fn summary(bytes: &[u8]) -> Result<String, String> {
    on_file("summary.json", bytes, |path| {
        let folder = path.parent().unwrap_or(Path::new(""));
        Summary::read(folder).map(|_| "a summary".into()).map_err(|error| without(&error.to_string(), path))
    })
}

fn camera(bytes: &[u8]) -> Result<String, String> {
    on_file("camera.csv", bytes, |path| camera_path(path).map(|_| "a path".into()))
}

fn balls(name: &str, bytes: &[u8]) -> Result<String, String> {
    on_file(name, bytes, |path| {
        let text = format!("run.until_s = 1\n[gas]\nsize = [100.0, 100.0, 100.0]\nstart_file = {name:?}\n");
        let scene = Scene::parse(&text, "scene.toml", &[]).map_err(|error| error.to_string())?;
        let folder = path_of("");
        let gas = Simulation::open(scene, &folder).map_err(|error| without(&error.to_string(), path))?;
        Ok(if gas.model().particles() > 1 { "balls" } else { "a ball" }.into())
    })
}

fn balls_xyz(bytes: &[u8]) -> Result<String, String> {
    balls("balls.xyz", bytes)
}

fn balls_csv(bytes: &[u8]) -> Result<String, String> {
    balls("balls.csv", bytes)
}
