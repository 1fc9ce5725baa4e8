//! What the README and the guide tell a newcomer to type does what they say. What takes minutes is run by `.ci/run`.
#![cfg(unix)]

mod tool;

use corpuscle::terrain::{Bounds, Terrain, write_geotiff};
use std::fs;
use std::path::Path;
use std::process::Command;
use tool::{Ended, Place};

fn page(name: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(name)).unwrap()
}

/// The blocks of a page between ``` and ```, of one language.
fn blocks(page: &str, language: &str) -> Vec<String> {
    let fence = format!("```{language}\n");
    page.split(&fence).skip(1).filter_map(|rest| Some(rest.split("```").next()?.to_owned())).collect()
}

/// A line typed by a user; `corpuscle` is the binary under test.
fn type_in(place: &Place, line: &str) -> Ended {
    let script = format!("corpuscle() {{ '{}' \"$@\"; }}\n{line}", env!("CARGO_BIN_EXE_corpuscle"));
    Ended::of(Command::new("sh").args(["-c", &script]).current_dir(place.path("")).output().unwrap())
}

/// Writes `dem.tif`: a valley where the README's inflow is.
fn write_terrain(place: &Place) {
    let bounds = Bounds { x_min: 512_000.0, x_max: 513_000.0, y_min: 203_800.0, y_max: 204_400.0 };
    let terrain = Terrain::gridded(bounds, 20.0, |x, y| 0.1 * (y - 204_100.0).abs() - 0.002 * (x - 512_000.0));
    let grid = terrain.map_grid();
    let centres = (0..grid.columns * grid.rows).map(|cell| grid.centre(cell % grid.columns, cell / grid.columns));
    let heights: Vec<f32> = centres.map(|[x, y]| terrain.height(x, y) as f32).collect();
    write_geotiff(place.path("dem.tif"), grid, &heights, -9999.0).unwrap();
}

#[test]
fn the_scene_of_the_readme_floods_a_terrain() {
    let place = Place::new();
    write_terrain(&place);
    let readme = page("README.md");
    let scenes = blocks(&readme, "toml");
    assert_eq!(scenes.len(), 1);
    place.write("flood.toml", &scenes[0]);
    let typed: Vec<_> =
        readme.lines().filter(|line| line.starts_with("cargo run --release -- run flood.toml")).collect();
    assert_eq!(typed.len(), 1);
    let line = typed[0].replace("cargo run --release --", "corpuscle") + " --until 60";
    type_in(&place, &line).expect_status(0);
    assert!(
        place.path("runs/flood-1/report.html").is_file() && place.path("runs/flood-1/maps/max_depth.tif").is_file()
    );
    assert!(readme.contains("`cargo run --release -- run dem.tif` answers with a scene"));
    let answer = type_in(&place, "corpuscle run dem.tif").expect_status(2);
    assert!(answer.stderr.contains("terrain.file.path = \"dem.tif\""), "{}", answer.stderr);
}

#[test]
fn every_command_of_the_readme_is_there_and_takes_json() {
    let place = Place::new();
    let readme = page("README.md");
    let rows: Vec<_> = readme.lines().filter_map(|line| line.strip_prefix("| `corpuscle ")).collect();
    assert!(rows.len() >= 5, "{rows:?}");
    for row in rows {
        let command = row.split(['`', ' ']).next().unwrap();
        let help = type_in(&place, &format!("corpuscle {command} --help")).expect_status(0).stdout;
        assert!(help.contains("--json"), "{command}");
    }
}

/// Runs of built-in scenes are checked instead: they differ in nothing but the work.
#[test]
fn what_the_guide_types_is_understood() {
    let place = Place::new();
    let mut typed = 0;
    for name in ["first-flood", "first-gas", "gas", "scene", "sph-swe", "command-line"] {
        for block in blocks(&page(&format!("docs/src/{name}.md")), "text") {
            let runs = block.lines().filter(|line| line.starts_with("corpuscle run") && !line.contains("--resume"));
            for line in
                runs.filter(|line| line.contains(" flood/") || line.contains(" --set ") && !line.contains("SCENE"))
            {
                let line = line.replacen("corpuscle run", "corpuscle check", 1);
                type_in(&place, &line).expect_status(0);
                typed += 1;
            }
        }
    }
    assert!(typed >= 5, "{typed}");
    let first = page("docs/src/first-flood.md");
    let blocks = blocks(&first, "text");
    let copying =
        blocks.iter().find_map(|block| Some(&block[block.find("corpuscle scenes flood/valley --copy my.toml")?..]));
    let copying: Vec<_> = copying.unwrap().lines().map(|line| line.split('#').next().unwrap().trim_end()).collect();
    assert_eq!(copying[1..], ["corpuscle check my.toml", "corpuscle run my.toml -o my-run"]);
    type_in(&place, &format!("{} --until 5", copying.join(" && "))).expect_status(0);
    assert!(place.path("my-run/report.html").is_file());
}

/// Built without MPI, it says so where `mpirun` starts several of it: each would run the whole scene.
#[cfg(not(feature = "mpi"))]
#[test]
fn several_processes_without_mpi_are_refused() {
    let place = Place::new();
    place.write("lake.toml", tool::LAKE);
    for (name, status) in [("OMPI_COMM_WORLD_SIZE", 2), ("PMI_SIZE", 2), ("PMIX_RANK", 2), ("OTHER", 0)] {
        let mut command = place.command(&["run", "lake.toml", "-o", name]);
        let ended = Ended::of(command.env(name, "2").output().unwrap()).expect_status(status);
        assert_eq!(ended.stderr.contains("--features mpi"), status == 2, "{}", ended.stderr);
    }
}
