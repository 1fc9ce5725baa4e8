//! Runs on the graphics card.

mod tool;

use tool::{LAKE, Place};

/// False, after a line that says so, where there is no device; a failure where one is required.
fn has_device(test: &str) -> bool {
    corpuscle::gpu::require_gpu(test).is_some()
}

#[test]
fn a_flood_runs_on_the_card() {
    if !has_device("a run on the card") {
        return;
    }
    let place = Place::new();
    place.write("lake.toml", LAKE);
    let on_card = place.run(&["run", "lake.toml", "--backend", "gpu", "-o", "card", "--json"]).expect_status(0).json();
    let on_processor = place.run(&["run", "lake.toml", "-o", "processor", "--json"]).expect_status(0).json();
    assert_eq!((&on_card["backend"], &on_card["status"]), (&"gpu".into(), &"done".into()));
    assert_eq!((&on_card["particles"], &on_card["steps"]), (&on_processor["particles"], &on_processor["steps"]));
    let error = on_card["ledger"]["water_m3"]["relative_error"].as_f64().unwrap();
    assert!(error.abs() < 1e-6, "{error}");
}

#[test]
fn dew_runs_on_the_card() {
    if !has_device("dew on the card") {
        return;
    }
    let place = Place::new();
    let on_card = place
        .run(&["run", "dew/pane", "--until", "0.06", "--backend", "gpu", "-o", "card", "--json"])
        .expect_status(0)
        .json();
    assert_eq!((&on_card["backend"], &on_card["status"]), (&"gpu".into(), &"done".into()));
    for quantity in ["water_kg", "energy_J"] {
        let error = on_card["ledger"][quantity]["relative_error"].as_f64().unwrap();
        assert!(error.abs() < 1e-6, "{quantity}: {error}");
    }
    let refused = place.run(&["run", "dew/glassware", "--backend", "gpu", "-o", "refused"]).expect_status(2);
    assert!(refused.stderr.contains("\"open\"") && refused.stderr.contains("--backend cpu"), "{}", refused.stderr);
    assert!(!place.path("refused").exists(), "a run that was refused leaves no folder");
}

#[test]
fn what_the_card_cannot_compute_is_refused_by_name() {
    if !has_device("a refusal by the card") {
        return;
    }
    let place = Place::new();
    let refused = place
        .run(&["run", "flood/cloudburst", "--set", "flood.refinement={}", "--backend", "gpu", "-o", "refused"])
        .expect_status(2);
    assert!(
        refused.stderr.contains("[flood.refinement]") && refused.stderr.contains("--backend cpu"),
        "{}",
        refused.stderr
    );
    assert!(!place.path("refused").exists(), "a run that was refused leaves no folder");
}
