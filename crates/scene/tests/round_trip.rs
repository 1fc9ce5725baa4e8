//! A scene written and read again is the same scene, and no text makes the parser panic.

use corpuscle_scene::{
    Edge, Field, FloodScene, Infiltration, LinkLaw, Manning, Scene, Scheme, Series, StartVelocity, Storage, Terrain,
    VelocityRasters, builtin, scenes,
};
use proptest::prelude::*;
use std::path::Path;

fn parse(text: &str) -> Scene {
    Scene::parse(text, "test.toml", &[]).unwrap()
}

#[test]
fn every_built_in_scene_reads_and_round_trips() {
    for scene in scenes() {
        let mut scene = Scene::parse(scene.text, scene.name, &[]).unwrap();
        assert!(!scene.title.is_empty() && !scene.description.is_empty());
        assert_eq!(parse(&scene.to_toml().unwrap()), scene);
        scene.resolve_defaults();
        let written = scene.to_toml().unwrap();
        assert_eq!(parse(&written), scene);
        let own = match (scene.gas(), scene.dew()) {
            (Some(_), _) => ["contact_time_s", "pair_distance"],
            (_, Some(_)) => ["colour_threshold", "pressure_pa"],
            _ => ["map_every_s", "gravity_m_per_s2"],
        };
        for key in ["frame_every_s", "gauge_every_s", "checkpoint_every_wall_s"].into_iter().chain(own) {
            assert!(written.contains(&format!("{key} = ")), "{key} is not in\n{written}");
        }
    }
}

#[test]
fn built_in_scenes_are_found_by_name() {
    assert_eq!(builtin("flood/valley").unwrap().name, "flood/valley");
    assert_eq!(builtin("flood/none"), None);
}

const FILES: &str = r#"
[run]
until_s = 60
[terrain.file]
path = "dem.tif"
[flood]
manning = { raster = "n.tif" }
observed_extent = "/abs/seen.geojson"
[flood.edges]
west = { stage = { csv = "tide.csv" } }
[[flood.water]]
depth_raster = "sub/depth.tif"
[[flood.inflow]]
name = "river"
line = [[0, 0], [1, 1]]
discharge_m3_per_s = { csv = "q.csv" }
[[flood.stage]]
name = "sea"
line = [[0, 0], [1, 1]]
level_m = { csv = "level.csv" }
[[flood.obstacle]]
name = "houses"
file = "houses.geojson"
[flood.rain]
intensity_mm_per_h = { csv = "rain.csv" }
raster = "share.tif"
[flood.land_use]
raster = "use.tif"
[[flood.land_use.class]]
code = 1
"#;

#[test]
fn paths_become_absolute_and_round_trip() {
    let mut scene = parse(FILES);
    scene.resolve_paths(Path::new("/data/scene"));
    let FloodScene { terrain, flood } = scene.flood().unwrap();
    let Terrain::File(file) = terrain else { panic!("{terrain:?}") };
    assert_eq!(file.path, Path::new("/data/scene/dem.tif"));
    assert_eq!(flood.manning, Manning::Raster { raster: "/data/scene/n.tif".into() });
    assert_eq!(flood.inflow[0].discharge_m3_per_s, Series::File { csv: "/data/scene/q.csv".into(), factor: 1.0 });
    assert_eq!(flood.observed_extent.as_deref(), Some(Path::new("/abs/seen.geojson")));
    let written = scene.to_toml().unwrap();
    let files = [".tif\"", ".csv\"", ".geojson\""];
    let values = written.lines().filter_map(|line| line.split_once(" = ")).map(|(_, value)| value);
    let paths: Vec<&str> = values.filter(|value| files.iter().any(|end| value.contains(end))).collect();
    assert_eq!(paths.len(), 11, "{written}");
    for path in paths {
        assert!(path.contains("\"/data/scene/") || path.contains("\"/abs/"), "{path} stays relative");
    }
    assert_eq!(parse(&written), scene);
}

#[test]
fn the_current_folder_is_made_absolute_too() {
    let mut scene = parse(FILES);
    scene.resolve_paths(Path::new(""));
    let Terrain::File(file) = &scene.flood().unwrap().terrain else { panic!() };
    assert_eq!(file.path, std::env::current_dir().unwrap().join("dem.tif"));
}

#[test]
fn the_paths_of_tiles_become_absolute() {
    let mut scene =
        parse(&FILES.replace("[terrain.file]\npath = \"dem.tif\"", "[terrain.tiles]\npaths = [\"a.tif\", \"/b.tif\"]"));
    scene.resolve_paths(Path::new("/data"));
    let Terrain::Tiles(tiles) = &scene.flood().unwrap().terrain else { panic!() };
    assert_eq!(tiles.paths, [Path::new("/data/a.tif"), Path::new("/b.tif")]);
    assert_eq!(parse(&scene.to_toml().unwrap()), scene);
    let text = "run.until_s = 1\nterrain.tiles.paths = []\nflood.water = [{ level_m = 1 }]";
    let text = Scene::parse(text, "test.toml", &[]).unwrap_err().to_string();
    assert!(text.contains("terrain.tiles.paths") && text.contains("must name"), "{text}");
}

#[test]
fn a_box_to_fetch_is_checked() {
    let scene = |bbox: &str| {
        let text = format!("run.until_s = 1\nterrain.fetch.bbox = {bbox}\nflood.water = [{{ level_m = 1 }}]");
        Scene::parse(&text, "test.toml", &[])
    };
    let sound = scene("[-91.56, 41.64, -91.52, 41.68]").unwrap();
    assert_eq!(parse(&sound.to_toml().unwrap()), sound);
    for wrong in ["[41.64, -91.56, 41.68, -91.52]", "[1, 2, 0, 3]", "[0, 0, 200, 1]", "[0, 0, nan, 1]", "[0, 0, 1]"] {
        let text = scene(wrong).unwrap_err().to_string();
        assert!(text.contains("terrain.fetch.bbox"), "{wrong}: {text}");
    }
}

#[test]
fn overrides_change_numbers_words_rows_and_kinds() {
    let set = |overrides: &[(&str, &str)]| {
        let overrides: Vec<_> = overrides.iter().map(|(path, value)| (path.to_string(), value.to_string())).collect();
        Scene::parse(FILES, "test.toml", &overrides).unwrap()
    };
    let scene = set(&[
        ("run.until_s", "10"),
        ("flood.storage", "level-volume"),
        ("title", "Two words"),
        ("flood.inflow.0.discharge_m3_per_s", "[[0, 1], [5, 2]]"),
        ("flood.gauge.0.name", "P1"),
        ("flood.gauge.0.at", "[1, 2]"),
        ("flood.gauge.1", "{ name = \"P2\", at = [3, 4] }"),
        ("flood.sph_swe.control_force", "false"),
    ]);
    assert_eq!(scene.run.until_s, 10.0);
    assert_eq!(scene.title, "Two words");
    let flood = &scene.flood().unwrap().flood;
    assert_eq!(flood.inflow[0].discharge_m3_per_s, Series::Table(vec![[0.0, 1.0], [5.0, 2.0]]));
    assert_eq!(flood.gauge[1].at, Some([3.0, 4.0]));
    assert_eq!(flood.storage, Storage::LevelVolume);
    assert!(!flood.sph_swe.control_force);
    assert_eq!(set(&[("terrain", "{ plane = {} }")]).flood().unwrap().terrain, Terrain::Plane(Default::default()));
}

/// Scheme `sph-swe` was called `paper`, and its table likewise.
#[test]
fn old_names_are_read_and_the_new_ones_written() {
    let new = builtin("flood/rough-terrain").unwrap().text;
    let old = new.replace("\"sph-swe\"", "\"paper\"").replace("[flood.sph_swe]", "[flood.paper]");
    assert_ne!(old, new);
    let read = |text: &str, overrides: &[(&str, &str)]| {
        let overrides: Vec<_> = overrides.iter().map(|(path, value)| (path.to_string(), value.to_string())).collect();
        Scene::parse(text, "test.toml", &overrides)
    };
    let scene = read(&old, &[]).unwrap();
    assert_eq!(scene, read(new, &[]).unwrap());
    let written = scene.to_toml().unwrap();
    assert!(written.contains("scheme = \"sph-swe\"") && written.contains("[flood.sph_swe]"), "{written}");
    assert!(!written.contains("flood.paper") && !written.contains("\"paper\""), "{written}");
    for text in [new, &old] {
        for path in ["flood.paper.control_square", "flood.sph_swe.control_square"] {
            let scene = read(text, &[("flood.scheme", "paper"), (path, "0.25")]).unwrap();
            let flood = &scene.flood().unwrap().flood;
            assert_eq!((flood.scheme, flood.sph_swe.control_square), (Scheme::SphSwe, 0.25), "{path}");
        }
    }
    let line_of = |text: &str, start: &str| 1 + text.lines().position(|line| line.starts_with(start)).unwrap();
    let [scheme, table] = ["scheme", "[flood.paper]"].map(|start| line_of(&old, start));
    assert_eq!(
        scene.notes,
        [
            format!(
                "test.toml:{scheme}:10: flood.scheme = \"paper\" is an old name, which is still read: write flood.scheme = \"sph-swe\""
            ),
            format!("test.toml:{table}:8: flood.paper is an old name, which is still read: write flood.sph_swe"),
        ]
    );
    let scene = read(new, &[("flood.paper.control_square", "0.25"), ("flood.scheme", "paper")]).unwrap();
    assert_eq!(
        scene.notes,
        [
            "--set flood.paper.control_square=0.25: flood.paper is an old name, which is still read: write flood.sph_swe",
            "--set flood.scheme=paper: flood.scheme = \"paper\" is an old name, which is still read: write flood.scheme = \"sph-swe\"",
        ]
    );
    assert!(read(new, &[]).unwrap().notes.is_empty());
    let wrong = old.replace("control_square = 0.5", "control_square = -1.0");
    let message = read(&wrong, &[]).unwrap_err().to_string();
    let line = 1 + wrong.lines().position(|line| line.starts_with("control_square")).unwrap();
    assert!(message.starts_with(&format!("test.toml:{line}:")), "{message}");
    let both = old + "[flood.sph_swe]\nviscosity = 0.2\n";
    let message = read(&both, &[]).unwrap_err().to_string();
    assert!(message.contains("flood.paper") && message.contains("old name of flood.sph_swe"), "{message}");
}

/// Scheme `particle-condensation` of dew was called `paper`.
#[test]
fn the_old_name_of_a_scheme_of_dew_is_read_and_the_new_one_written() {
    let text = builtin("dew/pane").unwrap().text;
    let read = |scheme: &str| {
        let overrides = [("dew.scheme".to_owned(), scheme.to_owned())];
        Scene::parse(text, "test.toml", &overrides).unwrap()
    };
    let (old, new) = (read("paper"), read("particle-condensation"));
    assert_eq!(old, new);
    assert!(old.to_toml().unwrap().contains("scheme = \"particle-condensation\""));
    assert_eq!(
        old.notes,
        [
            "--set dew.scheme=paper: dew.scheme = \"paper\" is an old name, which is still read: write dew.scheme = \"particle-condensation\""
        ]
    );
    assert!(new.notes.is_empty());
}

proptest! {
    #[test]
    fn any_text_is_read_or_refused(text in "\\PC{0,200}", value in "\\PC{0,20}", path in "[a-z0-9.]{0,20}") {
        for overrides in [vec![], vec![(path, value)]] {
            if let Err(error) = Scene::parse(&text, "any.toml", &overrides) {
                prop_assert!(!error.to_string().is_empty());
            }
        }
    }

    #[test]
    fn any_damaged_scene_is_read_or_refused(
        which in 0..scenes().count(), at in 0.0..1.0f64, length in 0usize..30, by in "[\\[\\]{}=.,#\"a-z0-9\n é-]{0,10}",
    ) {
        let text = scenes().nth(which).unwrap().text;
        let boundary = |byte: usize| (byte.min(text.len())..=text.len()).find(|&i| text.is_char_boundary(i)).unwrap();
        let from = boundary((at * text.len() as f64) as usize);
        let to = boundary(from + length);
        let damaged = format!("{}{by}{}", &text[..from], &text[to..]);
        match Scene::parse(&damaged, "damaged.toml", &[]) {
            Ok(scene) => prop_assert_eq!(Scene::parse(&scene.to_toml().unwrap(), "again.toml", &[]).unwrap(), scene),
            Err(error) => prop_assert!(error.to_string().starts_with("damaged.toml"), "{}", error),
        }
    }

    #[test]
    fn any_override_of_a_number_is_read_or_refused(value in any::<f64>()) {
        let overrides = [("flood.spacing_m".to_owned(), format!("{value:?}"))];
        match Scene::parse(builtin("flood/valley").unwrap().text, "valley", &overrides) {
            Ok(scene) => prop_assert_eq!(scene.flood().unwrap().flood.spacing_m.map(f64::to_bits), Some(value.to_bits())),
            Err(error) => prop_assert!(error.to_string().contains("flood.spacing_m"), "{}", error),
        }
    }
}

#[test]
fn feet_become_metres_and_defaults_stay() {
    let text = r#"
        run.until_s = 1
        terrain.plane.extent = { length_m = 100 }
        [flood]
        units = "us"
        spacing_ft = 10
        gravity_ft_per_s2 = 32.0
        rain = { intensity_in_per_h = [[0, 1], [9, 2]] }
        infiltration.green-ampt = { conductivity_in_per_h = 1, suction_ft = 2, deficit = 0.5 }
        edges.west = { stage = [[5, 10]] }
        edges.east = { discharge = [[5, 100]] }
        edge_part = [{ side = "north", from = 1, to = 2, edge = { discharge = { csv = "q.csv" } } }]
        water = [{ depth_ft = 2, polygon = [[0, 0], [1, 0], [1, 1]], velocity_ft_per_s = [1, "x * y"] },
            { level_ft = 1, velocity_ft_per_s = { east = "u.tif", north = "v.tif" } }]
        inflow = [{ name = "a", at = [7, 7], discharge_ft3_per_s = { csv = "q.csv" } }]
        outflow = [{ name = "b", at = [7, 7], rating = [[1, 100]] }]
        stage = [{ name = "c", line = [[7, 7], [8, 8]], level_ft = 3 }]
        [[flood.link]]
        name = "d"
        from = [1, 1]
        to = [9, 9]
        law.culvert = { width_ft = 4, height_ft = 3, floor_ft = [2, 1] }
        [[flood.link]]
        name = "e"
        from = [1, 1]
        to = [9, 9]
        law.weir = { crest_ft = 4, width_ft = 3, coefficient = 3.1 }
    "#;
    let scene = Scene::parse(text, "test", &[]).unwrap();
    let flood = &scene.flood().unwrap().flood;
    let near = |found: f64, exact: f64| assert!((found / exact - 1.0).abs() < 1e-12, "{found} {exact}");
    near(flood.spacing_m.unwrap(), 3.048);
    near(flood.gravity_m_per_s2, 32.0 * 0.3048);
    let rain = flood.rain.as_ref().unwrap();
    assert_eq!(rain.intensity_mm_per_h, Series::Table(vec![[0.0, 25.4], [9.0, 50.8]]));
    assert_eq!((rain.raster.as_ref(), flood.wet_depth_m), (None, 0.01));
    let Some(Infiltration::GreenAmpt(ground)) = flood.infiltration else { panic!() };
    near(ground.suction_m, 0.6096);
    assert_eq!((ground.conductivity_mm_per_h, ground.deficit), (25.4, 0.5));
    assert_eq!(flood.edges.west, Edge::Stage(Series::Table(vec![[5.0, 3.048]])));
    let Edge::Discharge(Series::Table(rows)) = &flood.edges.east else { panic!() };
    near(rows[0][1], 2.8316846592);
    let Edge::Discharge(Series::File { factor, .. }) = flood.edge_part[0].edge else { panic!() };
    near(factor, 0.028316846592);
    assert_eq!((flood.edge_part[0].from, rows[0][0]), (1.0, 5.0));
    assert_eq!(flood.water[0].depth_m, Some(Field::Number(0.6096)));
    let StartVelocity::Components([east, north]) = &flood.water[0].velocity_m_per_s else { panic!() };
    assert_eq!(east.number(), Some(0.3048));
    near(north.at(5.0, 7.0), 0.3048 * 35.0);
    let rasters = VelocityRasters { east: "u.tif".into(), north: "v.tif".into() };
    assert_eq!(flood.water[1].velocity_m_per_s, StartVelocity::Rasters(rasters));
    assert_eq!(flood.water[0].polygon.as_ref().unwrap()[1], [1.0, 0.0]);
    let Series::File { factor, .. } = flood.inflow[0].discharge_m3_per_s else { panic!() };
    near(factor, 0.028316846592);
    near(flood.outflow[0].rating[0][1], 2.8316846592);
    near(flood.outflow[0].rating[0][0], 0.3048);
    assert_eq!(flood.stage[0].level_m, Series::Constant(3.0 * 0.3048));
    let LinkLaw::Culvert(culvert) = &flood.link[0].law else { panic!() };
    assert_eq!((culvert.width_m, culvert.floor_m), (Some(4.0 * 0.3048), Some([0.6096, 0.3048])));
    let LinkLaw::Weir(weir) = &flood.link[1].law else { panic!() };
    near(weir.coefficient, 3.1 * 0.3048_f64.sqrt());
    // Written in metres, it is the same scene.
    let again = Scene::parse(&scene.to_toml().unwrap(), "again", &[]).unwrap();
    assert_eq!(again, scene);
}
