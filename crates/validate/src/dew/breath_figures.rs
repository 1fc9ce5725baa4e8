//! Breath figures: how drops grow on a level plate to which water comes evenly.

use super::rows;
use super::slide::{fitted_slope, laws, on_patches};
use crate::device::refuse_on_gpu;
use crate::{Case, Options, Row};
use corpuscle_dew::drops::{DropLaws, Drops, WATER_DENSITY};
use corpuscle_model::ModelError;
use std::f64::consts::PI;

pub(super) const BREATH_FIGURES: Case = Case {
    name: "dew/breath-figures",
    about: "Water comes evenly to a level plate with random nucleation sites, three seeds and two patch widths: radii grow as its cube root while the \
            drops are apart, as the water itself once they merge, and then cover 0.57 of the plate (Fritter, Knobler & Beysens 1991).",
    slow: true,
    reduced: 1.0,
    run: breath_figures,
};

/// Side of the plate, m; density of its sites, 1/m2; radius of the smallest drop, m.
const SIDE: f64 = 0.015;
const SITES: f64 = 1e8;
const SMALLEST: f64 = 1e-6;

/// Water in a step, as a part of what there is, and at the start, as a thickness in m.
const MORE: f64 = 0.05;
const START: f64 = 1e-10;

/// Mean radii between which drops are apart, and between which they merge, m.
const APART_RADII: [f64; 2] = [3e-6, 5e-6];
const MERGING_RADII: [f64; 2] = [2e-4, 5e-4];

/// Drops that began later are smaller than this part of the mean radius.
const LATER: f64 = 0.25;

fn breath_figures(_: &Options) -> Vec<Row> {
    rows(BREATH_FIGURES.name, measure())
}

fn measure() -> Result<Vec<Row>, ModelError> {
    let name = BREATH_FIGURES.name;
    refuse_on_gpu("drops, which stay with the CPU")?;
    let mut rows = Vec::new();
    for (seed, patches) in [(1, 20), (2, 20), (3, 50)] {
        let Grown { apart, merging, covered } = grow(seed, patches);
        let row = |quantity: &str, error: f64, bound: f64| {
            Row::at_most(name, &format!("{quantity}_seed_{seed}_patches_{patches}"), error, "", bound)
        };
        rows.push(row("exponent_apart_error", (apart - 1.0 / 3.0).abs(), 0.02));
        rows.push(row("exponent_merging_error", (merging - 1.0).abs(), 0.1));
        rows.push(row("covered_error", (covered - 0.57).abs(), 0.05));
    }
    Ok(rows)
}

/// Exponents of the mean radius over the water, and the mean part covered while drops merge.
struct Grown {
    apart: f64,
    merging: f64,
    covered: f64,
}

fn grow(seed: u64, patches: u32) -> Grown {
    let level = DropLaws { gravity: [0.0; 3], ..laws(0.0, 0.5 * PI, SMALLEST) };
    let mut drops = on_patches(level, SIDE, patches, SITES, seed);
    let width = SIDE / f64::from(patches);
    let mut thickness = 0.0;
    let (mut apart, mut merging, mut covered) = (Vec::new(), Vec::new(), Vec::new());
    loop {
        let more = if thickness == 0.0 { START } else { MORE * thickness };
        drops.condense(&vec![WATER_DENSITY * more * width * width; (patches * patches) as usize]);
        drops.advance(0.0);
        thickness += more;
        let radius = mean_radius(&drops);
        let is_in = |range: [f64; 2]| radius >= range[0] && radius < range[1];
        let point = [thickness.ln(), radius.ln()];
        if is_in(APART_RADII) {
            apart.push(point);
        } else if is_in(MERGING_RADII) {
            merging.push(point);
            covered.push(covered_by_first(&drops, radius));
        } else if radius >= MERGING_RADII[1] {
            let mean = covered.iter().sum::<f64>() / covered.len() as f64;
            return Grown { apart: fitted_slope(&apart), merging: fitted_slope(&merging), covered: mean };
        }
    }
}

/// Part of the plate that the drops cover which began first: the later ones between them are much smaller than the mean.
fn covered_by_first(drops: &Drops, mean: f64) -> f64 {
    let radii = drops.drops().iter().map(|drop| drop.radius);
    radii.filter(|&radius| radius > LATER * mean).map(|radius| PI * radius * radius).sum::<f64>() / (SIDE * SIDE)
}

/// Mean radius of the water's drops, weighted by their mass, m; 0 where none is seen.
fn mean_radius(drops: &Drops) -> f64 {
    let (sum, mass) =
        drops.drops().iter().fold((0.0, 0.0), |(sum, mass), drop| (sum + drop.mass * drop.radius, mass + drop.mass));
    if mass > 0.0 { sum / mass } else { 0.0 }
}
