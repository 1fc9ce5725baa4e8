//! Tables: time series, gauges, summaries, camera paths, balls at the start; maps of runs and their times, trajectories of particles.

use super::{none, on_file, path_of, written};
use crate::Target;
use corpuscle::{Simulation, camera_path};
use corpuscle_output::{FrameFormat, GaugeTable, MapFiles, Summary, followed_paths};
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
    Target {
        name: "map-times",
        about: "maps/times.csv",
        corpus: "map-times",
        read: map_times,
        more: || written::file("maps/times.csv", FrameFormat::None),
    },
    Target {
        name: "map",
        about: "maps of runs, GeoTIFF",
        corpus: "map",
        read: map,
        more: || {
            let names = ["maps/depth_000000.tif", "maps/max_depth.tif"];
            names.iter().flat_map(|name| written::file(name, FrameFormat::None)).collect()
        },
    },
    Target {
        name: "followed",
        about: "trajectories of particles, path.csv",
        corpus: "followed",
        read: followed,
        more: || written::file("path.csv", FrameFormat::None),
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

/// A folder with nothing but these times of maps.
fn map_times(bytes: &[u8]) -> Result<String, String> {
    on_file("times/maps/times.csv", bytes, |_| {
        let run = path_of("times");
        let maps = MapFiles::list(&run).map_err(|error| without(&error.to_string(), &run))?;
        Ok(if maps.times().is_empty() { "no times" } else { "times" }.into())
    })
}

/// A folder with one map of the whole run.
fn map(bytes: &[u8]) -> Result<String, String> {
    on_file("one/maps/max_depth.tif", bytes, |_| {
        let run = path_of("one");
        let told = |error: corpuscle_output::OutputError| without(&error.to_string(), &run);
        let maps = MapFiles::list(&run).map_err(told)?;
        let grid = maps.grid().map_err(told)?;
        let values = maps.read("max_depth", grid.columns * grid.rows).map_err(told)?;
        Ok(format!("{} {}", values.is_empty(), grid.columns > 1))
    })
}

fn followed(bytes: &[u8]) -> Result<String, String> {
    on_file("followed/path.csv", bytes, |_| {
        let run = path_of("followed");
        let paths = followed_paths(&run).map_err(|error| without(&error.to_string(), &run))?;
        for path in &paths {
            assert_eq!(path.times.len(), path.points.len());
        }
        Ok(if paths.is_empty() { "no paths" } else { "paths" }.into())
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
