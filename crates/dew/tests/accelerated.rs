//! Accelerated time: solids change faster, the air does not, and nothing is lost.

mod common;

use common::{D, GLASS, WARM, advance, through_flow, vapour};
use corpuscle_dew::solids::Body;
use corpuscle_dew::{Condensation, Dew, Face, Setup};
use corpuscle_model::Model;
use corpuscle_solids::{Pose, Shape, Solid};

const CLOSED: [[Face; 2]; 3] = [[Face::Wall; 2], [Face::Periodic; 2], [Face::Wall; 2]];

/// Air round a ball of glass, where solids change faster than in reality.
fn ball(faces: [[Face; 2]; 3], held: bool, time_factor: f64) -> Setup {
    let mut setup = common::ball(faces, held, 1.0);
    setup.settings.time_factor = time_factor;
    setup
}

fn run(setup: &Setup, time: f64) -> Dew {
    let mut dew = Dew::new(setup, |_| [WARM, vapour(WARM, 0.8)]).unwrap();
    advance(&mut dew, time);
    dew
}

/// Mean temperature of the ball, K, and the water on it, kg.
fn of_ball(dew: &Dew) -> [f64; 2] {
    [dew.temperatures().iter().sum::<f64>() / dew.temperatures().len() as f64, dew.water_on_body(0)]
}

#[test]
fn water_and_energy_balance_with_any_factor() {
    for condensation in [Condensation::Diffusion, Condensation::Particle] {
        for faces in [CLOSED, through_flow(0.1, 0.8)] {
            for held in [false, true] {
                let mut setup = ball(faces, held, 25.0);
                setup.settings.condensation = condensation;
                let dew = run(&setup, 0.4);
                assert!(dew.water_on_body(0) > 0.0, "nothing condensed");
                for balance in dew.ledger().balances {
                    let error = balance.relative_error().abs();
                    assert!(error < 1e-10, "{condensation:?}, held {held}: {balance:?}: {error:e}");
                }
            }
        }
    }
}

/// Where fresh air comes in, a ball warms and gathers water as much as with the factor 1 in so many times the time, beside how much warmer and moister
/// than its surface the air is.
#[test]
#[ignore = "takes a minute; cargo test --release --workspace --test accelerated -- --ignored"]
fn solids_go_through_the_same_in_less_time() {
    let found = [1.0, 2.0, 8.0].map(|factor| {
        let mut dew = run(&ball(through_flow(0.1, 0.8), false, factor), 3.0);
        let before = of_ball(&dew);
        advance(&mut dew, 3.0 + 3.0 / factor);
        let after = of_ball(&dew);
        let between = 0.5 * (before[0] + after[0]);
        let driven_by = [WARM - between, vapour(WARM, 0.8) - vapour(between, 1.0)];
        [0, 1].map(|k| (after[k] - before[k]) / driven_by[k])
    });
    assert!(found[0].iter().all(|rate| *rate > 0.0), "{found:?}");
    for other in &found[1..] {
        for (quick, true_time) in other.iter().zip(found[0]) {
            assert!((quick / true_time - 1.0).abs() < 0.03, "{found:?}");
        }
    }
}

/// In a closed room the ball and the air come to the same end, whatever the factor: nothing is left of what was not conserved.
#[test]
#[ignore = "takes a minute; cargo test --release --workspace --test accelerated -- --ignored"]
fn a_closed_room_ends_at_the_same_state() {
    let mut ends = [1.0, 4.0].map(|factor| {
        let mut setup = ball(CLOSED, false, factor);
        // Light, so that it comes to an end soon; that it conducts little keeps time steps long.
        setup.bodies[0].material.heat_capacity /= 500.0;
        setup.bodies[0].material.conductivity /= 50.0;
        let dew = run(&setup, 12.0 / factor.sqrt());
        let air = dew.air().iter().map(|particle| particle.temperature).sum::<f64>() / dew.air().len() as f64;
        [of_ball(&dew)[0], air, dew.water_on_body(0)]
    });
    assert!((ends[0][0] - ends[0][1]).abs() < 0.05, "not at the end yet: {ends:?}");
    let [slow, quick] = &mut ends;
    assert!((slow[0] - quick[0]).abs() < 0.05 && (slow[1] - quick[1]).abs() < 0.05, "{slow:?} {quick:?}");
    assert!((slow[2] - quick[2]).abs() < 0.02 * slow[2].max(1e-9), "{slow:?} {quick:?}");
}

/// The air of a closed room between plates held at two temperatures passes the same heat with any factor.
#[test]
fn air_passes_the_same_heat_with_any_factor() {
    let flows = [1.0, 20.0].map(|factor| {
        let mut setup = ball(CLOSED, true, factor);
        setup.room.faces = [[Face::Wall; 2], [Face::Periodic; 2], [Face::Periodic; 2]];
        setup.settings.gravity = [0.0; 3];
        setup.settings.condensation = Condensation::Particle;
        setup.settings.fog = false;
        let plate = |x: f64, temperature: f64| {
            let size = setup.room.high;
            let pose = Pose::new([x, 0.5 * size[1], 0.5 * size[2]], [0.0; 3]);
            let solid = Solid::of_shape(Shape::cuboid([4.0 * D, size[1], size[2]]).unwrap(), pose);
            Body::sampled(solid, D, GLASS, temperature, true).unwrap()
        };
        setup.bodies = vec![plate(0.0, WARM + 10.0), plate(setup.room.high[0], WARM - 2.0)];
        let mut dew = run(&setup, 4.0);
        let before = [0, 1].map(|plate| dew.heat_from(plate));
        let from = dew.stepped_until();
        advance(&mut dew, 5.0);
        let time = factor * (dew.stepped_until() - from);
        [0, 1].map(|plate| (dew.heat_from(plate) - before[plate]) / time)
    });
    // With the factor 1 the air as a whole still warms, so more heat goes in than out.
    let through = flows.map(|[warm, cold]| 0.5 * (warm - cold));
    assert!((through[1] / through[0] - 1.0).abs() < 0.005, "{flows:?}");
}
