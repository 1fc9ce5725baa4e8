//! Pictures and films of finished runs.

mod tool;

use corpuscle_drawing::png::decode_rgba;
use geotiff_writer::{GeoTiffBuilder, PhotometricInterpretation};
use ndarray::Array3;
use std::fs;
use std::path::Path;
use tool::{LAKE, Place};

const GAS: &str = "title = \"Three\"\nrun = { until_s = 2, frame_every_s = 0.5 }\n[gas]\nsize = [9, 9]\nfollow = 0\n\
                   ball = [{ position = [2, 2], velocity = [1, 0], radius = 1, mass = 1 }, { position = [6, 2], radius = 1, mass = 1 }]";

/// Writes a red photo, 20 m x 20 m, from a corner at the north-west on.
fn write_photo(path: &Path, [x, y]: [f64; 2]) {
    let builder = GeoTiffBuilder::new(40, 40).bands(3).photometric(PhotometricInterpretation::Rgb);
    let builder = builder.pixel_scale(0.5, 0.5).origin(x, y);
    let red = Array3::from_shape_fn((40, 40, 3), |(_, _, band)| if band == 0 { 220_u8 } else { 20 });
    builder.write_3d(path, red.view()).unwrap();
}

/// False, after a line that says so, where there is no device; a failure where one is required.
fn has_device(test: &str) -> bool {
    corpuscle::gpu::require_gpu(test).is_some()
}

#[test]
fn a_finished_run_is_drawn_and_filmed() {
    let place = Place::new();
    place.write("gas.toml", GAS);
    place.run(&["run", "gas.toml", "-o", "run"]).expect_status(0);
    if !has_device("pictures of a run") {
        return;
    }
    let drawn = place.run(&["render", "run", "--at", "0,1.1", "--size", "160x90", "--json"]).expect_status(0).json();
    assert_eq!(
        (&drawn[0]["time_s"], &drawn[1]["time_s"], drawn.as_array().unwrap().len()),
        (&0.0.into(), &1.0.into(), 2)
    );
    let picture = |number: usize| fs::read(place.path(format!("run/pictures/picture_{number:06}.png"))).unwrap();
    // Width and height stand at bytes 16 to 23 of a PNG.
    assert_eq!(picture(2)[16..24], [0, 0, 0, 160, 0, 0, 0, 90]);
    assert_ne!(picture(0), picture(2));
    let before = picture(2);
    place.run(&["render", "run", "--all", "--size", "160x90"]).expect_status(0);
    assert_eq!(picture(2), before);
    let film =
        place.run(&["render", "run", "--film", "--rate", "5", "--size", "160x90", "--json"]).expect_status(0).json();
    assert_eq!((&film["pictures"], &film["duration_s"]), (&5.into(), &1.0.into()));
    assert!(fs::metadata(place.path("run/film.mp4")).unwrap().len() > 1000);
    let report = fs::read_to_string(place.path("run/report.html")).unwrap();
    assert_eq!((report.matches("data:image/jpeg").count(), report.matches("data:video/mp4").count()), (5, 1));
}

#[test]
fn a_flood_is_drawn_from_where_one_wants_and_with_what_one_wants_on_its_ground() {
    let place = Place::new();
    place.write("lake.toml", LAKE);
    place.run(&["run", "lake.toml", "-o", "run"]).expect_status(0);
    if !has_device("pictures of a flood") {
        return;
    }
    place.write("path.csv", "time_s,bearing_deg,height_deg,zoom,x,y\n0,90,30,1,2,2\n100,180,20,2,8,8\n");
    let small = ["render", "run", "--at", "0", "--size", "160x90", "--samples", "1"];
    place.run(&small).expect_status(0);
    fs::rename(place.path("run/pictures/picture_000000.png"), place.path("photo.png")).unwrap();
    write_photo(&place.path("photo.tif"), [0.0, 20.0]);
    let looks: [&[&str]; 11] = [
        &[],
        &["--camera", "plan"],
        &["--from", "20,50"],
        &["--look", "3,3", "--zoom", "2.5"],
        &["--camera-path", "path.csv"],
        &["--ground", "depth"],
        &["--ground", "photo.png"],
        &["--ground", "photo.tif"],
        &["--heights", "3"],
        &["--water", "brown"],
        &["--sun", "250,20"],
    ];
    let drawn = looks.map(|look| {
        place.run(&[&small, look].concat()).expect_status(0);
        fs::read(place.path("run/pictures/picture_000000.png")).unwrap()
    });
    for (number, picture) in drawn.iter().enumerate() {
        assert!(!drawn[..number].contains(picture), "{:?} changes nothing", looks[number]);
    }
}

#[test]
fn pictures_for_papers_have_what_one_wants_in_them() {
    let place = Place::new();
    place.write("lake.toml", LAKE);
    place.run(&["run", "lake.toml", "-o", "run"]).expect_status(0);
    place.write("gas.toml", GAS);
    place.run(&["run", "gas.toml", "-o", "gas"]).expect_status(0);
    if !has_device("pictures for papers") {
        return;
    }
    let small = ["render", "run", "--at", "0", "--size", "320x180", "--samples", "1"];
    let gauge = fs::read_to_string(place.path("run/gauges.csv")).unwrap();
    let gauge = gauge.lines().next().unwrap().split(',').nth(1).unwrap();
    let looks: [&[&str]; 7] = [
        &[],
        &["--transparent"],
        &["--overlay", "none"],
        &["--caption", "A lake at rest"],
        &["--north"],
        &["--inset", gauge],
        &["--beside", "gas", "--caption", "One", "--caption", "Two"],
    ];
    let read = |ending: &str| fs::read(place.path(format!("run/pictures/picture_000000.{ending}")));
    let drawn = looks.map(|look| {
        place.run(&[&small, look].concat()).expect_status(0);
        read("png").unwrap()
    });
    for (number, picture) in drawn.iter().enumerate() {
        assert!(!drawn[..number].contains(picture), "{:?} changes nothing", looks[number]);
    }
    let opaque = |png: &[u8]| {
        let (_, _, rgba) = decode_rgba(png).unwrap();
        rgba.chunks_exact(4).filter(|pixel| pixel[3] == 255).count()
    };
    assert_eq!(opaque(&drawn[0]), 320 * 180);
    // The block of ground is there, the sky round it is not.
    assert!((2000..40_000).contains(&opaque(&drawn[1])), "{}", opaque(&drawn[1]));
    assert!(read("svg").is_err());
    place
        .run(&[&small[..], &["--overlay", "vector", "--caption", "A < B", "--beside", "gas"]].concat())
        .expect_status(0);
    assert_eq!(decode_rgba(&read("png").unwrap()).unwrap().0, 320);
    let svg = String::from_utf8(read("svg").unwrap()).unwrap();
    assert!(svg.contains("A &lt; B") && svg.contains(">Three<"), "{svg:.2000}");
    assert_eq!(svg.matches("data:image/png;base64").count(), 2);
}

#[test]
fn ways_to_look_that_cannot_be_are_refused_in_words() {
    let place = Place::new();
    place.write("lake.toml", LAKE);
    place.run(&["run", "lake.toml", "-o", "run"]).expect_status(0);
    place.write("header.csv", "time,bearing\n0,1\n");
    place.write("row.csv", "time_s,bearing_deg,height_deg,zoom\n0,90,north,1\n");
    place.write("photo.png", "no picture");
    let refused = |look: [&str; 2], what: &str| {
        let ended = place.run(&["render", "run", look[0], look[1]]).expect_status(2);
        assert!(ended.stderr.contains(what), "{look:?}: {}", ended.stderr);
    };
    refused(["--from", "20"], "155,35");
    refused(["--from", "20,95"], "89");
    refused(["--zoom", "0"], "0.01");
    refused(["--look", "nan,1"], "500,320");
    refused(["--sun", "250,1"], "135,40");
    refused(["--sun", "noon"], "2026-06-21T15:00Z");
    refused(["--water", "green"], "brown");
    refused(["--overlay", "paper"], "vector");
    if has_device("a gauge that is not there") {
        let ended = place.run(&["render", "run", "--inset", "Mill"]).expect_status(2);
        assert!(ended.stderr.contains("no such gauge") && ended.stderr.contains("_m3"), "{}", ended.stderr);
    }
    refused(["--beside", "nowhere"], "nowhere");
    for (option, what) in [(["--overlay", "vector"], "no vectors"), (["--transparent", "--json"], "--film-to")] {
        let ended = place.run(&["render", "run", "--film", option[0], option[1]]).expect_status(2);
        assert!(ended.stderr.contains(what), "{option:?}: {}", ended.stderr);
    }
    refused(["--camera-path", "header.csv"], "bearing_deg");
    refused(["--camera-path", "row.csv"], "line 2");
    refused(["--camera-path", "none.csv"], "none.csv");
    if has_device("a picture for the ground") {
        refused(["--ground", "photo.png"], "PNG");
        refused(["--ground", "none.png"], "none.png");
        write_photo(&place.path("far.tif"), [500.0, 20.0]);
        refused(["--ground", "far.tif"], "beside the terrain");
        refused(["--ground", "none.tif"], "none.tif");
        // The lake has no position on Earth.
        refused(["--sun", "2026-06-21T12:00Z"], "--sun 135,40");
    }
}

#[test]
fn what_cannot_be_drawn_is_refused_in_words() {
    let place = Place::new();
    let none = place.run(&["render", "nothing"]).expect_status(2);
    assert!(none.stderr.contains("nothing"), "{}", none.stderr);
    place.write("gas.toml", GAS);
    place.run(&["run", "gas.toml", "-o", "bare", "--frames", "none"]).expect_status(0);
    let bare = place.run(&["render", "bare"]).expect_status(2);
    assert!(bare.stderr.contains("--frames vtp"), "{}", bare.stderr);
    let size = place.run(&["render", "bare", "--size", "9by9"]).expect_status(2);
    assert!(size.stderr.contains("1920x1080"), "{}", size.stderr);
}

#[cfg(target_os = "linux")]
#[test]
fn without_any_device_a_run_ends_well_and_render_says_what_to_install() {
    let place = Place::new();
    place.write("gas.toml", GAS);
    let without = |arguments: &[&str]| {
        let mut command = place.command(arguments);
        // The loader of Vulkan looks for drivers here and nowhere else.
        command.envs([("VK_DRIVER_FILES", "/nonexistent"), ("VK_ICD_FILENAMES", "/nonexistent")]).output().unwrap()
    };
    let run = without(&["run", "gas.toml", "-o", "run"]);
    let told = String::from_utf8(run.stderr).unwrap();
    assert!(run.status.success() && told.contains("corpuscle render run"), "{told}");
    let filmed = without(&["run", "gas.toml", "-o", "filmed", "--film"]);
    let told = String::from_utf8(filmed.stderr).unwrap();
    let line = told.lines().find(|line| line.contains("no film")).unwrap_or_default();
    assert!(filmed.status.success() && line.contains("apt-get install mesa-vulkan-drivers"), "{told}");
    assert!(place.path("filmed/report.html").is_file() && !place.path("filmed/film.mp4").exists());
    let drawn = without(&["render", "run"]);
    let told = String::from_utf8(drawn.stderr).unwrap();
    assert_eq!(drawn.status.code(), Some(1), "{told}");
    assert!(told.contains("apt-get install mesa-vulkan-drivers"), "{told}");
}
