//! Gas scenes: every form reads and round-trips, and every way to be wrong is refused with its reason.

use corpuscle_scene::*;
use std::path::Path;

/// A scene with every kind of thing in it; each test spoils one line of it.
const GOOD: &str = r##"
[run]
until_s = 10.0

[gas]
size = [100.0, 50.0]
units = "reduced"
method = "event-driven"
gravity = [0.0, -0.1]
restitution = 0.9
reversed_at_s = 5.0
follow = 0
partition = { axis = "x", at = 50.0, lifted_at_s = 2.0, hole = { from = [20.0], to = [30.0] } }
measure = { profile_axis = "y" }

[gas.walls]
x_min = { thermal = { temperature = 2.0 } }
x_max = { piston = { mass = 100.0, pressure = 0.5 } }
y_min = { motion = { sinusoid = { amplitude = 1.0, period_s = 3.0 } } }
y_max = { motion = { displacement = [[0.0, 0.0], [5.0, -2.0]] } }

[[gas.ball]]
position = [10.0, 10.0]
radius = 2.0
mass = 1.0

[[gas.ball]]
name = "second"
position = [14.0, 10.0]
velocity = [1.0, 0.0]
radius = 2.0
mass = 2.0

[[gas.species]]
name = "light"
count = 20
radius = 1.0
mass = 1.0
temperature = 1.0

[[gas.species]]
name = "heavy"
packing = 0.2
radius = 0.5
mass = 4.0
temperature = 2.0
speeds = "equal"
velocity = [1.0, 0.0]
region = { from = [60.0, 0.0], to = [90.0, 50.0] }
start = "lattice"
colour = "#123456"
"##;

fn parse(text: &str) -> Scene {
    Scene::parse(text, "test.toml", &[]).unwrap()
}

fn refuse(text: &str) -> String {
    match Scene::parse(text, "test.toml", &[]) {
        Ok(scene) => panic!("accepted:\n{text}\n{scene:?}"),
        Err(error) => error.to_string(),
    }
}

/// Replaces one line by another and asserts that the message has the line's number and holds all the words.
fn assert_refused(line: &str, by: &str, words: &[&str]) {
    let number = 1 + GOOD.lines().position(|found| found == line).unwrap_or_else(|| panic!("no line {line}"));
    let message = refuse(&GOOD.replacen(&format!("\n{line}\n"), &format!("\n{by}\n"), 1));
    for word in words.iter().copied().chain([format!("test.toml:{number}:").as_str()]) {
        assert!(message.contains(word), "{by}: {word:?} is not in:\n{message}");
    }
}

#[test]
fn every_form_reads_and_round_trips_with_its_defaults() {
    let mut scene = parse(GOOD);
    assert_eq!(parse(&scene.to_toml().unwrap()), scene);
    scene.resolve_defaults();
    let written = scene.to_toml().unwrap();
    assert_eq!(parse(&written), scene);
    let gas = scene.gas().unwrap();
    assert_eq!((gas.dimensions(), gas.gravity()), (2, [0.0, -0.1, 0.0]));
    assert_eq!(gas.walls.along(Axis::X)[0], &Wall::Thermal { temperature: 2.0 });
    // Radius over thermal speed: 1 / 1 for the light species, 0.5 / sqrt(1 / 2) for the heavy one.
    assert_eq!(gas.contact_time_s, Some(1e-4 * 0.5 / 0.5f64.sqrt()));
    assert_eq!(gas.measure.pair_distance, Some(20.0));
    assert_eq!(gas.species[0].region, Some(Region { from: vec![0.0; 2], to: vec![100.0, 50.0] }));
    let colours = [&gas.species[0].colour, &gas.species[1].colour, &gas.ball[0].colour, &gas.ball[1].colour];
    assert_eq!(colours.map(|colour| colour.as_deref().unwrap()), ["#0072b2", "#123456", "#009e73", "#cc79a7"]);
    for key in ["units", "speed_bins", "pair_distance", "from_s", "start", "velocity", "speeds", "y_max", "colour"] {
        assert!(written.contains(&format!("{key} = ")) || written.contains(&format!("{key}.")), "{key}:\n{written}");
    }
}

#[test]
fn three_dimensions_have_six_walls() {
    let text = "run.until_s = 1\n[gas]\nsize = [1e-8, 1e-8, 1e-8]\nunits = \"si\"\n[gas.walls]\nz_min = \"periodic\"\n\
                z_max = \"periodic\"\n[[gas.species]]\nname = \"argon\"\ncount = 9\nradius = 1.7e-10\nmass = 6.63e-26\n\
                temperature = 300";
    let mut scene = parse(text);
    scene.resolve_defaults();
    let gas = scene.gas().unwrap();
    assert_eq!(gas.walls.along(Axis::Z), [&Wall::Periodic; 2]);
    assert_eq!(gas.gravity.as_deref(), Some(&[0.0; 3][..]));
    assert_eq!(gas.units.boltzmann(), 1.380649e-23);
    let alone = refuse(&text.replace("z_min = \"periodic\"\n", ""));
    assert!(alone.contains("gas.walls.z_max") && alone.contains("give z_min = \"periodic\""), "{alone}");
}

#[test]
fn methods_and_paths() {
    let mut scene = parse(&GOOD.replace("\"event-driven\"", "{ fixed-step = { time_step_s = 0.01 } }"));
    assert_eq!(scene.gas().unwrap().method, Method::FixedStep { time_step_s: 0.01 });
    assert_eq!(parse(&GOOD.replace("\"event-driven\"", "\"list\"")).gas().unwrap().method, Method::List);
    scene = parse(&GOOD.replace("[[0.0, 0.0], [5.0, -2.0]]", "{ csv = \"lid.csv\" }"));
    scene.resolve_paths(Path::new("/data"));
    let lid = Series::File { csv: "/data/lid.csv".into(), factor: 1.0 };
    assert_eq!(scene.gas().unwrap().walls.y_max, Wall::Motion(Motion::Displacement(lid)));
}

#[test]
fn the_box_and_what_is_in_it() {
    let size = "size = [100.0, 50.0]";
    assert_refused(size, "size = [100.0]", &["gas.size", "two or three numbers, not 1"]);
    assert_refused(size, "size = [100.0, -50.0]", &["gas.size.1 = -50.0", "larger than 0"]);
    assert_refused(size, "size = [100.0, nan]", &["gas.size.1 = nan", "finite"]);
    let missing = refuse(&GOOD.replace("size = [100.0, 50.0]\n", ""));
    assert!(missing.contains("gas.size is missing: give the sides of the box"), "{missing}");
    assert_refused("gravity = [0.0, -0.1]", "gravity = [0.0, 0.0, -0.1]", &["gas.gravity", "must have 2 numbers"]);
    assert_refused("restitution = 0.9", "restitution = 1.1", &["gas.restitution = 1.1", "at most 1"]);
    assert_refused("restitution = 0.9", "restitution = 0", &["gas.restitution", "larger than 0"]);
    assert_refused("units = \"reduced\"", "units = \"cgs\"", &["gas.units", "known: reduced, si"]);
    assert_refused("method = \"event-driven\"", "method = \"event\"", &["gas.method", "did you mean `event-driven`"]);
    let step = "method = { fixed-step = { time_step_s = 0 } }";
    assert_refused("method = \"event-driven\"", step, &["fixed-step.time_step_s", "larger than 0"]);
    assert_refused("follow = 0", "follow = 100000", &["gas.follow = 100000", "no such ball"]);
    assert_refused("measure = { profile_axis = \"y\" }", "measure = { profile_axis = \"z\" }", &["no z in two dim"]);
    assert_refused("measure = { profile_axis = \"y\" }", "measure = { speed_bins = 0 }", &["speed_bins", "from 1 to"]);
    let far = "measure = { pair_distance = 26 }";
    assert_refused(
        "measure = { profile_axis = \"y\" }",
        far,
        &["pair_distance = 26", "at most 25, half the shortest side"],
    );
    // One has the other's files, or the gauges of the gas or a wall.
    for (one, other, refused) in
        [("red ball", "red_ball", true), ("gas", "red", true), ("x_min", "red", true), ("red", "blue", false)]
    {
        let of = |name: &str| {
            format!("[[gas.species]]\nname = \"{name}\"\ncount = 1\nradius = 1\nmass = 1\ntemperature = 1\n")
        };
        let read = Scene::parse(
            &format!("run.until_s = 1\n[gas]\nsize = [50, 50]\n{}{}", of(one), of(other)),
            "test.toml",
            &[],
        );
        let told = read.err().map(|error| error.to_string());
        assert_eq!(told.is_some(), refused, "{told:?}");
        assert!(told.is_none_or(|told| told.contains("name")));
    }
    let empty = refuse("run.until_s = 1\ngas.size = [1, 1]");
    assert!(empty.contains("gas.species") && empty.contains("there are no balls"), "{empty}");
}

#[test]
fn walls_and_partition() {
    let piston = "x_max = { piston = { mass = 100.0, pressure = 0.5 } }";
    assert_refused(
        piston,
        "x_max = { piston = { mass = 1.0, pressure = 0 } }",
        &["x_max.piston.pressure", "from outside"],
    );
    assert_refused(
        piston,
        "x_max = { piston = { mass = 0.0, pressure = 1 } }",
        &["x_max.piston.mass", "larger than 0"],
    );
    assert_refused(piston, "x_max = { piston = { mass = 1.0 } }", &["pressure is missing"]);
    assert_refused(piston, "x_max = { pistn = { mass = 1.0 } }", &["did you mean `piston`"]);
    assert_refused(piston, "x_max = \"periodic\"", &["gas.walls.x_max", "give x_min = \"periodic\""]);
    assert_refused(piston, "z_max = \"fixed\"", &["gas.walls.z_max", "no z in two dimensions"]);
    assert_refused(piston, "x_max = { thermal = { temperature = -1.0 } }", &["temperature = -1.0", "larger than 0"]);
    let lid = "y_max = { motion = { displacement = [[0.0, 0.0], [5.0, -2.0]] } }";
    assert_refused(lid, "y_max = { motion = { displacement = [[0, 1]] } }", &["must begin with 0, not 1"]);
    assert_refused(lid, "y_max = { motion = { displacement = [[0, 0], [1, 0], [1, 2]] } }", &["cannot jump"]);
    let periodic = GOOD.replace(lid, "y_max = \"periodic\"");
    let swing = "y_min = { motion = { sinusoid = { amplitude = 1.0, period_s = 3.0 } } }";
    let falls = refuse(&periodic.replace(swing, "y_min = \"periodic\""));
    assert!(falls.contains("fall through for ever"), "{falls}");
    assert_refused(
        swing,
        "y_min = { motion = { sinusoid = { amplitude = 1.0, period_s = 0.0 } } }",
        &["period_s = 0.0"],
    );
    let partition = GOOD.lines().find(|line| line.starts_with("partition")).unwrap();
    let spoil = |by: &str, words: &[&str]| assert_refused(partition, &format!("partition = {by}"), words);
    spoil("{ axis = \"x\", at = 100.0 }", &["gas.partition.at", "inside the box"]);
    spoil("{ axis = \"z\", at = 10.0 }", &["gas.partition.axis", "no z"]);
    spoil("{ axis = \"x\", at = 50.0, hole = { from = [20.0], to = [60.0] } }", &["hole.to", "inside the box"]);
    spoil("{ axis = \"x\", at = 50.0, hole = { from = [20.0], to = [10.0] } }", &["hole.to", "larger than from"]);
    spoil("{ axis = \"x\", at = 50.0, hole = { from = [20.0, 1.0], to = [30.0] } }", &["hole.from", "1 numbers"]);
}

#[test]
fn square_wells() {
    let text = "run.until_s = 1\n[gas]\nsize = [30, 30]\nwalls = { x_min = \"periodic\", x_max = \"periodic\" }\n\
                well = { depth = 1.0, width = 1.5 }\nrestitution = 1.0\nmethod = \"list\"\n[[gas.species]]\nname = \"a\"\ncount = 9\n\
                radius = 1\nmass = 1\ntemperature = 1";
    assert_eq!(parse(text).gas().unwrap().well, Some(SquareWell { depth: 1.0, width: 1.5 }));
    for (line, old, new, words) in [
        (5, "depth = 1.0", "depth = 0", ["gas.well.depth = 0", "must not be 0"]),
        (5, "width = 1.5", "width = 1", ["gas.well.width = 1", "larger than 1"]),
        (5, "width = 1.5", "width = 5", ["gas.well.width = 5", "more than three wells apart"]),
        (5, ", width = 1.5", "", ["gas.well", "width"]),
        (6, "restitution = 1.0", "restitution = 0.9", ["gas.restitution = 0.9", "take [gas.well] out"]),
        (7, "\"list\"", "{ fixed-step = { time_step_s = 0.1 } }", ["gas.method", "miss the rims"]),
    ] {
        let message = refuse(&text.replace(old, new));
        for word in words.into_iter().chain([format!("test.toml:{line}:").as_str()]) {
            assert!(message.contains(word), "{new}: {word:?} is not in:\n{message}");
        }
    }
}

#[test]
fn shear() {
    let text = "run.until_s = 1\n[gas]\nsize = [30, 30]\nshear = { rate_per_s = 0.1, temperature = 1.0 }\nmethod = \"list\"\n\
                gravity = [0.0, 0.0]\nreversed_at_s = 9\n[gas.walls]\nx_min = \"periodic\"\nx_max = \"periodic\"\ny_min = \"periodic\"\n\
                y_max = \"periodic\"\n[[gas.species]]\nname = \"a\"\ncount = 9\nradius = 1\nmass = 1\ntemperature = 1";
    let message = refuse(text);
    assert!(message.contains("gas.reversed_at_s") && message.contains("test.toml:7:"), "{message}");
    let text = text.replace("reversed_at_s = 9", "");
    assert_eq!(parse(&text).gas().unwrap().shear, Some(Shear { rate_per_s: 0.1, temperature: Some(1.0) }));
    for (line, old, new, words) in [
        (4, "rate_per_s = 0.1", "rate_per_s = 0", ["gas.shear.rate_per_s = 0", "larger than 0"]),
        (4, "temperature = 1.0", "temperature = 0", ["gas.shear.temperature = 0", "larger than 0"]),
        (6, "[0.0, 0.0]", "[0.0, -1.0]", ["gas.gravity", "fall"]),
        (5, "\"list\"", "{ fixed-step = { time_step_s = 0.1 } }", ["gas.method", "take it out, or [gas.shear]"]),
    ] {
        let message = refuse(&text.replace(old, new));
        for word in words {
            assert!(message.contains(word), "{new}: {word:?} is not in:\n{message}");
        }
        assert!(line == 4 || line == 6 || message.contains(&format!("test.toml:{line}:")), "{message}");
    }
    let well = refuse(&text.replace("method = ", "well = { depth = 1, width = 2 }\nmethod = "));
    assert!(well.contains("gas.well") && well.contains("test.toml:5:"), "{well}");
    let walled = refuse(&text.replace("y_min = \"periodic\"\ny_max = \"periodic\"", "y_min = \"fixed\""));
    assert!(walled.contains("gas.walls.y_min") && walled.contains("periodic along all axes"), "{walled}");
}

#[test]
fn balls() {
    let second = "position = [14.0, 10.0]";
    assert_refused(second, "position = [13.9, 10.0]", &["gas.ball.1.position", "overlaps gas.ball.0", "sum to 4"]);
    assert_refused(second, "position = [1.0, 10.0]", &["gas.ball.1.position", "inside the box", "from 2 to 98"]);
    assert_refused(second, "position = [1.0]", &["gas.ball.1.position", "must have 2 numbers"]);
    assert_refused(second, "position = [nan, 1]", &["gas.ball.1.position.0 = nan", "finite"]);
    assert_refused("name = \"second\"", "name = \"a,b\"", &["gas.ball.1.name", "letters, digits"]);
    let spoil_first = |key: &str, by: &str| refuse(&GOOD.replacen(key, by, 1));
    let zero = spoil_first("mass = 1.0", "mass = 0.0");
    assert!(zero.contains("gas.ball.0.mass = 0.0: must be larger than 0"), "{zero}");
    let large = spoil_first("radius = 2.0", "radius = 26.0");
    assert!(large.contains("gas.ball.0.radius = 26.0") && large.contains("at most 25"), "{large}");
}

#[test]
fn a_ball_in_the_partition() {
    let message = refuse(&GOOD.replace("at = 50.0", "at = 11.0"));
    assert!(message.contains("gas.ball.0.position") && message.contains("stands in the partition at 11"), "{message}");
}

#[test]
fn overlap_across_periodic_sides() {
    let text = "run.until_s = 1\n[gas]\nsize = [10, 10]\nwalls = { x_min = \"periodic\", x_max = \"periodic\" }\n\
                [[gas.ball]]\nposition = [0.5, 5]\nradius = 1\nmass = 1\n[[gas.ball]]\nposition = [9.5, 5]\nradius = 1\nmass = 1";
    let message = refuse(text);
    assert!(message.contains("gas.ball.1.position") && message.contains("their centres are 1 apart"), "{message}");
    parse(&text.replace("9.5", "8.5"));
}

#[test]
fn species() {
    assert_refused("count = 20", "count = 0", &["gas.species.0.count = 0", "at least 1"]);
    assert_refused("count = 20", "count = -3", &["gas.species.0.count", "0 or more"]);
    assert_refused("count = 20", "count = 1500", &["gas.species.0.count", "fill 0.9425 of the box", "0.9069 in 2"]);
    assert_refused("packing = 0.2", "packing = 0.91", &["gas.species.1.packing = 0.91", "close packing"]);
    assert_refused("packing = 0.2", "packing = -0.1", &["gas.species.1.packing", "larger than 0"]);
    let both = refuse(&GOOD.replace("packing = 0.2", "packing = 0.2\ncount = 3"));
    assert!(
        both.contains("gas.species.1: give exactly one of count, packing, not count and packing together"),
        "{both}"
    );
    assert_refused("name = \"heavy\"", "name = \"light\"", &["gas.species.1.name", "taken by gas.species.0.name"]);
    assert_refused("mass = 4.0", "mass = -4.0", &["gas.species.1.mass = -4.0", "larger than 0"]);
    assert_refused("radius = 0.5", "radius = 0", &["gas.species.1.radius", "larger than 0"]);
    assert_refused("radius = 0.5", "radius = 16.0", &["fit into its region", "at most 15"]);
    assert_refused("temperature = 2.0", "temperature = -2.0", &["gas.species.1.temperature", "at least 0"]);
    assert_refused("colour = \"#123456\"", "colour = \"blue\"", &["gas.species.1.colour", "#0072b2"]);
    assert_refused("speeds = \"equal\"", "speeds = \"equl\"", &["gas.species.1.speeds", "did you mean `equal`"]);
    let region = "region = { from = [60.0, 0.0], to = [90.0, 50.0] }";
    assert_refused(region, "region = { from = [60.0, 0.0], to = [101.0, 50.0] }", &["region.to", "outside the box"]);
    assert_refused(region, "region = { from = [60.0, 0.0], to = [50.0, 50.0] }", &["region.to", "larger than from"]);
    assert_refused(region, "region = { from = [60.0], to = [50.0, 50.0] }", &["region.from", "must have 2 numbers"]);
    let full =
        GOOD.replace("count = 20", "packing = 0.9").replace("packing = 0.2", "packing = 0.9").replace(region, "");
    let message = refuse(&full);
    assert!(message.contains("gas.size") && message.contains("together would fill 1.8"), "{message}");
}
