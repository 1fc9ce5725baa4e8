//! Particles that are split where the water is thin, and merged where it is deep.

use corpuscle_flood::Flood;
use corpuscle_model::Model;
use corpuscle_scene::Scene;
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

fn open(text: &str) -> Flood {
    let mut scene = Scene::parse(text, "test", &[]).unwrap();
    scene.resolve_defaults();
    let scene = scene.flood().unwrap();
    let terrain = Terrain::open(&scene.terrain, 1, Path::new(".")).unwrap();
    Flood::new(&scene.flood, 1, Path::new("."), Arc::new(terrain)).unwrap()
}

fn go(flood: &mut Flood, time: f64) {
    flood.advance_to(time, &AtomicBool::new(false)).unwrap();
}

/// Water let go at the upper end of a tilted trough runs down as a sheet and gathers at the lower end.
const TROUGH: &str = r#"
run.until_s = 150
terrain.plane = { extent = { length_m = 80, width_m = 20, cell_m = 1 }, slope_east = -0.05 }

[flood]
scheme = "balanced"
spacing_m = 1
spacing_depth_m = 0.5
refinement = {}
edges = { west = "wall", east = "wall", south = "wall", north = "wall" }
water = [{ depth_m = 0.5, polygon = [[0, 0], [16, 0], [16, 20], [0, 20]] }]
"#;

fn without_refinement(text: &str) -> String {
    text.replace("refinement = {}\n", "")
}

#[test]
fn particles_are_split_in_a_sheet_and_merged_in_a_pool() {
    let mut flood = open(TROUGH);
    let count = flood.particles().len();
    let volume: f64 = flood.particles().iter().map(|particle| particle.volume).sum();
    go(&mut flood, 40.0);
    let in_sheet = flood.particles().len();
    assert!(in_sheet > 3 * count, "{count} particles, {in_sheet} in the sheet");
    go(&mut flood, 150.0);
    let in_pool = flood.particles().len();
    assert!(in_pool < in_sheet * 3 / 4, "{count} particles, {in_sheet} in the sheet, {in_pool} in the pool");
    let ledger = flood.ledger();
    assert!(ledger.balances[0].relative_error().abs() < 1e-13, "{ledger:?}");
    let after: f64 = flood.particles().iter().map(|particle| particle.volume).sum();
    assert!((after / volume - 1.0).abs() < 1e-13);
    let mut identities: Vec<u64> = flood.particles().iter().map(|particle| particle.id).collect();
    identities.sort_unstable();
    identities.dedup();
    assert_eq!(identities.len(), in_pool);
}

/// Where a sheet runs, no particle stands for more ground than was asked for, but for those too small to be split.
#[test]
fn no_particle_stands_for_too_much_ground() {
    let widest = |text: &str| {
        let mut flood = open(text);
        go(&mut flood, 12.0);
        let area = |share: f64| {
            let mut areas: Vec<f64> = flood.particles().iter().map(corpuscle_flood::Particle::area).collect();
            areas.sort_unstable_by(f64::total_cmp);
            areas[(share * (areas.len() - 1) as f64) as usize]
        };
        area(0.98)
    };
    let (refined, plain) = (widest(TROUGH), widest(&without_refinement(TROUGH)));
    assert!(refined < 2.5 && plain > 5.0, "{refined} m2 refined, {plain} m2 without");
}

#[test]
fn a_lake_stays_as_it_is() {
    let lake = r#"
run.until_s = 20
terrain.plane = { extent = { length_m = 40, width_m = 20, cell_m = 1 }, slope_east = -0.05 }

[flood]
scheme = "balanced"
spacing_m = 1
spacing_depth_m = 0.5
refinement = {}
edges = { west = "wall", east = "wall", south = "wall", north = "wall" }
water = [{ level_m = -1.0 }]
"#;
    let (mut refined, mut plain) = (open(lake), open(&without_refinement(lake)));
    go(&mut refined, 20.0);
    go(&mut plain, 20.0);
    assert!(refined.save() == plain.save());
    let fastest = refined.particles().iter().map(corpuscle_flood::Particle::speed).fold(0.0, f64::max);
    assert!(fastest < 1e-12, "{fastest} m/s");
}

#[test]
fn the_same_bits_with_any_threads_and_after_a_restart() {
    let with = |threads| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| {
            let mut flood = open(TROUGH);
            go(&mut flood, 8.0);
            flood.save()
        })
    };
    let (one, three) = (with(1), with(3));
    assert!(one == three);
    let mut resumed = open(TROUGH);
    resumed.restore(&one).unwrap();
    let mut whole = open(TROUGH);
    go(&mut whole, 8.0);
    go(&mut whole, 14.0);
    go(&mut resumed, 14.0);
    assert!(whole.save() == resumed.save());
}
