//! Mixing of two gases.

use super::{SEED, advance, rows};
use crate::{Case, Options, Row};
use corpuscle_gas::{Amount, Estimate, Partition, Setup, Species};
use corpuscle_model::ModelError;

pub(super) const MIXING: Case = Case {
    name: "gas/mixing",
    about: "Two gases alike but in name, with a partition between them that is lifted: the entropy of mixing rises from 0 to N ln 2 \
            and stays there.",
    slow: false,
    reduced: 1.0,
    run: mixing,
};

/// Balls: 25 in each of 8 x 8 cells, so that no cell is of both sides at first.
const COUNT: usize = 1600;

fn mixing(_: &Options) -> Vec<Row> {
    rows(MIXING.name, measure())
}

fn measure() -> Result<Vec<Row>, ModelError> {
    let side = 112.0;
    let mut setup = Setup::new([side, side]).seed(SEED);
    setup.partition = Some(Partition { axis: 0, at: 0.5 * side, lifted_at: Some(1.0), hole: None });
    for (name, from, to) in [("left", 0.0, 0.5), ("right", 0.5, 1.0)] {
        let region = Some([[from * side, 0.0], [to * side, side]]);
        setup = setup.species(Species { region, ..Species::new(name, Amount::Count(COUNT / 2)) });
    }
    let mut gas = setup.build()?;
    let full = COUNT as f64 * 2_f64.ln();
    let start = gas.mixing_entropy() / full;
    // Diffusion takes side^2 / (pi^2 D), about 700, to even out; balls forget their cell within about 100.
    let entropies = (0..60).map(|sample| {
        advance(&mut gas, 7000.0 + 200.0 * f64::from(sample))?;
        Ok(gas.mixing_entropy() / full)
    });
    let end = Estimate::of(&entropies.collect::<Result<Vec<f64>, ModelError>>()?);
    let row = |measure, value, bound| Row::at_most(MIXING.name, measure, value, "", bound);
    Ok(vec![
        row("entropy_at_start_over_n_ln_2", start, 1e-12),
        row("entropy_at_end_less_n_ln_2_in_standard_errors", (end.mean - 1.0).abs() / end.error, 3.0),
        row("standard_error_over_n_ln_2", end.error, 1e-3),
    ])
}
