//! Vapour diffuses from moist air into dry.

use super::{advance, column, ready, rows};
use crate::{Case, Options, Row};
use corpuscle_dew::air::Properties;
use corpuscle_dew::humid_air::ZERO_CELSIUS;
use corpuscle_dew::{Dew, Settings, Setup};
use corpuscle_model::ModelError;
use corpuscle_scene::KernelName;
use statrs::function::erf::erfc;

pub(super) const FICK: Case = Case {
    name: "dew/fick",
    about: "Moist air beside dry air, 1 s later: twice the humidity over that at the start is erfc(x / (2 sqrt(D t))) in the \
            dry air, D = 2.5e-5 m2/s: 0.47950 at 5 mm and 0.15730 at 10 mm (Crank 1975, equation 2.14). With each smoothing kernel.",
    slow: false,
    reduced: 1.0,
    run: fick,
};

const SPACING: f64 = 1e-3;

fn fick(_: &Options) -> Vec<Row> {
    rows(FICK.name, measure())
}

fn measure() -> Result<Vec<Row>, ModelError> {
    let ([at_5_mm, at_10_mm], worst) = errors(KernelName::Mueller)?;
    let row = |measure, value| Row::at_most(FICK.name, measure, value, "", 5e-3);
    Ok(vec![
        row("error_at_5_mm", at_5_mm),
        row("error_at_10_mm", at_10_mm),
        row("largest_error", worst),
        row("largest_error_cubic_spline", errors(KernelName::CubicSpline)?.1),
        row("largest_error_wendland_c2", errors(KernelName::WendlandC2)?.1),
    ])
}

/// Errors of the humidity at 5 and 10 mm, and the largest of any particle.
fn errors(kernel: KernelName) -> Result<([f64; 2], f64), ModelError> {
    let temperature = ZERO_CELSIUS + 25.0;
    let (moist, half) = (0.01, 40.0 * SPACING);
    let air = Properties { vapour_diffusivity: 2.5e-5, ..Properties::at_room_temperature(0.05) };
    let settings = Settings { kernel, gravity: [0.0; 3], ..Settings::new(SPACING, temperature, 0.0) };
    let setup =
        Setup { settings, air, room: column(2.0 * half, SPACING), bodies: Vec::new(), fans: Vec::new(), seed: 1 };
    let mut dew = ready(Dew::new(&setup, |[x, ..]| [temperature, if x < half { moist } else { 0.0 }])?)?;
    advance(&mut dew, 1.0)?;
    let exact = |x: f64| erfc(x / (2.0 * (air.vapour_diffusivity * 1.0).sqrt()));
    let found: Vec<(f64, f64)> =
        dew.air().iter().map(|particle| (particle.position[0] - half, 2.0 * particle.vapour / moist)).collect();
    let worst = found.iter().map(|&(x, humidity)| (humidity - exact(x)).abs()).fold(0.0, f64::max);
    // Positions half way between two layers.
    let at = |position: f64| {
        let near: Vec<f64> =
            found.iter().filter(|(x, _)| (x - position).abs() < 0.6 * SPACING).map(|(_, humidity)| *humidity).collect();
        near.iter().sum::<f64>() / near.len() as f64
    };
    Ok(([(at(0.005) - 0.479_50).abs(), (at(0.010) - 0.157_30).abs()], worst))
}
