//! Air that conducts better where it is warm.

use super::packings::{ALL, GAP, Gap, LAYERS};
use super::{ledger_rounding, rows};
use crate::device::{is_reduced, reduced};
use crate::{Case, Options, Row};
use corpuscle_dew::air::{Properties, transport};
use corpuscle_dew::humid_air::{HumidAir, ZERO_CELSIUS};
use corpuscle_model::ModelError;

pub(super) const PROPERTIES: Case = Case {
    name: "dew/properties",
    about: "Air at 80 kPa whose conductivity and diffusivity are those of its temperature, between plates at 5 and 45 °C, settled, stirred or at random, \
            at three spacings: heat, integral of k dT / L (Carslaw & Jaeger 1959, section 1.6), and vapour, dY / integral of dx / (rho D), by the laws of the \
            U.S. Standard Atmosphere (1976) and of Massman (1998). Water and energy balance.",
    slow: false,
    reduced: 2.0,
    run: properties,
};

/// Largest relative error.
const BOUND: f64 = 0.005;

/// Parts of integrals over temperature (the midpoint rule: its error is far below that of the model).
const PARTS: usize = 1000;

fn properties(_: &Options) -> Vec<Row> {
    rows(PROPERTIES.name, measure())
}

/// Integral from the cold plate's temperature to the warm one's.
fn integral([cold, warm]: [f64; 2], of: impl Fn(f64) -> f64) -> f64 {
    let part = (warm - cold) / PARTS as f64;
    (0..PARTS).map(|k| of(cold + (k as f64 + 0.5) * part)).sum::<f64>() * part
}

/// Heat, W/m2, and vapour, kg/(m2 s), from plate to plate, where the air conducts and diffuses like this at a temperature.
fn fluxes(gap: &Gap, conductivity: impl Fn(f64) -> f64, diffused: impl Fn(f64) -> f64) -> [f64; 2] {
    let conducted = integral(gap.plates, &conductivity);
    let resistance = integral(gap.plates, |kelvin| conductivity(kelvin) / diffused(kelvin)) * GAP / conducted;
    let [least, most] = gap.saturated();
    [conducted / GAP, (most - least) / resistance]
}

fn measure() -> Result<Vec<Row>, ModelError> {
    // The air's properties are given at the warm plate, so that those of the cold one are far from them.
    let plates = [5.0, 45.0].map(|celsius| ZERO_CELSIUS + celsius);
    let pressure = 80_000.0;
    let ambient = HumidAir::with_relative_humidity(plates[1], pressure, 0.0);
    let gap = Gap { air: Properties::of(&ambient, 0.05), plates, measured: [4.0, 5.5] };
    // The density of the air times the diffusivity: the first goes as 1/T.
    let diffused =
        |kelvin: f64| ambient.density() * plates[1] / kelvin * transport::vapour_diffusivity(kelvin, pressure);
    let exact = fluxes(&gap, transport::conductivity, diffused);
    // The order is that of the model, whose properties are straight lines.
    let air = gap.air;
    let of_lines =
        fluxes(&gap, |kelvin| air.conductivity_at(kelvin), |kelvin| air.density * air.vapour_diffusivity_at(kelvin));
    let mut rows = Vec::new();
    let mut balance = 0.0_f64;
    let mut sums = [[0.0; 3]; 2];
    for &(name, packing) in reduced(&ALL) {
        for (k, &layers) in reduced(&LAYERS).iter().enumerate() {
            let found = [gap.heat_flux(packing, layers)?, gap.vapour_flux(packing, layers)?];
            for (what, [flux, unbalanced]) in found.into_iter().enumerate() {
                balance = balance.max(unbalanced);
                let error = (flux / exact[what] - 1.0).abs();
                sums[what][k] += (flux / of_lines[what] - 1.0).abs();
                let measure = format!("{}_error_{name}_{layers}", ["heat", "vapour"][what]);
                rows.push(Row::at_most(PROPERTIES.name, &measure, error, "", BOUND));
            }
        }
    }
    for (what, sums) in ["heat", "vapour"].into_iter().zip(sums).filter(|_| !is_reduced()) {
        let order = (sums[0] / sums[2]).ln() / (LAYERS[2] as f64 / LAYERS[0] as f64).ln();
        rows.push(Row::at_least(PROPERTIES.name, &format!("{what}_order"), order, "", 0.5));
    }
    rows.push(Row::at_most(PROPERTIES.name, "water_and_energy_error", balance, "", ledger_rounding()));
    Ok(rows)
}
