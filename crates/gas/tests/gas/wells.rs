//! Balls with square wells.

use crate::agreement::{agrees, same_bits, same_positions};
use crate::common::{advance, bits, deepest, scatter};
use crate::exactness::{independent_of_frames, saved_and_taken_back};
use corpuscle_gas::{LiveChange, Method, Setup, Side};
use corpuscle_model::Model;
use proptest::prelude::*;

/// Two balls of masses 1 and 3 and contact distance 1 that fly at each other at a relative speed of 2.
fn two(depth: f64) -> Setup<2> {
    let setup = Setup::<2>::new([40.0, 10.0]).well(depth, 1.5);
    setup.ball([15.0, 5.0], [1.5, 0.0], 0.5, 1.0).ball([20.0, 5.0], [-0.5, 0.0], 0.5, 3.0)
}

/// Relative velocity along x.
fn apart(gas: &corpuscle_gas::Gas<2>) -> f64 {
    gas.states()[1].1[0] - gas.states()[0].1[0]
}

#[test]
fn a_pair_speeds_up_in_its_well_and_leaves_as_it_came() {
    for method in [Method::EventDriven, Method::List] {
        let mut gas = two(0.7).method(method).build().unwrap();
        // The rim, 1.5 apart, after 1.75; the reduced mass is 3/4.
        advance(&mut gas, 1.7);
        assert_eq!((apart(&gas), gas.pairs_in_wells()), (-2.0, 0));
        advance(&mut gas, 1.8);
        let inside = (4.0_f64 + 2.0 * 0.7 / 0.75).sqrt();
        assert!((apart(&gas) + inside).abs() < 1e-14 && gas.pairs_in_wells() == 1);
        assert!((gas.potential_energy() + 0.7).abs() < 1e-15);
        // Half a length on they touch.
        advance(&mut gas, 1.76 + 0.5 / inside);
        assert!((apart(&gas) - inside).abs() < 1e-14 && gas.collisions() == 1);
        advance(&mut gas, 1.76 + 1.0 / inside);
        assert!((apart(&gas) - 2.0).abs() < 1e-14 && gas.rim_events() == [1, 1, 0]);
        assert!(gas.momentum()[0].abs() < 1e-15);
    }
}

#[test]
fn a_pair_that_is_too_slow_stays_in_its_well_or_outside_its_step() {
    let setup = Setup::<2>::new([40.0, 10.0]).well(1.0, 1.5);
    // Energy along the line of centres 1/4 of 1: less than the depth.
    let setup = setup.ball([15.0, 5.0], [-0.5, 0.1], 0.5, 1.0).ball([16.2, 5.0], [0.5, 0.1], 0.5, 1.0);
    let mut gas = setup.build().unwrap();
    assert_eq!(gas.pairs_in_wells(), 1);
    advance(&mut gas, 10.0);
    assert_eq!(gas.pairs_in_wells(), 1);
    let [captures, escapes, returns] = gas.rim_events();
    // In and out of half a length at a speed of 1.
    assert_eq!((captures, escapes, gas.collisions()), (0, 0, 10));
    assert_eq!(returns, 10);
    // A step of more energy than the pair has turns it back at once.
    let mut gas = two(-1.6).build().unwrap();
    advance(&mut gas, 2.0);
    assert!((apart(&gas) - 2.0).abs() < 1e-14 && gas.collisions() == 0 && gas.rim_events() == [0, 0, 1]);
    let mut gas = two(-1.4).build().unwrap();
    advance(&mut gas, 1.8);
    assert!((apart(&gas) + (4.0_f64 - 2.0 * 1.4 / 0.75).sqrt()).abs() < 1e-14 && gas.pairs_in_wells() == 1);
}

/// A box of random sides with random balls, and where it repeats.
fn scene<const D: usize>(seed: u64, count: usize, ratio: f64, periodic: [bool; D], depth: f64) -> Setup<D> {
    let size = std::array::from_fn(|axis| 6.5 + 2.0 * ((seed >> (8 * axis)) % 3) as f64);
    let mut setup = Setup::new(size).well(depth, 1.1 + 0.1 * (seed % 10) as f64);
    for axis in (0..D).filter(|&axis| periodic[axis]) {
        setup = setup.side(axis, 0, Side::Periodic).side(axis, 1, Side::Periodic);
    }
    if seed.is_multiple_of(5) && !periodic[0] {
        setup = setup.side(0, 1, Side::Moving { velocity: -0.2, until: None });
    }
    scatter(&mut setup, count, 0.5 / ratio, ratio, seed);
    setup
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn plain_search_and_engine_agree_in_two_dimensions(
        seed in any::<u64>(), count in 2..14_usize, ratio in 1.0..5.0_f64, x: bool, y: bool, depth in -1.5..1.5_f64,
    ) {
        agrees(scene::<2>(seed, count, ratio, [x, y], depth))?;
    }

    #[test]
    fn plain_search_and_engine_agree_in_three_dimensions(
        seed in any::<u64>(), count in 2..14_usize, ratio in 1.0..3.0_f64, x: bool, y: bool, z: bool, depth in -1.5..1.5_f64,
    ) {
        agrees(scene::<3>(seed, count, ratio, [x, y, z], depth))?;
    }
}

#[test]
fn engine_and_list_have_the_same_bits_between_walls() {
    for gravity in [0.0, -0.3] {
        let mut flat = Setup::<2>::new([20.0, 15.0]).well(0.8, 1.6).gravity([0.0, gravity]);
        flat.sides[0][0] = Side::Thermal { temperature: 1.0 };
        flat.sides[0][1] = Side::Piston { mass: 20.0, pressure: 0.5, velocity: 0.0 };
        scatter(&mut flat, 150, 0.2, 3.0, 1);
        same_bits(flat, 4.0);
    }
    let mut deep = Setup::<3>::new([8.0, 9.0, 10.0]).well(-0.5, 1.3);
    scatter(&mut deep, 200, 0.2, 4.0, 1);
    same_bits(deep, 3.0);
}

#[test]
fn engine_and_list_agree_across_periodic_sides() {
    same_positions(Setup::<2>::fluid(150, 0.4).well(1.0, 1.5), 0.8);
    same_positions(Setup::<3>::fluid(150, 0.3).well(0.7, 1.5), 0.25);
    same_positions(Setup::<3>::fluid(40, 0.02).well(1.0, 1.8), 4.0);
}

/// Fluids with wells or steps, balls of one size or many, between walls or not.
fn fluids() -> Vec<(&'static str, Setup<2>, [bool; 2])> {
    let fill = |mut setup: Setup<2>, ratio: f64| {
        scatter(&mut setup, 120, 1.0 / ratio, ratio, 5);
        setup
    };
    let walls = || Setup::<2>::new([30.0, 25.0]);
    vec![
        ("fluid", Setup::fluid(300, 0.5).well(1.0, 1.5), [true; 2]),
        ("deep", Setup::fluid(200, 0.1).well(6.0, 1.2), [true; 2]),
        ("step", Setup::fluid(300, 0.5).well(-2.0, 1.4), [true; 2]),
        ("walls", fill(walls(), 4.0).well(0.5, 2.0), [false; 2]),
        ("radii 1 to 20", fill(walls().periodic(), 20.0).well(0.5, 1.3), [true; 2]),
        ("falling", fill(walls().gravity([0.1, -0.5]), 4.0).well(1.0, 1.5), [false; 2]),
    ]
}

#[test]
fn balls_never_overlap_and_energy_stays() {
    for (name, setup, periodic) in fluids() {
        let mut gas = setup.clone().build().unwrap();
        let energy = gas.energy();
        let scale = energy.abs().max(gas.kinetic_energy());
        for frame in 1..=60 {
            advance(&mut gas, 0.37 * f64::from(frame));
            assert!(deepest(&setup, &gas, periodic) < 1e-9, "{name}, frame {frame}");
            assert!((gas.energy() - energy).abs() < 1e-11 * scale, "{name}: {} and {energy}", gas.energy());
        }
        let [captures, escapes, returns] = gas.rim_events();
        assert!(captures > 100 && escapes > 50 && returns > 50, "{name}: {:?}", gas.rim_events());
        assert!(gas.ledger().balances[0].relative_error().abs() < 1e-11);
    }
}

/// What is in a well by the kept pairs is what is in it by distance, but for pairs at their rims.
#[test]
fn pairs_in_wells_are_those_that_are_near() {
    for (name, setup, periodic) in fluids() {
        let mut gas = setup.clone().build().unwrap();
        for time in [0.0, 3.0, 11.0] {
            advance(&mut gas, time);
            let (states, width) = (gas.states(), setup.well.unwrap().width);
            let mut near = 0;
            for a in 0..states.len() {
                for b in 0..a {
                    let square = |axis: usize| {
                        let mut x = states[a].0[axis] - states[b].0[axis];
                        if periodic[axis] {
                            x -= setup.size[axis] * (x / setup.size[axis]).round();
                        }
                        x * x
                    };
                    let apart = (0..2).map(square).sum::<f64>().sqrt();
                    near += u64::from(apart < width * (gas.body(a).0 + gas.body(b).0));
                }
            }
            assert_eq!(gas.pairs_in_wells(), near, "{name} at {time}");
        }
    }
}

#[test]
fn a_saved_state_goes_on_to_the_bit_and_output_changes_nothing() {
    let fluid = || Setup::<3>::fluid(200, 0.2).well(1.0, 1.5).measured(0.0, 0.1);
    let mut walls = Setup::<2>::new([30.0, 25.0]).well(0.9, 1.7).gravity([0.0, -0.2]);
    walls.sides[0][1] = Side::Piston { mass: 30.0, pressure: 0.1, velocity: -0.2 };
    (walls.reversed_at, walls.follow) = (Some(2.5), Some(3));
    scatter(&mut walls, 60, 0.2, 4.0, 8);
    for method in [Method::EventDriven, Method::List] {
        saved_and_taken_back(fluid().method(method), 2.0);
        saved_and_taken_back(walls.clone().method(method), 3.0);
        independent_of_frames(walls.clone().method(method), 5.0);
    }
    independent_of_frames(fluid(), 1.5);
    let mut without = Setup::<3>::fluid(200, 0.2).build().unwrap();
    assert!(without.restore(&fluid().build().unwrap().save()).is_err());
}

#[test]
fn turned_round_it_runs_back() {
    let mut setup = Setup::<3>::fluid(300, 0.1).well(1.0, 1.5);
    setup.reversed_at = Some(0.8);
    let mut gas = setup.build().unwrap();
    let (before, pairs) = (gas.states(), gas.pairs_in_wells());
    advance(&mut gas, 0.8);
    assert!(gas.rim_events().iter().sum::<u64>() > 300);
    advance(&mut gas, 1.6);
    assert_eq!(gas.pairs_in_wells(), pairs);
    for ((_, v), (_, w)) in before.iter().zip(gas.states()) {
        assert!((0..3).all(|axis| (v[axis] + w[axis]).abs() < 1e-6));
    }
}

#[test]
fn balls_with_wells_come_in_and_go_out_and_the_ledger_says_so() {
    for method in [Method::EventDriven, Method::List] {
        let setup = Setup::<2>::fluid(150, 0.4).well(1.0, 1.5).method(method);
        let mut gas = setup.clone().build().unwrap();
        advance(&mut gas, 2.0);
        let pairs = gas.pairs_in_wells();
        LiveChange::AddBalls { set: 0, count: 20 }.change(&mut gas).unwrap();
        assert!(gas.pairs_in_wells() > pairs + 10);
        advance(&mut gas, 4.0);
        LiveChange::Heat(2.0).change(&mut gas).unwrap();
        LiveChange::RemoveBalls { set: 0, count: 90 }.change(&mut gas).unwrap();
        advance(&mut gas, 6.0);
        assert!(deepest(&setup, &gas, [true; 2]) < 1e-9 && gas.len() == 80);
        assert!(gas.ledger().balances[0].relative_error().abs() < 1e-11, "{:?}", gas.ledger());
        let mut again = setup.build().unwrap();
        again.restore(&gas.save()).unwrap();
        advance(&mut gas, 9.0);
        advance(&mut again, 9.0);
        assert_eq!(bits(&gas), bits(&again));
        assert_eq!(gas.rim_events(), again.rim_events());
    }
}

#[test]
fn what_does_not_go_with_wells_is_refused() {
    let fluid = || Setup::<2>::fluid(50, 0.3);
    for (setup, named) in [
        (fluid().well(0.0, 1.5), "depth"),
        (fluid().well(f64::NAN, 1.5), "depth"),
        (fluid().well(1.0, 1.0), "width"),
        (fluid().well(1.0, 5.0), "with their wells"),
        (fluid().well(1.0, 1.5).restitution(0.9), "restitution"),
        (fluid().well(1.0, 1.5).method(Method::FixedStep(0.01)), "fixed time steps"),
    ] {
        let text = setup.build().expect_err("must be refused").to_string();
        assert!(text.contains(named), "{text} does not name {named}");
    }
}
