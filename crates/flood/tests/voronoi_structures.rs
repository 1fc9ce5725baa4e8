//! Outflows by rating, held levels, culverts and weirs.

mod common;

use corpuscle_flood::VoronoiFlood;
use corpuscle_model::Model;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Two pools of 30 m by 30 m with a wall 6 m thick between them, and what `keys` add.
fn pools(depths: [f64; 2], spacing: f64, keys: &str) -> VoronoiFlood {
    let water = |x: [f64; 2], depth: f64| {
        format!("{{ depth_m = {depth}, polygon = [[{0}, 0], [{1}, 0], [{1}, 30], [{0}, 30]] }}", x[0], x[1])
    };
    let standing: Vec<String> = [([0.0, 30.0], depths[0]), ([36.0, 66.0], depths[1])]
        .into_iter()
        .filter(|(_, depth)| *depth > 0.0)
        .map(|(x, depth)| water(x, depth))
        .collect();
    let text = format!(
        "run.until_s = 600\nterrain.plane.extent = {{ length_m = 66, width_m = 30, cell_m = 1 }}\n[flood]\n\
         spacing_m = {spacing}\nwater = [{}]\nedges = {{ west = \"wall\", east = \"wall\", south = \"wall\", north = \"wall\" }}\n\
         obstacle = [{{ name = \"wall\", polygon = [[30, 0], [36, 0], [36, 30], [30, 30]] }}]\n{keys}",
        standing.join(", ")
    );
    common::voronoi(&common::scene(&text))
}

fn go(flood: &mut VoronoiFlood, time: f64) {
    flood.advance_to(time, &AtomicBool::new(false)).unwrap();
    let water = &flood.ledger().balances[0];
    assert!(water.relative_error().abs() < 1e-12, "{water:?}");
}

/// Water in the two pools, m3.
fn volumes(flood: &VoronoiFlood) -> [f64; 2] {
    let of = |side: fn(f64) -> bool| {
        flood.wet_cells().filter(|cell| side(cell.centroid[0])).map(|cell| cell.area * cell.depth).sum()
    };
    [of(|x| x < 33.0), of(|x| x >= 33.0)]
}

/// Volume in the first pool after `time`, by small steps of dV/dt = -discharge(level, level of the other).
fn emptied(volumes: [f64; 2], time: f64, discharge: impl Fn(f64, f64) -> f64) -> f64 {
    let [mut first, mut second] = volumes;
    for _ in 0..10_000 {
        let out = discharge(first / 900.0, second / 900.0) * time / 1e4;
        (first, second) = (first - out, second + out);
    }
    first
}

#[test]
fn a_weir_leads_what_its_formula_says() {
    let keys = "link = [{ name = \"weir\", from = [15, 15], to = [50, 15], law = { weir = { crest_m = 1.0, width_m = 2.0 } } }]";
    let mut flood = pools([1.6, 0.8], 2.5, keys);
    let start = volumes(&flood);
    go(&mut flood, 120.0);
    let exact = emptied(start, 120.0, |upper, lower| {
        let (head, behind) = ((upper - 1.0_f64).max(0.0), (lower - 1.0).max(0.0));
        1.705 * 2.0 * head.powf(1.5) * (1.0 - (behind / head).powf(1.5)).powf(0.385)
    });
    let (gone, should) = (start[0] - volumes(&flood)[0], start[0] - exact);
    assert!(should > 60.0 && (gone / should - 1.0).abs() < 0.06, "{gone} {should}");
    let sum = |volumes: [f64; 2]| volumes[0] + volumes[1];
    assert!((sum(volumes(&flood)) - sum(start)).abs() < 1e-9);
}

#[test]
fn a_culvert_levels_two_pools_whichever_is_higher() {
    for (depths, sign) in [([2.0, 1.5], 1.0), ([1.5, 2.0], -1.0)] {
        let keys =
            "link = [{ name = \"pipe\", from = [15, 15], to = [50, 15], law = { culvert = { diameter_m = 1.0 } } }]";
        let mut flood = pools(depths, 2.5, keys);
        let column = flood.gauge_columns().iter().position(|column| column.gauge == "pipe").unwrap();
        go(&mut flood, 5.0);
        // Drowned: a full pipe of 35 m.
        let friction = 2.0 * 9.81 * 0.012_f64.powi(2) * 35.0 / 0.25_f64.powf(4.0 / 3.0);
        let full = std::f64::consts::FRAC_PI_4 * (2.0 * 9.81 * 0.5 / (1.5 + friction)).sqrt();
        let found = flood.gauge_row()[column];
        assert!((sign * found / full - 1.0).abs() < 0.1, "{found} {full}");
        go(&mut flood, 600.0);
        let [west, east] = volumes(&flood);
        assert!((west - east).abs() < 0.05 * west, "{west} {east}");
    }
    let one_way =
        "link = [{ name = \"flap\", from = [15, 15], to = [50, 15], both_ways = false, law = { rating = [[0, 1]] } }]";
    let mut flood = pools([1.0, 1.5], 2.5, one_way);
    let before = volumes(&flood);
    go(&mut flood, 60.0);
    assert!(volumes(&flood).iter().zip(before).all(|(now, before)| (now - before).abs() < 1e-9));
}

#[test]
fn an_outflow_takes_what_its_rating_says() {
    let keys = "outflow = [{ name = \"sluice\", line = [[26, 2], [26, 28]], rating = [[0.0, 0.0], [2.0, 4.0]] }]";
    let mut flood = pools([1.5, 0.0], 1.5, keys);
    let start = volumes(&flood)[0];
    go(&mut flood, 200.0);
    // dV/dt = -2 V / 900.
    let exact = start * (-2.0 * 200.0 / 900.0_f64).exp();
    let found = volumes(&flood)[0];
    assert!((found / exact - 1.0).abs() < 0.02, "{found} {exact}");
    assert!((flood.ledger().balances[0].outflow - (start - found)).abs() < 1e-9);
}

#[test]
fn a_held_polygon_keeps_a_pool_at_its_level() {
    let keys = "manning = 0.05\nstage = [{ name = \"tide\", polygon = [[1, 1], [14, 1], [14, 29], [1, 29]], \
                level_m = [[0, 1], [100, 1.5], [200, 1.5], [300, 1.0]] }]";
    let mut flood = pools([1.0, 0.0], 2.5, keys);
    for (time, level) in [(200.0, 1.5), (400.0, 1.0)] {
        go(&mut flood, time);
        // Outside the polygon.
        let positions = (0..20).map(|k| [16.0 + f64::from(k % 4) * 1.5, 3.0 + f64::from(k / 4) * 6.0]);
        let mean = positions.map(|[x, y]| flood.sample(x, y).depth).sum::<f64>() / 20.0;
        assert!((mean - level).abs() < 0.03, "at {time} s {mean} for {level}");
    }
}

#[test]
fn links_too_close_for_the_particles_are_refused() {
    let text = "run.until_s = 1\nterrain.plane = {}\n[flood]\nspacing_m = 10\n\
                link = [{ name = \"pipe\", from = [500, 500], to = [510, 500], law = { culvert = { diameter_m = 1 } } }]";
    let scene = common::scene(text);
    let error = VoronoiFlood::new(&scene.flood, 1, Path::new("."), common::terrain(&scene)).err().unwrap().to_string();
    assert!(error.contains("'pipe'") && error.contains("10.000 m apart"), "{error}");
}

#[test]
fn a_culvert_shorter_than_its_way_is_warned_of() {
    let warnings = |length: f64| {
        let law = format!("{{ culvert = {{ diameter_m = 1.0, length_m = {length} }} }}");
        let keys = format!("link = [{{ name = \"pipe\", from = [15, 15], to = [50, 15], law = {law} }}]");
        pools([2.0, 1.5], 2.5, &keys).warnings()
    };
    assert!(warnings(30.0).iter().all(|warning| !warning.contains("pipe")));
    let short = warnings(1.0);
    assert!(
        short.iter().any(|warning| warning.contains("'pipe' is 1 m long") && warning.contains("35.0 m")),
        "{short:?}"
    );
}

/// Deep water beside a film: a rating goes by the level of most of the water, not by that of most of the ground.
#[test]
fn a_level_at_a_structure_is_a_mean_by_volume() {
    let text = "run.until_s = 1\nterrain.plane.extent = { length_m = 60, width_m = 30, cell_m = 1 }\n[flood]\nspacing_m = 1.5\n\
        water = [{ depth_m = 1.0, polygon = [[0, 0], [15, 0], [15, 30], [0, 30]] }, \
        { depth_m = 0.01, polygon = [[15, 0], [60, 0], [60, 30], [15, 30]] }]\n\
        edges = { west = \"wall\", east = \"wall\", south = \"wall\", north = \"wall\" }\n\
        outflow = [{ name = \"drain\", polygon = [[0, 0], [60, 0], [60, 30], [0, 30]], rating = [[0.0, 0.0], [2.0, 4.0]] }]";
    let mut flood = common::voronoi(&common::scene(text));
    let column = flood.gauge_columns().iter().position(|column| column.gauge == "drain").unwrap();
    go(&mut flood, 0.02);
    let [deep, film] = [15.0 * 1.0, 45.0 * 0.01];
    let level = (deep * 1.0 + film * 0.01) / (deep + film);
    let found = flood.gauge_row()[column];
    assert!((found / (2.0 * level) - 1.0).abs() < 0.03, "{found} for a level of {level}");
}
