//! Runs on the GPU.

mod tool;

use tool::{LAKE, Place};

/// False, after a line that says so, where there is no device; a failure where one is required.
fn has_device(test: &str) -> bool {
    corpuscle::gpu::require_gpu(test).is_some()
}

#[test]
fn a_flood_runs_on_the_gpu() {
    if !has_device("a run on the GPU") {
        return;
    }
    let place = Place::new();
    place.write("lake.toml", LAKE);
    // Steps of 0.02 s end when the run does but for rounding: one of both may take another.
    for (scheme, set) in [("sph-swe", "flood.sph_swe.time_step_s=0.0199"), ("voronoi", "flood.gravity_m_per_s2=9.81")] {
        let scheme_set = format!("flood.scheme={scheme}");
        let common = ["run", "lake.toml", "--set", &scheme_set, "--set", set, "--json"];
        let run = |rest: &[&str]| place.run(&[&common[..], rest].concat()).expect_status(0).json();
        let on_gpu = run(&["--backend", "gpu", "-o", &format!("gpu-{scheme}")]);
        let on_cpu = run(&["-o", &format!("cpu-{scheme}")]);
        assert_eq!((&on_gpu["backend"], &on_gpu["status"]), (&"gpu".into(), &"done".into()));
        assert_eq!((&on_gpu["particles"], &on_gpu["steps"]), (&on_cpu["particles"], &on_cpu["steps"]));
        let error = on_gpu["ledger"]["water_m3"]["relative_error"].as_f64().unwrap();
        assert!(error.abs() < 1e-6, "{error}");
    }
}

#[test]
fn the_gpu_refuses_what_it_does_not_compute_and_says_what_to_do() {
    let place = Place::new();
    place.write("lake.toml", LAKE);
    let rate = ["--set", "flood.scheme=sph-swe", "--set", "flood.sph_swe.smoothing=rate"];
    let refused = place.run(&[&["run", "lake.toml", "--backend", "gpu", "-o", "gpu"][..], &rate].concat());
    let refused = refused.expect_status(2);
    for words in ["CPU only", "smoothing"] {
        assert!(refused.stderr.contains(words), "{}", refused.stderr);
    }
    assert!(!place.path("gpu").exists());
}

#[test]
fn dew_runs_on_the_gpu() {
    if !has_device("dew on the GPU") {
        return;
    }
    let place = Place::new();
    let on_gpu = place
        .run(&["run", "dew/pane", "--until", "0.06", "--backend", "gpu", "-o", "gpu", "--json"])
        .expect_status(0)
        .json();
    assert_eq!((&on_gpu["backend"], &on_gpu["status"]), (&"gpu".into(), &"done".into()));
    for quantity in ["water_kg", "energy_J"] {
        let error = on_gpu["ledger"][quantity]["relative_error"].as_f64().unwrap();
        assert!(error.abs() < 1e-6, "{quantity}: {error}");
    }
}

/// Where it computes is said, and why; software in place of a GPU, as where this is tested, is not chosen.
#[test]
fn a_backend_is_chosen_and_said() {
    let place = Place::new();
    place.write("lake.toml", LAKE);
    let voronoi = place.run(&["run", "lake.toml", "-o", "voronoi"]).expect_status(0);
    assert!(voronoi.stderr.contains("computing on the CPU: scheme voronoi"), "{}", voronoi.stderr);
    assert!(!voronoi.stderr.contains("is small"), "{}", voronoi.stderr);
    let few = place.run(&["run", "lake.toml", "--set", "flood.scheme=sph-swe", "-o", "few"]).expect_status(0);
    assert!(few.stderr.contains("computing on the CPU: the scene is small"), "{}", few.stderr);
    let gas = place.run(&["run", "gas/mixing", "--until", "0.01", "-o", "gas"]).expect_status(0);
    assert!(gas.stderr.contains("computing on the CPU: the gas model"), "{}", gas.stderr);
    let many = ["run", "flood/dam-break", "--until", "0.1", "--backend", "auto", "--json", "-o", "many"];
    let sph_swe = ["--set", "flood.scheme=sph-swe", "--set", "flood.spacing_depth_m=10"];
    let many = place.run(&[&many[..], &sph_swe].concat()).expect_status(0);
    let why = match corpuscle::gpu::Gpu::open().map(|gpu| gpu.kind) {
        Ok(corpuscle::gpu::GpuKind::Hardware) => "computing on the GPU",
        // Where there is no GPU, none is spoken of.
        _ => "computing on the CPU\n",
    };
    assert!(many.stderr.contains(why), "{why}: {}", many.stderr);
}
