//! Hard balls from collision to collision.

#![warn(missing_docs)]

mod engine;
mod sum;

/// Tries the engine's speed.
#[doc(hidden)]
pub mod trial {
    use crate::engine::ball::Kind;
    use crate::engine::contact::Field;
    use crate::engine::*;
    use rand::{RngExt, SeedableRng};

    fn cpu() -> f64 {
        let stat = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap();
        stat.split_whitespace().next().unwrap().parse::<f64>().unwrap() * 1e-9
    }

    /// Rate.
    pub fn rate<const D: usize>(n: usize, packing: f64, seconds: f64) {
        let per = if D == 2 { std::f64::consts::FRAC_PI_4 } else { std::f64::consts::PI / 6.0 };
        let across = (n as f64).powf(1.0 / D as f64).round() as usize;
        // fcc / hexagonal-ish: use simple lattice where it fits, else body-centred
        let cells = if D == 3 && packing > 0.45 { ((n as f64 / 4.0).powf(1.0 / 3.0)).round() as usize } else { across };
        let total = if D == 3 && packing > 0.45 { 4 * cells.pow(3) } else { across.pow(D as u32) };
        let side = (total as f64 * per / packing).powf(1.0 / D as f64);
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        let mut starts = vec![];
        let step = side / cells as f64;
        let bases: Vec<[f64; 3]> = if D == 3 && packing > 0.45 {
            vec![[0.25, 0.25, 0.25], [0.75, 0.75, 0.25], [0.75, 0.25, 0.75], [0.25, 0.75, 0.75]]
        } else {
            vec![[0.5; 3]]
        };
        for i in 0..cells.pow(D as u32) {
            for base in &bases {
                let position = std::array::from_fn(|axis| ((i / cells.pow(axis as u32)) % cells) as f64 * step + base[axis] * step);
                let velocity = std::array::from_fn(|_| {
                    let mut s = -6.0;
                    for _ in 0..12 {
                        s += rng.random::<f64>();
                    }
                    s
                });
                starts.push(Start { position, velocity, kind: 0, species: 0 });
            }
        }
        let field = Field { gravity: [0.0; D], scale: 1.0, growth: 0.0, period: [side; D] };
        let mut engine = Engine::new(
            [0.0; D],
            [side; D],
            vec![Kind { radius: 0.5, mass: 1.0 }],
            &starts,
            vec![],
            field,
            Rebound { restitution: 1.0, contact_time: 0.0 },
        );
        let go = |seconds: f64, engine: &mut Engine<D>| {
            let start = cpu();
            let before = engine.tally.clone();
            let from = engine.time();
            while (cpu() - start) < seconds {
                match engine.run(f64::INFINITY, 100_000) {
                    Pause::WindowFull => engine.rebuild(),
                    Pause::Worked => {}
                    other => panic!("{other:?}"),
                }
            }
            let collisions = engine.tally.collisions - before.collisions;
            let time = engine.time() - from;
            (
                collisions as f64 / (cpu() - start) / 1e3,
                2.0 * collisions as f64 / time / engine.balls.len() as f64,
                (engine.tally.crossings - before.crossings) as f64 / collisions as f64,
                (engine.tally.disturbed - before.disturbed) as f64 / collisions as f64,
            )
        };
        go(seconds * 0.5 + n as f64 * 5e-6, &mut engine);
        let (rate, per_ball, crossings, disturbed) = go(seconds, &mut engine);
        println!(
            "{D}D n={} packing {packing}: {rate:.0} k/s, {per_ball:.3} per ball and time, crossings {crossings:.2}, disturbed {disturbed:.2}, {} bytes",
            engine.balls.len(),
            engine.bytes() / engine.balls.len()
        );
    }
}
