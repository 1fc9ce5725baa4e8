//! A thin wet plate in a stream of dry air.

use super::{advance, gpu, ledger_rounding, ready, rows};
use crate::device::reduction;
use crate::{Case, Options, Row};
use corpuscle_dew::air::Properties;
use corpuscle_dew::humid_air::{HumidAir, ZERO_CELSIUS};
use corpuscle_dew::solids::{Body, Material};
use corpuscle_dew::{Dew, Face, Inflow, Room, Scatter, Settings, Setup};
use corpuscle_model::{Model, ModelError};
use rayon::prelude::*;

pub(super) const PLATE: Case = Case {
    name: "dew/plate",
    about: "Dry air streams along a thin wet plate, from air that stands off any lattice: the water that leaves the plate between 15 and 35 mm from its edge, against \
            the laminar boundary layer (Blasius 1908; Pohlhausen 1921: Sh_x = 0.282 Re_x^(1/2) at Sc 0.628), at three spacings and two speeds. Water and \
            energy balance.",
    slow: true,
    reduced: 4.0,
    run: plate,
};

/// Spacings, m, and the speed of the stream at all three and at the one in the middle, m/s.
const SPACINGS: [f64; 3] = [1.25e-3, 1e-3, 0.8e-3];
const SPEED: f64 = 0.25;
const FASTER: f64 = 0.35;

/// The same where a GPU is compared with the CPU.
const WIDE: [f64; 1] = [2.5e-3];
const OF_FEW: f64 = 0.5;

/// Largest relative error of the Sherwood number; before the outlet at the finest spacing and at coarser ones.
const BOUND: f64 = 0.03;
const BEFORE_OUTLET: [f64; 2] = [0.03, 0.08];

/// From the inlet to the plate, the plate, and from it to the smooth wall above, m: far, lest the stream becomes much faster between them.
const BEFORE: f64 = 0.025;
const LENGTH: f64 = 0.05;
const HEIGHT: f64 = 0.1;

/// Where the water that leaves is measured, m from the plate's edge: far from the side where air leaves, and before that side, which is at the plate's end.
const MEASURED: [[f64; 2]; 2] = [[0.015, 0.035], [0.035, 0.045]];

/// When the boundary layer is steady, and until when it is measured, over the time in which air crosses the box.
const STEADY: f64 = 1.5;
const UNTIL: f64 = 2.7;

/// Particles along the third axis, which is periodic.
const DEEP: usize = 2;

const TEMPERATURE: f64 = ZERO_CELSIUS + 20.0;

/// At one temperature up to its surface.
const PERFECT: Material = Material { conductivity: 1e9, heat_capacity: 1000.0, density: 1000.0 };

/// f''(0) of Blasius' equation f''' + f f'' / 2 = 0 with f'(infinity) = 1 (Blasius 1908; digits: Boyd, Experimental Mathematics 8, 1999, 381).
const BLASIUS: f64 = 0.332_057_336_215_196;

/// Sh_x / Re_x^(1/2) at a plate: 1 / (integral of exp(-Sc/2 (integral of f)) over eta) (Pohlhausen 1921).
fn sherwood_over_root(schmidt: f64) -> f64 {
    const STEP: f64 = 1e-3;
    // f, f', f'', the integral of f, and the integral sought.
    let slope = |[f, df, ddf, below, _]: [f64; 5]| [df, ddf, -0.5 * f * ddf, f, (-0.5 * schmidt * below).exp()];
    let mut state = [0.0, 0.0, BLASIUS, 0.0, 0.0];
    for _ in 0..12_000 {
        let first = slope(state);
        let middle = slope(std::array::from_fn(|k| state[k] + 0.5 * STEP * first[k]));
        state = std::array::from_fn(|k| state[k] + STEP * middle[k]);
    }
    1.0 / state[4]
}

fn air(speed: f64) -> Properties {
    Properties::at_room_temperature(10.0 * speed)
}

/// Part of the mass that is vapour in saturated air.
fn saturated(air: &Properties) -> f64 {
    HumidAir::with_relative_humidity(TEMPERATURE, air.pressure, 1.0).mass_fraction()
}

/// Mean rate at which water leaves a part of the plate, kg/(m2 s).
fn exact(speed: f64, [from, to]: [f64; 2]) -> f64 {
    let air = air(speed);
    let mean_root = 2.0 * (to.sqrt() - from.sqrt()) / (to - from);
    let sherwood = sherwood_over_root(air.viscosity / air.vapour_diffusivity);
    air.density * air.vapour_diffusivity * saturated(&air) * sherwood * (speed / air.viscosity).sqrt() * mean_root
}

/// A plate two particles thick, whose lower half is the mirror image beyond the floor, with the stream above it.
fn set_up(speed: f64, spacing: f64, seed: u64) -> Result<Dew, ModelError> {
    let count = |length: f64| (length / spacing).round() as usize;
    let at = |index: usize| (index as f64 + 0.5) * spacing;
    let [first, along] = [BEFORE, LENGTH].map(count);
    let positions: Vec<_> =
        (first..first + along).flat_map(|x| (0..DEEP).map(move |y| [at(x), at(y), at(0)])).collect();
    let (volumes, areas) = (vec![spacing.powi(3); positions.len()], vec![spacing.powi(2); positions.len()]);
    let plate = Body {
        positions,
        volumes,
        areas,
        material: PERFECT,
        temperature: TEMPERATURE,
        held: true,
        surface: None,
        walls: None,
    };
    let inflow = Inflow { velocity: [speed, 0.0, 0.0], temperature: TEMPERATURE, vapour: 0.0 };
    let room = Room {
        low: [0.0; 3],
        high: [first + along, DEEP, count(HEIGHT)].map(|count| count as f64 * spacing),
        faces: [[Face::Inlet(inflow), Face::Outlet], [Face::Periodic; 2], [Face::Wall; 2]],
    };
    let settings = Settings { gravity: [0.0; 3], fog: false, ..Settings::new(spacing, TEMPERATURE, 0.0) };
    let start = |_| [TEMPERATURE, 0.0];
    let setup = Setup { settings, air: air(speed), room, bodies: vec![plate], fans: Vec::new(), seed };
    let mut dew = Dew::new(&setup, start)?;
    dew.scatter(Scatter { reach: 0.5, sweeps: 15, seed }, start);
    dew.stir(|_| [speed, 0.0, 0.0]);
    dew.wet(0, 1.0);
    Ok(dew)
}

/// Water on a part of the plate, kg/m2.
fn water(dew: &Dew, [from, to]: [f64; 2]) -> f64 {
    let solids = dew.solids().particles.iter().zip(dew.water_on_solids());
    let measured = |x: f64| (from..to).contains(&(x - BEFORE));
    let [water, area] = solids
        .filter(|(particle, _)| measured(particle.position[0]))
        .fold([0.0; 2], |[water, area], (particle, on)| [water + on, area + particle.area]);
    water / area
}

/// The Sherwood numbers of the measured parts over the exact ones, and the error of the balances.
fn sherwood(speed: f64, spacing: f64, seed: u64) -> Result<[f64; 3], ModelError> {
    let mut dew = ready(set_up(speed, spacing, seed)?)?;
    let crossing = (BEFORE + LENGTH) / speed;
    advance(&mut dew, STEADY / reduction() * crossing)?;
    let (before, from) = (MEASURED.map(|part| water(&dew, part)), dew.stepped_until());
    advance(&mut dew, UNTIL / reduction() * crossing)?;
    let time = dew.stepped_until() - from;
    let [far, near] = [0, 1].map(|k| (before[k] - water(&dew, MEASURED[k])) / time / exact(speed, MEASURED[k]));
    let errors = dew.ledger().balances.into_iter().map(|balance| balance.relative_error().abs());
    Ok([far, near, errors.fold(0.0, f64::max)])
}

fn plate(options: &Options) -> Vec<Row> {
    rows(PLATE.name, measure(options))
}

fn measure(options: &Options) -> Result<Vec<Row>, ModelError> {
    let spacings = if options.reduced { &WIDE[..] } else { &SPACINGS[..] };
    let middle = spacings[spacings.len() / 2];
    let faster = (!options.reduced).then_some([FASTER, middle]);
    let runs: Vec<[f64; 2]> = spacings.iter().map(|&spacing| [SPEED, spacing]).chain(faster).collect();
    let run = |&[speed, spacing]: &[f64; 2]| sherwood(speed, spacing, 1);
    let found: Vec<[f64; 3]> = if gpu().is_some() {
        runs.iter().map(run).collect::<Result<_, _>>()?
    } else {
        runs.par_iter().map(run).collect::<Result<_, _>>()?
    };
    let errors: Vec<f64> = found.iter().map(|[ratio, ..]| (ratio - 1.0).abs()).collect();
    let mut rows = Vec::new();
    for ([speed, spacing], [far, near, _]) in runs.iter().zip(&found) {
        let row = |part: &str, ratio: &f64, bound: f64| {
            let measure = format!("sherwood_error{part}_{speed}_m_per_s_{}_mm", spacing * 1e3);
            Row::at_most(PLATE.name, &measure, (ratio - 1.0).abs(), "", bound)
        };
        if options.reduced {
            // So coarse, the part before the outlet is four particles long.
            rows.push(row("", far, OF_FEW));
            continue;
        }
        rows.push(row("", far, BOUND));
        let coarse = usize::from(*spacing != SPACINGS[2]);
        rows.push(row("_before_outlet", near, BEFORE_OUTLET[coarse]));
    }
    if let [coarse, _, fine, _] = errors[..] {
        let order = (coarse / fine).ln() / (SPACINGS[0] / SPACINGS[2]).ln();
        let why =
            "2 % at each spacing: the air at the layer's edge is 5 % faster than it came in, and the layer is thicker";
        rows.push(Row::beside(PLATE.name, "order", order, "", 1.0, why));
    }
    let balance = found.iter().map(|[.., balance]| *balance).fold(0.0, f64::max);
    rows.push(Row::at_most(PLATE.name, "water_and_energy_error", balance, "", ledger_rounding()));
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sherwood_numbers_are_those_of_the_tables() {
        // Schlichting, Boundary-Layer Theory, 7th edition, table 12.1.
        for (schmidt, known) in [(0.6, 0.276), (0.7, 0.293), (1.0, 0.332), (7.0, 0.645)] {
            let found = sherwood_over_root(schmidt);
            assert!((found - known).abs() < 0.0015, "{found} for {known} at {schmidt}");
        }
    }
}
