//! Input that cannot be used: each is refused with one paragraph and exit status 2, and nothing is written.

mod tool;

use corpuscle::terrain::{Bounds, Terrain, write_geotiff};
use std::fs;
use tool::{Ended, Place};

/// A scene on `dem.tif`, which spans 0 to 600 m eastwards and 0 to 500 m northwards, but for its water.
const BASE: &str = "terrain.file.path = \"dem.tif\"\nrun.until_s = 2\n[flood]\nspacing_m = 20\nspacing_depth_m = 1\n";

/// A folder with a sound terrain in it.
fn place_with_terrain() -> Place {
    let place = Place::new();
    let bounds = Bounds { x_min: 0.0, x_max: 600.0, y_min: 0.0, y_max: 500.0 };
    let terrain = Terrain::gridded(bounds, 10.0, |x, y| 0.01 * x + 0.001 * y);
    let grid = terrain.map_grid();
    let heights: Vec<f32> = (0..grid.columns * grid.rows)
        .map(|cell| grid.centre(cell % grid.columns, cell / grid.columns))
        .map(|[x, y]| terrain.height(x, y) as f32)
        .collect();
    write_geotiff(place.path("dem.tif"), grid, &heights, -9999.0).unwrap();
    write_geotiff(place.path("nothing.tif"), grid, &vec![f32::NAN; heights.len()], -9999.0).unwrap();
    place
}

/// One paragraph after `error: `; it may end with the line of the scene at fault and a mark below it.
fn assert_one_paragraph(ended: &Ended, words: &[&str]) {
    let text = ended.stderr.strip_prefix("error: ").unwrap_or_else(|| panic!("{}", ended.stderr));
    let rest: Vec<_> = text.trim_end().lines().skip(1).collect();
    assert!(rest.iter().all(|line| line.contains(" | ")), "{text}");
    assert!(words.iter().all(|word| text.contains(word)), "{words:?}: {text}");
    assert!(ended.stdout.is_empty(), "{}", ended.stdout);
}

/// Runs the scene with this water and wants it refused with these words.
fn refused(place: &Place, rest: &str, words: &[&str]) {
    place.write("scene.toml", &format!("{BASE}{rest}\n"));
    for command in [&["run", "scene.toml", "-o", "out"][..], &["check", "scene.toml"]] {
        assert_one_paragraph(&place.run(command).expect_status(2), words);
    }
    assert!(!place.path("out").exists(), "a refused scene writes nothing");
}

#[test]
fn terrain_that_is_none_is_refused() {
    let place = place_with_terrain();
    let whole = place.read("dem.tif");
    fs::write(place.path("cut.tif"), &whole[..whole.len() / 2]).unwrap();
    fs::write(place.path("picture.tif"), b"\x89PNG\r\n\x1a\n0000").unwrap();
    fs::write(place.path("empty.tif"), b"").unwrap();
    place.write("huge.asc", "ncols 1000000\nnrows 1000000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n");
    fs::create_dir(place.path("folder.tif")).unwrap();
    for (name, words) in [
        ("missing.tif", "No such file"),
        ("cut.tif", "damaged or cut off"),
        ("picture.tif", "PNG picture"),
        ("empty.tif", "the file is empty"),
        ("huge.asc", "1000000 x 1000000"),
        ("nothing.tif", "none of its cells has data"),
        ("folder.tif", "directory"),
    ] {
        place.write("scene.toml", &BASE.replace("dem.tif", name));
        let scene = place.run(&["run", "scene.toml", "-o", "out"]).expect_status(2);
        assert_one_paragraph(&scene, &[name, words]);
        // The same where the terrain stands in the scene's place.
        if name != "missing.tif" && name != "folder.tif" {
            assert_one_paragraph(&place.run(&["run", name]).expect_status(2), &[name, words]);
        }
    }
    assert!(!place.path("out").exists() && !place.path("runs").exists());
}

/// Whoever may read everything (root) reads this file, too; then there is nothing to see.
#[cfg(unix)]
#[test]
fn terrain_that_may_not_be_read_is_refused() {
    use std::os::unix::fs::PermissionsExt;
    let place = place_with_terrain();
    fs::set_permissions(place.path("dem.tif"), fs::Permissions::from_mode(0o000)).unwrap();
    if fs::read(place.path("dem.tif")).is_ok() {
        eprintln!("skipped: this user may read any file");
        return;
    }
    refused(&place, "water = [{ depth_m = 1 }]", &["dem.tif", "may read it"]);
}

#[test]
fn what_lies_outside_the_terrain_is_refused() {
    let place = place_with_terrain();
    let span = "x from 0 to 600 and y from 0 to 500";
    for rest in [
        "water = [{ level_m = 5, polygon = [[1000, 0], [1010, 0], [1010, 10]] }]",
        "water = [{ depth_m = 5, polygon = [[-50, 0], [-10, 0], [-10, 10]] }]",
        "water = [{ block = { from = [590, 10], to = [620, 20], height_m = 5 } }]",
        "inflow = [{ name = \"river\", at = [300, -1], discharge_m3_per_s = 5 }]",
        "inflow = [{ name = \"river\", line = [[300, 0], [1e12, 9]], discharge_m3_per_s = 5 }]",
        "water = [{ depth_m = 1 }]\ngauge = [{ name = \"mill\", at = [601, 0] }]",
        "water = [{ depth_m = 1 }]\nsection = [{ name = \"bridge\", line = [[0, 0], [1e12, 1]] }]",
    ] {
        refused(&place, rest, &["outside the terrain", span]);
    }
}

#[test]
fn numbers_that_are_none_and_keys_that_are_not_known_are_refused_with_their_line() {
    let place = place_with_terrain();
    for (rest, words) in [
        ("water = [{ level_m = nan }]", ["scene.toml:6:22", "must be a finite number"]),
        ("water = [{ depth_m = inf }]", ["flood.water.0.depth_m", "must be a finite number"]),
        ("water = [{ depth_m = 1, polygon = [[0, 0], [9, nan], [9, 9]] }]", ["polygon.1.1 = nan", "finite"]),
        ("manning = nan", ["flood.manning = nan", "finite"]),
        ("water = [{ depht_m = 5 }]", ["flood.water.0.depht_m", "did you mean `depth_m`"]),
        ("watr = [{ depth_m = 5 }]", ["flood.watr", "did you mean `water`"]),
        ("scheme = 3", ["flood.scheme", "wrong kind of value"]),
    ] {
        refused(&place, rest, &words);
    }
}

#[test]
fn files_that_a_scene_names_and_that_are_not_there_are_refused() {
    let place = place_with_terrain();
    for (rest, words) in [
        ("water = [{ depth_raster = \"none.tif\" }]", "none.tif"),
        ("water = [{ depth_raster = \"nothing.tif\" }]", "nothing.tif"),
        ("water = [{ depth_m = 1 }]\nmanning = { raster = \"none.tif\" }", "none.tif"),
        ("water = [{ depth_m = 1 }]\nobserved_extent = \"none.geojson\"", "none.geojson"),
        ("inflow = [{ name = \"river\", at = [300, 200], discharge_m3_per_s = { csv = \"none.csv\" } }]", "none.csv"),
    ] {
        refused(&place, rest, &[words]);
    }
}

#[test]
fn more_water_than_a_machine_holds_is_refused_before_any_memory_is_taken() {
    let place = place_with_terrain();
    for rest in [
        "water = [{ level_m = 1e9 }]",
        "water = [{ level_m = 1e300 }]",
        "water = [{ block = { from = [10, 10], to = [90, 90], height_m = 5, layers = 100000000000 } }]",
        "water = [{ depth_m = 1 }]\n[[flood.inflow]]\nname = \"river\"\nat = [300, 200]\ndischarge_m3_per_s = 1e30",
    ] {
        refused(&place, &format!("scheme = \"sph-swe\"\n{rest}"), &["particles", "flood.spacing_m"]);
    }
    // Particles of scheme voronoi are as many however deep the water is.
    for (rest, words) in [
        ("water = [{ level_m = 1e9 }]", ["1.0e9 m deep", "[[flood.water]]"]),
        ("water = [{ level_m = 1e300 }]", ["m deep", "[[flood.water]]"]),
        (
            "water = [{ block = { from = [10, 10], to = [90, 90], height_m = 5, layers = 100000000000 } }]",
            ["particles", "flood.spacing_m"],
        ),
        (
            "inflow = [{ name = \"river\", at = [300, 200], discharge_m3_per_s = 1e30 }]",
            ["[[flood.inflow]]", "in m3/s"],
        ),
    ] {
        refused(&place, rest, &words);
    }
    let base = BASE.replace("spacing_m = 20", "spacing_m = 1e-4");
    place.write("fine.toml", &format!("{base}water = [{{ depth_m = 1 }}]\n"));
    assert_one_paragraph(&place.run(&["run", "fine.toml"]).expect_status(2), &["particles", "flood.spacing_m"]);
}

#[test]
fn a_scene_without_water_runs_and_says_so() {
    let place = place_with_terrain();
    for (rest, words) in [("", "There is no water"), ("water = [{ level_m = -5 }]", "holds no water")] {
        place.write("dry.toml", &format!("{BASE}{rest}\n"));
        let report = place.run(&["check", "dry.toml", "--json"]).expect_status(0).json();
        let warnings: Vec<_> = report["warnings"].as_array().unwrap().iter().filter_map(|text| text.as_str()).collect();
        assert!(warnings.iter().any(|warning| warning.contains(words)), "{warnings:?}");
    }
}
