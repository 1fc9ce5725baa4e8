//! What the flood model promises to whoever runs it.

use corpuscle_flood::Flood;
use corpuscle_model::Model;
use corpuscle_scene::{Edge, FloodScene, Scene, Series};
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

const RIVER: &str = r#"
run.until_s = 60
terrain.valley = { extent = { length_m = 300, width_m = 200, cell_m = 5 }, slope = 0.02, plain_width_m = 60, meander_m = 10 }

[flood]
scheme = "balanced"
spacing_m = 6
spacing_depth_m = 1

[flood.edges]
west = "wall"
south = "wall"
north = "wall"

[[flood.water]]
depth_m = 0.5
polygon = [[100, 80], [200, 80], [200, 120], [100, 120]]

[[flood.inflow]]
name = "river"
at = [40, 100]
discharge_m3_per_s = [[0, 20], [60, 60]]

[[flood.gauge]]
name = "bridge"
at = [150, 100]

[[flood.section]]
name = "bridge line"
line = [[150, 180], [150, 20]]
"#;

fn river(change: impl FnOnce(&mut FloodScene)) -> Flood {
    let mut scene = parse(RIVER, &[]);
    change(&mut scene);
    open(&scene)
}

fn parse(text: &str, overrides: &[(String, String)]) -> FloodScene {
    let mut scene = Scene::parse(text, "test", overrides).unwrap();
    scene.resolve_defaults();
    scene.flood().unwrap().clone()
}

fn open(scene: &FloodScene) -> Flood {
    let terrain = Terrain::open(&scene.terrain, 1, Path::new(".")).unwrap();
    Flood::new(&scene.flood, 1, Path::new("."), Arc::new(terrain)).unwrap()
}

fn go(flood: &mut Flood, time: f64) {
    flood.advance_to(time, &AtomicBool::new(false)).unwrap();
}

/// Beyond a wall there are images of the water, and so the place before it is not half dry.
#[test]
fn water_reaches_up_to_walls_and_periodic_sides() {
    let basin = r#"
        run.until_s = 1
        terrain.plane.extent = { length_m = 40, width_m = 30, cell_m = 0.5 }
        [flood]
        spacing_m = 3
        water = [{ depth_m = 1 }]
        edges = { west = "wall", east = "wall", south = "periodic", north = "periodic" }
    "#;
    for scheme in ["balanced", "sph-swe"] {
        let maps = open(&parse(basin, &[("flood.scheme".into(), scheme.into())])).maps();
        let depth = &maps.iter().find(|map| map.name == "depth").unwrap().values;
        let dry = depth.iter().filter(|depth| depth.is_nan()).count();
        assert_eq!(dry, 0, "of {} places, scheme {scheme}", depth.len());
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let with = |threads| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| {
            let mut flood = river(|_| {});
            go(&mut flood, 20.0);
            flood.save()
        })
    };
    assert!(with(1) == with(3));
}

#[test]
fn looking_more_often_does_not_change_the_water() {
    let [mut once, mut often] = [(); 2].map(|()| river(|_| {}));
    go(&mut once, 20.0);
    (1..=200).for_each(|look| go(&mut often, f64::from(look) * 0.1));
    assert!(once.save() == often.save());
    assert_eq!(once.gauge_row(), often.gauge_row());
}

#[test]
fn a_restored_run_goes_on_to_the_same_bits() {
    let mut whole = river(|_| {});
    go(&mut whole, 12.3);
    let saved = whole.save();
    go(&mut whole, 25.0);
    let mut resumed = river(|_| {});
    resumed.restore(&saved).unwrap();
    assert_eq!(resumed.time(), 12.3);
    go(&mut resumed, 25.0);
    assert!(whole.save() == resumed.save());
    assert_eq!(format!("{:?}", whole.frame()), format!("{:?}", resumed.frame()));
    let mut other = river(|scene| scene.flood.inflow.clear());
    assert!(other.restore(&saved).is_err());
    assert!(resumed.restore(&saved[..saved.len() / 2]).is_err());
}

#[test]
fn water_balances_with_inflow_and_outflow() {
    let mut flood = river(|_| {});
    go(&mut flood, 60.0);
    let water = &flood.ledger().balances[0];
    assert!(water.inflow > 2300.0 && water.inflow <= 2400.0, "{water:?}");
    assert!(water.outflow > 0.0, "{water:?}");
    assert!(water.relative_error().abs() <= 1e-12, "{water:?}");
}

/// A pool whose east side is held at a level fills or empties to it.
#[test]
fn an_edge_held_at_a_level_fills_and_empties_a_pool() {
    for (depth, level) in [(1.0, 1.5), (1.5, 1.0)] {
        let text = "run.until_s = 200\nterrain.plane = { extent = { length_m = 60, width_m = 30, cell_m = 2 } }\n\
                    flood = { scheme = \"balanced\", spacing_m = 2, spacing_depth_m = 1, manning = 0.1, water = [{ depth_m = 1 }] }\n";
        let mut scene = parse(text, &[]);
        scene.flood.water[0].depth_m = Some(depth.into());
        let edges = &mut scene.flood.edges;
        (edges.west, edges.south, edges.north) = (Edge::Wall, Edge::Wall, Edge::Wall);
        edges.east = Edge::Stage(Series::Constant(level));
        let mut flood = open(&scene);
        go(&mut flood, 200.0);
        let water = &flood.ledger().balances[0];
        let mean = water.now / (60.0 * 30.0);
        assert!((mean - level).abs() < 0.1, "from {depth} to {level}: {mean}");
        assert!(water.relative_error().abs() <= 1e-12);
    }
}

#[test]
fn both_schemes_land_what_falls() {
    for scheme in ["sph-swe", "balanced"] {
        let text = "run.until_s = 10\nterrain.plane = { extent = { length_m = 40, width_m = 40, cell_m = 1 } }\n\
                    flood.spacing_m = 1\nflood.spacing_depth_m = 1\n\
                    [[flood.water]]\nblock = { from = [10, 10], to = [20, 20], height_m = 5, layers = 2 }\n";
        let set = [("flood.scheme".to_string(), scheme.to_string())];
        let mut flood = open(&parse(text, &set));
        assert_eq!(flood.frame().sets[0].len(), 200);
        assert!(flood.particles().is_empty());
        // The upper layer's fall of 6.5 m takes 1.15 s.
        go(&mut flood, 1.3);
        assert_eq!(flood.particles().len(), 200);
    }
}

/// Hills 30 m wide and 6 m high, half under water; particles 1.5 m apart, cells of 2 m.
const ROUGH_LAKE: &str = r#"
run.until_s = 20
terrain.rough-hills = { extent = { length_m = 100, width_m = 100, cell_m = 2 }, relief_m = 6, hill_size_m = 30 }

[flood]
scheme = "balanced"
spacing_m = 1.5
spacing_depth_m = 1
manning = 0.03
balanced = { fine_shores = true }

[flood.edges]
west = "wall"
east = "wall"
south = "wall"
north = "wall"

[[flood.water]]
level_m = 3
"#;

/// A glass with nothing beyond the shore holds 2.5 % too little here, one that is cut out of a larger one 1.9 % too much.
#[test]
fn a_lake_between_rough_hills_holds_its_volume() {
    let scene = parse(ROUGH_LAKE, &[]);
    let terrain = Terrain::open(&scene.terrain, 1, Path::new(".")).unwrap();
    let (parts, step) = (400, 0.25);
    let middle = |k: usize| (k as f64 + 0.5) * step;
    let depth = |k: usize| (3.0 - terrain.height(middle(k % parts), middle(k / parts))).max(0.0);
    let volume: f64 = (0..parts * parts).map(|k| depth(k) * step * step).sum();
    let held: f64 = open(&scene).particles().iter().map(|particle| particle.volume).sum();
    assert!((held / volume - 1.0).abs() < 0.01, "{held} of {volume} m3");
}

/// Particles that follow the depth alone, and that nothing holds back at the shore, move with 0.03 m/s here.
#[test]
fn a_lake_between_rough_hills_lies_still() {
    let mut flood = open(&parse(ROUGH_LAKE, &[]));
    let full: f64 = flood.particles().iter().map(|particle| particle.volume).sum();
    go(&mut flood, 20.0);
    let particles = flood.particles();
    let kinetic: f64 = particles.iter().map(|p| p.volume * (p.u * p.u + p.v * p.v)).sum();
    let speed = (kinetic / full).sqrt();
    assert!(speed < 0.008, "{speed} m/s");
    let off = particles.iter().filter(|p| (p.surface() - 3.0).abs() > 0.1).count();
    assert!(off * 500 < particles.len(), "{off} of {} more than 10 cm off the level", particles.len());
}

/// One particle on ground that falls to the corner of two walls comes to rest there, as deep as before.
#[test]
fn a_lone_particle_in_a_corner_stays_as_deep_as_it_was() {
    let text = r#"
        run.until_s = 60
        terrain.plane = { extent = { length_m = 20, width_m = 20, cell_m = 1 }, slope_east = 0.1, slope_north = 0.1 }
        [flood]
        scheme = "balanced"
        spacing_m = 2
        spacing_depth_m = 1
        manning = 0.05
        edges = { west = "wall", south = "wall" }
        water = [{ depth_m = 1, polygon = [[4, 4], [6, 4], [6, 6], [4, 6]] }]
    "#;
    let mut flood = open(&parse(text, &[]));
    go(&mut flood, 60.0);
    let [particle] = flood.particles() else { panic!("{} particles", flood.particles().len()) };
    assert!(particle.x < 2.0 && particle.y < 2.0, "at {}, {}", particle.x, particle.y);
    assert!(particle.depth < 4.0 && flood.steps() < 2000, "{} m deep after {} steps", particle.depth, flood.steps());
}
