//! What a hand changes while a gas runs.

use crate::common::{advance, bits, deepest, scatter};
use corpuscle_gas::{ByHand, Method, Partition, Setup, Side};
use corpuscle_model::Model;

fn change<const D: usize>(gas: &mut corpuscle_gas::Gas<D>, change: ByHand) {
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
        change(&mut gas, ByHand::Heat(2.5));
        assert!((gas.energy() / energy - 2.5).abs() < 1e-12, "{}", gas.energy() / energy);
        // Where balls are does not change at once.
        assert_eq!(gas.time(), 3.3);
        for frame in 1..=30 {
            advance(&mut gas, 3.3 + 0.21 * f64::from(frame));
            assert!(deepest(&setup, &gas, [false; 2]) < 1e-9);
        }
        assert!(gas.collisions() > before + 100);
        change(&mut gas, ByHand::Heat(0.1));
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
    change(&mut gas, ByHand::Heat(1.7));
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
    assert!(gas.states().iter().all(|(place, _)| place[0] < 20.0));
    change(&mut gas, ByHand::LiftPartition);
    assert!(ByHand::LiftPartition.change(&mut gas).is_err());
    advance(&mut gas, 60.0);
    assert!(gas.states().iter().filter(|(place, _)| place[0] > 20.0).count() > 15);
}

#[test]
fn a_piston_goes_where_its_pressure_drives_it() {
    let build = || {
        let mut setup =
            Setup::<2>::new([30.0, 25.0]).side(0, 1, Side::Piston { mass: 400.0, pressure: 4.8, velocity: 0.0 });
        scatter(&mut setup, 120, 1.0, 1.0, 5);
        setup.build().unwrap()
    };
    let place = |pressure: Option<f64>| {
        let mut gas = build();
        advance(&mut gas, 1.0);
        if let Some(pressure) = pressure {
            change(&mut gas, ByHand::PistonPressure { wall: [0, 1], pressure });
        }
        advance(&mut gas, 3.0);
        let ledger = gas.ledger();
        assert!(ledger.balances.iter().all(|balance| balance.relative_error().abs() < 1e-9), "{ledger:?}");
        gas.wall(0, 1).unwrap()[0]
    };
    let (freed, left, pressed) = (place(Some(0.0)), place(None), place(Some(20.0)));
    assert!(freed > left + 0.1 && left > pressed + 0.1, "{freed} {left} {pressed}");
    // The same pressure again changes nothing but rounding.
    assert!((place(Some(4.8)) - left).abs() < 1e-6);
}

#[test]
fn what_is_not_there_cannot_be_changed() {
    let mut gas = walls().build().unwrap();
    let wall = [0, 1];
    let refused = [
        ByHand::Heat(0.0),
        ByHand::Heat(f64::NAN),
        ByHand::LiftPartition,
        ByHand::WallTemperature { wall, temperature: 1.0 },
        ByHand::PistonPressure { wall, pressure: 1.0 },
        ByHand::PistonPressure { wall: [7, 0], pressure: 1.0 },
    ];
    for change in refused {
        assert!(change.change(&mut gas).is_err(), "{change:?}");
    }
    assert!(ByHand::Heat(2.0).change(&mut 5_u8).is_err());
}
