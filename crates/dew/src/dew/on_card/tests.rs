//! Room on the card, and its loss.

use super::*;
use crate::air::Properties;
use crate::dew::Setup;
use crate::room::{Inflow, Room};
use crate::settings::Settings;
use corpuscle_gpu::require_gpu;
use corpuscle_model::Model;
use corpuscle_scene::{Scene, builtin};
use std::path::Path;

const WARM: f64 = 300.0;

fn duct() -> Dew {
    let inlet = Face::Inlet(Inflow { velocity: [0.097, 0.0, 0.0], temperature: WARM + 1.0, vapour: 0.01 });
    let faces = [[inlet, Face::Outlet], [Face::Wall; 2], [Face::Periodic; 2]];
    let room = Room { low: [0.0; 3], high: [0.02, 0.012, 0.01], faces };
    let (settings, air) = (Settings::new(0.002, WARM, 0.01), Properties::at_room_temperature(0.5));
    let setup = Setup { settings, air, room, bodies: Vec::new(), fans: Vec::new(), seed: 1 };
    Dew::new(&setup, |_| [WARM, 0.01]).unwrap()
}

#[test]
fn more_room_is_taken_where_air_that_comes_might_find_none() {
    let Some(gpu) = require_gpu("room on the card") else { return };
    let mut cards = [(); 2].map(|()| duct());
    let come = cards[0].most_in_a_step();
    let scarce = cards[0].state.air.len() + come - 1;
    cards[0].open_card_with(gpu.clone(), scarce).unwrap();
    cards[1].use_card(gpu).unwrap();
    for dew in &mut cards {
        dew.advance_to(0.05, &AtomicBool::new(false)).unwrap();
    }
    let [with_more, plain] = &cards;
    assert!(come > 0 && with_more.card.as_ref().unwrap().filling()[1] > scarce);
    assert!(with_more.state.next_id > with_more.state.air.len() as u64, "some have come");
    assert!(with_more.state.air == plain.state.air && with_more.state.water == plain.state.water);
}

/// Sent anew amid a run, numbers are rounded anew.
#[test]
fn more_room_is_taken_amid_a_run() {
    let Some(gpu) = require_gpu("more room on the card") else { return };
    let mut cards = [(); 2].map(|()| duct());
    let scarce = cards[0].state.air.len() + cards[0].most_in_a_step();
    cards[0].open_card_with(gpu.clone(), scarce).unwrap();
    cards[1].use_card(gpu).unwrap();
    for dew in &mut cards {
        dew.advance_to(0.1, &AtomicBool::new(false)).unwrap();
        dew.state.air.sort_unstable_by_key(|particle| particle.id);
    }
    let [with_more, plain] = &cards;
    assert!(with_more.card.as_ref().unwrap().filling()[1] > scarce);
    assert!(with_more.state.steps == plain.state.steps && with_more.state.next_id == plain.state.next_id);
    assert_eq!(with_more.state.air.len(), plain.state.air.len());
    for (a, b) in with_more.state.air.iter().zip(&plain.state.air) {
        let apart = (0..3).map(|axis| (a.position[axis] - b.position[axis]).abs()).fold(0.0, f64::max);
        assert!(a.id == b.id && a.role == b.role && apart < 1e-4 * 0.002, "{apart} m");
    }
    let balances = with_more.ledger().balances;
    assert!(balances.iter().all(|balance| balance.relative_error().abs() < 1e-7));
}

/// Batches of steps, and drops, have come back by then.
#[test]
fn a_card_lost_amid_a_run_leaves_the_state_of_before() {
    let Some(gpu) = require_gpu("a card that is lost") else { return };
    let mut scene = Scene::parse(builtin("dew/pane").unwrap().text, "dew/pane", &[]).unwrap();
    scene.resolve_defaults();
    let open = || crate::open(scene.dew().unwrap(), 1, Path::new("")).unwrap();
    let stop = AtomicBool::new(false);
    let mut dew = open();
    dew.use_card(gpu).unwrap();
    dew.advance_to(0.05, &stop).unwrap();
    let saved = dew.save();
    dew.card.as_mut().unwrap().lost_after = Some(3);
    let error = dew.advance_to(0.15, &stop).unwrap_err();
    assert!(matches!(error, ModelError::Device(_)), "{error}");
    assert_eq!(dew.card.take().unwrap().lost_after, Some(0));
    assert!(dew.save() == saved && dew.time() == 0.05);
    // The run goes on where there is no card.
    let mut other = open();
    other.restore(&saved).unwrap();
    for dew in [&mut dew, &mut other] {
        dew.advance_to(0.06, &stop).unwrap();
    }
    assert!(dew.save() == other.save());
}
