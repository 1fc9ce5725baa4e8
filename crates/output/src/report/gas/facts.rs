//! Numbers in the report of a gas.

use super::GasReport;
use crate::Summary;
use crate::picture::{number, time as clock};
use crate::report::parts::{KeyFigure, how_it_ended};
use corpuscle_scene::{Gas, Method, Units};

/// A time of the scene: with its unit where it has one.
pub(super) fn time(gas: &Gas, value: f64) -> String {
    let text = number(value);
    // Often whole: 10, not 10.0.
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if gas.units == Units::Si { format!("{text} s") } else { text.to_owned() }
}

/// The key figures.
pub(super) fn key_figures(report: &GasReport<'_>, summary: &Summary) -> Vec<KeyFigure> {
    let gas = report.gas;
    let whole = |value: f64| number(value).trim_end_matches(".0").to_owned();
    let collisions = summary.collisions.unwrap_or(summary.steps) as f64;
    let mut figures = vec![
        KeyFigure {
            label: "Balls",
            value: whole(summary.particles as f64),
            remark: format!("in {} dimensions", gas.dimensions()),
        },
        KeyFigure {
            label: "Collisions",
            value: whole(collisions),
            remark: format!("{} per ball", number(2.0 * collisions / summary.particles.max(1) as f64)),
        },
        KeyFigure {
            label: "Rate",
            value: format!("{}/s", number(collisions / summary.wall_time_s)),
            remark: "collisions, over the whole run with its output".into(),
        },
    ];
    if let Some((name, energy)) = summary.ledger.iter().find(|(name, _)| name.starts_with("energy")) {
        let unit = name.strip_prefix("energy").unwrap_or("").trim_start_matches('_');
        figures.push(KeyFigure {
            label: "Energy error",
            value: number(energy.relative_error.abs()),
            remark: format!("relative; at the end {} {unit}", number(energy.end)),
        });
    }
    let columns = report.model.gauge_columns();
    let row = report.model.gauge_row();
    for (quantity, label) in [("temperature", "Temperature"), ("pressure", "Pressure")] {
        let found = columns.iter().zip(&row).find(|(column, value)| {
            column.gauge == "gas" && column.quantity.starts_with(quantity) && value.is_finite()
        });
        if let Some((column, value)) = found {
            let unit = column.unit.replace("_per_", "/");
            figures.push(KeyFigure { label, value: format!("{} {unit}", number(*value)), remark: "at the end".into() });
        }
    }
    figures
}

/// Names and values of the facts of the run.
pub(super) fn run_facts(gas: &Gas, summary: &Summary) -> Vec<(&'static str, String)> {
    let method = match gas.method {
        Method::EventDriven => "event driven (cells and an event queue)".to_owned(),
        Method::List => "event driven (the published list of nearest events)".to_owned(),
        Method::FixedStep { time_step_s } => format!("equal steps of {}, all pairs", time(gas, time_step_s)),
    };
    let unit = if gas.units == Units::Si { " m" } else { "" };
    let size: Vec<String> = gas.size.iter().map(|length| number(*length)).collect();
    vec![
        ("Model", format!("{}, {method}", summary.model)),
        ("Units", if gas.units == Units::Si { "SI" } else { "reduced: Boltzmann's constant is 1" }.into()),
        ("Box", format!("{}{unit}", size.join(" × "))),
        ("Simulated time", format!("{} ({})", time(gas, summary.simulated_time_s), how_it_ended(summary))),
        ("Balls", number(summary.particles as f64).replace(".0", "")),
        ("Computed in", format!("{} on {}", clock(summary.wall_time_s), summary.backend)),
        ("Corpuscle", format!("version {}", summary.version)),
    ]
}
