//! Estimates of the water that is to come, beside what comes.

use corpuscle_flood::{Flood, VoronoiFlood};
use corpuscle_scene::Scene;
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;

fn open(text: &str) -> Flood {
    let mut scene = Scene::parse(text, "test", &[]).unwrap();
    scene.resolve_defaults();
    let scene = scene.flood().unwrap();
    let terrain = Terrain::open(&scene.terrain, 1, Path::new(".")).unwrap();
    Flood::new(&scene.flood, 1, Path::new("."), Arc::new(terrain)).unwrap()
}

/// A level tank of 100 m by 40 m between walls, with particles of 4 m3, and what else is said.
fn tank(rest: &str) -> Flood {
    let walls = ["west", "east", "south", "north"].map(|side| (side, format!("{side} = \"wall\"")));
    let walls = walls.iter().filter(|(side, _)| !rest.contains(&format!("edges.{side}")));
    let walls: String = walls.map(|(_, wall)| format!("edges.{wall}\n")).collect();
    open(&format!(
        "run.until_s = 600\nterrain.plane.extent = {{ length_m = 100, width_m = 40, cell_m = 2 }}\n[flood]\n\
         scheme = \"balanced\"\nspacing_m = 2\nspacing_depth_m = 1\n{walls}{rest}"
    ))
}

#[test]
fn inflow_comes_as_it_is_written() {
    let flood = tank("[[flood.inflow]]\nname = \"river\"\nat = [20, 20]\ndischarge_m3_per_s = [[0, 0], [100, 8]]\n");
    assert_eq!(flood.particles_to_come(0.0, 100.0), 100.0);
    assert_eq!(flood.particles_to_come(100.0, 600.0), 1000.0);
    assert_eq!(tank("").particles_to_come(0.0, 600.0), 0.0);
}

/// An edge or a zone held at 1 m over dry ground fills the tank, if there is time; a lake at that level gains nothing. What comes is not counted
/// here: edges of scheme balanced overfill this tank by half.
#[test]
fn held_levels_let_in_what_finds_room() {
    let edge = "edges.west = { stage = 1 }\n";
    let zone = "[[flood.stage]]\nname = \"pond\"\nlevel_m = 1\npolygon = [[0, 0], [10, 0], [10, 40], [0, 40]]\n";
    let room = 1000.0;
    for (what, flood) in [("edge", tank(edge)), ("zone", tank(zone))] {
        let estimate = flood.particles_to_come(0.0, 600.0);
        assert!((estimate / room - 1.0).abs() < 0.1, "{what}: {estimate} of {room}");
        let soon = flood.particles_to_come(0.0, 3.0);
        assert!(soon > 0.02 * room && soon < 0.5 * room, "{what}: {soon} in three seconds");
    }
    let lake = format!("{edge}water = [{{ level_m = 1 }}]\n");
    assert!(tank(&lake).particles_to_come(0.0, 600.0) < 0.1 * room);
}

/// Rain leaves a film of 1 mm, of which a cell as large as a particle's film makes a particle; what more falls on it makes no other.
#[test]
fn rain_makes_few_particles_for_each_cell() {
    let rain = |hours: f64| tank("rain = { intensity_mm_per_h = 10 }\n").particles_to_come(0.0, 3600.0 * hours);
    let cells = 4000.0 / (12.0 * 12.0);
    assert!(rain(0.01) < 0.2 * cells, "{}", rain(0.01));
    assert!((rain(10.0) / (2.0 * cells) - 1.0).abs() < 0.3, "{}", rain(10.0));
    let soaked = "rain = { intensity_mm_per_h = 10 }\ninfiltration.constant.rate_mm_per_h = 20\n";
    assert_eq!(tank(soaked).particles_to_come(0.0, 36_000.0), 0.0);
}

/// Scheme voronoi counts cells of 4 m2 that are to get wet: by an inflow, a held level, rain, and not those that are wet already.
#[test]
fn cells_to_get_wet_are_counted() {
    let to_come = |rest: &str| {
        let mut scene = Scene::parse(
            &format!(
                "run.until_s = 600\nterrain.plane = {{ slope_east = 0.02, extent = {{ length_m = 100, width_m = 40, cell_m = 2 }} }}\n[flood]\n\
                 scheme = \"voronoi\"\nspacing_m = 2\n{rest}"
            ),
            "test",
            &[],
        )
        .unwrap();
        scene.resolve_defaults();
        let scene = scene.flood().unwrap();
        let terrain = Terrain::open(&scene.terrain, 1, Path::new(".")).unwrap();
        let flood = VoronoiFlood::new(&scene.flood, 1, Path::new("."), Arc::new(terrain)).unwrap();
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
