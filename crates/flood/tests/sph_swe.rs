//! Density and smoothing length of scheme sph-swe, against sums over all pairs and known answers.

use corpuscle_flood::{InitialWater, Particle, SphSweFlood};
use corpuscle_model::Model;
use corpuscle_scene::Scene;
use corpuscle_sph::kernel::{Mueller, SmoothingKernel};
use corpuscle_terrain::{Bounds, Terrain};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// The side of the ground, m, and its middle.
const SIDE: f64 = 80.0;
const MIDDLE: f64 = 0.5 * SIDE;

/// A lake round a dry island, towards whose shore particles are smaller.
const UNEVEN: &str = r#"
run.until_s = 60
terrain.bump = { extent = { length_m = 80, width_m = 80, cell_m = 1 }, height_m = 3, width_m = 10 }
[flood]
scheme = "sph-swe"
spacing_m = 2
spacing_depth_m = 1
edges = { west = "wall", east = "wall", south = "wall", north = "wall" }
water = [{ level_m = 1.2, velocity_m_per_s = [0.5, 0.2] }]
"#;

/// Particles that nothing pushes on flat ground.
const FREE: &str = r#"
run.until_s = 60
terrain.plane = { extent = { length_m = 80, width_m = 80, cell_m = 2 } }
[flood]
scheme = "sph-swe"
spacing_m = 1
spacing_depth_m = 1
manning = 0
water = [{ level_m = 1 }]
sph_swe = { gas_constant = 0, viscosity = 0, control_force = false }
"#;

fn open(text: &str, overrides: &[(&str, &str)], water: Option<InitialWater>) -> SphSweFlood {
    let overrides: Vec<_> = overrides.iter().map(|(path, value)| (path.to_string(), value.to_string())).collect();
    let mut scene = Scene::parse(text, "test", &overrides).unwrap();
    scene.resolve_defaults();
    let scene = scene.flood().unwrap();
    let terrain = Arc::new(Terrain::open(&scene.terrain, 1, Path::new(".")).unwrap());
    match water {
        None => SphSweFlood::new(&scene.flood, 1, Path::new("."), terrain),
        Some(water) => SphSweFlood::with_water(&scene.flood, 1, Path::new("."), terrain, &[water]),
    }
    .unwrap()
}

fn go(flood: &mut SphSweFlood, time: f64) {
    flood.advance_to(time, &AtomicBool::new(false)).unwrap();
}

/// A disc of 12 m, 1 m deep, that spreads evenly, `rate` times the way from its middle a second.
fn spreading(rate: f64) -> InitialWater<'static> {
    InitialWater {
        depth: Box::new(|_, _| 1.0),
        inside: Box::new(|x, y| (x - MIDDLE).hypot(y - MIDDLE) < 12.0),
        within: Bounds { x_min: MIDDLE - 12.0, x_max: MIDDLE + 12.0, y_min: MIDDLE - 12.0, y_max: MIDDLE + 12.0 },
        velocity: Box::new(move |x, y| [rate * (x - MIDDLE), rate * (y - MIDDLE)]),
    }
}

/// The particles within `radius` of the middle, in the order of their identities.
fn within(flood: &SphSweFlood, radius: f64) -> Vec<Particle> {
    let near = |particle: &&Particle| (particle.x - MIDDLE).hypot(particle.y - MIDDLE) < radius;
    let mut near: Vec<_> = flood.particles().iter().filter(near).copied().collect();
    near.sort_unstable_by_key(|particle| particle.id);
    near
}

fn apart(a: &Particle, b: &Particle) -> f64 {
    (a.x - b.x).hypot(a.y - b.y)
}

/// rho_i = sum_j m_j W_poly6(r_i - r_j, h_i), each neighbour with its own mass.
#[test]
fn each_neighbour_counts_with_its_own_mass() {
    let mut flood = open(UNEVEN, &[], None);
    go(&mut flood, 5.0);
    // Beyond the edges there are ghost particles.
    let inside =
        |particle: &Particle| [particle.x, particle.y].iter().all(|at| (particle.h..SIDE - particle.h).contains(at));
    let some: Vec<_> = within(&flood, SIDE).into_iter().filter(inside).collect();
    let volumes = || some.iter().map(|particle| particle.volume);
    let (least, most) = (volumes().fold(f64::INFINITY, f64::min), volumes().fold(0.0, f64::max));
    assert!(some.len() > 200 && most > 1.5 * least, "{} particles of {least} to {most} m3", some.len());
    for particle in &some {
        let kernel = Mueller::<2>::new(particle.h);
        let of_one = |other: &Particle| other.volume * kernel.value(apart(particle, other).powi(2));
        let depth: f64 = flood.particles().iter().map(of_one).sum();
        assert!((particle.depth / depth - 1.0).abs() < 1e-12, "{depth} m: {particle:?}");
    }
}

/// Form (8) with its neighbours counted by hand. Where particles stand evenly it gives what Table 1 has: 2.66 spacings.
#[test]
fn smoothing_length_at_the_start_is_from_the_neighbours() {
    let flood = open(FREE, &[("flood.sph_swe.smoothing", "rate")], None);
    let some = within(&flood, 20.0);
    for particle in &some {
        let reach = 2.4 * (particle.volume / particle.depth).sqrt();
        let near = flood.particles().iter().filter(|other| apart(particle, other) < reach);
        let area = near.map(|other| other.volume).sum::<f64>() / particle.depth;
        let c_2 = (1.0 / (4.0 * std::f64::consts::PI)).sqrt();
        let h = 2.0 * c_2 * area.sqrt();
        assert!((particle.next_h / h - 1.0).abs() < 1e-12, "{h} m: {particle:?}");
    }
    let mean = some.iter().map(|particle| particle.next_h).sum::<f64>() / some.len() as f64;
    assert!((mean / 2.5 - 1.0).abs() < 0.08, "{mean} m");
}

/// Water that spreads evenly by a factor has its density over the factor's square and its smoothing length times the factor.
#[test]
fn both_forms_follow_water_that_spreads_evenly() {
    for (form, most) in [("density", 0.01), ("rate", 0.01)] {
        for rate in [0.1, -0.05] {
            let mut flood = open(FREE, &[("flood.sph_swe.smoothing", form)], Some(spreading(rate)));
            let before = within(&flood, 6.0);
            go(&mut flood, 4.0);
            let factor = 1.0 + 4.0 * rate;
            let after = within(&flood, 12.0 * factor);
            let mut mean = 0.0;
            for particle in &before {
                let later = after[after.binary_search_by_key(&particle.id, |particle| particle.id).unwrap()];
                let grown = later.next_h / particle.next_h;
                // By the density of each, too: h = h0 (rho0 / rho)^(1/2).
                let by_density = (particle.depth / later.depth).sqrt();
                assert!((grown / by_density - 1.0).abs() < 3.0 * most, "{form}: {grown}, {by_density}: {later:?}");
                mean += grown / before.len() as f64;
            }
            assert!((mean / factor - 1.0).abs() < most, "{form}: {mean} times, {factor} expected");
        }
    }
}

/// Water that falls onto rough hills and splashes: particles lose all their neighbours, and find some again.
#[test]
fn smoothing_lengths_by_their_rate_stay_sound_where_water_splashes() {
    let text = r#"
        run.until_s = 60
        terrain.rough-hills = { extent = { length_m = 60, width_m = 60, cell_m = 1 }, relief_m = 20, hill_size_m = 30 }
        [flood]
        scheme = "sph-swe"
        spacing_m = 1
        spacing_depth_m = 1
        manning = 0
        sph_swe.smoothing = "rate"
        edges = { west = "wall", east = "wall", south = "wall", north = "wall" }
        water = [{ block = { from = [20, 20], to = [40, 40], height_m = 20, layers = 3 } }]
    "#;
    let mut flood = open(text, &[], None);
    for time in 1..=20 {
        go(&mut flood, f64::from(time));
        for particle in flood.particles() {
            let by_density = 2.66 / particle.depth.sqrt();
            let sound = particle.next_h > 0.499 * by_density.min(4.0 * 2.66) && particle.next_h < 4.001 * 2.66;
            assert!(sound, "{by_density} m by density: {particle:?}");
        }
    }
    let water = &flood.ledger().balances[0];
    assert!(water.relative_error().abs() < 1e-12, "{water:?}");
}
