//! Estimates of the water that is to come, beside what comes.

mod common;

use corpuscle_flood::SphSweFlood;

fn open(text: &str) -> SphSweFlood {
    common::sph_swe(&common::scene(text))
}

/// Particles of scheme sph-swe, of 4 m3 each.
#[test]
fn inflow_comes_as_it_is_written() {
    let tank = "run.until_s = 600\nterrain.plane.extent = { length_m = 100, width_m = 40, cell_m = 2 }\n[flood]\n\
                scheme = \"sph-swe\"\nspacing_m = 2\nspacing_depth_m = 1\n";
    let river = "[[flood.inflow]]\nname = \"river\"\nat = [20, 20]\ndischarge_m3_per_s = [[0, 0], [100, 8]]\n";
    let flood = open(&format!("{tank}{river}"));
    assert_eq!(flood.particles_to_come(0.0, 100.0), 100.0);
    assert_eq!(flood.particles_to_come(100.0, 600.0), 1000.0);
    assert_eq!(open(tank).particles_to_come(0.0, 600.0), 0.0);
}

/// Scheme voronoi counts cells of 4 m2 that are to get wet: by an inflow, a held level, rain, and not those that are wet already.
#[test]
fn cells_to_get_wet_are_counted() {
    let to_come = |rest: &str| {
        let flood = common::voronoi(&common::scene(&format!(
            "run.until_s = 600\nterrain.plane = {{ slope_east = 0.02, extent = {{ length_m = 100, width_m = 40, cell_m = 2 }} }}\n[flood]\n\
                 scheme = \"voronoi\"\nspacing_m = 2\n{rest}"
        )));
        [100.0, 600.0].map(|until| flood.particles_to_come(0.0, until) / 1000.0)
    };
    let near = |found: [f64; 2], expected: [f64; 2]| (0..2).all(|k| (found[k] - expected[k]).abs() < 0.02);
    let inflow =
        to_come("inflow = [{ name = \"river\", at = [20, 20], discharge_m3_per_s = [[0, 0], [100, 8], [200, 8]] }]");
    assert!(near(inflow, [0.1, 1.0]), "{inflow:?}");
    // The ground falls by 2 m to the east, from 1 m to -1 m.
    let held = to_come("edges.east = { stage = [[0, -1], [100, -0.5], [500, 0]] }");
    assert!(near(held, [0.25, 0.5]), "{held:?}");
    let more = to_come("edges.east = { stage = [[0, -0.5], [100, -0.5], [500, 0]] }\nwater = [{ level_m = -0.5 }]");
    assert!(near(more, [0.0, 0.25]), "{more:?}");
    assert!(near(to_come("rain = { intensity_mm_per_h = 10 }"), [1.0; 2]));
    assert_eq!(to_come("water = [{ level_m = 0 }]"), [0.0; 2]);
}
