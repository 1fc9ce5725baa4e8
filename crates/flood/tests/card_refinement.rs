//! Splitting and merging of particles on the graphics card does what it does on the processor.

use corpuscle_flood::{Flood, Particle};
use corpuscle_gpu::{Gpu, require_gpu};
use corpuscle_model::{Balance, GpuModel, Model};
use corpuscle_scene::Scene;
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Water let go at the upper end of a tilted trough runs down as a sheet, round a post, and gathers at the lower end.
const TROUGH: &str = r#"
run.until_s = 150
terrain.plane = { extent = { length_m = 80, width_m = 20, cell_m = 1 }, slope_east = -0.05 }
[flood]
scheme = "balanced"
spacing_m = 1
spacing_depth_m = 0.5
refinement = {}
edges = { west = "wall", east = "wall", south = "periodic", north = "periodic" }
water = [{ depth_m = 0.5, polygon = [[0, 0], [16, 0], [16, 20], [0, 20]] }]
[[flood.obstacle]]
name = "post"
circle = { centre = [30, 9], radius_m = 2 }
"#;

/// Rain on a slope, whose films become particles that are merged where they gather.
const RAIN: &str = r#"
run.until_s = 60
terrain.plane = { extent = { length_m = 40, width_m = 20, cell_m = 1 }, slope_east = -0.05 }
[flood]
scheme = "balanced"
spacing_m = 1
spacing_depth_m = 0.02
manning = 0.03
refinement = {}
edges = { west = "wall", east = "wall", south = "wall", north = "wall" }
water = [{ depth_m = 0.02, polygon = [[0, 0], [10, 0], [10, 20], [0, 20]] }]
rain = { intensity_mm_per_h = 3600, film_m = 0.0005 }
"#;

fn open(text: &str) -> Flood {
    let mut scene = Scene::parse(text, "test", &[]).unwrap();
    scene.resolve_defaults();
    let scene = scene.flood().unwrap();
    let terrain = Terrain::open(&scene.terrain, 1, Path::new(".")).unwrap();
    Flood::new(&scene.flood, 1, Path::new("."), Arc::new(terrain)).unwrap()
}

fn on_card(text: &str, gpu: &Gpu) -> Flood {
    let mut flood = open(text);
    flood.use_gpu(gpu.clone()).unwrap();
    flood
}

fn step(flood: &mut Flood, count: usize) {
    for _ in 0..count {
        // A little more than a step, lest rounding take it for less.
        flood.advance_to(flood.time() + 1.000_001 * flood.time_step(), &AtomicBool::new(false)).unwrap();
    }
}

fn go(flood: &mut Flood, time: f64) {
    flood.advance_to(time, &AtomicBool::new(false)).unwrap();
}

/// Largest differences of particles from those that stand nearest them in the other water: place, m; velocity, m/s; volume, of their own.
/// What is new is numbered in another order, so identities tell nothing.
fn differences(host: &Flood, card: &Flood) -> [f64; 3] {
    let apart = |a: &Particle, b: &Particle| (a.x - b.x).hypot(a.y - b.y);
    let mut most = [0.0_f64; 3];
    for particle in card.particles() {
        let all = host.particles().iter();
        let nearest = all.min_by(|a, b| apart(a, particle).total_cmp(&apart(b, particle))).unwrap();
        let velocity = (nearest.u - particle.u).hypot(nearest.v - particle.v);
        let now = [apart(nearest, particle), velocity, (particle.volume / nearest.volume - 1.0).abs()];
        most = [0, 1, 2].map(|k| most[k].max(now[k]));
    }
    most
}

fn identities(flood: &Flood) -> usize {
    let mut identities: Vec<u64> = flood.particles().iter().map(|particle| particle.id).collect();
    identities.sort_unstable();
    identities.dedup();
    identities.len()
}

/// From states with much to split and much to merge.
#[test]
fn particle_by_particle_as_on_the_processor() {
    let Some(gpu) = require_gpu("splitting and merging on the card") else { return };
    for (name, text, begin) in [("sheet", TROUGH, 6.0), ("pool", TROUGH, 70.0), ("rain", RAIN, 20.0)] {
        let mut host = open(text);
        go(&mut host, begin);
        // To the next step in which particles are split and merged.
        while !host.steps().is_multiple_of(8) {
            step(&mut host, 1);
        }
        let mut card = on_card(text, &gpu);
        card.restore(&host.save()).unwrap();
        let before = host.particles().len();
        for (steps, most) in [(1, 3e-5), (9, 3e-4)] {
            step(&mut host, steps);
            step(&mut card, steps);
            let counts = [&host, &card].map(|flood| flood.particles().len());
            assert!(counts[0] == counts[1] && counts[0] != before, "{name}: {before} became {counts:?}");
            let apart = differences(&host, &card);
            assert!(apart.iter().all(|apart| *apart < most), "{name} after {steps} steps more: {apart:?}");
            assert_eq!(identities(&card), counts[1], "{name}: each has an identity of its own");
        }
    }
}

#[test]
fn the_sheet_and_the_pool_are_those_of_the_processor() {
    let Some(gpu) = require_gpu("splitting and merging on the card") else { return };
    let (mut host, mut card) = (open(TROUGH), on_card(TROUGH, &gpu));
    let count = card.particles().len();
    let volume = |flood: &Flood| flood.particles().iter().map(|particle| particle.volume).sum::<f64>();
    let before = volume(&card);
    for (time, fewest, most) in [(30.0, 2.5, 8.0), (110.0, 0.8, 4.0)] {
        go(&mut host, time);
        go(&mut card, time);
        let counts = [&host, &card].map(|flood| flood.particles().len() as f64);
        assert!((counts[1] / counts[0] - 1.0).abs() < 0.1, "{count} at first, at {time} s {counts:?}");
        assert!((fewest..most).contains(&(counts[1] / count as f64)), "{count} at first, at {time} s {counts:?}");
        assert!((volume(&card) / before - 1.0).abs() < 1e-6, "{before} m3 at first, at {time} s {}", volume(&card));
        for balance in &card.ledger().balances {
            assert!(Balance::relative_error(balance).abs() < 1e-6, "at {time} s {balance:?}");
        }
    }
}

/// How often something looks changes nothing but the rounding of the time asked for.
#[test]
fn when_it_is_looked_at_does_not_matter() {
    let Some(gpu) = require_gpu("splitting and merging on the card") else { return };
    let (mut once, mut often) = (on_card(TROUGH, &gpu), on_card(TROUGH, &gpu));
    go(&mut once, 12.0);
    (1..=24).for_each(|k| go(&mut often, 0.5 * f64::from(k)));
    let by_id = |flood: &Flood| {
        let mut particles = flood.particles().to_vec();
        particles.sort_unstable_by_key(|particle| particle.id);
        particles
    };
    assert!(once.particles().len() > 600, "{}", once.particles().len());
    assert_eq!(by_id(&once), by_id(&often));
}
