//! Boxes whose images slide.

use crate::agreement::agrees;
use crate::common::{advance, bits, scatter};
use crate::exactness::{independent_of_frames, saved_and_taken_back};
use corpuscle_gas::{Gas, LiveChange, Method, Region, Setup, Side};
use corpuscle_model::Model;
use proptest::prelude::*;

#[test]
fn a_ball_that_leaves_above_comes_in_below_displaced_and_slower() {
    for method in [Method::EventDriven, Method::List] {
        // The image above moves at 0.1 times 8.
        let setup = Setup::<2>::new([10.0, 8.0]).periodic().shear(0.1, None).method(method);
        let mut gas = setup.ball([1.0, 7.0], [0.0, 0.5], 0.5, 2.0).build().unwrap();
        // Relative to the flow it was at rest, which at height 7 is 0.3.
        assert_eq!(gas.states()[0].1, [0.1 * (7.0 - 4.0), 0.5]);
        let energy = gas.energy();
        advance(&mut gas, 3.0);
        // It left at time 2, at x = 1.6; the image above was 1.6 on.
        let (position, velocity) = gas.states()[0];
        let after = 0.3 - 0.8;
        assert!((velocity[0] - after).abs() < 1e-15 && velocity[1] == 0.5, "{velocity:?}");
        let x = (1.6 - 1.6 + after).rem_euclid(10.0);
        assert!((position[0] - x).abs() < 1e-14 && (position[1] - 0.5).abs() < 1e-14, "{position:?}");
        assert!((gas.work() - (after * after - 0.09)).abs() < 1e-15);
        assert!((gas.energy() - energy - gas.work()).abs() < 1e-15);
    }
}

/// A sheared box of random sides with random balls.
fn scene<const D: usize>(seed: u64, count: usize, ratio: f64, rate: f64) -> Setup<D> {
    let size = std::array::from_fn(|axis| 6.5 + 2.0 * ((seed >> (8 * axis)) % 7) as f64);
    let mut setup = Setup::new(size).periodic().shear(rate, None);
    scatter(&mut setup, count, 1.0 / ratio, ratio, seed);
    setup
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn plain_search_and_engine_agree_in_two_dimensions(
        seed in any::<u64>(), count in 2..14_usize, ratio in 1.0..8.0_f64, rate in 0.01..2.0_f64,
    ) {
        agrees(scene::<2>(seed, count, ratio, rate))?;
    }

    #[test]
    fn plain_search_and_engine_agree_in_three_dimensions(
        seed in any::<u64>(), count in 2..14_usize, ratio in 1.0..4.0_f64, rate in 0.01..2.0_f64,
    ) {
        agrees(scene::<3>(seed, count, ratio, rate))?;
    }
}

#[test]
fn engine_and_list_agree() {
    for rate in [0.05, 1.0] {
        same_positions(Setup::<2>::fluid(150, 0.4).shear(rate, None), 0.9);
        same_positions(Setup::<3>::fluid(150, 0.3).shear(rate, None), 0.3);
        same_positions(Setup::<3>::fluid(30, 0.02).shear(rate, None), 6.0);
    }
}

/// Engine and list are at the same positions, but for rounding and images.
fn same_positions<const D: usize>(setup: Setup<D>, time: f64) {
    let mut engine = setup.clone().build().unwrap();
    let mut list = setup.clone().method(Method::List).build().unwrap();
    advance(&mut engine, time);
    advance(&mut list, time);
    assert!(3 * engine.collisions() > engine.len() as u64, "only {} collisions", engine.collisions());
    assert_eq!(engine.collisions(), list.collisions());
    for (a, b) in engine.states().iter().zip(list.states()) {
        for axis in 0..D {
            let apart = a.0[axis] - b.0[axis];
            let apart = apart - setup_size(&engine)[axis] * (apart / setup_size(&engine)[axis]).round();
            assert!(apart.abs() < 1e-6 && (a.1[axis] - b.1[axis]).abs() < 1e-6, "{a:?} {b:?}");
        }
    }
}

fn setup_size<const D: usize>(gas: &Gas<D>) -> Vec<f64> {
    gas.container().unwrap().to[..D].to_vec()
}

/// Deepest overlap of any two balls, all pairs and images, over the smaller radius; the image above has slid this far.
fn deepest<const D: usize>(gas: &Gas<D>, slid: f64) -> f64 {
    let (states, size) = (gas.states(), setup_size(gas));
    let mut deepest = f64::NEG_INFINITY;
    let bodies: Vec<(f64, f64)> = (0..states.len()).map(|ball| gas.body(ball)).collect();
    for a in 0..states.len() {
        for b in 0..a {
            let mut apart: [f64; D] = std::array::from_fn(|axis| states[a].0[axis] - states[b].0[axis]);
            let above = (apart[1] / size[1]).round();
            apart[0] -= above * slid;
            let nearest = |axis: usize| apart[axis] - size[axis] * (apart[axis] / size[axis]).round();
            let distance = (0..D).map(|axis| nearest(axis).powi(2)).sum::<f64>().sqrt();
            let (a, b) = (bodies[a].0, bodies[b].0);
            deepest = deepest.max((a + b - distance) / a.min(b));
        }
    }
    deepest
}

#[test]
fn balls_never_overlap_in_a_million_collisions_and_every_energy_is_booked() {
    let mut sizes = Setup::<2>::new([30.0, 25.0]).periodic().shear(0.3, Some(1.0));
    scatter(&mut sizes, 120, 0.2, 5.0, 5);
    never_overlap("many sizes", sizes, 100_000);
    never_overlap("flat", Setup::<2>::fluid(200, 0.6).shear(0.5, Some(1.0)), 200_000);
    never_overlap("deep", Setup::<3>::fluid(200, 0.4).shear(0.2, Some(1.0)), 1_000_000);
    never_overlap("fast", Setup::<3>::fluid(200, 0.2).shear(4.0, Some(1.0)), 20_000);
    never_overlap("heating", Setup::<3>::fluid(200, 0.3).shear(0.3, None), 100_000);
    never_overlap("granular", Setup::<3>::fluid(200, 0.3).shear(0.5, None).restitution(0.9), 100_000);
}

fn never_overlap<const D: usize>(name: &str, setup: Setup<D>, collisions: u64) {
    let (rate, held) = (setup.shear.unwrap().rate, setup.shear.unwrap().temperature);
    let mut gas = setup.build().unwrap();
    let size = setup_size(&gas);
    let mut time = 0.0;
    while gas.collisions() < collisions {
        time += collisions as f64 / 150.0 / gas.len() as f64 * 0.13;
        advance(&mut gas, time);
        let depth = deepest(&gas, rate * size[1] * time);
        assert!(depth < 1e-9, "{name} at {time}: {depth} deep");
        assert!(gas.deepest_overlap() < 1e-9, "{name} at {time}: {} deep", gas.deepest_overlap());
    }
    let ledger = gas.ledger();
    let energy = &ledger.balances[0];
    let booked = energy.inflow + energy.outflow + energy.initial.abs();
    assert!(
        (energy.initial + energy.inflow - energy.outflow - energy.now).abs() < 1e-11 * booked,
        "{name}: {energy:?}"
    );
    let momentum = &ledger.balances[1];
    assert!(momentum.relative_error().abs() < 1e-11, "{name}: {momentum:?}");
    assert!(gas.work() > 0.0, "{name}: shear does work, not {}", gas.work());
    if held.is_some() {
        assert!((gas.temperature() - 1.0).abs() < 0.25, "{name}: temperature {}", gas.temperature());
    }
}

/// Work over volume and time is stress times rate, but for what the gas holds of it meanwhile.
#[test]
fn work_is_stress_times_rate() {
    let rate = 0.4;
    let mut gas = Setup::<3>::fluid(500, 0.3).shear(rate, Some(1.0)).measured(0.0, 0.25).build().unwrap();
    advance(&mut gas, 200.0);
    let by_stress = gas.shear_stress().mean * rate * gas.volume() * 200.0;
    assert!((gas.work() / by_stress - 1.0).abs() < 0.02, "{} and {by_stress}", gas.work());
    assert_eq!(gas.viscosity().mean, gas.shear_stress().mean / rate);
    // The flow is straight, and its middle at rest.
    let height = setup_size(&gas)[1];
    for [y, velocity] in gas.flow_profile() {
        assert!((velocity - rate * (y - 0.5 * height)).abs() < 0.15, "{velocity} at {y}");
    }
}

#[test]
fn a_saved_state_goes_on_to_the_bit_and_output_changes_nothing() {
    for method in [Method::EventDriven, Method::List] {
        let fluid = Setup::<3>::fluid(200, 0.3).shear(0.7, Some(1.5)).measured(0.0, 0.1).method(method);
        saved_and_taken_back(fluid.clone(), 3.0);
        independent_of_frames(fluid, 1.5);
        independent_of_frames(Setup::<2>::fluid(100, 0.3).shear(0.2, None).method(method), 3.0);
    }
    let mut other = Setup::<3>::fluid(200, 0.3).shear(0.6, None).build().unwrap();
    let gas = Setup::<3>::fluid(200, 0.3).shear(0.7, None).build().unwrap();
    assert!(other.restore(&gas.save()).is_err());
}

#[test]
fn balls_come_in_and_go_out_of_a_sheared_box() {
    let rate = 0.3;
    let mut gas = Setup::<2>::fluid(150, 0.4).shear(rate, Some(1.0)).build().unwrap();
    let height = setup_size(&gas)[1];
    advance(&mut gas, 3.3);
    LiveChange::AddBalls { set: 0, count: 20 }.change(&mut gas).unwrap();
    assert!(deepest(&gas, rate * height * 3.3) < 1e-9);
    advance(&mut gas, 5.0);
    LiveChange::Heat(2.0).change(&mut gas).unwrap();
    LiveChange::RemoveBalls { set: 0, count: 50 }.change(&mut gas).unwrap();
    advance(&mut gas, 9.0);
    assert!(deepest(&gas, rate * height * 9.0) < 1e-9);
    for balance in &gas.ledger().balances {
        assert!(balance.relative_error().abs() < 1e-10, "{balance:?}");
    }
    let mut again = Setup::<2>::fluid(150, 0.4).shear(rate, Some(1.0)).build().unwrap();
    again.restore(&gas.save()).unwrap();
    advance(&mut gas, 12.0);
    advance(&mut again, 12.0);
    assert_eq!(bits(&gas), bits(&again));
}

#[test]
fn what_does_not_go_with_shear_is_refused() {
    let fluid = || Setup::<2>::fluid(50, 0.3).shear(0.1, None);
    let mut reversed = fluid();
    reversed.reversed_at = Some(1.0);
    let mut regions = fluid();
    regions.regions = vec![Region { name: "a".into(), from: [0.0; 2], to: [1.0; 2] }];
    for (setup, named) in [
        (fluid().shear(0.0, None), "rate of shear"),
        (fluid().shear(f64::NAN, None), "rate of shear"),
        (fluid().shear(0.1, Some(0.0)), "temperature"),
        (fluid().side(0, 0, Side::Fixed).side(0, 1, Side::Fixed), "periodic along all"),
        (fluid().well(1.0, 1.5), "square wells"),
        (fluid().method(Method::FixedStep(0.01)), "fixed time steps"),
        (fluid().gravity([1.0, 0.0]), "gravity"),
        (reversed, "reversed"),
        (regions, "regions"),
    ] {
        let text = setup.build().expect_err("must be refused").to_string();
        assert!(text.contains(named), "{text} does not name {named}");
    }
}
