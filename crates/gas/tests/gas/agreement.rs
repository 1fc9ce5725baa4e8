//! The engine against the plainest event search, and against the published list, on small random scenes.

use crate::common::brute::Brute;
use crate::common::{advance, bits, scatter};
use corpuscle_gas::{Gas, Method, Partition, Setup, Side};
use proptest::prelude::*;

/// A box of random sides with random balls, and where it repeats.
fn scene<const D: usize>(seed: u64, count: usize, ratio: f64, periodic: [bool; D], moving: bool) -> Setup<D> {
    let size = std::array::from_fn(|axis| 6.5 + 2.0 * ((seed >> (8 * axis)) % 7) as f64);
    let mut setup = Setup::new(size);
    for axis in 0..D {
        if periodic[axis] {
            setup = setup.side(axis, 0, Side::Periodic).side(axis, 1, Side::Periodic);
        }
    }
    if moving && !periodic[0] {
        setup = setup.side(0, 1, Side::Moving { velocity: -0.2, until: None });
    }
    scatter(&mut setup, count, 1.0 / ratio, ratio, seed);
    setup
}

/// The plain search at a time, from a start with one coordinate of one ball moved by as much as told.
fn brute_at<const D: usize>(setup: &Setup<D>, coordinate: usize, moved: f64, time: f64) -> Brute<D> {
    let mut brute = Brute::new(setup);
    brute.position[coordinate / D][coordinate % D] += moved;
    while !brute.step(time) {}
    brute
}

/// Largest difference of any two positions.
fn apart<const D: usize>(setup: &Setup<D>, periodic: [bool; D], a: &[[f64; D]], b: &[[f64; D]]) -> f64 {
    let differences = a.iter().zip(b).flat_map(|(a, b)| {
        (0..D).map(move |axis| {
            let apart = a[axis] - b[axis];
            let images = if periodic[axis] { (apart / setup.size[axis]).round() } else { 0.0 };
            (apart - images * setup.size[axis]).abs()
        })
    });
    differences.fold(0.0, f64::max)
}

/// The engine's state, where the plain search has had about one collision for every two balls, is the plain one's: as nearly
/// as rounding errors allow, which grow with every collision as a start moved a little does. Each coordinate of each ball is moved by
/// itself: errors in any direction are sums of these, and their largest growth is what counts.
pub fn agrees<const D: usize>(setup: Setup<D>) -> Result<(), TestCaseError> {
    let mut brute = Brute::new(&setup);
    let collisions = setup.balls.len().div_ceil(2) as u64;
    for _ in 0..20 + 2 * setup.balls.len() {
        brute.step(f64::INFINITY);
        if brute.collisions >= collisions || brute.walls[0][1][0] < 0.6 * setup.size[0] {
            break;
        }
    }
    // Between events.
    let time = brute.time + 1e-6;
    let brute = brute_at(&setup, 0, 0.0, time);
    let periodic = brute.periodic;
    let moved = |coordinate| brute_at(&setup, coordinate, 1e-13, time).position;
    let growth = (0..D * setup.balls.len()).map(|at| apart(&setup, periodic, &brute.position, &moved(at)));
    let bound = 1e-10 + 10.0 * growth.fold(0.0, f64::max);
    prop_assume!(bound < 1e-3);
    for method in [Method::EventDriven, Method::List] {
        let mut gas = setup.clone().method(method).build().unwrap();
        advance(&mut gas, time);
        prop_assert_eq!(gas.collisions(), brute.collisions, "{:?}", method);
        prop_assert_eq!(gas.pairs_in_wells(), brute.bound.len() as u64, "{:?}", method);
        let positions: Vec<[f64; D]> = gas.states().into_iter().map(|(position, _)| position).collect();
        let error = apart(&setup, periodic, &positions, &brute.position);
        prop_assert!(error < bound, "{:?}: {} off, not {}", method, error, bound);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn plain_search_and_engine_agree_in_two_dimensions(
        seed in any::<u64>(), count in 2..14_usize, ratio in 1.0..20.0_f64, x: bool, y: bool, moving: bool,
    ) {
        agrees(scene::<2>(seed, count, ratio, [x, y], moving))?;
    }

    #[test]
    fn plain_search_and_engine_agree_in_three_dimensions(
        seed in any::<u64>(), count in 2..14_usize, ratio in 1.0..5.0_f64, x: bool, y: bool, z: bool, moving: bool,
    ) {
        agrees(scene::<3>(seed, count, ratio, [x, y, z], moving))?;
    }
}

/// Engine and list have the same bits after many collisions, within their first windows.
pub fn same_bits<const D: usize>(setup: Setup<D>, time: f64) {
    let (engine, list) = both(setup, time);
    assert!(engine.collisions() > engine.len() as u64, "only {} collisions", engine.collisions());
    assert_eq!(engine.collisions(), list.collisions());
    assert!(bits(&engine) == bits(&list));
}

fn both<const D: usize>(setup: Setup<D>, time: f64) -> (Gas<D>, Gas<D>) {
    let mut engine = setup.clone().build().unwrap();
    let mut list = setup.method(Method::List).build().unwrap();
    advance(&mut engine, time);
    advance(&mut list, time);
    (engine, list)
}

#[test]
fn engine_and_list_have_the_same_bits_between_walls() {
    let mut flat = Setup::<2>::new([20.0, 15.0]);
    scatter(&mut flat, 200, 0.2, 4.0, 1);
    same_bits(flat, 10.0);
    let mut deep = Setup::<3>::new([8.0, 9.0, 10.0]);
    scatter(&mut deep, 200, 0.2, 4.0, 1);
    same_bits(deep, 10.0);
}

/// Across periodic sides they agree to rounding errors.
pub fn same_positions<const D: usize>(setup: Setup<D>, time: f64) {
    let (engine, list) = both(setup.clone(), time);
    assert!(2 * engine.collisions() > engine.len() as u64, "only {} collisions", engine.collisions());
    assert_eq!(engine.collisions(), list.collisions());
    for (a, b) in engine.unwrapped().iter().zip(list.unwrapped()) {
        assert!((0..D).all(|axis| (a[axis] - b[axis]).abs() < 1e-6), "{a:?} {b:?}");
    }
}

#[test]
fn engine_and_list_agree_across_periodic_sides() {
    same_positions(Setup::<2>::fluid(150, 0.4), 1.0);
    same_positions(Setup::<3>::fluid(150, 0.3), 0.3);
    // Long ways across small boxes: balls meet in images that were not the nearest when they set out.
    same_positions(Setup::<2>::fluid(20, 0.02), 18.0);
    same_positions(Setup::<3>::fluid(30, 0.02), 10.0);
}

#[test]
fn engine_and_list_have_the_same_bits_whatever_the_sides() {
    for seed in 0..6 {
        let mut box2 = Setup::<2>::new([30.0, 20.0]);
        box2.sides[0] = [Side::Thermal { temperature: 2.0 }, Side::Piston { mass: 20.0, pressure: 0.5, velocity: 0.0 }];
        box2.sides[1] = match seed % 3 {
            0 => [Side::Fixed, Side::Moving { velocity: -0.1, until: Some(20.0) }],
            1 => [Side::Fixed, Side::Swinging { amplitude: 1.0, period: 3.0 }],
            _ => [Side::Fixed, Side::Displaced(vec![[1.0, 0.0], [2.0, -1.0], [5.0, 0.0]])],
        };
        box2.gravity = if seed % 2 == 0 { [0.0; 2] } else { [0.0, -0.3] };
        box2.restitution = if seed > 3 { 0.9 } else { 1.0 };
        box2.contact_time = Some(1e-6);
        let hole = (seed == 5).then(|| vec![[8.0, 12.0]]);
        box2.partition = Some(Partition { axis: 0, at: 15.0, lifted_at: Some(4.0), hole });
        let mut filled = box2;
        filled.seed = seed;
        scatter_beside(&mut filled, 60, seed);
        same_bits(filled, 25.0);
    }
}

/// Balls clear of the partition at the middle.
fn scatter_beside(setup: &mut Setup<2>, count: usize, seed: u64) {
    scatter(setup, count, 0.2, 4.0, seed);
    setup.balls.retain(|ball| (ball.position[0] - 15.0).abs() > ball.radius + 1e-6);
}
