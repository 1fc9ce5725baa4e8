//! Water of scheme sph-swe goes round obstacles.

mod common;

use common::{scene, scene_with, sph_swe};
use corpuscle_flood::SphSweFlood;
use corpuscle_model::Model;
use corpuscle_terrain::Terrain;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

fn go(flood: &mut SphSweFlood, time: f64) {
    flood.advance_to(time, &AtomicBool::new(false)).unwrap();
}

fn gauge(flood: &SphSweFlood, header: &str) -> f64 {
    let at = flood.gauge_columns().iter().position(|column| column.header() == header).expect(header);
    flood.gauge_row()[at]
}

/// A lake over hills with an oblique block and a round tower in it.
const LAKE: &str = r#"
run.until_s = 20
terrain.bump = { extent = { length_m = 40, width_m = 30, cell_m = 0.5 }, height_m = 0.6 }
[flood]
scheme = "sph-swe"
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

/// Distance of a position from the walls of the block and of the tower, m; negative inside.
fn distance([x, y]: [f64; 2]) -> f64 {
    let tower = (x - 27.0).hypot(y - 18.0) - 4.0;
    let corners = [[10.0, 8.0], [17.0, 11.0], [15.0, 16.0], [8.0, 13.0]];
    // The corners go round against the clock, so the outside is to the right of each side; the largest is the distance of a convex block.
    let beyond = |k: usize| {
        let (a, b): ([f64; 2], [f64; 2]) = (corners[k], corners[(k + 1) % 4]);
        let side = [b[0] - a[0], b[1] - a[1]];
        (side[1] * (x - a[0]) - side[0] * (y - a[1])) / side[0].hypot(side[1])
    };
    tower.min((0..4).map(beyond).fold(f64::NEG_INFINITY, f64::max))
}

/// A bore against the block and the tower, on a flat bed.
fn bore() -> SphSweFlood {
    let water = "[{ depth_m = 2, polygon = [[0, 0], [7, 0], [7, 30], [0, 30]] }, { depth_m = 0.3, polygon = [[7, 0], [40, 0], [40, 30], [7, 30]] }]";
    sph_swe(&scene_with(
        LAKE,
        &[("flood.water", water), ("terrain.bump.height_m", "0"), ("flood.spacing_depth_m", "1")],
    ))
}

#[test]
fn no_water_comes_into_obstacles() {
    let mut flood = bore();
    for look in 1..=40 {
        go(&mut flood, 0.25 * f64::from(look));
        let positions = flood.particles().iter().map(|particle| [particle.x, particle.y]);
        let deepest = positions.map(distance).fold(f64::INFINITY, f64::min);
        assert!(deepest > -1e-3, "{deepest} m at {} s", flood.time());
    }
    let balance = &flood.ledger().balances[0];
    assert!(balance.relative_error().abs() < 1e-12, "{balance:?}");
    // The bore has reached the block and pushed it on its way.
    assert!(gauge(&flood, "block.impulse_east_N_s") > 0.0);
}

/// What the water loses in momentum, walls and obstacles take.
#[test]
fn momentum_that_obstacles_take_is_booked() {
    let mut flood = bore();
    go(&mut flood, 4.0);
    let balance = &flood.ledger().balances[1];
    // Of the momentum that the walls in the west give, about 2 g 30 m 4 s 1000 kg/m3.
    let error = (balance.now - balance.initial - balance.inflow + balance.outflow).abs();
    assert!(error < 1e-9 * 2.4e6, "{error} of {balance:?}");
}

#[test]
fn obstacles_come_from_files_and_bad_ones_are_named() {
    let folder = std::env::temp_dir().join(format!("corpuscle-obstacles-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
    write("houses.csv", "x, y, name\n5,5,a\n9,5,a\n9,9,a\n20,5,b\n24,5,b\n24,9,b\n");
    write("house.geojson", r#"{"type":"Polygon","coordinates":[[[505,505],[509,505],[509,509],[505,505]]]}"#);
    write("lines.geojson", r#"{"type":"LineString","coordinates":[[5,5],[9,5]]}"#);
    write("words.csv", "x,y\n1,2\none,3\n");
    let with = |file: &str| {
        let text = format!(
            "run.until_s = 1\nterrain.plane.extent = {{ length_m = 40, width_m = 20, cell_m = 1 }}\n[flood]\nscheme = \"sph-swe\"\nspacing_m = 1\nwater = [{{ \
             depth_m = 1 }}]\nobstacle = [{{ name = \"houses\", file = \"{file}\" }}]"
        );
        let scene = scene(&text);
        let terrain = Terrain::open(&scene.terrain, 1, &folder).unwrap();
        SphSweFlood::new(&scene.flood, 1, &folder, Arc::new(terrain))
    };
    let houses = with("houses.csv").unwrap();
    let inside = |x: f64, y: f64| houses.particles().iter().any(|p| (p.x - x).hypot(p.y - y) < 0.7);
    assert!(!inside(8.0, 6.0) && !inside(23.0, 6.0) && inside(15.0, 6.0));
    // Of a town some houses may stand beyond the terrain.
    write("town.csv", "x, y, name\n505,5,a\n509,5,a\n509,9,a\n20,5,b\n24,5,b\n24,9,b\n");
    with("town.csv").unwrap();
    let refused = |file: &str| with(file).err().expect(file).to_string();
    assert!(refused("house.geojson").contains("outside the terrain"));
    assert!(refused("lines.geojson").contains("no polygon"));
    assert!(refused("words.csv").contains("line 3"));
    assert!(refused("houses.kml").contains(".kml"));
    assert!(refused("nowhere.shp").contains("houses"));
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn water_higher_than_an_obstacle_is_told() {
    let low = LAKE.replace("circle =", "height_m = 1\ncircle =");
    let mut flood = sph_swe(&scene(&low));
    go(&mut flood, 0.5);
    let warnings = flood.warnings();
    assert!(warnings.iter().any(|warning| warning.contains("'tower'")), "{warnings:?}");
    assert!(!sph_swe(&scene(LAKE)).warnings().iter().any(|warning| warning.contains("'tower'")));
}

#[test]
fn corners_far_away_take_no_memory_and_no_time() {
    for far in ["1e15", "1e300"] {
        let polygon = format!("[[30, 8], [{far}, 8], [{far}, 12], [30, 12]]");
        let mut flood = sph_swe(&scene_with(LAKE, &[("flood.obstacle.0.polygon", &polygon)]));
        go(&mut flood, 0.1);
        let near =
            flood.frame().sets[0].position.iter().filter(|at| at[0] > 30.0 && (8.0..12.0).contains(&at[1])).count();
        assert_eq!(near, 0, "{far}");
    }
}
