//! Tests of buffer sizes, and of requests and maps on the GPU.

use crate::sph_swe::{Particle, SphSweFlood};
use corpuscle_gpu::require_gpu;
use corpuscle_model::{GpuModel, Model, ModelError};
use corpuscle_scene::Scene;
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Water between a wall, an open side and periodic ones, so that there are neighbours in mirrors too.
const POOL: &str = r#"
run.until_s = 60
terrain.plane = { extent = { length_m = 24, width_m = 12, cell_m = 1 }, slope_east = -0.02 }
[flood]
scheme = "sph-swe"
spacing_m = 0.5
spacing_depth_m = 0.5
sph_swe.time_step_s = 0.01
edges = { west = "wall", east = "open", south = "periodic", north = "periodic" }
water = [{ depth_m = 0.5, polygon = [[0, 0], [16, 0], [16, 12], [0, 12]] }]
"#;

const OBSTACLE: &str = r#"
[[flood.obstacle]]
name = "pier"
polygon = [[17, 4], [19, 4], [19, 7], [17, 7]]
"#;

fn opened(scene: &str) -> SphSweFlood {
    let mut scene = Scene::parse(scene, "scene", &[]).unwrap();
    scene.resolve_defaults();
    let scene = scene.flood().unwrap();
    let terrain = Terrain::open(&scene.terrain, 1, Path::new(".")).unwrap();
    SphSweFlood::new(&scene.flood, 1, Path::new("."), Arc::new(terrain)).unwrap()
}

#[test]
fn room_grows_where_spawned_particles_might_find_none() {
    let Some(gpu) = require_gpu("room on the GPU") else { return };
    let text = format!("{POOL}inflow = [{{ name = 'pipe', at = [20, 6], discharge_m3_per_s = 10 }}]\n");
    let mut pools = [(); 2].map(|()| opened(&text));
    let count = pools[0].state.particles.len();
    let scarce = count + 100; // Enough until the next check.
    pools[0].open_gpu_with(gpu.clone(), scarce).unwrap();
    pools[1].use_gpu(gpu).unwrap();
    for pool in &mut pools {
        pool.advance_to(4.003, &AtomicBool::new(false)).unwrap();
    }
    let [with_more, plain] = &pools;
    let room = with_more.on_gpu.as_ref().unwrap().room();
    assert!(room > scarce, "room for {scarce} for {room}");
    let spawned = with_more.state.next_id as usize - count;
    assert!(spawned > 250 && with_more.state.next_id == plain.state.next_id, "{spawned} spawned beside {count}");
    assert!((with_more.stored() / plain.stored() - 1.0).abs() < 1e-6);
}

/// Water that falls dry and comes back, an obstacle, and map samples about as often as steps, and less often.
#[test]
fn maps_that_the_gpu_keeps_are_those_that_the_host_makes() {
    let Some(gpu) = require_gpu("maps on the GPU") else { return };
    let text = POOL.replace("water = ", "wet_depth_m = 0.05\nwater = ") + OBSTACLE;
    // Also when steps of 0.01 s end.
    for period in [0.01, 0.1, 0.011307, 0.103307, 0.903307] {
        let [by_gpu, by_host] = [true, false].map(|by_gpu| {
            let mut pool = opened(&format!("run.gauge_every_s = {period}\n{text}"));
            pool.use_gpu(gpu.clone()).unwrap();
            let on_gpu = pool.on_gpu.as_mut().unwrap();
            assert!(on_gpu.keeps_maps());
            if !by_gpu {
                on_gpu.forget_maps();
            }
            // Some steps first, so that the maps are not empty when they are uploaded.
            for time in [1.3, 4.003] {
                pool.advance_to(time, &AtomicBool::new(false)).unwrap();
                let state = pool.save();
                pool.restore(&state).unwrap();
            }
            pool
        });
        assert!(by_gpu.state.particles == by_host.state.particles);
        assert_eq!(by_gpu.state.next_sample, by_host.state.next_sample);
        assert!((by_gpu.state.maps.last() - by_host.state.maps.last()).abs() < 1e-6);
        for (one, other) in by_gpu.maps().iter().zip(&by_host.maps()) {
            let pairs = || one.values.iter().zip(&other.values);
            let in_one = pairs().filter(|(one, other)| one.is_nan() != other.is_nan()).count();
            assert!(in_one == 0, "{}, each {period} s: {in_one} cells in one only", one.name);
            let wet = pairs().filter(|(one, _)| !one.is_nan()).count();
            let off = pairs().filter(|(one, other)| (*one - *other).abs() > 2e-5).count();
            // A cell that falls dry just when it is sampled may do so on one device only.
            assert!(wet > 100 && off <= wet / 100, "{}, each {period} s: {off} of {wet} cells", one.name);
        }
    }
}

/// A value of a particle on the GPU is not finite: the host's water stays unchanged, and the error names the position.
#[test]
fn a_value_that_is_no_number_does_not_come_back() {
    let Some(gpu) = require_gpu("a value that is no number on the GPU") else { return };
    let values: [fn(&mut Particle) -> &mut f64; 3] = [|p| &mut p.u, |p| &mut p.volume, |p| &mut p.y];
    for value in values {
        let mut pool = opened(POOL);
        pool.use_gpu(gpu.clone()).unwrap();
        pool.advance_to(0.2, &AtomicBool::new(false)).unwrap();
        let before = pool.state.particles.clone();
        *value(&mut pool.state.particles[100]) = f64::NAN;
        pool.upload_to_gpu().unwrap();
        pool.state.particles = before.clone();
        let error = pool.advance_to(0.4, &AtomicBool::new(false)).unwrap_err();
        let text = error.to_string();
        assert!(matches!(error, ModelError::Breakdown { .. }) && text.contains("terrain's coordinates"), "{text}");
        assert!(text.contains("NaN") && pool.state.particles == before, "{text}");
        assert!(pool.ledger().balances.iter().all(|balance| balance.now.is_finite()), "{text}");
    }
}

/// All water is in the air still: it has no smoothing length.
#[test]
fn a_state_of_falling_water_goes_on() {
    let Some(gpu) = require_gpu("falling water on the GPU") else { return };
    let block = "water = [{ block = { from = [2, 2], to = [8, 8], height_m = 20, layers = 2 } }]";
    let pool: Vec<_> = POOL.lines().map(|line| if line.starts_with("water") { block } else { line }).collect();
    let text = pool.join("\n");
    let mut before = opened(&text);
    before.use_gpu(gpu).unwrap();
    before.advance_to(0.5, &AtomicBool::new(false)).unwrap();
    assert!(before.state.particles.is_empty() && !before.state.falling.is_empty());
    let mut after = opened(&text);
    after.restore(&before.save()).unwrap();
    after.advance_to(4.0, &AtomicBool::new(false)).unwrap();
    assert!(after.state.falling.is_empty());
}
