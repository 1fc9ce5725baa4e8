//! Live changes of a gas.

use crate::common::{advance, bits, deepest, scatter};
use corpuscle_gas::{LiveChange, Method, Partition, Setup, Side};
use corpuscle_model::Model;

fn change<const D: usize>(gas: &mut corpuscle_gas::Gas<D>, change: LiveChange) {
    change.change(gas).unwrap();
}

fn walls() -> Setup<2> {
    let mut setup = Setup::<2>::new([30.0, 25.0]);
    scatter(&mut setup, 120, 0.25, 4.0, 5);
    setup
}

#[test]
fn a_gas_that_is_heated_has_so_much_more_energy_and_its_ledger_says_so() {
    for method in [Method::EventDriven, Method::List] {
        let setup = Setup { method, ..walls() };
        let mut gas = setup.clone().build().unwrap();
        advance(&mut gas, 3.3);
        let (energy, before) = (gas.energy(), gas.collisions());
        change(&mut gas, LiveChange::Heat(2.5));
        assert!((gas.energy() / energy - 2.5).abs() < 1e-12, "{}", gas.energy() / energy);
        // Where balls are does not change at once.
        assert_eq!(gas.time(), 3.3);
        for frame in 1..=30 {
            advance(&mut gas, 3.3 + 0.21 * f64::from(frame));
            assert!(deepest(&setup, &gas, [false; 2]) < 1e-9);
        }
        assert!(gas.collisions() > before + 100);
        change(&mut gas, LiveChange::Heat(0.1));
        advance(&mut gas, 12.0);
        assert!((gas.energy() / energy - 0.25).abs() < 1e-12);
        let ledger = gas.ledger();
        assert!(ledger.balances[0].inflow > 1.4 * energy && ledger.balances[0].outflow > 2.2 * energy);
        for balance in &ledger.balances {
            assert!(balance.relative_error().abs() < 1e-10, "{}: {}", balance.quantity, balance.relative_error());
        }
    }
}

#[test]
fn a_gas_that_was_heated_goes_on_from_its_checkpoint_to_the_same_bits() {
    let mut gas = walls().build().unwrap();
    advance(&mut gas, 2.0);
    change(&mut gas, LiveChange::Heat(1.7));
    let state = gas.save();
    let mut again = walls().build().unwrap();
    again.restore(&state).unwrap();
    advance(&mut gas, 6.0);
    advance(&mut again, 6.0);
    assert_eq!(bits(&gas), bits(&again));
    assert_eq!(gas.ledger(), again.ledger());
}

#[test]
fn balls_cross_a_partition_once_it_is_lifted() {
    let mut setup = Setup::<2>::new([40.0, 20.0]);
    setup.partition = Some(Partition { axis: 0, at: 20.0, lifted_at: None, hole: None });
    for ball in 0..64 {
        let (column, row) = (f64::from(ball % 8), f64::from(ball / 8));
        let velocity = [(0.7 * row + column).sin(), (1.3 * column - row).cos()];
        setup = setup.ball([1.5 + 2.2 * column, 1.5 + 2.2 * row], velocity, 0.4, 1.0);
    }
    let mut gas = setup.build().unwrap();
    advance(&mut gas, 10.0);
    assert!(gas.states().iter().all(|(position, _)| position[0] < 20.0));
    change(&mut gas, LiveChange::LiftPartition);
    assert!(LiveChange::LiftPartition.change(&mut gas).is_err());
    advance(&mut gas, 60.0);
    assert!(gas.states().iter().filter(|(position, _)| position[0] > 20.0).count() > 15);
}

#[test]
fn a_piston_goes_where_its_pressure_drives_it() {
    let build = || {
        let mut setup =
            Setup::<2>::new([30.0, 25.0]).side(0, 1, Side::Piston { mass: 400.0, pressure: 4.8, velocity: 0.0 });
        scatter(&mut setup, 120, 1.0, 1.0, 5);
        setup.build().unwrap()
    };
    let position = |pressure: Option<f64>| {
        let mut gas = build();
        advance(&mut gas, 1.0);
        if let Some(pressure) = pressure {
            change(&mut gas, LiveChange::PistonPressure { wall: [0, 1], pressure });
        }
        advance(&mut gas, 3.0);
        let ledger = gas.ledger();
        assert!(ledger.balances.iter().all(|balance| balance.relative_error().abs() < 1e-9), "{ledger:?}");
        gas.wall(0, 1).unwrap()[0]
    };
    let (freed, left, pressed) = (position(Some(0.0)), position(None), position(Some(20.0)));
    assert!(freed > left + 0.1 && left > pressed + 0.1, "{freed} {left} {pressed}");
    // The same pressure again changes nothing but rounding.
    assert!((position(Some(4.8)) - left).abs() < 1e-6);
}

#[test]
fn what_is_not_there_cannot_be_changed() {
    let mut gas = walls().build().unwrap();
    let wall = [0, 1];
    let refused = [
        LiveChange::Heat(0.0),
        LiveChange::Heat(f64::NAN),
        LiveChange::LiftPartition,
        LiveChange::WallTemperature { wall, temperature: 1.0 },
        LiveChange::PistonPressure { wall, pressure: 1.0 },
        LiveChange::PistonPressure { wall: [7, 0], pressure: 1.0 },
    ];
    for change in refused {
        assert!(change.change(&mut gas).is_err(), "{change:?}");
    }
    assert!(LiveChange::Heat(2.0).change(&mut 5_u8).is_err());
}

fn balanced<const D: usize>(gas: &corpuscle_gas::Gas<D>) {
    for balance in &gas.ledger().balances {
        assert!(balance.relative_error().abs() < 1e-9, "{balance:?}: {}", balance.relative_error());
    }
}

/// Goes on in frames; in none of them do balls overlap.
fn without_overlap(setup: &Setup<2>, gas: &mut corpuscle_gas::Gas<2>, time: f64) {
    let from = gas.time();
    for frame in 1..=20 {
        advance(gas, from + (time - from) * f64::from(frame) / 20.0);
        assert!(deepest(setup, gas, [false; 2]) < 1e-9);
    }
    balanced(gas);
}

#[test]
fn balls_that_are_put_in_fit_and_those_taken_out_are_gone() {
    for (method, gravity) in [(Method::EventDriven, 0.0), (Method::List, 0.0), (Method::EventDriven, -0.5)] {
        let setup = Setup { method, gravity: [0.0, gravity], ..walls() };
        let mut gas = setup.clone().build().unwrap();
        advance(&mut gas, 2.2);
        let (energy, temperature) = (gas.energy(), gas.temperature());
        change(&mut gas, LiveChange::AddBalls { set: 0, count: 200 });
        assert_eq!(gas.len(), 320);
        assert!((gas.temperature() / temperature - 1.0).abs() < 0.2, "{}", gas.temperature() / temperature);
        let balls = gas.ledger().balances[2].clone();
        assert_eq!([balls.initial, balls.inflow, balls.now], [120.0, 200.0, 320.0]);
        assert!(gas.ledger().balances[0].inflow > 0.5 * energy);
        without_overlap(&setup, &mut gas, 6.0);
        change(&mut gas, LiveChange::RemoveBalls { set: 0, count: 300 });
        assert_eq!(gas.len(), 20);
        let frame = gas.frame();
        assert_eq!(frame.sets[0].id, (0..20).collect::<Vec<u64>>());
        without_overlap(&setup, &mut gas, 12.0);
        // What is full is full, and one ball stays.
        assert!(LiveChange::AddBalls { set: 0, count: 100_000 }.change(&mut gas).is_err());
        assert!(LiveChange::RemoveBalls { set: 0, count: 20 }.change(&mut gas).is_err());
        assert!(LiveChange::AddBalls { set: 7, count: 1 }.change(&mut gas).is_err());
        assert_eq!(gas.len(), 20);
        // It goes on from its checkpoint, and back to before.
        let state = gas.save();
        let mut again = setup.clone().build().unwrap();
        let start = again.save();
        again.restore(&state).unwrap();
        advance(&mut gas, 15.0);
        advance(&mut again, 15.0);
        assert_eq!(bits(&gas), bits(&again));
        again.restore(&start).unwrap();
        assert_eq!(again.len(), 120);
    }
}

#[test]
fn a_temperature_that_is_held_is_held() {
    let hot = Side::Thermal { temperature: 9.0 };
    let setup = Setup { method: Method::EventDriven, ..walls() }.side(0, 0, hot);
    let mut gas = setup.clone().build().unwrap();
    advance(&mut gas, 1.0);
    change(&mut gas, LiveChange::HoldTemperature(Some(2.0)));
    for frame in 1..=40 {
        advance(&mut gas, 1.0 + 0.25 * f64::from(frame));
        assert!((gas.temperature() / 2.0 - 1.0).abs() < 0.1, "{}", gas.temperature());
    }
    balanced(&gas);
    let mut again = setup.clone().build().unwrap();
    again.restore(&gas.save()).unwrap();
    advance(&mut gas, 13.0);
    advance(&mut again, 13.0);
    assert_eq!(bits(&gas), bits(&again));
    change(&mut gas, LiveChange::HoldTemperature(None));
    // The hot wall is alone now: by and by the gas has its temperature, about which that of 120 balls scatters by a tenth.
    advance(&mut gas, 600.0);
    assert!((gas.temperature() / 9.0 - 1.0).abs() < 0.4, "{}", gas.temperature());
    balanced(&gas);
}

#[test]
fn a_piston_is_dragged_held_and_let_go() {
    let wall = [0, 1];
    let mut setup =
        Setup::<2>::new([30.0, 25.0]).side(0, 1, Side::Piston { mass: 400.0, pressure: 4.8, velocity: 0.0 });
    scatter(&mut setup, 120, 1.0, 1.0, 5);
    let mut gas = setup.clone().build().unwrap();
    advance(&mut gas, 1.0);
    let energy = gas.energy();
    change(&mut gas, LiveChange::DragPiston { wall, to: 26.0 });
    // On the way it can be pressed otherwise, for when it is let go.
    advance(&mut gas, 4.0);
    change(&mut gas, LiveChange::PistonPressure { wall, pressure: 0.0 });
    let state = gas.save();
    advance(&mut gas, 40.0);
    assert!((gas.wall(0, 1).unwrap()[0] - 26.0).abs() < 1e-9 && gas.wall(0, 1).unwrap()[1] == 0.0);
    // Slow compression of a gas in the plane: T V is kept, V without what the balls take.
    assert!(gas.energy() > 30.0 / 26.0 * energy, "{}", gas.energy() / energy);
    balanced(&gas);
    let mut again = setup.build().unwrap();
    again.restore(&state).unwrap();
    advance(&mut again, 40.0);
    assert_eq!(bits(&gas), bits(&again));
    advance(&mut gas, 50.0);
    assert!((gas.wall(0, 1).unwrap()[0] - 26.0).abs() < 1e-9);
    change(&mut gas, LiveChange::LetPistonGo { wall });
    advance(&mut gas, 60.0);
    assert!(gas.wall(0, 1).unwrap()[0] > 27.0);
    balanced(&gas);
    let refused = [
        LiveChange::LetPistonGo { wall },
        LiveChange::DragPiston { wall, to: 5.0 },
        LiveChange::DragPiston { wall, to: f64::NAN },
        LiveChange::DragPiston { wall: [1, 1], to: 26.0 },
        LiveChange::HoldTemperature(Some(0.0)),
    ];
    for change in refused {
        assert!(change.change(&mut gas).is_err(), "{change:?}");
    }
}
