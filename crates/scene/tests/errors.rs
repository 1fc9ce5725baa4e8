//! Every way a scene can be wrong is refused with its line, key, value and what would be right.

use corpuscle_scene::{FloodScene, Scene};

/// A scene without fault; each test spoils one line of it.
const GOOD: &str = r#"title = "test"
seed = 1

[run]
until_s = 60.0
frame_every_s = 1.0

[terrain.plane]
extent = { length_m = 100.0, width_m = 50.0, cell_m = 1.0 }

[flood]
scheme = "voronoi"
spacing_m = 1.0
manning = 0.03

[flood.edges]
west = "wall"
east = { stage = [[0.0, 1.0], [10.0, 2.0]] }

[[flood.water]]
level_m = 1.0
polygon = [[0, 0], [10, 0], [10, 10]]

[[flood.inflow]]
name = "river"
at = [1.0, 1.0]
discharge_m3_per_s = [[0.0, 1.0], [10.0, 2.0]]

[[flood.gauge]]
name = "P1"
at = [1.0, 1.0]

[[flood.section]]
name = "S1"
line = [[0.0, 0.0], [1.0, 0.0]]
"#;

/// What scheme sph-swe does not have in it.
const EAST: &str = "east = { stage = [[0.0, 1.0], [10.0, 2.0]] }";

fn refuse(text: &str, overrides: &[(&str, &str)]) -> String {
    let overrides: Vec<_> = overrides.iter().map(|(path, value)| (path.to_string(), value.to_string())).collect();
    match Scene::parse(text, "test.toml", &overrides) {
        Ok(scene) => panic!("accepted:\n{text}\n{scene:?}"),
        Err(error) => error.to_string(),
    }
}

/// Replaces one line by another and asserts that the message holds all the words.
fn assert_refused(line: &str, by: &str, words: &[&str]) {
    let lines: Vec<_> = GOOD.lines().collect();
    let number = 1 + lines.iter().position(|found| *found == line).unwrap_or_else(|| panic!("no line {line}"));
    let text = GOOD.replace(&format!("\n{line}\n"), &format!("\n{by}\n"));
    let message = refuse(&text, &[]);
    for word in words.iter().copied().chain([format!("test.toml:{number}:").as_str()]) {
        assert!(message.contains(word), "{by}: {word:?} is not in:\n{message}");
    }
}

#[test]
fn the_scene_that_the_tests_spoil_is_good() {
    Scene::parse(GOOD, "test.toml", &[]).unwrap();
}

#[test]
fn syntax() {
    assert_refused("until_s = 60.0", "until_s =", &["this is not TOML"]);
    assert_refused("scheme = \"voronoi\"", "scheme = \"voronoi", &["this is not TOML"]);
    let twice = refuse(&GOOD.replace("seed = 1", "seed = 1\nseed = 2"), &[]);
    assert!(twice.contains("test.toml:3:1") && twice.contains("duplicate key"), "{twice}");
}

#[test]
fn the_message_shows_the_line_and_marks_the_value() {
    let message = refuse(&GOOD.replace("spacing_m = 1.0", "spacing_m = -5.0 # too small"), &[]);
    let expected = "test.toml:13:13: flood.spacing_m = -5.0: must be larger than 0
  13 | spacing_m = -5.0 # too small
     |             ^^^^";
    assert_eq!(message, expected);
}

#[test]
fn unknown_words() {
    assert_refused("seed = 1", "sed = 1", &["sed is not a key", "did you mean `seed`"]);
    assert_refused("spacing_m = 1.0", "spacng_m = 1.0", &["flood.spacng_m", "did you mean `spacing_m`"]);
    assert_refused("spacing_m = 1.0", "qq = 1.0", &["flood.qq", "known: scheme, units, spacing_m"]);
    assert_refused("[run]", "[rum]", &["rum", "did you mean `run`"]);
    assert_refused("[terrain.plane]", "[terrain.plain]", &["did you mean `plane`", "rough-hills"]);
    assert_refused("west = \"wall\"", "west = \"wal\"", &["flood.edges.west", "did you mean `wall`"]);
    assert_refused("west = \"wall\"", "west = { stag = 1.0 }", &["flood.edges.west", "did you mean `stage`"]);
    assert_refused("scheme = \"voronoi\"", "scheme = \"voroni\"", &["flood.scheme", "did you mean `voronoi`"]);
}

#[test]
fn wrong_types() {
    assert_refused("until_s = 60.0", "until_s = \"long\"", &["run.until_s", "\"long\"", "expected a number"]);
    assert_refused("seed = 1", "seed = -1", &["seed", "-1", "0 or more"]);
    assert_refused("seed = 1", "seed = 99999999999999999999999", &["seed", "99999999999999999999999"]);
    assert_refused("seed = 1", "seed = 18446744073709551615", &["at most 9223372036854775807"]);
    assert_refused("manning = 0.03", "manning = true", &["flood.manning", "expected a number", "raster"]);
    assert_refused("manning = 0.03", "manning = { rster = \"n.tif\" }", &["{ raster = "]);
    assert_refused("manning = 0.03", "manning = { raster = \"n.tif\", n = 1 }", &["{ raster = "]);
    assert_refused("west = \"wall\"", "west = \"stage\"", &["flood.edges.west", "needs a value", "{ stage = "]);
    assert_refused("west = \"wall\"", "west = { stage = \"a\" }", &["flood.edges.west", "expected a number", "csv"]);
    assert_refused("west = \"wall\"", "west = 1", &["flood.edges.west", "a word in quotes or a table"]);
    assert_refused("line = [[0.0, 0.0], [1.0, 0.0]]", "line = [[0.0], [1.0, 0.0]]", &["two numbers"]);
    assert_refused("[[flood.gauge]]", "[flood.gauge]", &["flood.gauge", "double brackets"]);
}

#[test]
fn nothing_written_is_passed_over() {
    let third = "line = [[0.0, 0.0, 7.0], [1.0, 0.0]]";
    assert_refused("line = [[0.0, 0.0], [1.0, 0.0]]", third, &["flood.section.0.line.0.2", "not used", "^^^"]);
    let list = "extent = [100.0, 50.0, 1.0]";
    assert_refused("extent = { length_m = 100.0, width_m = 50.0, cell_m = 1.0 }", list, &["terrain.plane.extent"]);
}

#[test]
fn missing_keys_and_tables() {
    let without = |line: &str| refuse(&GOOD.replace(&format!("{line}\n"), ""), &[]);
    let message = without("until_s = 60.0");
    assert!(
        message.contains("test.toml:4:1: run.until_s is missing") && message.contains("until_s = 600"),
        "{message}"
    );
    let message = without("name = \"S1\"");
    assert!(message.contains("test.toml:33:1: flood.section.0.name is missing"), "{message}");
    for (text, words) in [
        ("", ["test.toml: run is missing", "until_s"]),
        ("[run]\nuntil_s = 1\n[flood]\n", ["test.toml: terrain is missing", "[terrain.file]"]),
        ("[run]\nuntil_s = 1\n", ["test.toml: the scene has no model", "[gas]"]),
        (
            "[run]\nuntil_s = 1\n[terrain.plane]\n[gas]\nsize = [1, 1]\n",
            ["test.toml:4:1: gas", "take out [gas], or [terrain]"],
        ),
        ("[run]\nuntil_s = 1\n[flood]\n[gas]\nsize = [1, 1]\n", ["test.toml:4:1: gas", "take out [gas], or [flood]"]),
        ("[run]\nuntil_s = 1\n[terrain.plane]\n", ["test.toml: flood is missing", "[flood]"]),
        ("[run]\nuntil_s = 1\n[terrain]\n[flood]\n", ["test.toml:3:1: terrain", "exactly one"]),
        ("[run]\nuntil_s = 1\n[terrain.bowl]\n[terrain.plane]\n[flood]\n", ["terrain", "exactly one kind, found more"]),
    ] {
        let message = refuse(text, &[]);
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
    }
}

#[test]
fn numbers_out_of_range() {
    for value in ["nan", "inf", "-inf", "0", "-1.0"] {
        assert_refused("until_s = 60.0", &format!("until_s = {value}"), &["run.until_s = ", "must be "]);
    }
    assert_refused("spacing_m = 1.0", "spacing_m = nan", &["flood.spacing_m = nan", "finite"]);
    assert_refused("line = [[0.0, 0.0], [1.0, 0.0]]", "line = [[0.0, nan], [1.0, 0.0]]", &["flood.section.0.line.0.1"]);
    assert_refused("frame_every_s = 1.0", "frame_every_s = 1e-9", &["run.frame_every_s", "frames"]);
    assert_refused("manning = 0.03", "manning = 30.0", &["flood.manning = 30.0", "1/k = 0.0333"]);
    assert_refused("manning = 0.03", "manning = -0.1", &["flood.manning = -0.1", "at least 0"]);
    let extent = "extent = { length_m = 100.0, width_m = 50.0, cell_m = 1.0 }";
    assert_refused(extent, "extent = { length_m = 1e6, width_m = 1e6, cell_m = 1.0 }", &["cell_m", "larger cells"]);
    assert_refused(extent, "extent = { length_m = 9.0, width_m = 5.0, cell_m = 7.0 }", &["cell_m = 7.0", "at most"]);
    assert_refused(extent, "extent = { length_m = -9.0 }", &["length_m = -9.0", "larger than 0"]);
}

#[test]
fn shapes() {
    let polygon = "polygon = [[0, 0], [10, 0], [10, 10]]";
    assert_refused(polygon, "polygon = []", &["flood.water.0.polygon", "at least three corners"]);
    assert_refused(polygon, "polygon = [[0, 0], [5, 5], [10, 10]]", &["flood.water.0.polygon", "area"]);
    let line = "line = [[0.0, 0.0], [1.0, 0.0]]";
    assert_refused(line, "line = [[0.0, 0.0]]", &["flood.section.0.line", "at least two points"]);
    assert_refused(line, "line = [[0.0, 0.0], [0.0, 0.0]]", &["points 0 and 1", "same"]);
}

/// The water and the gauge of the good scene are at the heads of their tables, so the error points there.
#[test]
fn exactly_one_kind() {
    let spoil = |line: &str, by: &str| refuse(&GOOD.replacen(line, by, 1), &[]);
    let both = spoil("level_m = 1.0", "level_m = 1.0\ndepth_m = 1.0");
    assert!(
        both.contains("test.toml:20:1: flood.water.0") && both.contains("not level_m and depth_m together"),
        "{both}"
    );
    let none = spoil("level_m = 1.0\n", "");
    assert!(none.contains("flood.water.0: give exactly one of level_m, depth_m, depth_raster, block"), "{none}");
    let none = spoil("at = [1.0, 1.0]\n", "");
    assert!(none.contains("flood.inflow.0: give exactly one of at, line; none"), "{none}");
    let both = spoil("name = \"P1\"", "name = \"P1\"\nlon_lat = [7.0, 43.5]");
    assert!(both.contains("flood.gauge.0: give exactly one of at, lon_lat"), "{both}");
    let block = "block = { from = [0, 0], to = [1, 1], height_m = 1 }";
    let polygon = spoil("level_m = 1.0", block);
    assert!(polygon.contains("flood.water.0.polygon") && polygon.contains("own corners"), "{polygon}");
}

#[test]
fn series_in_the_scene() {
    let line = "discharge_m3_per_s = [[0.0, 1.0], [10.0, 2.0]]";
    let key = "flood.inflow.0.discharge_m3_per_s";
    let spoil = |by: &str, words: &[&str]| assert_refused(line, &format!("discharge_m3_per_s = {by}"), words);
    spoil("[[10.0, 1.0], [1.0, 2.0]]", &[key, "sort the rows by time"]);
    spoil("[[0.0, 1.0], [10.0, -2.0]]", &[key, "must not be negative (-2 here)"]);
    spoil("-3", &[key, "must not be negative"]);
    spoil("[]", &[key, "no rows"]);
    spoil("[[0.0, inf]]", &[key, "finite"]);
    spoil("[[0.0, 1.0], [10.0]]", &[key, "rows of [time_s, value]"]);
    assert_refused(EAST, "east = { stage = [[9.0, 1.0], [1.0, 2.0]] }", &["flood.edges.east.stage.1", "sort the rows"]);
}

#[test]
fn names_and_edges() {
    assert_refused("name = \"S1\"", "name = \"P1\"", &["flood.section.0.name", "taken by flood.gauge.0.name"]);
    assert_refused("name = \"river\"", "name = \"S1\"", &["flood.inflow.0.name", "taken by flood.section.0.name"]);
    assert_refused("name = \"S1\"", "name = \"a,b\"", &["flood.section.0.name = \"a,b\"", "letters, digits"]);
    assert_refused("name = \"S1\"", "name = \"\"", &["flood.section.0.name", "letters, digits"]);
    assert_refused("west = \"wall\"", "west = \"periodic\"", &["flood.edges.west", "give east = \"periodic\""]);
}

#[test]
fn what_an_override_leaves_out_is_named_by_its_table() {
    for path in ["flood.gauge.1.at", "flood.outflow.0.at"] {
        let message = refuse(GOOD, &[(path, "[1, 3]")]);
        let table = path.strip_suffix(".at").unwrap();
        assert!(message.contains(&format!("{table}.")) && !message.contains(".at."), "{message}");
    }
}

#[test]
fn overrides_are_named() {
    let others = ("flood.wet_depth_m", "0.5");
    for ((path, value), words) in [
        (("flood.scheme", "sph-sw"), "did you mean `sph-swe`"),
        (("flood.scheme", ""), "known: voronoi, sph-swe"),
        (("flood.spacing_m", "-1"), "must be larger than 0"),
        (("flood.spcing_m", "1"), "did you mean `spacing_m`"),
        (("flood.gauge.5.name", "b"), "the number of a row, 0 to 1"),
        (("flood.gauge.1.name", "b"), "exactly one of at, lon_lat"),
        (("flood.scheme.a", "b"), "there is no `a` in a string"),
        (("flood..a", "b"), "words joined by dots"),
    ] {
        let message = refuse(GOOD, &[others, (path, value), others]);
        assert!(message.starts_with(&format!("--set {path}={value}: ")) && message.contains(words), "{message}");
    }
}

#[test]
fn a_scene_made_in_memory_is_checked_too() {
    let mut scene = Scene::parse(GOOD, "test.toml", &[]).unwrap();
    let FloodScene { flood, .. } = scene.model.get_mut().unwrap();
    flood.spacing_m = Some(f64::NAN);
    assert_eq!(scene.check().unwrap_err().to_string(), "flood.spacing_m = nan: must be a finite number");
}

#[test]
fn a_missing_file_is_named() {
    let message = Scene::read("no/such/scene.toml".as_ref(), &[]).unwrap_err().to_string();
    assert!(message.contains("no/such/scene.toml"), "{message}");
}

#[test]
fn rain_and_ground() {
    let line = "manning = 0.03";
    let spoil = |by: &str, words: &[&str]| assert_refused(line, by, words);
    spoil("rain.intensity_mm_per_h = -1", &["flood.rain.intensity_mm_per_h = -1", "must not be negative"]);
    spoil("rain = { intensity_mm_per_h = [[9, 1], [1, 2]] }", &["flood.rain.intensity_mm_per_h.1", "sort the rows"]);
    spoil("rain = { raster = \"r.tif\" }", &["flood.rain.intensity_mm_per_h is missing"]);
    spoil("infiltration = { constant = { rate_mm_per_h = -1 } }", &["flood.infiltration.constant.rate_mm_per_h"]);
    let horton = "infiltration.horton = { first_mm_per_h = 1, last_mm_per_h = 2, decay_per_h = 1 }";
    spoil(horton, &["flood.infiltration.horton.first_mm_per_h = 1", "at least last_mm_per_h = 2"]);
    let green_ampt = "infiltration.green-ampt = { conductivity_mm_per_h = 1, suction_m = 0.1, deficit = 30 }";
    spoil(green_ampt, &["flood.infiltration.green-ampt.deficit = 30", "from 0 to 1"]);
    spoil("infiltration.hortn = {}", &["did you mean `horton`"]);
    let twice = "land_use = { raster = \"l.tif\", class = [{ code = 1 }, { code = 1 }] }";
    spoil(twice, &["flood.land_use.class.1.code = 1", "taken by flood.land_use.class.0"]);
    let rough = "land_use = { raster = \"l.tif\", class = [{ code = 1, manning = 33 }] }";
    spoil(rough, &["flood.land_use.class.0.manning = 33", "Strickler"]);
    spoil("friction.chezy = 0", &["flood.friction.chezy = 0", "larger than 0"]);
}

#[test]
fn sides_of_scheme_voronoi() {
    let spoil = |by: &str, words: &[&str]| assert_refused("scheme = \"voronoi\"", by, words);
    let part = |rest: &str| format!("edge_part = [{{ side = \"west\", {rest} }}]\nscheme = \"voronoi\"");
    spoil(&part("from = 2, to = 1, edge = \"wall\""), &["flood.edge_part.0.to", "larger than from = 2"]);
    spoil(&part("from = 0, to = 1, edge = \"periodic\""), &["flood.edge_part.0.edge", "whole sides"]);
    spoil(&part("from = 0, to = 1, edge = { normal_depth = 0 }"), &["normal_depth = 0", "larger than 0"]);
    spoil(&part("from = 0, to = 1, edge = { rating = [[1, 1], [0, 2]] }"), &["edge.rating.1", "must rise"]);
    spoil(
        &part("from = 0, to = 1, edge = { wave = { rest_level_m = 1 } }"),
        &["edge.wave", "level_m, velocity_m_per_s, or both"],
    );
}

#[test]
fn structures() {
    let line = "manning = 0.03";
    let spoil = |by: &str, words: &[&str]| assert_refused(line, by, words);
    let sluice = |keys: &str| format!("outflow = [{{ name = \"a\", at = [1, 1], {keys} }}]");
    spoil(&sluice("rating = []"), &["flood.outflow.0.rating", "no rows"]);
    spoil(&sluice("rating = [[2, 1], [1, 2]]"), &["flood.outflow.0.rating.1", "must rise"]);
    spoil(&sluice("rating = [[2, -1]]"), &["flood.outflow.0.rating.0", "must not be negative"]);
    spoil(&sluice("polygon = [[0, 0], [1, 0], [1, 1]], rating = [[0, 1]]"), &["not at and polygon together"]);
    let wall = |rest: &str| format!("obstacle = [{{ name = \"a\", {rest} }}]");
    let line = "line = [[0, 0], [1, 1]]";
    let refused = |by: &str, words: &[&str]| assert_refused("scheme = \"voronoi\"", by, words);
    let voronoi = |rest: &str| format!("{}\nscheme = \"voronoi\"", wall(rest));
    refused(&voronoi("line = [[0, 0]]"), &["flood.obstacle.0.line", "at least two points"]);
    refused(&voronoi(&format!("{line}, crest_m = 1, height_m = 1")), &["flood.obstacle.0.crest_m", "not both"]);
    refused(&voronoi("polygon = [[0, 0], [1, 0], [1, 1]], crest_m = 1"), &["flood.obstacle.0.crest_m", "height_m"]);
    spoil("stage = [{ name = \"a\", level_m = 1 }]", &["flood.stage.0", "exactly one of line, polygon; none"]);
    let link = |law: &str| format!("link = [{{ name = \"a\", from = [0, 0], to = [9, 9], law = {{ {law} }} }}]");
    spoil(&link("culvert = {}"), &["flood.link.0.law.culvert", "diameter_m, width_m and height_m; none"]);
    spoil(&link("culvert = { width_m = 1 }"), &["a box needs both"]);
    spoil(&link("culvert = { diameter_m = -1 }"), &["flood.link.0.law.culvert.diameter_m = -1", "larger than 0"]);
    spoil(&link("weir = { crest_m = 1 }"), &["width_m is missing"]);
    spoil(&link("rating = [[0, 1], [0, 2]]"), &["flood.link.0.law.rating.1", "must rise"]);
    let same = "link = [{ name = \"a\", from = [0, 0], to = [0, 0], law = { weir = { crest_m = 1, width_m = 1 } } }]";
    spoil(same, &["flood.link.0.to", "another position"]);
    spoil("outflow = [{ name = \"river\", at = [1, 1], rating = [[0, 1]] }]", &["flood.outflow.0.name", "is taken by"]);
}

#[test]
fn errors_in_feet_speak_of_feet() {
    let feet = |keys: &str| {
        let text = format!("run.until_s = 1\nterrain.plane = {{}}\n[flood]\nunits = \"us\"\n{keys}\n");
        refuse(&text, &[])
    };
    let cases: [(&str, &[&str]); 6] = [
        ("spacing_m = 3", &["test.toml:5:", "flood.spacing_m: with units = \"us\" give spacing_ft"]),
        ("spacing_ft = -3", &["test.toml:5:", "flood.spacing_ft = -3.0", "larger than 0"]),
        ("spacng_ft = 3", &["did you mean `spacing_ft`"]),
        ("spacing_ft = \"a\"", &["flood.spacing_ft", "expected a number"]),
        ("water = [{ level_ft = 1, depth_ft = 1 }]", &["flood.water.0", "not level_ft and depth_ft together"]),
        ("inflow = [{ name = \"a\", at = [1, 1] }]", &["flood.inflow.0.discharge_ft3_per_s is missing"]),
    ];
    for (keys, words) in cases {
        let message = feet(keys);
        assert!(words.iter().all(|word| message.contains(word)), "{words:?} are not in {message}");
    }
    assert_refused("spacing_m = 1.0", "spacing_ft = 1.0", &["flood.spacing_ft", "not a key that is known here"]);
}

#[test]
fn expressions_and_velocities_at_the_start() {
    assert_refused(
        "level_m = 1.0",
        "level_m = \"2 + sine(x)\"",
        &[
            "flood.water.0.level_m",
            "`2 + sine(x)` cannot be read at character 5",
            "`sine` is not known here",
            "sin, cos",
        ],
    );
    assert_refused(
        "level_m = 1.0",
        "level_m = [1.0]",
        &["flood.water.0.level_m", "an expression of x and y in quotes"],
    );
    assert_refused("level_m = 1.0", "level_m = nan", &["flood.water.0.level_m = nan", "finite"]);
    let velocity = |text: &str| format!("level_m = 1.0\nvelocity_m_per_s = {text}");
    for (text, words) in [
        ("[1, \"2 *\"]", ["flood.water.0.velocity_m_per_s", "at character 4"]),
        ("[1]", ["flood.water.0.velocity_m_per_s", "two components"]),
        ("[1, 2, 3]", ["flood.water.0.velocity_m_per_s", "not used"]),
        ("{ east = \"u.tif\" }", ["flood.water.0.velocity_m_per_s", "north"]),
        ("{ east = \"u.tif\", north = \"v.tif\", up = 1 }", ["up", "known: east, north"]),
    ] {
        let message = refuse(&GOOD.replace("level_m = 1.0", &velocity(text)), &[]);
        assert!(
            words.iter().all(|word| message.contains(word)) && message.contains("test.toml:2"),
            "{text}: {message}"
        );
    }
    let block =
        "block = { from = [1, 1], to = [9, 9], height_m = 1 }\nvelocity_m_per_s = { east = \"u\", north = \"v\" }";
    let message = refuse(&GOOD.replace("level_m = 1.0\npolygon = [[0, 0], [10, 0], [10, 10]]", block), &[]);
    assert!(message.contains("the velocity of a block is two numbers"), "{message}");
}

/// Of earlier versions: what did nothing in another scheme is passed over, and the rest is refused with what to do.
#[test]
fn what_is_gone_with_scheme_balanced() {
    let with = |by: &str| GOOD.replace("scheme = \"voronoi\"\n", by);
    let written_by_a_run =
        with("scheme = \"voronoi\"\nbalanced = { cfl = 0.3 }\nrain = { intensity_mm_per_h = 1.0, film_m = 0.001 }\n");
    Scene::parse(&written_by_a_run, "test", &[]).unwrap();
    let chosen = refuse(&with("scheme = \"balanced\"\n"), &[]);
    let words = ["test.toml:12", "flood.scheme = \"balanced\"", "is gone", "take \"voronoi\""];
    assert!(words.iter().all(|word| chosen.contains(word)), "{chosen}");
    let by_hand = refuse(GOOD, &[("flood.scheme", "balanced")]);
    assert!(by_hand.starts_with("--set flood.scheme=balanced") && by_hand.contains("is gone"), "{by_hand}");
    for (text, key) in [
        (with("balanced = { cfl = 0.3 }\n"), "flood.balanced"),
        (with("refinement = {}\n"), "flood.refinement"),
        (with("scheme = \"voronoi\"\nrefinement = {}\n"), "flood.refinement"),
    ] {
        let message = refuse(&text, &[]);
        assert!(
            message.contains("test.toml:1") && message.contains(key) && message.contains("take it out"),
            "{message}"
        );
    }
}

#[test]
fn what_only_scheme_voronoi_has() {
    let rest = "raster = \"a.tif\", class = [{ code = 1 }, { code = 2, infiltration.constant.rate_mm_per_h = 1 }]";
    for (key, value) in [
        ("storage", "\"level-volume\""),
        ("time_steps", "\"local\""),
        ("adaptive", "{ finest_m = 0.5 }"),
        ("rain", "{ intensity_mm_per_h = 1 }"),
        ("infiltration", "{ constant = { rate_mm_per_h = 1 } }"),
        ("finer", "[{ circle = { centre = [5, 5], radius_m = 2 }, spacing_m = 0.5 }]"),
        ("edge_part", "[{ side = \"west\", from = 0, to = 1, edge = \"wall\" }]"),
        ("edge_line", "[{ line = [[1, 1], [2, 2]], edge = \"open\" }]"),
        ("outflow", "[{ name = \"a\", at = [1, 1], rating = [[0, 1]] }]"),
        ("stage", "[{ name = \"a\", line = [[1, 1], [2, 2]], level_m = 1 }]"),
        ("link", "[{ name = \"a\", from = [0, 0], to = [9, 9], law = { rating = [[0, 1]] } }]"),
        ("obstacle", "[{ name = \"a\", line = [[0, 0], [1, 1]] }]"),
        ("land_use", &format!("{{ {rest} }}")),
    ] {
        let text = GOOD.replace("scheme = \"voronoi\"", &format!("scheme = \"voronoi\"\n{key} = {value}"));
        Scene::parse(&text, "test", &[]).unwrap();
        let other = refuse(&text.replace("\"voronoi\"", "\"sph-swe\"").replace(EAST, "east = \"wall\""), &[]);
        assert!(other.contains(&format!("flood.{key}")) && other.contains("is for scheme = \"voronoi\""), "{other}");
    }
    let stage = refuse(&GOOD.replace("\"voronoi\"", "\"sph-swe\""), &[]);
    assert!(stage.contains("flood.edges.east") && stage.contains("is for scheme = \"voronoi\""), "{stage}");
}

#[test]
fn paddles() {
    let with = |edge: &str| GOOD.replace("west = \"wall\"", &format!("west = {edge}"));
    Scene::parse(&with("{ paddle = [[0, 0], [1, 0.1]] }"), "test", &[]).unwrap();
    let jump = refuse(&with("{ paddle = [[0, 0], [1, 0.1], [1, 0.2]] }"), &[]);
    assert!(jump.contains("flood.edges.west.paddle.2") && jump.contains("cannot jump"), "{jump}");
}
