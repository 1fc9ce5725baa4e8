//! Rain, and what soaks into the ground.

mod common;

use corpuscle_flood::VoronoiFlood;
use corpuscle_model::{Balance, Model};
use corpuscle_terrain::Terrain;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

fn open(text: &str) -> VoronoiFlood {
    common::voronoi(&common::scene(text))
}

fn go(flood: &mut VoronoiFlood, time: f64) {
    flood.advance_to(time, &AtomicBool::new(false)).unwrap();
}

fn water(flood: &VoronoiFlood) -> Balance {
    flood.ledger().balances[0].clone()
}

fn gauge(flood: &VoronoiFlood, quantity: &str) -> f64 {
    let column = flood.gauge_columns().iter().position(|column| column.gauge == "water" && column.quantity == quantity);
    flood.gauge_row()[column.unwrap()]
}

/// A slope of 60 m by 40 m, dry at first, under 100 mm/h.
const SLOPE: &str = r#"
run.until_s = 600
terrain.plane = { extent = { length_m = 60, width_m = 40, cell_m = 2 }, slope_east = -0.05 }

[flood]
spacing_m = 1
edges = { west = "wall", south = "wall", north = "wall" }
rain.intensity_mm_per_h = 100.0
"#;

#[test]
fn rain_brings_what_it_should_and_runs_off() {
    let mut flood = open(SLOPE);
    go(&mut flood, 600.0);
    let (water, rained) = (water(&flood), gauge(&flood, "total_rain"));
    let fallen = 0.1 / 3600.0 * 600.0 * 60.0 * 40.0;
    assert!((rained / fallen - 1.0).abs() < 1e-3, "{rained} of {fallen}");
    assert!(water.relative_error().abs() < 1e-12, "{water:?}");
    assert!(water.outflow > 0.5 * rained && flood.wet_cells().count() > 0, "{water:?}");
    // In the end as much runs off as falls.
    go(&mut flood, 900.0);
    let later = self::water(&flood);
    let (ran, fell) = (later.outflow - water.outflow, later.inflow - water.inflow);
    assert!((ran / fell - 1.0).abs() < 0.05, "{ran} of {fell}");
    assert!(later.relative_error().abs() < 1e-12, "{later:?}");
}

/// On a pool at rest the level rises by the rain, and the water stays at rest.
#[test]
fn rain_on_a_pool_raises_its_level() {
    let mut flood = open(
        r#"
        run.until_s = 60
        terrain.plane.extent = { length_m = 30, width_m = 20, cell_m = 1 }
        [flood]
                spacing_m = 1
        water = [{ depth_m = 0.5 }]
        edges = { west = "wall", east = "wall", south = "wall", north = "wall" }
        rain.intensity_mm_per_h = 3600.0
        "#,
    );
    go(&mut flood, 60.0);
    let depths: Vec<f64> = (2..28).map(|x| flood.sample(f64::from(x), 10.0).depth).collect();
    assert!(depths.iter().all(|depth| (depth - 0.56).abs() < 1e-4), "{depths:?}");
    let fastest = flood.wet_cells().map(|cell| cell.velocity[0].hypot(cell.velocity[1])).fold(0.0, f64::max);
    assert!(fastest < 1e-9, "{fastest} m/s");
    assert!(water(&flood).relative_error().abs() < 1e-12);
}

/// A hyetograph, infiltration from ponds and from the film, inflow and outflow at once.
const ALL: &str = r#"
run.until_s = 120
terrain.plane = { extent = { length_m = 60, width_m = 40, cell_m = 2 }, slope_east = -0.02 }

[flood]
spacing_m = 1
edges = { west = "wall", south = "wall", north = "wall" }
water = [{ depth_m = 0.05, polygon = [[10, 10], [30, 10], [30, 30], [10, 30]] }]
infiltration.green-ampt = { conductivity_mm_per_h = 20, suction_m = 0.1, deficit = 0.3 }
rain.intensity_mm_per_h = [[0, 0], [60, 120], [90, 20]]

[[flood.inflow]]
name = "spring"
at = [10, 20]
discharge_m3_per_s = 0.05
"#;

#[test]
fn the_ledger_holds_with_all_that_comes_and_goes() {
    let mut flood = open(ALL);
    go(&mut flood, 120.0);
    let water = water(&flood);
    assert!(gauge(&flood, "total_rain") > 3.0 && gauge(&flood, "total_infiltration") > 3.0);
    assert!(water.outflow > gauge(&flood, "total_infiltration") + 1.0, "{water:?}");
    assert!(water.relative_error().abs() < 1e-12, "{water:?}");
}

#[test]
fn the_same_bits_with_any_threads_and_after_a_restart() {
    let with = |threads| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| {
            let mut flood = open(ALL);
            go(&mut flood, 40.0);
            flood.save()
        })
    };
    let (one, three) = (with(1), with(3));
    assert!(one == three);
    let mut resumed = open(ALL);
    resumed.restore(&one).unwrap();
    let mut whole = open(ALL);
    go(&mut whole, 40.0);
    go(&mut whole, 50.0);
    go(&mut resumed, 50.0);
    assert!(whole.save() == resumed.save());
}

/// Ponds on soils of each kind lose what their laws say, and dry ground no more than it is given.
#[test]
fn ponds_soak_away_as_the_laws_say() {
    let pond = |law: &str| {
        let mut flood = open(&format!(
            "run.until_s = 900\nterrain.plane.extent = {{ length_m = 30, width_m = 20, cell_m = 2 }}\n\
             [flood]\nspacing_m = 1\nwater = [{{ depth_m = 0.2 }}]\n\
             edges = {{ west = \"wall\", east = \"wall\", south = \"wall\", north = \"wall\" }}\n\
             infiltration.{law}\n"
        ));
        go(&mut flood, 900.0);
        assert!(water(&flood).relative_error().abs() < 1e-12);
        gauge(&flood, "total_infiltration") / 600.0
    };
    let constant = pond("constant.rate_mm_per_h = 60.0");
    assert!((constant / 0.015 - 1.0).abs() < 0.01, "{constant}");
    let horton = pond("horton = { first_mm_per_h = 200, last_mm_per_h = 20, decay_per_h = 8 }");
    let exact = 0.02 * 0.25 + 0.18 / 8.0 * (1.0 - (-2.0_f64).exp());
    assert!((horton / exact - 1.0).abs() < 0.01, "{horton} {exact}");
    let green_ampt = pond("green-ampt = { conductivity_mm_per_h = 20, suction_m = 0.2, deficit = 0.3 }");
    let residual = green_ampt - 0.06 * (1.0 + green_ampt / 0.06_f64).ln() - 0.005;
    assert!(residual.abs() < 1e-4, "{green_ampt} {residual}");
    // All of it, and then no more.
    let drained = pond("constant.rate_mm_per_h = 3600.0");
    assert!((drained / 0.2 - 1.0).abs() < 0.02, "{drained}");
}

/// Rain, roughness and soil by rasters: rain falls in the west, the north is smooth and sealed, the south rough and thirsty.
#[test]
fn rasters_say_where_it_rains_and_what_the_ground_is() {
    let folder = tempfile::tempdir().unwrap();
    let header = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 48\nNODATA_value -9999\n";
    std::fs::write(folder.path().join("rain.asc"), format!("{header}2 0\n2 0\n")).unwrap();
    std::fs::write(folder.path().join("land.asc"), format!("{header}10 10\n20 20\n")).unwrap();
    let text = r#"
        run.until_s = 80
        terrain.plane = { extent = { length_m = 96, width_m = 96, cell_m = 2 }, slope_east = -0.01 }
        [flood]
                spacing_m = 2
        wet_depth_m = 0.001
        water = [{ depth_m = 0.1 }]
        edges = { west = "periodic", east = "periodic", south = "wall", north = "wall" }
        rain = { intensity_mm_per_h = 18.0, raster = "rain.asc" }
        land_use.raster = "land.asc"
        [[flood.land_use.class]]
        code = 10
        manning = 0.02
        [[flood.land_use.class]]
        code = 20
        manning = 0.1
        infiltration.constant.rate_mm_per_h = 36.0
    "#;
    let scene = common::scene(text);
    let terrain = Arc::new(Terrain::open(&scene.terrain, 1, folder.path()).unwrap());
    let mut flood = VoronoiFlood::new(&scene.flood, 1, folder.path(), Arc::clone(&terrain)).unwrap();
    go(&mut flood, 80.0);
    // 36 mm/h on half of the ground rain, and soak in on another half.
    let half = 0.01 / 1000.0 * 80.0 * 96.0 * 48.0;
    for quantity in ["total_rain", "total_infiltration"] {
        let found = gauge(&flood, quantity);
        assert!((found / half - 1.0).abs() < 0.12, "{quantity}: {found} of {half}");
    }
    let speed = |side: fn(f64) -> bool| {
        let there: Vec<f64> =
            flood.wet_cells().filter(|cell| side(cell.centroid[1])).map(|cell| cell.velocity[0]).collect();
        there.iter().sum::<f64>() / there.len() as f64
    };
    let (north, south) = (speed(|y| y > 60.0), speed(|y| y < 36.0));
    assert!(north > 3.0 * south && south > 0.1, "{north} {south}");
    let maps = flood.maps();
    let soaked = maps.iter().find(|map| map.name == "infiltration").unwrap();
    let (top, bottom) = (soaked.values[soaked.columns * 5], soaked.values[soaked.columns * 40]);
    assert!(top == 0.0 && (bottom / 8e-4 - 1.0).abs() < 0.2, "{top} {bottom}");
    // A factor below nothing is refused.
    std::fs::write(folder.path().join("rain.asc"), format!("{header}2 -1\n2 0\n")).unwrap();
    let error = VoronoiFlood::new(&scene.flood, 1, folder.path(), terrain).err().unwrap().to_string();
    assert!(error.contains("rain.asc") && error.contains("must not be negative"), "{error}");
}
