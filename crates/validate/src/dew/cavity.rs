//! Natural convection in a heated square cavity.

use super::{advance, gpu, ledger_rounding, ready, rows};
use crate::{Case, Options, Row};
use corpuscle_dew::air::Properties;
use corpuscle_dew::humid_air::ZERO_CELSIUS;
use corpuscle_dew::solids::{Body, Material};
use corpuscle_dew::{Dew, Face, Room, Scatter, Settings, Setup};
use corpuscle_model::{Model, ModelError};
use rayon::prelude::*;

pub(super) const CAVITY: Case = Case {
    name: "dew/cavity",
    about: "Air in a square cavity between a warm and a cold wall, floor and ceiling insulated, from rest and off any lattice: the heat that passes over \
            that by conduction (Nu), against de Vahl Davis (1983, table 4: 1.118, 2.243, 4.519 at Ra 1e3, 1e4, 1e5), with time_factor 1 and 20. \
            Water and energy balance.",
    slow: true,
    reduced: 1.0,
    run: cavity,
};

/// Rayleigh numbers, and Nusselt numbers by de Vahl Davis.
const KNOWN: [(f64, f64, &str); 3] = [(1e3, 1.118, "1e3"), (1e4, 2.243, "1e4"), (1e5, 4.519, "1e5")];

/// Particles across the cavity.
const ACROSS: [usize; 3] = [20, 28, 40];

/// The same where a GPU is compared with the CPU.
const FEW: [usize; 1] = [12];

/// Largest relative error of Nu at the finest spacing, and at coarser ones.
const BOUND: f64 = 0.01;
const COARSE: f64 = 0.08;

/// Largest relative change of Nu by the time factor.
const ALIKE: f64 = 0.005;

/// Layers of walls, and particles along the third axis, which is periodic.
const WALL: usize = 3;
const DEEP: usize = 4;

/// Difference of temperatures of the walls, K.
const CONTRAST: f64 = 10.0;
const MEAN: f64 = ZERO_CELSIUS + 20.0;
const GRAVITY: f64 = 9.81;

/// At one temperature up to its surface, and passing no heat at all.
const PERFECT: Material = Material { conductivity: 1e9, heat_capacity: 1000.0, density: 1000.0 };
const INSULATOR: Material = Material { conductivity: 1e-12, heat_capacity: 1000.0, density: 1000.0 };

fn air(sound: f64) -> Properties {
    // Pr = 0.71.
    let air = Properties::at_room_temperature(sound);
    Properties { viscosity: 0.71 * air.heat_diffusivity(), ..air }
}

/// Side of the cavity with a Rayleigh number g dT L^3 / (T nu alpha), m.
fn side(rayleigh: f64) -> f64 {
    let air = air(1.0);
    (rayleigh * air.viscosity * air.heat_diffusivity() * MEAN / (GRAVITY * CONTRAST)).cbrt()
}

/// Particles of the walls whose positions, in spacings from the cavity's corner, satisfy `belongs`.
fn wall(
    count: usize,
    spacing: f64,
    material: Material,
    temperature: f64,
    held: bool,
    belongs: impl Fn(i64, i64) -> bool,
) -> Body {
    let layers = WALL as i64;
    let along = -layers..count as i64 + layers;
    let columns = along.clone().flat_map(|x| along.clone().map(move |z| (x, z))).filter(|(x, z)| belongs(*x, *z));
    let at = |k: i64| (k as f64 + 0.5) * spacing;
    let positions: Vec<_> = columns.flat_map(|(x, z)| (0..DEEP as i64).map(move |y| [at(x), at(y), at(z)])).collect();
    let (volumes, areas) = (vec![spacing.powi(3); positions.len()], vec![spacing.powi(2); positions.len()]);
    Body { positions, volumes, areas, material, temperature, held, surface: None, walls: None }
}

/// A cavity with so many particles across, warm on the left.
fn set_up(rayleigh: f64, count: usize, time_factor: f64, seed: u64) -> Result<Dew, ModelError> {
    let length = side(rayleigh);
    let spacing = length / count as f64;
    // Ten times the fastest that air goes there: 3.7, 19.6, 68.6 of the diffusive speed (de Vahl Davis).
    let fastest = air(1.0).heat_diffusivity() / length * 0.217 * rayleigh.sqrt();
    let inside = 0..count as i64;
    let end = count as i64;
    let held = |temperature: f64, belongs: &dyn Fn(i64) -> bool| {
        wall(count, spacing, PERFECT, temperature, true, |x, z| belongs(x) && inside.contains(&z))
    };
    let bodies = vec![
        held(MEAN + 0.5 * CONTRAST, &|x| x < 0),
        held(MEAN - 0.5 * CONTRAST, &|x| x >= end),
        wall(count, spacing, INSULATOR, MEAN, false, |_, z| z < 0),
        wall(count, spacing, INSULATOR, MEAN, false, |_, z| z >= end),
    ];
    let beyond = WALL as f64 * spacing;
    let room = Room {
        low: [-beyond, 0.0, -beyond],
        high: [length + beyond, DEEP as f64 * spacing, length + beyond],
        faces: [[Face::Wall; 2], [Face::Periodic; 2], [Face::Wall; 2]],
    };
    let settings =
        Settings { gravity: [0.0, 0.0, -GRAVITY], fog: false, time_factor, ..Settings::new(spacing, MEAN, 0.0) };
    let start = |_| [MEAN, 0.0];
    let setup = Setup { settings, air: air(10.0 * fastest), room, bodies, fans: Vec::new(), seed };
    let mut dew = Dew::new(&setup, start)?;
    dew.scatter(Scatter { reach: 0.5, sweeps: 15, seed }, start);
    Ok(dew)
}

/// Nu: the heat that passes from wall to wall over that by conduction, as a mean over some time once it is steady; and the error of the balances.
fn nusselt(rayleigh: f64, count: usize, time_factor: f64, seed: u64) -> Result<[f64; 2], ModelError> {
    let mut dew = ready(set_up(rayleigh, count, time_factor, seed)?)?;
    let air = air(1.0);
    let length = side(rayleigh);
    let crossing = length * length / air.heat_diffusivity();
    // Boundary layers form within some L^2 / (alpha Ra^(1/2)), the core within L^2 / alpha over Ra^(1/4) (Patterson & Imberger 1980).
    let settled = 4.0 * crossing / rayleigh.powf(0.25);
    advance(&mut dew, settled)?;
    let given = |dew: &Dew| 0.5 * (dew.heat_from(0) - dew.heat_from(1));
    let (before, from) = (given(&dew), dew.stepped_until());
    advance(&mut dew, 1.5 * settled)?;
    let time = dew.stepped_until() - from;
    let flow = (given(&dew) - before) / (time_factor * time);
    let deep = DEEP as f64 * length / count as f64;
    let conducted = air.conductivity * CONTRAST / length * (deep * length);
    let errors = dew.ledger().balances.into_iter().map(|balance| balance.relative_error().abs());
    Ok([flow / conducted, errors.fold(0.0, f64::max)])
}

fn cavity(options: &Options) -> Vec<Row> {
    rows(CAVITY.name, measure(options))
}

/// A cavity by its Rayleigh number and particles across, with a time factor.
type Run = (f64, usize, f64);

fn measure(options: &Options) -> Result<Vec<Row>, ModelError> {
    let known = if options.reduced { &KNOWN[..1] } else { &KNOWN[..] };
    let across = if options.reduced { &FEW[..] } else { &ACROSS[..] };
    // With the factor 20 at the spacing in the middle.
    let middle = across[across.len() / 2];
    let of_one =
        |rayleigh: f64| across.iter().map(move |count| (rayleigh, *count, 1.0)).chain([(rayleigh, middle, 20.0)]);
    let runs: Vec<Run> = known.iter().flat_map(|(rayleigh, ..)| of_one(*rayleigh)).collect();
    let run = |(rayleigh, count, factor): &Run| nusselt(*rayleigh, *count, *factor, 1);
    // So few particles give no work to several threads; several cavities do.
    let found: Vec<[f64; 2]> = if gpu().is_some() {
        runs.iter().map(run).collect::<Result<_, _>>()?
    } else {
        runs.par_iter().map(run).collect::<Result<_, _>>()?
    };
    let mut rows = Vec::new();
    for ((_, exact, name), found) in known.iter().zip(found.chunks(across.len() + 1)) {
        let errors: Vec<f64> = found.iter().map(|[nu, _]| (nu / exact - 1.0).abs()).collect();
        for (count, error) in across.iter().zip(&errors) {
            let measure = format!("nusselt_error_{name}_{count}");
            let bound = if *count == ACROSS[2] { BOUND } else { COARSE };
            rows.push(Row::at_most(CAVITY.name, &measure, *error, "", bound));
        }
        let [of_middle, accelerated] = [found[across.len() / 2][0], found[across.len()][0]];
        let error = (accelerated / exact - 1.0).abs();
        rows.push(Row::at_most(CAVITY.name, &format!("nusselt_error_{name}_{middle}_accelerated"), error, "", COARSE));
        if !options.reduced {
            let changed = (accelerated / of_middle - 1.0).abs();
            rows.push(Row::at_most(CAVITY.name, &format!("change_by_time_factor_{name}"), changed, "", ALIKE));
        }
        if let ([coarse, _, fine, _], true) = (&errors[..], across.len() == 3) {
            let order = (coarse / fine).ln() / (across[2] as f64 / across[0] as f64).ln();
            rows.push(Row::beside(
                CAVITY.name,
                &format!("order_{name}"),
                order,
                "",
                1.0,
                "what is left at the walls falls with the spacing",
            ));
        }
    }
    let balance = found.iter().map(|[_, balance]| *balance).fold(0.0, f64::max);
    rows.push(Row::at_most(CAVITY.name, "water_and_energy_error", balance, "", ledger_rounding()));
    Ok(rows)
}
