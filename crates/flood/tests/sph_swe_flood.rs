//! What scheme sph-swe promises to whoever runs it.

mod common;

use common::{scene, sph_swe, terrain};
use corpuscle_flood::SphSweFlood;
use corpuscle_model::Model;
use corpuscle_scene::FloodScene;
use std::f64::consts::PI;
use std::path::Path;
use std::sync::atomic::AtomicBool;

const RIVER: &str = r#"
run.until_s = 60
terrain.valley = { extent = { length_m = 300, width_m = 200, cell_m = 5 }, slope = 0.02, plain_width_m = 60, meander_m = 10 }

[flood]
scheme = "sph-swe"
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

fn river(change: impl FnOnce(&mut FloodScene)) -> SphSweFlood {
    let mut scene = scene(RIVER);
    change(&mut scene);
    sph_swe(&scene)
}

/// With half the smoothing length that is needed depths reached 1e97 m within 2 s.
#[test]
fn a_smoothing_length_with_which_a_particle_alone_gets_ever_deeper_is_refused() {
    for (kernel, least) in [
        ("mueller", (4.0 / PI).sqrt()),
        ("cubic-spline", (40.0 / (7.0 * PI)).sqrt()),
        ("wendland-c2", (7.0 / PI).sqrt()),
    ] {
        let volume: f64 = 36.0;
        let open = |factor: f64| {
            let length = factor * least * volume.sqrt();
            let sets = format!("\n[flood.sph_swe]\nkernel = \"{kernel}\"\nsmoothing_length_m = {length}\n");
            let scene = scene(&format!("{RIVER}{sets}"));
            SphSweFlood::new(&scene.flood, 1, Path::new("."), terrain(&scene))
        };
        let error = open(0.999).map(|_| ()).unwrap_err().to_string();
        assert!(error.contains("smoothing_length_m") && error.contains("15.96"), "{error}");
        assert!(open(1.001).is_ok(), "{kernel}");
    }
}

fn go(flood: &mut SphSweFlood, time: f64) {
    flood.advance_to(time, &AtomicBool::new(false)).unwrap();
}

/// Beyond a wall there are ghost particles of the water, and so the position before it is not half dry.
#[test]
fn water_reaches_up_to_walls_and_periodic_sides() {
    let basin = r#"
        run.until_s = 1
        terrain.plane.extent = { length_m = 40, width_m = 30, cell_m = 0.5 }
        [flood]
        scheme = "sph-swe"
        spacing_m = 3
        water = [{ depth_m = 1 }]
        edges = { west = "wall", east = "wall", south = "periodic", north = "periodic" }
    "#;
    let maps = sph_swe(&scene(basin)).maps();
    let depth = &maps.iter().find(|map| map.name == "depth").unwrap().values;
    let dry = depth.iter().filter(|depth| depth.is_nan()).count();
    assert_eq!(dry, 0, "of {} positions", depth.len());
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
    // The control force would hold the water back.
    let mut flood = river(|scene| scene.flood.sph_swe.control_force = false);
    go(&mut flood, 60.0);
    let water = &flood.ledger().balances[0];
    assert!(water.inflow > 2300.0 && water.inflow <= 2400.0, "{water:?}");
    assert!(water.outflow > 0.0, "{water:?}");
    assert!(water.relative_error().abs() <= 1e-12, "{water:?}");
}

/// Water that had left slowly over one side and ran fast along it went on beyond the next corner, until its state was refused as that of another scene.
#[test]
fn what_leaves_over_a_side_and_runs_along_it_is_gone_beyond_the_corner() {
    let text = "run.until_s = 10\nterrain.plane = { extent = { length_m = 40, width_m = 40, cell_m = 1 } }\n\
                flood.scheme = \"sph-swe\"\nflood.spacing_m = 2\nflood.spacing_depth_m = 1\nflood.sph_swe.control_force = false\nflood.manning = 0\n\
                flood.edges = { west = \"open\", east = \"open\", south = \"open\", north = \"open\" }\n\
                [[flood.water]]\ndepth_m = 1\nvelocity_m_per_s = [60, 0.3]\npolygon = [[2, 30], [2, 40], [20, 40], [20, 30]]\n";
    let mut flood = sph_swe(&scene(text));
    go(&mut flood, 4.0);
    let farthest = flood.particles().iter().map(|particle| particle.x).fold(0.0, f64::max);
    assert!(farthest < 40.0 + 4.0 * 4.0 * 5.0, "{farthest}");
    let saved = flood.save();
    let mut other = sph_swe(&scene(text));
    other.restore(&saved).unwrap();
}

#[test]
fn what_falls_lands() {
    let text = "run.until_s = 10\nterrain.plane = { extent = { length_m = 40, width_m = 40, cell_m = 1 } }\n\
                flood.scheme = \"sph-swe\"\nflood.spacing_m = 1\nflood.spacing_depth_m = 1\n\
                [[flood.water]]\nblock = { from = [10, 10], to = [20, 20], height_m = 5, layers = 2 }\n";
    let mut flood = sph_swe(&scene(text));
    assert_eq!(flood.frame().sets[0].len(), 200);
    assert!(flood.particles().is_empty());
    // The upper layer's fall of 6.5 m takes 1.15 s.
    go(&mut flood, 1.3);
    assert_eq!(flood.particles().len(), 200);
}
