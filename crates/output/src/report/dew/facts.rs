//! Numbers in the report of dew.

use crate::picture::{number, time as clock};
use crate::report::parts::{KeyFigure, how_it_ended};
use crate::{GaugeTable, Summary};
use corpuscle_scene::Dew;

/// A time of the scene.
pub(super) fn time(value: f64) -> String {
    format!("{} s", number(value))
}

/// The key figures.
pub(super) fn key_figures(table: &GaugeTable, summary: &Summary, dew: &Dew) -> Vec<KeyFigure> {
    let last = |header: &str| table.column(header).and_then(|values| values.last().copied()).unwrap_or(f64::NAN);
    let first = last("drops.first_at_s");
    let figure = |label, value: String, remark: &str| KeyFigure { label, value, remark: remark.into() };
    let whole = |value: f64| number(value).trim_end_matches(".0").to_owned();
    let mut figures = vec![
        figure("First drop", if first.is_finite() { time(first) } else { "none".into() }, "after the start"),
        figure("Drops", whole(last("drops.number")), "at the end"),
        figure("Largest drop", format!("{} mm", number(1e3 * last("drops.largest_radius_m"))), "radius, at the end"),
        figure("Covered", format!("{} mm²", number(1e6 * last("solids.covered_area_m2"))), "by drops, at the end"),
        figure("On the solids", format!("{} mg", number(1e6 * last("water.on_solids_kg"))), "water, at the end"),
    ];
    // Of the solid that fogged first, and of the one that cleared last.
    let times = |quantity: &str| -> Vec<(&str, f64)> {
        let all = dew.solid.iter().map(|solid| (solid.name.as_str(), last(&format!("{}.{quantity}", solid.name))));
        all.filter(|(_, at)| at.is_finite()).collect()
    };
    if let Some((name, at)) = times("fogged_at_s").into_iter().min_by(|a, b| a.1.total_cmp(&b.1)) {
        figures.push(figure("Fogged", time(at), &format!("{name}, a tenth covered")));
    }
    if let Some((name, at)) = times("clear_at_s").into_iter().max_by(|a, b| a.1.total_cmp(&b.1)) {
        let took = last(&format!("{name}.time_to_clear_s"));
        figures.push(figure("Clear again", time(at), &format!("{name}, {} after it was wettest", time(took))));
    }
    if let Some(water) = summary.ledger.get("water_kg") {
        figures.push(figure("Water error", number(water.relative_error.abs()), "relative"));
    }
    figures
}

/// Names and values of the facts of the run.
pub(super) fn run_facts(dew: &Dew, summary: &Summary) -> Vec<(&'static str, String)> {
    let size: Vec<String> = dew.size_m.iter().map(|length| number(1e3 * length)).collect();
    let rate = summary.particle_steps_per_s.unwrap_or(0.0);
    vec![
        ("Model", summary.model.clone()),
        ("Box", format!("{} mm", size.join(" × "))),
        ("Spacing", format!("{} mm", number(1e3 * dew.spacing_m))),
        ("Time factor", number(dew.time_factor)),
        ("Simulated time", format!("{} ({})", time(summary.simulated_time_s), how_it_ended(summary))),
        ("Particles", number(summary.particles as f64).replace(".0", "")),
        ("Steps", number(summary.steps as f64).replace(".0", "")),
        (
            "Computed in",
            format!("{} on {}, {} particle-steps/s", clock(summary.wall_time_s), summary.backend, number(rate)),
        ),
        ("Corpuscle", format!("version {}", summary.version)),
    ]
}
