//! A flood whose values are no longer numbers: the run ends with one paragraph and exit status 1, and no file holds any
//! of them.

mod tool;

use corpuscle::terrain::{Bounds, Terrain, write_geotiff};
use serde_json::Value;
use std::fs;
use std::path::Path;
use tool::Place;

/// The texts of a folder's files of some ending, with their names.
fn texts(folder: &Path, ending: &str) -> Vec<(String, String)> {
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let wanted = files.filter(|path| path.extension().is_some_and(|found| found == ending));
    wanted.map(|path| (path.display().to_string(), fs::read_to_string(&path).unwrap())).collect()
}

/// The numbers of a ledger, all of which must be there.
fn assert_numbers(summary: &Value) {
    let ledger = summary["ledger"].as_object().unwrap();
    let values = ledger.values().flat_map(|balance| balance.as_object().unwrap().values());
    let values: Vec<_> = values.collect();
    assert!(values.len() >= 8 && values.iter().all(|value| value.is_number()), "{ledger:?}");
}

/// Water of the published scheme ten million times as viscous as the scene has it, far more than its time step can resolve: after
/// some steps its velocities are no numbers.
#[test]
fn a_run_ends_where_a_value_is_no_number_and_no_file_gets_it() {
    let place = Place::new();
    let viscous = ["--set", "flood.sph_swe.viscosity=1e6", "--set", "run.frame_every_s=0.25"];
    let rest = ["--backend", "cpu", "--frames", "csv", "-o", "out"];
    let ended = place.run(&[&["run", "flood/cuboid"], &viscous[..], &rest[..]].concat()).expect_status(1);
    let told = ended.stderr.lines().find(|line| line.starts_with("error: ")).unwrap();
    for word in ["broke down at t = ", "x = ", "y = ", "terrain's coordinates", "stays readable in out"] {
        assert!(told.contains(word), "{word}: {told}");
    }
    let summary: Value = serde_json::from_slice(&place.read("out/summary.json")).unwrap();
    assert_eq!(summary["status"], "failed");
    assert_numbers(&summary);
    let (gauges, frames) = (texts(&place.path("out"), "csv"), texts(&place.path("out/frames"), "csv"));
    assert!(gauges.len() == 1 && frames.len() > 3, "{} frames", frames.len());
    for (name, text) in gauges.iter().chain(&frames) {
        // The first line names the columns: "inflow" is no infinity.
        let numbers = text.lines().skip(1).collect::<String>().to_lowercase();
        assert!(!numbers.contains("nan") && !numbers.contains("inf"), "{name}");
    }
}

/// A reservoir by a raster of depths that end at a dam, twenty metres high.
#[test]
fn water_by_a_raster_that_ends_at_a_dam_runs() {
    let place = Place::new();
    let bounds = Bounds { x_min: 0.0, x_max: 600.0, y_min: 0.0, y_max: 400.0 };
    let terrain = Terrain::gridded(bounds, 10.0, |x, _| 0.02 * (600.0 - x));
    let grid = terrain.map_grid();
    let raster = |name: &str, value: &dyn Fn(f64, f64) -> f64| {
        let cells = (0..grid.columns * grid.rows).map(|cell| grid.centre(cell % grid.columns, cell / grid.columns));
        let values: Vec<f32> = cells.map(|[x, y]| value(x, y) as f32).collect();
        write_geotiff(place.path(name), grid, &values, -9999.0).unwrap();
    };
    raster("dem.tif", &|x, y| terrain.height(x, y));
    raster("depth.tif", &|x, y| if x < 300.0 && (y - 200.0).abs() < 150.0 { 20.0 } else { 0.0 });
    place.write(
        "dam.toml",
        "terrain.file.path = \"dem.tif\"\nrun.until_s = 10\n[flood]\nspacing_m = 10\nspacing_depth_m = 10\n\
         water = [{ depth_raster = \"depth.tif\" }]\n",
    );
    for seed in ["1", "2", "3"] {
        let seed = format!("seed={seed}");
        let ended = place.run(&["run", "dam.toml", "--set", &seed, "--backend", "cpu", "--json"]).expect_status(0);
        assert_numbers(&ended.json());
    }
}

/// Malpasset's own raster of depths, the start of the case that is widely used.
#[test]
fn the_reservoir_of_malpasset_runs_from_its_raster() {
    let Some(data) = std::env::var_os("CORPUSCLE_DATA").filter(|data| Path::new(data).join("malpasset").exists())
    else {
        let is_required = std::env::var_os("CORPUSCLE_REQUIRE_DATA").is_some_and(|value| value == "1");
        assert!(!is_required, "the data of malpasset are missing");
        return eprintln!("skipped the reservoir of malpasset: CORPUSCLE_DATA names no folder with it");
    };
    let place = Place::new();
    let file = |name: &str| Path::new(&data).join("malpasset").join(name).display().to_string();
    place.write(
        "malpasset.toml",
        &format!(
            "terrain.file.path = {:?}\nrun.until_s = 60\n[flood]\nspacing_m = 60\nspacing_depth_m = 20\n\
             water = [{{ depth_raster = {:?} }}]\n",
            file("bed-20m.tif"),
            file("initial-depth-20m.tif")
        ),
    );
    let ended = place.run(&["run", "malpasset.toml", "--backend", "cpu", "--json"]).expect_status(0);
    assert_numbers(&ended.json());
}
