//! Two gases that leave a box through a small hole.

use super::{advance, rows, standard_errors_off};
use crate::{Case, Options, Row};
use corpuscle_gas::{Amount, Estimate, Partition, Setup, Side, Species};
use corpuscle_model::ModelError;
use std::f64::consts::TAU;

pub(super) const EFFUSION: Case = Case {
    name: "gas/effusion",
    about: "Balls of masses 1 and 4 leave a box, held at its temperature by a wall, through a hole into a vacuum: each after \
            n A sqrt(k T / 2 pi m) (Knudsen 1909), so the light ones twice as fast as the heavy ones (Graham 1846).",
    slow: true,
    reduced: 1.0,
    run: effusion,
};

const MASSES: [f64; 2] = [1.0, 4.0];

/// Balls of each mass.
const COUNT: usize = 12_500;

/// Free paths are far longer than the box.
const RADIUS: f64 = 0.05;

/// Width and height, length of the box, and of the vacuum, at whose end is a cold wall: what comes there stays.
const WIDTH: f64 = 1000.0;
const LENGTH: f64 = 500.0;
const BEYOND: f64 = 500.0;
const COLD: f64 = 1e-8;

/// Side of the hole, away from the middle.
const HOLE: f64 = 150.0;
const CORNER: f64 = 310.0;

const TIME: f64 = 3000.0;

/// Each seed is a measurement of its own.
const SEEDS: u64 = 8;

fn effusion(_: &Options) -> Vec<Row> {
    rows(EFFUSION.name, measure())
}

fn measure() -> Result<Vec<Row>, ModelError> {
    let rates = (1..=SEEDS).map(rates).collect::<Result<Vec<_>, _>>()?;
    let of = |value: &dyn Fn(&[f64; 2]) -> f64| Estimate::of(&rates.iter().map(value).collect::<Vec<_>>());
    let row = |measure: &str, value: f64, bound: f64| Row::at_most(EFFUSION.name, measure, value, "", bound);
    let ratio = of(&|rates| rates[0] / rates[1]);
    let (light, heavy) = (of(&|rates| rates[0]), of(&|rates| rates[1]));
    // 7 degrees of freedom: 3.5 standard errors for one in a hundred.
    Ok(vec![
        row("ratio_off_by_standard_errors", standard_errors_off(ratio, (MASSES[1] / MASSES[0]).sqrt()), 3.5),
        row("ratio_standard_error", ratio.error / ratio.mean, 0.03),
        row("light_rate_off_by_standard_errors", standard_errors_off(light, rate(MASSES[0])), 3.5),
        row("heavy_rate_off_by_standard_errors", standard_errors_off(heavy, rate(MASSES[1])), 3.5),
        row("light_rate_standard_error", light.error / light.mean, 0.02),
    ])
}

/// Part of the balls of a mass that leaves in a unit of time: A sqrt(T / 2 pi m) / V, V open to centres.
fn rate(mass: f64) -> f64 {
    let volume = (WIDTH - 2.0 * RADIUS).powi(2) * (LENGTH - 2.0 * RADIUS);
    HOLE * HOLE * (1.0 / (TAU * mass)).sqrt() / volume
}

/// Part of the balls of each mass that left in a unit of time, of those that were there.
fn rates(seed: u64) -> Result<[f64; 2], ModelError> {
    let mut setup = Setup::<3>::new([LENGTH + BEYOND, WIDTH, WIDTH])
        .side(0, 0, Side::Thermal { temperature: 1.0 })
        .side(0, 1, Side::Thermal { temperature: COLD });
    let hole = Some(vec![[CORNER, CORNER + HOLE]; 2]);
    setup.partition = Some(Partition { axis: 0, at: LENGTH, lifted_at: None, hole });
    for (mass, name) in MASSES.into_iter().zip(["light", "heavy"]) {
        let region = Some([[0.0; 3], [LENGTH, WIDTH, WIDTH]]);
        setup = setup.species(Species { mass, radius: RADIUS, region, ..Species::new(name, Amount::Count(COUNT)) });
    }
    let mut gas = setup.seed(seed).build()?;
    advance(&mut gas, TIME)?;
    let states = gas.states();
    let left =
        |balls: &[([f64; 3], [f64; 3])]| balls.iter().filter(|(position, _)| position[0] > LENGTH).count() as f64;
    let [light, heavy] = [&states[..COUNT], &states[COUNT..]].map(left);
    Ok([light, heavy].map(|left| -(1.0 - left / COUNT as f64).ln() / TIME))
}
