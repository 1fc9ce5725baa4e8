//! Cells that follow the water, beside cells of one size.

use super::super::rows;
use super::beach::run_up;
use super::thacker::{Exact, error, omega, plane, swing_with};
use super::{all_sides, settings, worst};
use crate::device::{rounding, sized};
use crate::{Case, Options, Row};
use corpuscle_flood::VoronoiFlood;
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::{Adaptive, Edge, Flood};
use std::f64::consts::TAU;

pub(in super::super) const ADAPTIVE: Case = Case {
    name: "flood/voronoi/adaptive",
    about: "Cells that follow the water, three seeds: the run-up of `flood/voronoi/beach` with particles 0.2 d apart and down to 0.05 d at the shore has less \
            of an error than with 0.1 d everywhere, for a fifth of the work (steps of cells); the bowl of `flood/voronoi/thacker-planar`, shallow nearly \
            everywhere, with 8 cm and down to 4 cm, beside 4 cm everywhere. Bound of the run-up: that of `flood/voronoi/beach` at 0.05 d.",
    slow: true,
    reduced: 3.0,
    run: |_: &Options| rows(ADAPTIVE.name, measure()),
};

/// Spacings of the run-up, in depths: the widest, that everywhere in a run beside it, and the finest.
const RUN_UP: [f64; 3] = [0.2, 0.1, 0.05];

/// Spacings in the bowl, m: the widest and the finest.
const BOWL: [f64; 2] = [0.08, 0.04];

/// Films less deep than this ask for no finer cells, m: the cases are about a metre wide and more.
const WET: f64 = 1e-4;

fn measure() -> Result<Vec<Row>, ModelError> {
    let [adapted, even, coarse, over_even, over_coarse, water] = worst(run_ups)?;
    let [bowl, bowl_work, bowl_water] = worst(bowls)?;
    let at_most = |measure, value, bound| Row::at_most(ADAPTIVE.name, measure, value, "", bound);
    let beside =
        |measure, value, other| Row::beside(ADAPTIVE.name, measure, value, "", other, "with cells of one size");
    Ok(vec![
        at_most("run_up_error", adapted, 0.02),
        beside("run_up_error_010d", even, adapted),
        beside("run_up_error_020d", coarse, adapted),
        at_most("run_up_work_over_010d", over_even, 0.25),
        at_most("run_up_work_over_020d", over_coarse, 2.0),
        at_most("bowl_error_over_4cm", bowl, 1.05),
        at_most("bowl_work_over_4cm", bowl_work, 0.85),
        at_most("water_relative_error", water.max(bowl_water), rounding(1e-13, 1e-11)),
    ])
}

/// Settings with cells that become `finest_m` m wide.
fn adaptive(finest_m: f64, settings: Flood) -> Flood {
    let adaptive = Some(Adaptive { finest_m: sized(finest_m), ..Adaptive::default() });
    Flood { adaptive, wet_depth_m: WET, ..settings }
}

fn water_error(flood: &VoronoiFlood) -> f64 {
    flood.ledger().balances[0].relative_error().abs()
}

/// Errors of the run-up with cells that follow the water, with the middle and with the widest spacing; the work of the first over that of the second and the
/// third; and the error of its water.
fn run_ups(seed: u64) -> Result<[f64; 6], ModelError> {
    let [wide, middle, finest] = RUN_UP;
    let (adapted, flood) = run_up(|settings| adaptive(finest, settings), wide, seed)?;
    let (even, even_flood) = run_up(|settings| settings, middle, seed)?;
    let (coarse, coarse_flood) = run_up(|settings| settings, wide, seed)?;
    // Strips are as many spacings wide.
    let work = |flood: &VoronoiFlood, spacing: f64| flood.particle_steps() as f64 / spacing;
    let over = |other: f64| work(&flood, wide) / other;
    let water = water_error(&flood);
    Ok([adapted, even, coarse, over(work(&even_flood, middle)), over(work(&coarse_flood, wide)), water])
}

/// Error and work in the bowl, over those with fine cells everywhere, and the error of the water.
fn bowls(seed: u64) -> Result<[f64; 3], ModelError> {
    let [wide, finest] = BOWL;
    let (exact, time): (Exact, f64) = (plane, 2.0 * TAU / omega());
    let even = settings(finest, 0.0, all_sides(&Edge::Wall));
    let fine = swing_with(&even, exact, time, seed)?;
    let flood = swing_with(&adaptive(finest, Flood { spacing_m: Some(sized(wide)), ..even }), exact, time, seed)?;
    let work = flood.particle_steps() as f64 / fine.particle_steps() as f64;
    Ok([error(&flood, exact, time) / error(&fine, exact, time), work, water_error(&flood)])
}
