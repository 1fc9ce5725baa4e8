//! The dew point against its formula worked out by hand and against tables.

use super::rows;
use crate::device::refuse_on_gpu;
use crate::{Case, Options, Row};
use corpuscle_dew::humid_air::{ZERO_CELSIUS, dew_point_of};
use corpuscle_model::ModelError;

pub(super) const DEW_POINT: Case = Case {
    name: "dew/dew-point",
    about: "The dew point of air at seven temperatures and humidities: Magnus' formula with Bolton's constants to its printed digits, \
            and PsychroLib 2.5.0 beside it.",
    slow: false,
    reduced: 1.0,
    run: dew_point,
};

/// Air temperature in °C, relative humidity, dew point by the formula as printed in °C, and by PsychroLib 2.5.0 in °C
/// (`GetTDewPointFromRelHum`, SI units; after ASHRAE's equations 5 and 6).
const VALUES: [[f64; 4]; 7] = [
    [20.0, 0.5, 9.2701, 9.272_392],
    [20.0, 0.7, 14.3673, 14.367_081],
    [25.0, 0.3, 6.2368, 6.238_119],
    [25.0, 0.5, 13.8676, 13.863_973],
    [25.0, 0.8, 21.3125, 21.309_397],
    [30.0, 0.6, 21.3985, 21.387_990],
    [35.0, 0.4, 19.4072, 19.384_649],
];

fn dew_point(_: &Options) -> Vec<Row> {
    rows(DEW_POINT.name, measure())
}

fn measure() -> Result<Vec<Row>, ModelError> {
    refuse_on_gpu("the CPU's own formula of the dew point")?;
    let worst = |column: usize| {
        let miss = |row: &[f64; 4]| (dew_point_of(row[0] + ZERO_CELSIUS, row[1]) - ZERO_CELSIUS - row[column]).abs();
        VALUES.iter().map(miss).fold(0.0, f64::max)
    };
    let row = |measure, value, bound| Row::at_most(DEW_POINT.name, measure, value, "K", bound);
    Ok(vec![row("max_error_of_printed_values", worst(2), 1e-4), row("max_difference_to_psychrolib", worst(3), 0.03)])
}
