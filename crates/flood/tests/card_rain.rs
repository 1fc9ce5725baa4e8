//! Rain that a function gives falls on the graphics card as on the processor.

use corpuscle_flood::Flood;
use corpuscle_gpu::require_gpu;
use corpuscle_model::{GpuModel, Model};
use corpuscle_scene::Scene;
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A slope that is wet at its upper end.
const SLOPE: &str = r#"
run.until_s = 60
terrain.plane = { extent = { length_m = 60, width_m = 40, cell_m = 2 }, slope_east = -0.02 }
[flood]
scheme = "balanced"
spacing_m = 1.5
spacing_depth_m = 0.05
manning = 0.03
edges = { west = "wall", east = "wall", south = "wall", north = "wall" }
water = [{ depth_m = 0.05, polygon = [[0, 0], [30, 0], [30, 40], [0, 40]] }]
"#;

fn open() -> Flood {
    let mut scene = Scene::parse(SLOPE, "test", &[]).unwrap();
    scene.resolve_defaults();
    let scene = scene.flood().unwrap();
    let terrain = Terrain::open(&scene.terrain, 1, Path::new(".")).unwrap();
    Flood::new(&scene.flood, 1, Path::new("."), Arc::new(terrain)).unwrap()
}

/// Rain in a wave that goes east at 2 m/s and swells, m/s.
fn wave(x: f64, _: f64, time: f64) -> f64 {
    let phase = std::f64::consts::TAU * (x - 2.0 * time) / 60.0;
    5e-5 * (1.0 + 0.2 * time) * (1.0 + phase.sin())
}

#[test]
fn a_wave_of_rain_wets_the_ground_as_on_the_processor() {
    let Some(gpu) = require_gpu("rain by a function on the card") else { return };
    let (mut host, mut card) = (open(), open());
    // Whether the card or the rain comes first.
    card.use_gpu(gpu.clone()).unwrap();
    let mut after = open();
    for flood in [&mut host, &mut card, &mut after] {
        flood.rain(Box::new(wave));
    }
    after.use_gpu(gpu).unwrap();
    for flood in [&mut host, &mut card, &mut after] {
        flood.advance_to(18.0, &AtomicBool::new(false)).unwrap();
    }
    assert_eq!([card.backend(), after.backend()], ["gpu"; 2]);
    let water = |flood: &Flood| flood.ledger().balances[0].clone();
    let [on_host, on_card] = [&host, &card].map(water);
    // It has rained until the sixteenth step; in each place for some time hardly.
    assert!(on_host.inflow > 3.0, "{} m3", on_host.inflow);
    // Between the times that the card knows, some second apart, it takes the rate to change evenly.
    assert!((on_card.inflow / on_host.inflow - 1.0).abs() < 5e-3, "{} and {} m3", on_card.inflow, on_host.inflow);
    assert!(on_card.relative_error().abs() < 1e-6, "{on_card:?}");
    assert_eq!(water(&after).inflow, on_card.inflow);
    // It has fallen where it should: by up to 7 mm.
    let depth =
        |flood: &Flood, x: f64| (1..8).map(|row| flood.sample(x, 5.0 * f64::from(row)).depth).sum::<f64>() / 7.0;
    for x in [5.0, 15.0, 25.0, 35.0, 45.0, 55.0] {
        let [host, card] = [&host, &card].map(|flood| depth(flood, x));
        assert!((host - card).abs() < 5e-4, "{host} and {card} m at {x} m");
    }
    assert_eq!(card.particles().len(), host.particles().len());
}
