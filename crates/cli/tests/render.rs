//! Pictures and films of finished runs.

mod tool;

use std::fs;
use tool::Place;

const GAS: &str = "title = \"Three\"\nrun = { until_s = 2, frame_every_s = 0.5 }\n[gas]\nsize = [9, 9]\nfollow = 0\n\
                   ball = [{ position = [2, 2], velocity = [1, 0], radius = 1, mass = 1 }, { position = [6, 2], radius = 1, mass = 1 }]";

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
    let drawn = without(&["render", "run"]);
    let told = String::from_utf8(drawn.stderr).unwrap();
    assert_eq!(drawn.status.code(), Some(1), "{told}");
    assert!(told.contains("apt-get install mesa-vulkan-drivers"), "{told}");
}
