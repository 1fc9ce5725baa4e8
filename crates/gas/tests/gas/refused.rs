//! Scenes that cannot be are refused by name; what cannot go on is stopped with its reason; nothing hangs.

use corpuscle_gas::{Amount, Partition, Setup, SetupError, Side, Species, Start};
use corpuscle_model::{Model, ModelError};
use std::sync::atomic::AtomicBool;
use std::time::Instant;

fn why<const D: usize>(setup: Setup<D>) -> String {
    setup.build().map(|_| ()).expect_err("must be refused").to_string()
}

fn one(position: [f64; 2], velocity: [f64; 2], radius: f64, mass: f64) -> Setup<2> {
    Setup::new([10.0, 8.0]).ball(position, velocity, radius, mass)
}

#[test]
fn numbers_that_cannot_be_are_named() {
    let at = [5.0, 4.0];
    for (setup, named) in [
        (one(at, [0.0; 2], 0.0, 1.0), "radius"),
        (one(at, [0.0; 2], f64::NAN, 1.0), "radius"),
        (one(at, [0.0; 2], 1.0, 0.0), "mass"),
        (one(at, [0.0; 2], 1.0, -2.0), "mass"),
        (one(at, [f64::INFINITY, 0.0], 1.0, 1.0), "velocity"),
        (one([f64::NAN, 4.0], [0.0; 2], 1.0, 1.0), "position"),
        (one(at, [0.0; 2], 1.0, 1.0).restitution(0.0), "restitution"),
        (one(at, [0.0; 2], 1.0, 1.0).gravity([f64::NAN, 0.0]), "gravity"),
        (one(at, [0.0; 2], 1.0, 1.0).side(0, 0, Side::Thermal { temperature: 0.0 }), "temperature"),
        (one(at, [0.0; 2], 1.0, 1.0).side(0, 0, Side::Piston { mass: 0.0, pressure: 1.0, velocity: 0.0 }), "piston"),
        (one(at, [0.0; 2], 1.0, 1.0).side(0, 0, Side::Periodic), "periodic"),
        (one(at, [0.0; 2], 4.5, 1.0), "does not fit"),
        (one(at, [0.0; 2], 1.5, 1.0).periodic(), "three balls"),
        (Setup::new([10.0, 8.0]), "no balls"),
        (Setup::new([f64::NAN, 8.0]), "length along x"),
    ] {
        let text = why(setup);
        assert!(text.contains(named), "{text} does not name {named}");
    }
    let mut beyond = Species::new("gas", Amount::Count(10));
    beyond.region = Some([[0.0, 0.0], [11.0, 8.0]]);
    assert!(why(Setup::new([10.0, 8.0]).species(beyond)).contains("region"));
    let many = Species { radius: 1e-9, ..Species::new("gas", Amount::Count(2_000_000_000)) };
    assert!(why(Setup::new([10.0, 8.0]).species(many)).contains("number of balls"));
}

#[test]
fn overlaps_at_the_start_are_refused() {
    let error = one([5.0, 4.0], [0.0; 2], 1.0, 1.0).ball([6.5, 4.0], [0.0; 2], 1.0, 1.0).build().unwrap_err();
    assert!(matches!(error, SetupError::Overlap { depth, .. } if (depth - 0.5).abs() < 1e-12), "{error}");
    assert!(why(one([0.9, 4.0], [0.0; 2], 1.0, 1.0)).contains("wall"));
    let mut divided = one([5.0, 4.0], [0.0; 2], 1.0, 1.0);
    divided.partition = Some(Partition { axis: 0, at: 5.5, lifted_at: None, hole: None });
    assert!(why(divided).contains("partition"));
    // Balls that just touch do not overlap.
    assert!(one([5.0, 4.0], [0.0; 2], 1.0, 1.0).ball([7.0, 4.0], [0.0; 2], 1.0, 1.0).build().is_ok());
}

fn dense<const D: usize>(packing: f64, start: Start) -> Species<D> {
    Species { start, ..Species::new("gas", Amount::Packing(packing)) }
}

#[test]
fn packings_that_do_not_exist_are_refused() {
    for start in [Start::Lattice, Start::Random] {
        let text = why(Setup::<2>::new([20.0, 20.0]).periodic().species(dense(0.92, start)));
        assert!(text.contains("0.9069"), "{text}");
        let text = why(Setup::<3>::new([8.0; 3]).periodic().species(dense(0.75, start)));
        assert!(text.contains("0.7405"), "{text}");
    }
    // It exists, but not at random.
    let text = why(Setup::<3>::new([6.0; 3]).periodic().species(Species::new("gas", Amount::Packing(0.70))));
    assert!(text.contains("jammed") || text.contains("lattice"), "{text}");
}

/// The packing at which balls jam, as a refusal says.
fn jammed(text: &str) -> f64 {
    let after = text.split("jam at ").nth(1).unwrap_or_else(|| panic!("{text}"));
    after.split(' ').next().unwrap().parse().unwrap()
}

#[test]
fn random_packings_beyond_jamming_are_refused_at_once() {
    let start = Instant::now();
    for count in [20_000, 1_000_000] {
        let text = why(Setup::<2>::fluid(count, 0.88));
        assert!(jammed(&text) == 0.875 && text.contains("Ask for a lattice"), "{text}");
    }
    let text = why(Setup::<3>::fluid(100_000, 0.68));
    assert!(jammed(&text) == 0.66, "{text}");
    // Few balls, and balls of two sizes, are grown until they stall: each time at another packing, and now and then nearly as a lattice.
    let mut refused = 0;
    for seed in 0..6 {
        let small = Species { radius: 0.35, ..dense(0.44, Start::Random) };
        let two = Setup::<2>::new([30.0, 30.0]).periodic().species(dense(0.44, Start::Random)).species(small);
        for (setup, least) in [(Setup::<2>::fluid(300, 0.88), 0.83), (two, 0.80)] {
            let Err(error) = setup.seed(seed).build() else { continue };
            let text = error.to_string();
            assert!((least..0.88).contains(&jammed(&text)) && text.contains("Ask for a lattice"), "{text}");
            refused += 1;
        }
    }
    assert!(refused > 6, "{refused}");
    assert!(start.elapsed().as_secs() < 10, "{:?}", start.elapsed());
}

#[test]
fn a_piston_that_would_crush_the_gas_is_refused() {
    let gas = |mass: f64, pressure: f64, velocity: f64| {
        let piston = Side::Piston { mass, pressure, velocity };
        Setup::<2>::new([100.0, 100.0]).side(0, 1, piston).species(Species::new("gas", Amount::Packing(0.1)))
    };
    for (mass, pressure, velocity) in [(1e9, 0.2, -1e4), (1e30, 0.0, -1e12), (1e300, 0.0, -1e300), (1e9, 1e5, 0.0)] {
        assert!(why(gas(mass, pressure, velocity)).contains("crush"), "{mass} {pressure} {velocity}");
    }
    assert!(why(gas(1e-9, 0.2, 0.0)).contains("too light"));
    // It flies away and does not come back.
    assert!(gas(1e9, 0.0, 1e4).build().is_ok());
    assert!(gas(1e6, 0.2, -1.0).build().is_ok());
}

/// What of a gas can be odd, and how it ends: `None` for well.
type Odd = (&'static str, Setup<2>, f64, Option<&'static str>);

fn odd() -> Vec<Odd> {
    let gas = |packing: f64| Setup::<2>::new([30.0, 30.0]).species(Species::new("gas", Amount::Packing(packing)));
    let closing = |velocity: f64| Side::Moving { velocity, until: None };
    let piston = |mass: f64, pressure: f64| Side::Piston { mass, pressure, velocity: 0.0 };
    let cold = Species { temperature: 0.0, ..Species::new("gas", Amount::Count(200)) };
    let specks = Species { radius: 1e-9, ..Species::new("specks", Amount::Count(200)) };
    vec![
        (
            "between two walls that close in",
            one([5.0, 4.0], [0.1, 0.2], 1.0, 1.0).side(0, 0, closing(0.5)).side(0, 1, closing(-0.5)),
            100.0,
            Some("room"),
        ),
        (
            "at rest between two walls that close in",
            one([5.0, 4.0], [0.0; 2], 1.0, 1.0).side(0, 0, closing(0.5)).side(0, 1, closing(-0.5)),
            100.0,
            Some("room"),
        ),
        ("in a corner with loss", one([5.0, 4.0], [-1.0; 2], 1.0, 1.0).gravity([-1.0; 2]).restitution(0.5), 1e3, None),
        (
            "on another with loss",
            one([5.0, 1.0], [0.0; 2], 1.0, 1.0)
                .ball([5.0, 4.0], [0.0; 2], 1.0, 1.0)
                .gravity([0.0, -1.0])
                .restitution(0.9),
            1e4,
            Some("come to rest on each other"),
        ),
        ("hardly any rebound", gas(0.5).restitution(1e-6), 1e5, Some("longer contact time")),
        ("a thin gas with hardly any rebound", gas(0.1).restitution(0.01), 1e4, None),
        ("one much heavier, at rest", gas(0.1).ball([15.0; 2], [0.0; 2], 3.0, 1e12), 10.0, None),
        ("one much heavier, moving", gas(0.1).ball([15.0; 2], [1.0, 0.7], 3.0, 1e12), 30.0, None),
        ("specks", Setup::new([30.0, 30.0]).species(specks), 100.0, None),
        ("a light piston", gas(0.3).side(0, 1, piston(1e-6, 0.3)), 1.0, None),
        ("two pistons", gas(0.3).side(0, 0, piston(10.0, 5.0)).side(0, 1, piston(10.0, 5.0)), 20.0, None),
        (
            "two pistons with nothing behind",
            gas(0.3).side(0, 0, piston(1.0, 0.0)).side(0, 1, piston(1.0, 0.0)),
            1e5,
            None,
        ),
        (
            "a piston on a gas at rest",
            Setup::new([30.0, 30.0]).side(0, 1, piston(100.0, 1.0)).species(cold),
            30.0,
            None,
        ),
        ("a very long box", Setup::new([1e7, 3.0]).species(Species::new("gas", Amount::Count(200))), 10.0, None),
    ]
}

#[test]
fn odd_scenes_end_or_are_named_soon() {
    for (what, setup, end, named) in odd() {
        let start = Instant::now();
        match (
            setup.build().unwrap_or_else(|error| panic!("{what}: {error}")).advance_to(end, &AtomicBool::new(false)),
            named,
        ) {
            (Ok(()), None) => {}
            (Err(ModelError::Breakdown { what: text, .. }), Some(named)) if text.contains(named) => {}
            (other, _) => panic!("{what}: {other:?}"),
        }
        assert!(start.elapsed().as_secs() < 10, "{what}: {:?}", start.elapsed());
    }
}

fn stopped(mut gas: corpuscle_gas::Gas<2>) -> String {
    match gas.advance_to(1e6, &AtomicBool::new(false)) {
        Err(ModelError::Breakdown { what, .. }) => what,
        other => panic!("must be stopped, not {other:?}"),
    }
}

#[test]
fn a_ball_squeezed_between_walls_is_named() {
    let squeezed = one([5.0, 4.0], [1.0, 0.3], 1.0, 1.0).side(0, 1, Side::Moving { velocity: -0.5, until: None });
    assert!(stopped(squeezed.build().unwrap()).contains("room"));
    // At rest between two walls that touch it.
    let tight = Setup::<2>::new([2.0, 8.0]).ball([1.0, 4.0], [0.5, 0.1], 1.0, 1.0);
    assert!(stopped(tight.build().unwrap()).contains("without anything moving"));
}

#[test]
fn a_wall_that_crushes_the_gas_is_named() {
    let gas = |side: Side| {
        let species = Species::new("gas", Amount::Count(40));
        Setup::<2>::new([12.0, 10.0]).side(0, 1, side).species(species)
    };
    assert!(stopped(gas(Side::Moving { velocity: -0.5, until: None }).build().unwrap()).contains("room"));
    // Planned: refused at the start.
    let until = Side::Moving { velocity: -1.0, until: Some(10.0) };
    assert!(why(gas(until)).contains("walls across x would leave"));
    assert!(why(gas(Side::Displaced(vec![[0.0, 0.0], [5.0, -9.0]]))).contains("walls across x would leave"));
    assert!(why(gas(Side::Swinging { amplitude: 10.0, period: 9.0 })).contains("walls across x would leave"));
}

/// It was shown at the time of the frame before, as if balls had come along the paths that the last hits have bent: through one another.
#[test]
fn after_a_breakdown_the_balls_are_shown_where_it_happened() {
    let species = Species::new("gas", Amount::Count(40));
    let crushed =
        Setup::<2>::new([12.0, 10.0]).side(0, 1, Side::Moving { velocity: -0.5, until: None }).species(species);
    let mut gas = crushed.build().unwrap();
    let stop = AtomicBool::new(false);
    gas.advance_to(1.0, &stop).unwrap();
    let Err(ModelError::Breakdown { time, .. }) = gas.advance_to(1e6, &stop) else { panic!("must be stopped") };
    assert!(time > 1.0 && gas.time() == time, "{time} {}", gas.time());
    let balls = &gas.frame().sets[0];
    for (number, (at, radius)) in balls.position.iter().zip(&balls.radius).enumerate() {
        for (other, with) in balls.position.iter().zip(&balls.radius).take(number) {
            let distance = (at[0] - other[0]).hypot(at[1] - other[1]);
            assert!(distance >= (radius + with) * (1.0 - 1e-9), "{distance}");
        }
    }
}

#[test]
fn a_gas_too_hot_to_be_followed_is_named() {
    let mut species = Species::new("gas", Amount::Count(40));
    species.temperature = 1e300;
    assert!(stopped(Setup::<2>::new([12.0, 10.0]).species(species).build().unwrap()).contains("too many to wait for"));
}

#[test]
fn a_pile_at_rest_is_named() {
    let pile = Setup::<2>::new([8.0, 20.0]).gravity([0.0, -10.0]).restitution(0.5);
    let pile = pile.species(Species::new("grains", Amount::Count(20)));
    assert!(stopped(pile.build().unwrap()).contains("come to rest on each other"));
}

#[test]
fn inelastic_collapse_is_named_or_guarded() {
    // Three balls in a row: below a restitution of 7 - 4 sqrt(3) they collapse (McNamara and Young 1992).
    let row = |guard: f64| {
        let mut setup = Setup::<2>::new([40.0, 3.0]).restitution(0.05);
        setup.contact_time = Some(guard);
        setup.ball([10.0, 1.5], [1.0, 0.0], 0.5, 1.0).ball([12.0, 1.5], [0.0, 0.0], 0.5, 1.0).ball(
            [14.0, 1.5],
            [-1.0, 0.0],
            0.5,
            1.0,
        )
    };
    let mut bare = row(0.0).build().unwrap();
    let mut guarded = row(1e-6).build().unwrap();
    let stop = AtomicBool::new(false);
    match bare.advance_to(100.0, &stop) {
        Err(ModelError::Breakdown { what, .. }) => assert!(what.contains("contact time"), "{what}"),
        other => panic!("must collapse, not {other:?}"),
    }
    guarded.advance_to(100.0, &stop).unwrap();
    assert!(guarded.collisions() < 1000);
}

#[test]
fn corners_are_left_again() {
    // Into the corner exactly, and nearly.
    for aside in [0.0, 1e-13, 1e-9] {
        let mut gas = one([5.0, 4.0 + aside], [-4.0, -3.0], 1.0, 1.0).build().unwrap();
        gas.advance_to(2.0, &AtomicBool::new(false)).unwrap();
        let ([x, y], velocity) = gas.states()[0];
        assert_eq!(velocity, [4.0, 3.0]);
        assert!((x - 5.0).abs() < 1e-6 && (y - 4.0).abs() < 1e-6);
    }
}
