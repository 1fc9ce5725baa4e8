//! Output does not change the solution of a gas.

use super::{SEED, advance, rows};
use crate::{Case, Options, Row};
use corpuscle_gas::{Amount, Gas, Partition, Setup, Side, Species};
use corpuscle_model::{Model, ModelError};

pub(super) const FRAME_INDEPENDENCE: Case = Case {
    name: "gas/frame-independence",
    about: "The state at the end is the same to the bit with frames every 0.001, every 0.1 and none: gravity, a thermal and a swinging \
            wall, a piston, a partition that is lifted, two species, collisions with loss.",
    slow: false,
    reduced: 1.0,
    run: frame_independence,
};

const UNTIL: f64 = 20.0;

fn frame_independence(_: &Options) -> Vec<Row> {
    let measure = || Ok(vec![differences::<2>()?, differences::<3>()?]);
    rows(FRAME_INDEPENDENCE.name, measure())
}

/// Numbers of the final state, and of what was measured, that differ in any bit.
fn differences<const D: usize>() -> Result<Row, ModelError> {
    let alone = bits(&run::<D>(None)?);
    let mut differing = 0;
    for period in [0.1, 0.001] {
        let seen = bits(&run::<D>(Some(period))?);
        differing += alone.iter().zip(&seen).filter(|(a, b)| a != b).count() + alone.len().abs_diff(seen.len());
    }
    let measure = format!("numbers_that_differ_{D}d");
    Ok(Row::at_most(FRAME_INDEPENDENCE.name, &measure, differing as f64, "", 0.0))
}

fn run<const D: usize>(period: Option<f64>) -> Result<Gas<D>, ModelError> {
    let mut gas = everything::<D>().build()?;
    if let Some(period) = period {
        for frame in 1..(UNTIL / period).round() as u64 {
            advance(&mut gas, frame as f64 * period)?;
            std::hint::black_box(gas.frame());
        }
    }
    advance(&mut gas, UNTIL)?;
    Ok(gas)
}

/// A box with everything in it that a scene can ask for.
fn everything<const D: usize>() -> Setup<D> {
    let mut setup = Setup::new([12.0; D]).seed(SEED).restitution(0.98).measured(2.0, 0.37);
    setup.sides[0] = [Side::Thermal { temperature: 1.5 }, Side::Piston { mass: 50.0, pressure: 0.2, velocity: 0.0 }];
    setup.sides[1] = [Side::Swinging { amplitude: 0.2, period: 1.7 }, Side::Fixed];
    if D == 3 {
        setup.sides[2] = [Side::Periodic, Side::Periodic];
    }
    setup.gravity[1] = -0.1;
    setup.partition = Some(Partition { axis: 0, at: 6.0, lifted_at: Some(3.3), hole: None });
    let mut half = [[0.5; D], [11.5; D]];
    half[1][0] = 6.0;
    let left = Species { region: Some(half), ..Species::new("left", Amount::Packing(0.15)) };
    (half[0][0], half[1][0]) = (6.0, 11.5);
    let small = Species { region: Some(half), radius: 0.3, mass: 0.4, ..Species::new("right", Amount::Packing(0.15)) };
    setup.species(left).species(small)
}

fn bits<const D: usize>(gas: &Gas<D>) -> Vec<u64> {
    let states = gas.states();
    let numbers = states.iter().flat_map(|(position, velocity)| position.iter().chain(velocity));
    numbers.chain(&gas.gauge_row()).map(|number| number.to_bits()).collect()
}
