//! Water goes round obstacles.

use corpuscle_flood::Flood;
use corpuscle_model::Model;
use corpuscle_scene::{FloodScene, Scene};
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

fn parse(text: &str, overrides: &[(&str, &str)]) -> FloodScene {
    let overrides: Vec<_> = overrides.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    let mut scene = Scene::parse(text, "test", &overrides).unwrap();
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

fn gauge(flood: &Flood, header: &str) -> f64 {
    let at = flood.gauge_columns().iter().position(|column| column.header() == header).expect(header);
    flood.gauge_row()[at]
}

/// A lake over hills with an oblique block and a round tower in it.
const LAKE: &str = r#"
run.until_s = 20
terrain.bump = { extent = { length_m = 40, width_m = 30, cell_m = 0.5 }, height_m = 0.6 }
[flood]
spacing_m = 1
water = [{ level_m = 2 }]
edges = { west = "wall", east = "wall", south = "wall", north = "wall" }
[[flood.obstacle]]
name = "block"
polygon = [[10, 8], [17, 11], [15, 16], [8, 13]]
[[flood.obstacle]]
name = "tower"
circle = { centre = [27, 18], radius_m = 4 }
"#;

#[test]
fn a_lake_round_obstacles_stays_at_rest() {
    let mut flood = open(&parse(LAKE, &[]));
    for look in 1..=2 {
        go(&mut flood, 10.0 * f64::from(look));
        let fastest = flood.particles().iter().map(|particle| particle.speed()).fold(0.0, f64::max);
        println!("{fastest:e}");
    }
    let outline = |at: f64| flood.particles().iter().filter(|p| (p.x - at).abs() < 1.0).count();
    println!("{} {}", flood.particles().len(), outline(27.0));
    for p in flood.particles().iter().take(3) {
        println!("{p:?}");
    }
}
