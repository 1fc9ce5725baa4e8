//! What the tests share: small random scenes, and the plainest event search there is.

#![allow(dead_code)]

pub mod brute;

use corpuscle_gas::{Gas, Setup};
use corpuscle_model::Model;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::sync::atomic::AtomicBool;

/// Moves a gas on to a time.
pub fn advance<const D: usize>(gas: &mut Gas<D>, time: f64) {
    gas.advance_to(time, &AtomicBool::new(false)).unwrap();
}

/// All numbers of a gas's state, as bits.
pub fn bits<const D: usize>(gas: &Gas<D>) -> Vec<u64> {
    gas.states().iter().flat_map(|(position, velocity)| position.iter().chain(velocity)).map(|x| x.to_bits()).collect()
}

/// Puts balls of random radii (1 to `ratio`), masses (1 to 100) and velocities into a box, where there is room.
pub fn scatter<const D: usize>(setup: &mut Setup<D>, count: usize, smallest: f64, ratio: f64, seed: u64) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut put = 0;
    for _ in 0..100_000 {
        if put == count {
            break;
        }
        let radius = smallest * ratio.powf(random.random::<f64>());
        let position: [f64; D] =
            std::array::from_fn(|axis| radius + (setup.size[axis] - 2.0 * radius) * random.random::<f64>());
        let clear = setup.balls.iter().all(|ball| {
            let apart2: f64 = (0..D).map(|axis| (ball.position[axis] - position[axis]).powi(2)).sum();
            apart2.sqrt() > 1.0001 * (ball.radius + radius)
        });
        if clear {
            let velocity = std::array::from_fn(|_| 2.0 * random.random::<f64>() - 1.0);
            let mass = 100_f64.powf(random.random::<f64>());
            *setup = setup.clone().ball(position, velocity, radius, mass);
            put += 1;
        }
    }
}

/// Deepest overlap of any two balls, all pairs and images, over the smaller radius.
pub fn deepest<const D: usize>(setup: &Setup<D>, gas: &Gas<D>, periodic: [bool; D]) -> f64 {
    let states = gas.states();
    let radius = |ball: usize| gas.body(ball).0;
    let mut deepest = f64::NEG_INFINITY;
    for a in 0..states.len() {
        for b in 0..a {
            let square = |axis: usize| {
                let mut apart = (states[a].0[axis] - states[b].0[axis]).abs();
                if periodic[axis] {
                    apart = apart.rem_euclid(setup.size[axis]);
                    apart = apart.min(setup.size[axis] - apart);
                }
                apart * apart
            };
            let apart = (0..D).map(square).sum::<f64>().sqrt();
            deepest = f64::max(deepest, (radius(a) + radius(b) - apart) / radius(a).min(radius(b)));
        }
    }
    deepest
}
