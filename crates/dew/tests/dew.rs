//! What the model keeps whatever the air does: water and energy, momentum, and its bits.

mod common;

use common::{COLD, D, GLASS, WARM, advance, ball, through_flow, vapour};
use corpuscle_dew::air::{Properties, Role};
use corpuscle_dew::solids::Body;
use corpuscle_dew::{Condensation, Dew, Face, Inflow, Mean, Room, Settings, Setup, WallTreatment};
use corpuscle_model::Model;
use corpuscle_solids::{Pose, Shape, Solid};

fn open(setup: &Setup) -> Dew {
    Dew::new(setup, |_| [WARM, vapour(WARM, 0.8)]).unwrap()
}

#[test]
fn water_and_energy_balance_with_flow_condensation_and_fog() {
    for held in [false, true] {
        let mut dew = open(&ball(through_flow(0.05, 0.9), held, 0.5));
        advance(&mut dew, 1.5);
        let row = dew.gauge_row();
        assert!(row[2] > 0.0, "water on the ball {}", row[2]);
        for balance in dew.ledger().balances {
            assert!(balance.inflow > 0.0 && balance.outflow > 0.0, "{balance:?}");
            assert!(balance.relative_error().abs() < 1e-10, "{balance:?}: {:e}", balance.relative_error());
        }
    }
}

#[test]
fn water_evaporates_into_dry_air_and_no_more_than_there_is() {
    let mut setup = ball([[Face::Periodic; 2]; 3], true, 0.5);
    setup.bodies[0].temperature = WARM;
    let mut dew = Dew::new(&setup, |_| [WARM, vapour(WARM, 0.2)]).unwrap();
    dew.wet(0, 1e-5);
    let start = dew.water_on_body(0);
    advance(&mut dew, 2.0);
    assert!(dew.water_on_body(0) < 0.5 * start);
    assert!(dew.water_on_solids().iter().all(|&water| water >= 0.0));
    assert!(dew.ledger().balances[0].relative_error().abs() < 1e-10);
}

#[test]
fn a_surface_above_the_dew_point_stays_dry() {
    let mut setup = ball([[Face::Periodic; 2]; 3], true, 0.5);
    setup.bodies[0].temperature = WARM - 3.0;
    let mut dew = open(&setup);
    advance(&mut dew, 2.0);
    assert_eq!(dew.water_on_body(0), 0.0);
}

#[test]
fn published_ways_can_be_chosen() {
    let mut setup = ball([[Face::Periodic; 2]; 3], true, 0.5);
    setup.settings.condensation = Condensation::Particle;
    let mut dew = open(&setup);
    advance(&mut dew, 1.0);
    assert!(dew.water_on_body(0) > 0.0);
    assert!(dew.ledger().balances[0].relative_error().abs() < 1e-10);
    // Each warms by the mean of the diffusivities: heat is not conserved, which is why it is not the default.
    setup.settings.mean = Mean::Diffusivity;
    setup.bodies[0].held = false;
    let mut dew = open(&setup);
    advance(&mut dew, 0.2);
    assert!(dew.ledger().balances[1].relative_error().abs() > 1e-6);
}

#[test]
fn momentum_is_conserved_in_stirred_air() {
    let mut setup = ball([[Face::Periodic; 2]; 3], true, 0.5);
    setup.bodies.clear();
    setup.settings.gravity = [0.0; 3];
    let mut dew = open(&setup);
    let size = setup.room.size();
    let wave = |at: f64, side: f64| 0.05 * (std::f64::consts::TAU * at / side).sin();
    dew.stir(|[x, _, z]| [wave(z, size[2]), wave(x, size[0]), 0.02]);
    let momentum = |dew: &Dew| [0, 1, 2].map(|axis| dew.air().iter().map(|p| p.velocity[axis]).sum::<f64>());
    let before = momentum(&dew);
    advance(&mut dew, 1.0);
    let after = momentum(&dew);
    for axis in 0..3 {
        assert!((after[axis] - before[axis]).abs() < 1e-11 * dew.air().len() as f64, "{before:?} {after:?}");
    }
    let nearest = nearest_pair(&dew, size);
    assert!(nearest > 0.5 * D, "particles clump: {}", nearest / D);
}

fn nearest_pair(dew: &Dew, size: [f64; 3]) -> f64 {
    let positions: Vec<[f64; 3]> = dew.air().iter().map(|particle| particle.position).collect();
    let mut nearest = f64::INFINITY;
    for (i, a) in positions.iter().enumerate() {
        for b in &positions[..i] {
            let squared = (0..3).map(|axis| {
                let along = (a[axis] - b[axis]).abs();
                along.min(size[axis] - along).powi(2)
            });
            nearest = nearest.min(squared.sum::<f64>());
        }
    }
    nearest.sqrt()
}

#[test]
fn warm_air_rises() {
    let mut setup = ball([[Face::Wall; 2]; 3], true, 0.5);
    setup.bodies.clear();
    let middle = 0.5 * setup.room.high[0];
    let mut dew = Dew::new(&setup, |[x, ..]| [if x < middle { WARM + 5.0 } else { WARM }, vapour(WARM, 0.8)]).unwrap();
    advance(&mut dew, 0.1);
    let rising = |side: bool| {
        let there = dew.air().iter().filter(|particle| (particle.position[0] < middle) == side);
        there.map(|particle| particle.velocity[2]).sum::<f64>()
    };
    assert!(rising(true) > 0.0 && rising(false) < 0.0, "{} {}", rising(true), rising(false));
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut dew = open(&ball(through_flow(0.05, 0.9), false, 0.5));
            advance(&mut dew, 0.3);
            dew.save()
        })
    };
    assert_eq!(run(1), run(3));
}

#[test]
fn looking_and_stopping_do_not_change_the_air() {
    let setup = ball(through_flow(0.05, 0.9), false, 0.5);
    let mut straight = open(&setup);
    advance(&mut straight, 0.3);
    let mut looked_at = open(&setup);
    for look in 1..=10 {
        advance(&mut looked_at, 0.03 * f64::from(look));
        let _ = (looked_at.frame(), looked_at.gauge_row());
        let saved = looked_at.save();
        looked_at = open(&setup);
        looked_at.restore(&saved).unwrap();
    }
    advance(&mut looked_at, 0.3);
    assert!(straight.save() == looked_at.save());
    assert!(looked_at.restore(b"not a state").is_err());
}

/// Distance from a ball's surface of the air that comes deepest while all air is pushed past it, in spacings.
fn deepest_in(walls: WallTreatment, until: f64) -> f64 {
    let mut setup = ball([[Face::Periodic; 2]; 3], true, 0.5);
    let pose = Pose::new([6.39 * D, 4.0 * D, 6.0 * D], [0.0; 3]);
    let solid = Solid::of_shape(Shape::sphere(3.0 * D).unwrap(), pose);
    setup.bodies = vec![Body::sampled(solid.clone(), D, GLASS, COLD, true).unwrap()];
    setup.settings.walls = walls;
    setup.settings.body_acceleration = [0.05, 0.0, 0.0];
    let mut dew = open(&setup);
    let mut deepest = f64::INFINITY;
    for look in 1..=20 {
        advance(&mut dew, until * f64::from(look) / 20.0);
        deepest = dew.air().iter().map(|particle| solid.signed_distance(particle.position)).fold(deepest, f64::min);
    }
    deepest / D
}

#[test]
fn every_treatment_but_none_keeps_air_out() {
    let corrected = deepest_in(WallTreatment::DensityCorrection, 1.2);
    assert!(corrected > 0.0, "{corrected}");
    // Ghosts stand at random: where they are few a particle dips below the surface.
    let ghosts = deepest_in(WallTreatment::Ghosts, 0.6);
    assert!(ghosts > -0.1, "{ghosts}");
    let none = deepest_in(WallTreatment::None, 0.6);
    assert!(none < -1.0, "{none}");
}

/// Air that flows past a cylinder at ten and a thousand times what its viscosity evens out over a particle's distance.
#[test]
fn fast_air_behind_a_solid_stays_a_flow() {
    for speed in [0.05, 5.0] {
        let size = [30.0 * D, 6.0 * D, 16.0 * D];
        let shape = Shape::cylinder(3.0 * D, size[1]).unwrap();
        let solid = Solid::of_shape(shape, Pose::new([10.0 * D, 0.5 * size[1], 0.5 * size[2]], [90.0, 0.0, 0.0]));
        let inflow = Inflow { velocity: [speed, 0.0, 0.0], temperature: WARM, vapour: 0.0 };
        let setup = Setup {
            settings: Settings::new(D, WARM, 0.0),
            air: Properties::at_room_temperature(10.0 * speed),
            room: Room {
                low: [0.0; 3],
                high: size,
                faces: [[Face::Inlet(inflow), Face::Outlet], [Face::Periodic; 2], [Face::Wall; 2]],
            },
            bodies: vec![Body::sampled(solid.clone(), D, GLASS, WARM, true).unwrap()],
            fans: Vec::new(),
            seed: 1,
        };
        let mut dew = Dew::new(&setup, |_| [WARM, 0.0]).unwrap();
        // As long as the air takes to go twice through the box.
        for look in 1..=6 {
            advance(&mut dew, f64::from(look) * 10.0 * D / speed);
            let air = || dew.air().iter().filter(|particle| particle.role == Role::Inside);
            let fastest = air().map(|particle| particle.speed_squared()).fold(0.0, f64::max).sqrt();
            // Between cylinder and walls there are 10 of 16 spacings for the stream; it is faster round the cylinder.
            assert!(fastest < 3.5 * speed, "{fastest} m/s at {look}");
            let least = air().map(|particle| particle.density).fold(f64::INFINITY, f64::min);
            assert!(least > 0.75 * setup.air.density, "{least} kg/m3 at {look}");
            let deepest = air().map(|particle| solid.signed_distance(particle.position)).fold(f64::INFINITY, f64::min);
            assert!(deepest > 0.0, "{deepest} m at {look}");
            let through = air().map(|particle| particle.velocity[0]).sum::<f64>() / air().count() as f64;
            assert!(look < 4 || (through / speed - 1.15).abs() < 0.3, "{through} m/s at {look}");
        }
    }
}
