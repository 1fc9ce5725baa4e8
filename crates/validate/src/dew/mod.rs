//! Cases of the dew model.

mod adiabatic;
pub(crate) mod bench;
mod boundaries;
mod breath_figures;
mod cavity;
mod dew_point;
mod evaporation;
mod falling_film;
mod fick;
mod film;
mod heat_sources;
mod ledger;
mod low_utility;
mod packings;
mod pane;
mod plate;
mod properties;
mod slide;
mod two_slabs;
mod walls;

use crate::Case;
use crate::device::{gpu, rounding, rows};
use corpuscle_dew::solids::{Body, Material};
use corpuscle_dew::{Dew, Face, Room};
use corpuscle_model::{GpuModel, Model, ModelError};
use std::sync::atomic::AtomicBool;

pub(crate) const CASES: &[Case] = &[
    dew_point::DEW_POINT,
    two_slabs::TWO_SLABS,
    fick::FICK,
    film::FILM,
    packings::PACKINGS,
    properties::PROPERTIES,
    cavity::CAVITY,
    adiabatic::ADIABATIC,
    evaporation::EVAPORATION,
    falling_film::FALLING_FILM,
    heat_sources::HEAT_SOURCES,
    walls::WALLS,
    ledger::LEDGER,
    boundaries::BOUNDARIES,
    slide::SLIDE,
    breath_figures::BREATH_FIGURES,
    low_utility::CASE,
    pane::PANE,
    plate::PLATE,
];

/// Advances air to a time.
fn advance(dew: &mut Dew, time: f64) -> Result<(), ModelError> {
    dew.advance_to(time, &AtomicBool::new(false))
}

/// Air that is set up, on the GPU where one takes the steps.
fn ready(mut dew: Dew) -> Result<Dew, ModelError> {
    if let Some(gpu) = gpu() {
        dew.use_gpu(gpu)?;
    }
    Ok(dew)
}

/// The bound of relative errors in the ledger. The GPU books in single precision what it keeps as two numbers, the sum and what rounding
/// added to it: each amount is rounded to 6e-8 of itself.
fn ledger_rounding() -> f64 {
    rounding(1e-10, 1e-6)
}

/// Particles across a column, along y and along z.
const ACROSS: usize = 2;

/// Largest relative error of the balances of a run.
fn ledger_error(dew: &Dew) -> f64 {
    dew.ledger().balances.iter().map(|balance| balance.relative_error().abs()).fold(0.0, f64::max)
}

/// A column along x from 0 to `length` m of particles a `spacing` apart, periodic across, walled at its ends.
fn column(length: f64, spacing: f64) -> Room {
    let width = ACROSS as f64 * spacing;
    let periodic = [Face::Periodic; 2];
    Room { low: [0.0; 3], high: [length, width, width], faces: [[Face::Wall; 2], periodic, periodic] }
}

/// A slab of a [`column`], `from` so many layers on, so many `layers` thick.
fn slab(from: usize, layers: usize, spacing: f64, material: Material, temperature: f64, held: bool) -> Body {
    slab_across(ACROSS, from, layers, spacing, material, temperature, held)
}

/// The same of a column that is `across` particles wide.
fn slab_across(
    across: usize,
    from: usize,
    layers: usize,
    spacing: f64,
    material: Material,
    temperature: f64,
    held: bool,
) -> Body {
    let at = |index: usize| (index as f64 + 0.5) * spacing;
    let layer = |x: usize| (0..across * across).map(move |k| [at(x), at(k % across), at(k / across)]);
    let positions: Vec<_> = (from..from + layers).flat_map(layer).collect();
    let (volumes, areas) = (vec![spacing.powi(3); positions.len()], vec![spacing.powi(2); positions.len()]);
    Body { positions, volumes, areas, material, temperature, held, surface: None, walls: None }
}
