//! A value that is not a number ends the run where it appears, and none is shown.

use corpuscle_flood::{InitialWater, SphSweFlood};
use corpuscle_model::{Model, ModelError, Values};
use corpuscle_scene::{FloodScene, Scene, builtin};
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A basin between walls.
const BASIN: &str = r#"
run.until_s = 20
terrain.plane.extent = { length_m = 120, width_m = 80, cell_m = 2 }
[flood]
scheme = "sph-swe"
spacing_m = 2
spacing_depth_m = 10
edges = { west = "wall", east = "wall", south = "wall", north = "wall" }
"#;

fn parse(text: &str, name: &str, overrides: &[(&str, &str)]) -> FloodScene {
    let overrides: Vec<_> = overrides.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    let mut scene = Scene::parse(text, name, &overrides).unwrap();
    scene.resolve_defaults();
    scene.flood().unwrap().clone()
}

fn terrain(scene: &FloodScene) -> Arc<Terrain> {
    Arc::new(Terrain::open(&scene.terrain, 1, Path::new(".")).unwrap())
}

/// The basin with water of this depth and eastward velocity.
fn with_water(
    depth: impl Fn(f64, f64) -> f64 + Sync,
    velocity: impl Fn(f64, f64) -> f64 + Sync,
    seed: u64,
) -> Result<SphSweFlood, ModelError> {
    let scene = parse(BASIN, "basin", &[]);
    let terrain = terrain(&scene);
    let body = InitialWater {
        depth: Box::new(depth),
        inside: Box::new(|_, _| true),
        within: terrain.bounds(),
        velocity: Box::new(move |x, y| [velocity(x, y), 0.0]),
    };
    SphSweFlood::with_water(&scene.flood, seed, Path::new("."), terrain, &[body])
}

/// All that files get of a flood: of a frame, of gauges, and of the ledger. Maps mark dry cells by not-a-number, but
/// hold no other.
fn shown(flood: &SphSweFlood) -> Vec<f64> {
    let mut values = flood.gauge_row();
    for set in flood.frame().sets {
        values.extend(set.position.iter().chain(&set.velocity).flatten());
        values.extend(set.radius.iter().chain(&set.mass));
        for column in set.columns {
            let Values::Scalar(column) = column.values else { panic!("{} is a scalar", column.name) };
            values.extend(column);
        }
    }
    for balance in flood.ledger().balances {
        values.extend([balance.initial, balance.inflow, balance.outflow, balance.now, balance.relative_error()]);
    }
    let maps = flood.maps().into_iter().flat_map(|map| map.values);
    values.extend(maps.filter(|value| !value.is_nan()).map(f64::from));
    values
}

/// The text of an error that names what, where and when.
fn told(error: &ModelError) -> String {
    let text = error.to_string();
    assert!(matches!(error, ModelError::Breakdown { .. }), "{text}");
    assert!(text.contains("t = ") && text.contains("x = ") && text.contains("y = "), "{text}");
    text
}

/// Where the depth falls from ten metres to nothing at once, as in a raster of a reservoir beside its dam, particles
/// that are scattered at random may come to stand on dry ground: they would hold no water, and have no acceleration.
#[test]
fn no_particle_at_the_start_is_without_water() {
    for seed in 0..5 {
        let depth = |x: f64, y: f64| if (x - 60.0).hypot(y - 40.0) < 30.0 { 10.0 } else { 0.0 };
        let mut flood = with_water(depth, |_, _| 0.0, seed).unwrap();
        assert!(flood.particles().len() > 500 && flood.particles().iter().all(|particle| particle.volume > 0.0));
        flood.advance_to(2.0, &AtomicBool::new(false)).unwrap();
        assert!(shown(&flood).iter().all(|value| value.is_finite()));
    }
}

#[test]
fn a_velocity_that_is_no_number_is_refused_at_the_start_with_its_position() {
    let error = with_water(|_, _| 1.0, |x, _| if x > 100.0 { f64::NAN } else { 0.0 }, 1).err().unwrap();
    let text = told(&error);
    let x: f64 = text.split("x = ").nth(1).unwrap().split(',').next().unwrap().parse().unwrap();
    assert!(x > 100.0 && text.contains("velocity") && text.contains("NaN") && text.contains("t = 0 s"), "{text}");
}

/// Water ten million times as viscous as the scene has it, far more than its time step can resolve: its velocities come to be no
/// numbers.
#[test]
fn a_run_that_breaks_down_says_where_and_when_and_shows_numbers_only() {
    let viscous = [("flood.sph_swe.viscosity", "1e6")];
    let scene = parse(builtin("flood/cuboid").unwrap().text, "flood/cuboid", &viscous);
    let mut flood = SphSweFlood::new(&scene.flood, 1, Path::new("."), terrain(&scene)).unwrap();
    let mut time = 0.0;
    let error = loop {
        time += 0.05;
        if let Err(error) = flood.advance_to(time, &AtomicBool::new(false)) {
            break error;
        }
        assert!(time < 20.0 && shown(&flood).iter().all(|value| value.is_finite()), "t = {time}");
    };
    let text = told(&error);
    assert!(["NaN", "inf", "the speed of particle"].iter().any(|word| text.contains(word)), "{text}");
    assert!(shown(&flood).iter().all(|value| value.is_finite()), "after {text}");
}
