//! Removal of air of low utility: results hardly change, the computing time does.

use super::ledger::{LOW_UTILITY, SCENE, dew_by_chance, gauge};
use super::{advance, rows};
use crate::{Case, Options, Row};
use corpuscle_model::{Model, ModelError};

pub(super) const CASE: Case = Case {
    name: "dew/low-utility",
    about: "Humid air flows over a cold pane and away, with the air far downstream taken out and without: covered area and water on the \
            pane agree within 2 %, and fewer particles are moved.",
    slow: false,
    reduced: 1.0,
    run: low_utility,
};

/// s. From some 0.3 s on the flow fluctuates, and any two runs differ by one or two percent.
const UNTIL: f64 = 0.28;

fn low_utility(_: &Options) -> Vec<Row> {
    rows(CASE.name, measure())
}

fn measure() -> Result<Vec<Row>, ModelError> {
    // Drops that stay: when one drips is chance. Without accelerated time: where drops outnumber the air they are seen to less often, and with so much
    // water at a time fewer of them begin.
    let text = SCENE.replace("friction = 2e-6", "friction = 1").replace("time_factor = 40", "time_factor = 1");
    let [whole, less] = [sum(&text)?, sum(&text.replace("[dew.faces]", LOW_UTILITY))?];
    let difference = |measure: usize| (less[measure] / whole[measure] - 1.0).abs();
    let faster = whole[2] / less[2];
    Ok(vec![
        Row::at_most(CASE.name, "difference_of_covered_area", difference(0), "", 0.02),
        Row::at_most(CASE.name, "difference_of_water", difference(1), "", 0.02),
        Row::at_least(CASE.name, "particle_steps_saved", 1.0 - less[3] / whole[3], "", 0.1),
        Row::beside(CASE.name, "times_faster", faster, "", 1.0, "wall-clock time, shown: it depends on the machine"),
    ])
}

/// What [`run`] gives, over three seeds: where drops begin is chance.
fn sum(text: &str) -> Result<[f64; 4], ModelError> {
    let mut all = [0.0; 4];
    for seed in 1..=3 {
        let found = run(text, seed)?;
        all = std::array::from_fn(|k| all[k] + found[k]);
    }
    Ok(all)
}

/// Covered area, m2, water on the pane, kg, wall-clock time, s, and particle steps.
fn run(text: &str, seed: u64) -> Result<[f64; 4], ModelError> {
    let mut dew = dew_by_chance(text, seed)?;
    let start = std::time::Instant::now();
    advance(&mut dew, UNTIL)?;
    let seconds = start.elapsed().as_secs_f64();
    let steps = dew.particle_steps() as f64;
    Ok([gauge(&dew, "solids.covered_area_m2"), gauge(&dew, "water.on_solids_kg"), seconds, steps])
}
