//! What is promised of the state at any time.

use crate::common::{advance, bits, deepest, scatter};
use corpuscle_gas::{Gas, Method, Region, Setup, Side};
use corpuscle_model::Model;

/// Boxes of every kind whose energy is conserved, in two dimensions.
fn boxes() -> Vec<(&'static str, Setup<2>, [bool; 2])> {
    let fill = |mut setup: Setup<2>, ratio: f64| {
        scatter(&mut setup, 120, 1.0 / ratio, ratio, 5);
        setup
    };
    let walls = || Setup::<2>::new([30.0, 25.0]);
    vec![
        ("fluid", Setup::fluid(300, 0.6), [true; 2]),
        ("walls", fill(walls(), 4.0), [false; 2]),
        ("radii 1 to 20", fill(walls(), 20.0), [false; 2]),
        ("radii 1 to 20, periodic", fill(walls().periodic(), 20.0), [true; 2]),
        ("falling", fill(walls().gravity([0.1, -0.5]), 4.0), [false; 2]),
        ("tube", fill(walls().side(0, 0, Side::Periodic).side(0, 1, Side::Periodic), 4.0), [true, false]),
    ]
}

#[test]
fn balls_never_overlap_and_energy_stays() {
    for (name, setup, periodic) in boxes() {
        let mut gas = setup.clone().build().unwrap();
        let energy = gas.energy();
        for frame in 1..=60 {
            advance(&mut gas, 0.37 * f64::from(frame));
            let depth = deepest(&setup, &gas, periodic);
            assert!(depth < 1e-9, "{name}, frame {frame}: {depth} deep");
            assert!(gas.deepest_overlap() < 1e-9, "{name}: {} deep", gas.deepest_overlap());
            assert!((gas.energy() / energy - 1.0).abs() < 1e-12, "{name}: {} of the energy", gas.energy() / energy);
        }
        assert!(gas.collisions() > 1000 || name != "fluid");
    }
}

#[test]
fn balls_never_overlap_in_three_dimensions() {
    let setup = Setup::<3>::fluid(200, 0.49);
    let mut gas = setup.clone().build().unwrap();
    let (energy, momentum) = (gas.energy(), gas.momentum());
    for frame in 1..=20 {
        advance(&mut gas, 0.1 * f64::from(frame));
        assert!(deepest(&setup, &gas, [true; 3]) < 1e-9);
    }
    assert!(gas.collisions() > 5000);
    assert!((gas.energy() / energy - 1.0).abs() < 1e-12);
    for axis in 0..3 {
        assert!((gas.momentum()[axis] - momentum[axis]).abs() < 1e-11);
    }
}

/// The momentum ledger says what is there, rounding errors included, and not what should be there.
#[test]
fn the_momentum_ledger_is_what_the_balls_have() {
    let mut gas = Setup::<3>::fluid(200, 0.3).build().unwrap();
    advance(&mut gas, 5.0);
    let ledger = gas.ledger();
    let balance = ledger.balances.iter().find(|balance| balance.quantity == "momentum").unwrap();
    assert_eq!(balance.now, gas.momentum().iter().sum::<f64>());
    assert!(balance.now != balance.initial && balance.relative_error().abs() < 1e-13, "{balance:?}");
}

/// The same final bits for frames far apart, close together, and none.
pub fn independent_of_frames<const D: usize>(setup: Setup<D>, end: f64) {
    let mut none = setup.clone().build().unwrap();
    advance(&mut none, end);
    for period in [0.1, 0.001] {
        let mut framed = setup.clone().build().unwrap();
        for frame in 1..(end / period) as u64 {
            advance(&mut framed, frame as f64 * period);
            if frame.is_multiple_of(50) {
                framed.frame();
                framed.gauge_row();
            }
        }
        advance(&mut framed, end);
        assert!(bits(&none) == bits(&framed), "period {period}");
        assert_eq!(none.collisions(), framed.collisions());
    }
}

/// A box with everything that there is.
fn everything() -> Setup<2> {
    let mut setup = Setup::<2>::new([30.0, 20.0]).gravity([0.0, -0.2]).restitution(0.95).measured(1.0, 0.25).seed(3);
    setup.contact_time = Some(1e-6);
    setup.sides[0] = [Side::Thermal { temperature: 1.5 }, Side::Piston { mass: 30.0, pressure: 0.3, velocity: -0.2 }];
    setup.sides[1] =
        [Side::Swinging { amplitude: 0.5, period: 2.0 }, Side::Moving { velocity: -0.1, until: Some(5.0) }];
    setup.reversed_at = Some(2.5);
    setup.follow = Some(3);
    scatter(&mut setup, 50, 0.2, 5.0, 8);
    // Clear of the wall that swings in.
    setup.balls.retain(|ball| ball.position[1] > ball.radius);
    setup
}

#[test]
fn the_state_does_not_depend_on_frames() {
    independent_of_frames(Setup::<2>::fluid(200, 0.5), 4.0);
    independent_of_frames(Setup::<3>::fluid(200, 0.3), 2.0);
    independent_of_frames(everything(), 6.0);
    independent_of_frames(everything().method(Method::List), 6.0);
    independent_of_frames(everything().method(Method::FixedStep(0.004)), 6.0);
}

pub fn saved_and_taken_back<const D: usize>(setup: Setup<D>, half: f64) {
    let mut through: Gas<D> = setup.clone().build().unwrap();
    advance(&mut through, half);
    let saved = through.save();
    let mut taken = setup.build().unwrap();
    taken.restore(&saved).unwrap();
    assert!(bits(&through) == bits(&taken));
    advance(&mut through, 2.0 * half);
    advance(&mut taken, 2.0 * half);
    assert!(bits(&through) == bits(&taken));
    assert_eq!(through.collisions(), taken.collisions());
    assert_eq!(through.path(), taken.path());
    assert_eq!(format!("{:?}", through.gauge_row()), format!("{:?}", taken.gauge_row()));
    assert!(through.save() == taken.save());
}

#[test]
fn a_saved_state_goes_on_to_the_bit() {
    saved_and_taken_back(Setup::<2>::fluid(300, 0.5).measured(0.0, 0.1), 8.0);
    saved_and_taken_back(Setup::<3>::fluid(200, 0.3), 3.0);
    for method in [Method::EventDriven, Method::List, Method::FixedStep(0.004)] {
        saved_and_taken_back(everything().method(method), 3.0);
    }
}

#[test]
fn damaged_and_foreign_states_are_refused() {
    let mut gas = Setup::<2>::fluid(50, 0.3).build().unwrap();
    let saved = gas.save();
    for cut in [0, 1, saved.len() / 2, saved.len() - 1] {
        assert!(gas.restore(&saved[..cut]).is_err());
    }
    let mut other = Setup::<2>::fluid(51, 0.3).build().unwrap();
    assert!(other.restore(&saved).is_err());
    let mut deep = Setup::<3>::fluid(50, 0.3).build().unwrap();
    assert!(deep.restore(&saved).is_err());
}

#[test]
fn turned_round_it_runs_back() {
    let mut setup = Setup::<3>::fluid(500, 0.2);
    // Three collisions a ball: 6 ends at about 4.3 in a unit of time.
    setup.reversed_at = Some(0.7);
    let mut gas = setup.build().unwrap();
    let before = gas.states();
    advance(&mut gas, 0.7);
    assert!(2 * gas.collisions() > 2 * 500);
    advance(&mut gas, 1.4);
    for ((start, v), (end, w)) in before.iter().zip(gas.states()) {
        for axis in 0..3 {
            let mut apart = start[axis] - end[axis];
            let size = (500.0 * std::f64::consts::PI / 6.0 / 0.2_f64).cbrt();
            apart -= size * (apart / size).round();
            assert!(apart.abs() < 0.5e-6 && (v[axis] + w[axis]).abs() < 1e-5, "{apart}");
        }
    }
}

/// What the balls are given when all velocities are turned round was in no balance.
#[test]
fn momentum_balances_when_all_is_turned_round() {
    for method in [Method::EventDriven, Method::List, Method::FixedStep(0.004)] {
        let mut setup = Setup::<2>::new([30.0, 25.0]).gravity([0.3, -0.2]).method(method);
        setup.reversed_at = Some(1.3);
        scatter(&mut setup, 60, 0.3, 3.0, 5);
        let mut gas = setup.build().unwrap();
        for time in [1.0, 1.6, 3.0] {
            advance(&mut gas, time);
            let balances = gas.ledger().balances;
            let momentum = balances.iter().find(|balance| balance.quantity == "momentum").unwrap();
            assert!(momentum.relative_error().abs() < 1e-9, "{method:?} {time}: {momentum:?}");
        }
    }
}

#[test]
fn states_with_measures_of_another_shape_or_balls_of_one_number_are_refused() {
    let of_regions = |regions: usize| {
        let mut setup = Setup::<2>::fluid(50, 0.3).measured(0.0, 0.1);
        let region = |number: usize| Region { name: number.to_string(), from: [1.0; 2], to: [3.0; 2] };
        setup.regions = (0..regions).map(region).collect();
        let mut gas = setup.build().unwrap();
        advance(&mut gas, 1.0);
        gas
    };
    let saved = of_regions(1).save();
    assert!(of_regions(1).restore(&saved).is_ok());
    assert!(of_regions(2).restore(&saved).is_err());
    // Whichever byte is changed, the state is refused or can be shown.
    for at in (0..saved.len()).step_by(7) {
        let mut damaged = saved.clone();
        damaged[at] ^= 0x41;
        let mut gas = of_regions(1);
        if gas.restore(&damaged).is_ok() {
            gas.frame();
            gas.gauge_row();
            gas.save();
        }
    }
}

#[test]
fn fixed_steps_overlap_and_miss_where_the_exact_methods_do_not() {
    let setup = || Setup::<2>::fluid(100, 0.2);
    let mut coarse = setup().method(Method::FixedStep(0.3)).build().unwrap();
    let mut fine = setup().method(Method::FixedStep(0.002)).build().unwrap();
    let mut exact = setup().build().unwrap();
    advance(&mut coarse, 12.0);
    advance(&mut fine, 12.0);
    advance(&mut exact, 12.0);
    let (overlaps, missed, depth) = coarse.faults().unwrap();
    assert!(overlaps > 100 && missed > 5 && depth > 0.1, "{overlaps} {missed} {depth}");
    let (_, few, shallow) = fine.faults().unwrap();
    assert!(few < missed && shallow < depth, "{few} {shallow}");
    assert!(exact.faults().is_none() && exact.deepest_overlap() < 1e-9);
}
