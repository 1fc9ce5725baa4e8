//! Where balls are at the start.

use crate::common::{advance, deepest};
use corpuscle_gas::{Amount, Gas, Partition, Setup, Species, Speeds, Start, theory};

fn started<const D: usize>(packing: f64, count: usize, start: Start, walls: bool) -> (Setup<D>, Gas<D>) {
    let mut setup = Setup::<D>::fluid(count, packing);
    setup.species[0].start = start;
    if walls {
        setup.sides = std::array::from_fn(|_| Default::default());
    }
    (setup.clone(), setup.build().unwrap_or_else(|error| panic!("{packing}: {error}")))
}

#[test]
fn every_packing_is_reached_without_overlap() {
    for packing in [0.01, 0.3, 0.6, 0.7, 0.8] {
        for walls in [false, true] {
            let (setup, gas) = started::<2>(packing, 200, Start::Random, walls && packing < 0.75);
            assert!(deepest(&setup, &gas, [!walls || packing >= 0.75; 2]) < 1e-12);
            assert!((gas.packing() / packing - 1.0).abs() < 1e-9);
        }
    }
    for packing in [0.01, 0.3, 0.49, 0.6] {
        let (setup, gas) = started::<3>(packing, 250, Start::Random, false);
        assert!(deepest(&setup, &gas, [true; 3]) < 1e-12);
        assert!((gas.packing() / packing - 1.0).abs() < 1e-9);
    }
}

/// Collisions over those known of equilibrium, while each ball has its first two, about.
fn first_collisions<const D: usize>(packing: f64) -> f64 {
    let count = 10_000;
    let known = theory::collision_rate::<D>(packing, 0.5, 1.0);
    let mut gas = Setup::<D>::fluid(count, packing).build().unwrap();
    advance(&mut gas, 2.0 / known);
    gas.collisions() as f64 / count as f64
}

#[test]
fn grown_fluids_are_near_equilibrium() {
    let rates = [first_collisions::<3>(0.3), first_collisions::<2>(0.6)];
    assert!(rates.iter().all(|rate| (rate - 1.0).abs() < 0.05), "{rates:?}");
}

#[test]
fn lattices_go_to_close_packing() {
    let (setup, gas) = started::<3>(0.74, 500, Start::Lattice, false);
    assert!(deepest(&setup, &gas, [true; 3]) < 1e-12);
    for packing in [0.1, 0.5, 0.7] {
        for walls in [false, true] {
            let (setup, gas) = started::<2>(packing, 400, Start::Lattice, walls);
            assert!(deepest(&setup, &gas, [!walls; 2]) < 1e-12);
        }
    }
}

#[test]
fn temperature_and_momentum_are_exact() {
    for speeds in [Speeds::Maxwell, Speeds::Equal] {
        let mut setup = Setup::<3>::fluid(101, 0.1);
        setup.species[0] = Species { temperature: 2.5, mass: 3.0, speeds, ..setup.species[0].clone() };
        let gas = setup.build().unwrap();
        assert!((gas.temperature() - 2.5).abs() < 1e-12, "{speeds:?}: {}", gas.temperature());
        assert!(gas.momentum().iter().all(|p| p.abs() < 1e-11), "{speeds:?}: {:?}", gas.momentum());
    }
}

#[test]
fn species_stay_in_their_regions_and_clear_of_obstacles() {
    let mut setup = Setup::<2>::new([40.0, 20.0]);
    setup.partition = Some(Partition { axis: 0, at: 20.0, lifted_at: None, hole: None });
    let in_part = |name: &str, from: f64, packing: f64| Species {
        region: Some([[from, 0.0], [from + 20.0, 20.0]]),
        ..Species::new(name, Amount::Packing(packing))
    };
    let setup = setup.species(in_part("red", 0.0, 0.6)).species(in_part("blue", 20.0, 0.1)).ball(
        [10.0, 10.0],
        [0.0; 2],
        4.0,
        50.0,
    );
    let gas = setup.clone().build().unwrap();
    assert_eq!(gas.sets(), ["ball", "red", "blue"]);
    assert!(deepest(&setup, &gas, [false; 2]) < 1e-12);
    let reds = (0.6 * 400.0 / (0.25 * std::f64::consts::PI)).round() as usize;
    let states = gas.states();
    assert!(states[1..=reds].iter().all(|state| state.0[0] <= 19.5));
    assert!(states[reds + 1..].iter().all(|state| state.0[0] >= 20.5));
}

#[test]
fn the_seed_and_nothing_else_decides() {
    let start = |seed| Setup::<2>::fluid(100, 0.5).seed(seed).build().unwrap().states();
    assert!(start(1) == start(1));
    assert!(start(1) != start(2));
}
