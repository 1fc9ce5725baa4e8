//! A real terrain, 16-bit integers in longitude and latitude, flooded from a point: from the file alone to maps on its
//! grid. Needs the folder of reference data, named by `CORPUSCLE_DATA`.

mod tool;

use corpuscle::terrain::read_raster;
use serde_json::Value;
use std::path::PathBuf;
use tool::Place;

/// The terrain; `None` where the test is to be skipped.
fn terrain() -> Option<PathBuf> {
    let folder = std::env::var_os("CORPUSCLE_DATA").filter(|folder| !folder.is_empty()).map(PathBuf::from);
    if folder.is_none() {
        assert!(
            std::env::var_os("CORPUSCLE_REQUIRE_DATA").is_none_or(|value| value != "1"),
            "CORPUSCLE_DATA is not set"
        );
        eprintln!("skipped: CORPUSCLE_DATA does not name the folder of reference data");
    }
    folder.map(|folder| folder.join("jacksboro/dem.tif"))
}

#[test]
fn a_terrain_file_alone_leads_to_a_flood_on_its_own_grid() {
    let Some(dem) = terrain() else { return };
    let place = Place::new();
    let refused = place.run(&["run", &dem.display().to_string()]).expect_status(2);
    let scene: Vec<_> = refused.stderr.lines().filter(|line| line.contains(" = ")).collect();
    assert_eq!(scene.len(), 3, "{}", refused.stderr);
    place.write("flood.toml", &scene.join("\n"));
    let summary = place
        .run(&["run", "flood.toml", "--json", "--frames", "none", "--until", "600", "-o", "run"])
        .expect_status(0)
        .json();

    // 2000 m3/s for ten minutes over particles of 40 x 40 m; the ledger is that of the last step, which may end a little later.
    assert_eq!(summary["status"], "done");
    let [particles, steps] = ["particles", "steps"].map(|key| summary[key].as_u64().unwrap());
    assert!((100..750).contains(&particles), "{summary}");
    let water = &summary["ledger"]["water_m3"];
    assert!(water["relative_error"].as_f64().unwrap().abs() <= 1e-12, "{water}");
    let beyond = water["final"].as_f64().unwrap() - 1.2e6;
    assert!((0.0..3.0 * 1.2e6 / steps as f64).contains(&beyond), "{water}");

    let ground = read_raster(&dem).unwrap();
    for name in ["depth_000020", "max_depth", "max_speed", "arrival_s", "duration_s", "hazard"] {
        let map = read_raster(place.path(format!("run/maps/{name}.tif"))).unwrap();
        assert_eq!((map.columns, map.rows), (ground.columns, ground.rows), "{name}");
        assert_eq!(map.georeference.corner, ground.georeference.corner, "{name}");
        assert_eq!(map.georeference.cell, ground.georeference.cell, "{name}");
        let system = |raster: &corpuscle::terrain::Raster| raster.georeference.system.as_ref().unwrap().name.clone();
        assert_eq!(system(&map), system(&ground), "{name}");
    }
    // The water in the last map is the water let in, as well as cells twice as wide as the particles' distance show it.
    let depth = read_raster(place.path("run/maps/depth_000020.tif")).unwrap();
    let on_map: f64 = depth.values.iter().filter(|depth| !depth.is_nan()).sum::<f64>() * 74.573 * 92.475;
    let stored = water["final"].as_f64().unwrap();
    assert!((on_map / stored - 1.0).abs() < 0.3, "{on_map} m3 on the map, {stored} m3 let in");
    let extent: Value = serde_json::from_slice(&place.read("run/maps/extent.geojson")).unwrap();
    let corner = &extent["features"][0]["geometry"]["coordinates"][0][0][0];
    let [longitude, latitude] = [0, 1].map(|axis| corner[axis].as_f64().unwrap());
    assert!((-84.42..-84.07).contains(&longitude) && (36.44..36.74).contains(&latitude), "{corner}");
    assert!(place.path("run/report.html").is_file());
}
