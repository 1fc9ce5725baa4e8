//! Films as a user of the binary meets them.

#[path = "../../video/tests/film/ffprobe.rs"]
mod ffprobe;
mod tool;

use corpuscle::gpu::require_gpu;
use tool::{BALLS, LAKE, Place};

#[test]
fn a_run_films_itself() {
    if require_gpu("films").is_none() {
        return;
    }
    for (name, scene) in [("lake", LAKE), ("balls", BALLS)] {
        let place = Place::new();
        place.write(&format!("{name}.toml"), scene);
        let arguments = ["run", &format!("{name}.toml"), "--film", "--film-length", "0.4", "--film-size", "64x48"];
        place.run(&arguments).expect_status(0);
        let film = place.path(format!("runs/{name}-1/film.mp4"));
        assert!(film.is_file());
        let report = std::fs::read_to_string(place.path(format!("runs/{name}-1/report.html"))).unwrap();
        assert!(report.contains("data:video/mp4"));
        if let Some(probed) = ffprobe::read(&film) {
            assert_eq!((probed.codec.as_str(), probed.size, probed.pictures), ("h264", [64, 48], 10), "{name}");
            assert!((probed.seconds - 0.4).abs() < 1e-3 && (probed.rate - 25.0).abs() < 1e-3, "{name}: {probed:?}");
        }
    }
}

#[test]
fn a_finished_run_is_filmed_to_where_one_wants() {
    if require_gpu("films").is_none() {
        return;
    }
    let place = Place::new();
    place.write("lake.toml", LAKE);
    place.run(&["run", "lake.toml"]).expect_status(0);
    let film = ["render", "runs/lake-1", "--size", "65x48", "--rate", "5", "--film-to"];
    place.run(&[&film[..], &["lake.mp4"]].concat()).expect_status(0);
    if let Some(probed) = ffprobe::read(&place.path("lake.mp4")) {
        assert_eq!((probed.size, probed.pictures), ([66, 48], 3));
        assert!((probed.seconds - 0.6).abs() < 1e-3 && (probed.rate - 5.0).abs() < 1e-3, "{probed:?}");
    }
    let pictures = [&film[..], &["pictures"]].concat();
    place.run(&pictures).expect_status(0);
    assert!(place.path("pictures/000002.png").is_file());
    let again = place.run(&pictures);
    assert!(again.status != Some(0) && again.stderr.contains("name another folder"), "{}", again.stderr);
}

#[test]
fn a_film_that_cannot_be_is_refused_before_anything_is_written() {
    let place = Place::new();
    place.write("lake.toml", LAKE);
    for arguments in [["--film-size", "8000x8000"], ["--film-length", "-3"], ["--film-size", "0x0"]] {
        place.run(&["run", "lake.toml", "--film", arguments[0], arguments[1]]).expect_status(2);
    }
    assert!(!place.path("runs").exists());
}
