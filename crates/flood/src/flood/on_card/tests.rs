//! Room on the card, and what it is told and keeps.

use super::*;
use corpuscle_gpu::require_gpu;
use corpuscle_model::{GpuModel, Model};
use corpuscle_scene::Scene;
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;

/// Water that runs down as a sheet, so that all of it is split, and more than once.
const SHEET: &str = r#"
run.until_s = 60
terrain.plane = { extent = { length_m = 80, width_m = 20, cell_m = 1 }, slope_east = -0.05 }
[flood]
scheme = "balanced"
spacing_m = 1
spacing_depth_m = 0.5
refinement = {}
edges = { west = "wall", east = "wall", south = "wall", north = "wall" }
water = [{ depth_m = 0.5, polygon = [[0, 0], [16, 0], [16, 20], [0, 20]] }]
"#;

/// Water between a wall, an open side and periodic ones, so that lists have neighbours in mirrors too.
const POOL: &str = r#"
run.until_s = 60
terrain.plane = { extent = { length_m = 24, width_m = 12, cell_m = 1 }, slope_east = -0.02 }
[flood]
scheme = "balanced"
spacing_m = 0.5
spacing_depth_m = 0.5
edges = { west = "wall", east = "open", south = "periodic", north = "periodic" }
water = [{ depth_m = 0.5, polygon = [[0, 0], [16, 0], [16, 12], [0, 12]] }]
"#;

const OBSTACLE: &str = r#"
[[flood.obstacle]]
name = "pier"
polygon = [[17, 4], [19, 4], [19, 7], [17, 7]]
"#;

fn opened(scene: &str) -> Flood {
    let mut scene = Scene::parse(scene, "scene", &[]).unwrap();
    scene.resolve_defaults();
    let scene = scene.flood().unwrap();
    let terrain = Terrain::open(&scene.terrain, 1, Path::new(".")).unwrap();
    Flood::new(&scene.flood, 1, Path::new("."), Arc::new(terrain)).unwrap()
}

#[test]
fn more_room_is_taken_where_halves_might_find_none() {
    let Some(gpu) = require_gpu("room on the card") else { return };
    let mut sheets = [(); 2].map(|()| opened(SHEET));
    let count = sheets[0].state.particles.len();
    let scarce = count + count / 2; // Enough until the next look at it.
    sheets[0].open_card_with(gpu.clone(), scarce).unwrap();
    sheets[1].use_gpu(gpu.clone()).unwrap();
    for sheet in &mut sheets {
        sheet.advance_to(24.0, &AtomicBool::new(false)).unwrap();
    }
    let [with_more, plain] = &sheets;
    let (now, room) = (with_more.state.particles.len(), with_more.card.as_ref().unwrap().room());
    assert!(now > scarce && room > scarce, "{count} became {now}, room for {scarce} for {room}");
    // Laid out anew in cells of another size, so summed up in another order.
    let in_plenty = plain.state.particles.len();
    assert!(now.abs_diff(in_plenty) < in_plenty / 20, "{now} and {in_plenty}");
    assert!((with_more.stored() / plain.stored() - 1.0).abs() < 1e-6);
}

/// Without any room water stays whole, and none is lost.
#[test]
fn what_finds_no_room_stays_whole() {
    let Some(gpu) = require_gpu("no room on the card") else { return };
    let (mut host, mut card) = (opened(SHEET), opened(SHEET));
    host.advance_to(8.0, &AtomicBool::new(false)).unwrap();
    while !host.state.steps.is_multiple_of(8) {
        host.step().unwrap();
    }
    let (count, volume) = (host.state.particles.len(), host.stored());
    card.restore(&host.save()).unwrap();
    card.open_card_with(gpu, count + 3).unwrap();
    let on_card = card.card.as_mut().unwrap();
    let span = Span { now: 0.0, until: 10.0, most: 64, look: 1e-6, looks: &[], looked: 0.0, births: &[], due: &[] };
    assert_eq!(on_card.advance(span, None).unwrap().0.steps, 1);
    on_card.fetch(&mut card.state.particles, &card.surroundings.terrain).unwrap();
    host.step().unwrap();
    assert!(host.state.particles.len() > count + 3, "{} became {}", count, host.state.particles.len());
    assert!(card.state.particles.len() <= count + 3, "{} became {}", count, card.state.particles.len());
    assert!((card.stored() / volume - 1.0).abs() < 1e-6);
}

#[test]
fn neighbours_for_which_lists_have_no_room_are_looked_for_again() {
    let Some(gpu) = require_gpu("lists of neighbours") else { return };
    let [all, some, none] = [u32::MAX, 12, 0].map(|most| {
        let mut pool = opened(POOL);
        pool.use_gpu(gpu.clone()).unwrap();
        pool.card.as_mut().unwrap().list(most);
        pool.advance_to(1.0, &AtomicBool::new(false)).unwrap();
        // What the clock shows depends, in its last digits, on how many steps were ordered at once.
        pool.state.particles
    });
    assert!(all == some && all == none);
}

/// Water that falls dry and comes back, an obstacle, and looks more often than steps, as often and less.
#[test]
fn maps_that_the_card_keeps_are_those_that_the_host_makes() {
    let Some(gpu) = require_gpu("maps on the card") else { return };
    let text = POOL.replace("water = ", "wet_depth_m = 0.05\nwater = ") + OBSTACLE;
    for period in [0.011, 0.1, 0.9] {
        let [by_card, by_host] = [true, false].map(|by_card| {
            let mut pool = opened(&format!("run.gauge_every_s = {period}\n{text}"));
            pool.use_gpu(gpu.clone()).unwrap();
            let card = pool.card.as_mut().unwrap();
            assert!(card.keeps_maps());
            if !by_card {
                card.forget_maps();
            }
            // Some steps first, so that what maps hold is handed over.
            for time in [1.3, 4.0] {
                pool.advance_to(time, &AtomicBool::new(false)).unwrap();
                let state = pool.save();
                pool.restore(&state).unwrap();
            }
            pool
        });
        assert!(by_card.state.particles == by_host.state.particles);
        assert_eq!(by_card.state.next_look, by_host.state.next_look);
        assert!((by_card.state.maps.last() - by_host.state.maps.last()).abs() < 1e-6);
        for (one, other) in by_card.maps().iter().zip(&by_host.maps()) {
            let pairs = || one.values.iter().zip(&other.values);
            assert!(pairs().filter(|(one, other)| one.is_nan() != other.is_nan()).count() == 0, "{}", one.name);
            let wet = pairs().filter(|(one, _)| !one.is_nan()).count();
            let off = pairs().filter(|(one, other)| (*one - *other).abs() > 2e-5).count();
            // A cell that falls dry just when it is looked at may do so for the one only.
            assert!(wet > 100 && off <= wet / 100, "{}, each {period} s: {off} of {wet} cells", one.name);
        }
    }
}

#[test]
fn a_first_step_of_no_length_is_taken_before_the_card_goes_on() {
    let Some(gpu) = require_gpu("a first step of 0 s") else { return };
    let mut pool = opened(POOL);
    pool.state.time_step = 0.0;
    pool.use_gpu(gpu).unwrap();
    assert!(pool.state.steps == 1 && pool.state.time == 0.0 && pool.state.time_step > 0.0);
    pool.advance_to(0.2, &AtomicBool::new(false)).unwrap();
    assert!(pool.state.steps > 1 && pool.ledger().balances[0].relative_error().abs() < 1e-6);
}

/// What the card has of a particle is no number: the water here stays that of before, and the error names the place.
#[test]
fn a_value_that_is_no_number_does_not_come_back() {
    let Some(gpu) = require_gpu("a value that is no number on the card") else { return };
    let values: [fn(&mut Particle) -> &mut f64; 3] = [|p| &mut p.u, |p| &mut p.volume, |p| &mut p.ax];
    for value in values {
        let mut pool = opened(POOL);
        pool.use_gpu(gpu.clone()).unwrap();
        pool.advance_to(0.2, &AtomicBool::new(false)).unwrap();
        let before = pool.state.particles.clone();
        *value(&mut pool.state.particles[100]) = f64::NAN;
        pool.send_to_card().unwrap();
        pool.state.particles = before.clone();
        let error = pool.advance_to(0.4, &AtomicBool::new(false)).unwrap_err();
        let text = error.to_string();
        assert!(matches!(error, ModelError::Breakdown { .. }) && text.contains("terrain's coordinates"), "{text}");
        assert!(text.contains("NaN") && pool.state.particles == before, "{text}");
        assert!(pool.ledger().balances.iter().all(|balance| balance.now.is_finite()), "{text}");
    }
}
