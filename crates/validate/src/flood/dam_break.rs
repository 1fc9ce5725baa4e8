//! Dam breaks with exact solutions.

use super::{GRAVITY, order, rows, run, settings, strip};
use crate::{Case, Options, Row};
use corpuscle_flood::{Flood, InitialWater};
use corpuscle_model::{Chart, ChartAxis, ChartSeries, ChartStyle, ModelError};
use corpuscle_scene::{Edge, Flood as Settings, Refinement};
use corpuscle_terrain::{Bounds, Terrain};
use std::sync::Arc;

pub(super) const STOKER: Case = Case {
    name: "flood/stoker",
    about: "Dam break onto a wet bed (Stoker 1957): 1000 m, 10 m against 1 m, 20 s; particles of equal volume. Bound: \
            first-order finite volumes at the same spacing (LISFLOOD-FP 8.1 FV1: 3.2e-3 at 1 m, 1.0e-2 at 4 m).",
    slow: true,
    reduced: 2.0,
    run: stoker,
};

pub(super) const RITTER: Case = Case {
    name: "flood/ritter",
    about: "Dam break onto a dry bed (Ritter 1892): 1000 m, 10 m of water, 20 s; particles of equal volume. Bound: \
            first-order finite volumes at the same spacing (LISFLOOD-FP 8.1 FV1: 4.4e-3 at 1 m, 1.2e-2 at 4 m).",
    slow: true,
    reduced: 2.0,
    run: ritter,
};

pub(super) const LENGTH: f64 = 1000.0;
pub(super) const DAM: f64 = 500.0;
pub(super) const UPSTREAM: f64 = 10.0;
pub(super) const TIME: f64 = 20.0;

/// Width of the channel in spacings; its long sides are joined.
pub(super) const WIDTH: f64 = 14.0;

fn stoker(options: &Options) -> Vec<Row> {
    rows(STOKER.name, measure(STOKER.name, 1.0, [3.2e-3, 1.0e-2], options))
}

fn ritter(options: &Options) -> Vec<Row> {
    rows(RITTER.name, measure(RITTER.name, 0.0, [4.4e-3, 1.2e-2], options))
}

fn measure(case: &'static str, downstream: f64, bounds: [f64; 2], options: &Options) -> Result<Vec<Row>, ModelError> {
    let coarse = run_to_end(4.0, downstream, None)?;
    options.draw(profile(&coarse, 4.0, downstream));
    let [fine, coarse] = [error(&run_to_end(1.0, downstream, None)?, 1.0, downstream), error(&coarse, 4.0, downstream)];
    Ok(vec![
        Row::at_most(case, "relative_l1_error_1m", fine, "", bounds[0]),
        Row::at_most(case, "relative_l1_error_4m", coarse, "", bounds[1]),
        // Halved, or nearly, when the spacing is quartered.
        Row::at_least(case, "order", order(fine, coarse, 4.0), "", 0.45),
    ])
}

/// The dam break at its end.
pub(super) fn run_to_end(spacing: f64, downstream: f64, refinement: Option<Refinement>) -> Result<Flood, ModelError> {
    run_until(TIME, spacing, downstream, refinement)
}

/// The dam break at a time, s.
pub(super) fn run_until(
    time: f64,
    spacing: f64,
    downstream: f64,
    refinement: Option<Refinement>,
) -> Result<Flood, ModelError> {
    let bounds = Bounds { x_min: 0.0, x_max: LENGTH, y_min: 0.0, y_max: WIDTH * spacing };
    let terrain = Arc::new(Terrain::analytic(bounds, spacing, |_, _| (0.0, [0.0; 2])));
    let pool = |depth: f64, from: f64, to: f64| InitialWater {
        depth: Box::new(move |_, _| depth),
        inside: Box::new(move |x, _| (from..to).contains(&x)),
        within: Bounds { x_min: from, x_max: to, ..bounds },
        velocity: Box::new(|_, _| [0.0; 2]),
    };
    let mut water = vec![pool(UPSTREAM, 0.0, DAM)];
    if downstream > 0.0 {
        water.push(pool(downstream, DAM, LENGTH));
    }
    let settings = Settings { refinement, ..settings(TIME, spacing, UPSTREAM, strip(&Edge::Wall)) };
    run(&settings, &terrain, &water, time)
}

/// mean |h - h_exact| / mean h_exact on a uniform 1 m grid over the whole channel.
pub(super) fn error(flood: &Flood, spacing: f64, downstream: f64) -> f64 {
    let width = WIDTH * spacing;
    let lines = 7;
    let (mut wrong, mut right) = (0.0, 0.0);
    for metre in 0..LENGTH as usize {
        let x = metre as f64 + 0.5;
        let exact = exact_depth((x - DAM) / TIME, downstream);
        right += exact;
        let off = |line: usize| (flood.sample(x, width * (line as f64 + 0.5) / lines as f64).depth - exact).abs();
        wrong += (0..lines).map(off).sum::<f64>() / lines as f64;
    }
    wrong / right
}

/// The depth along the middle of the channel over the exact one.
fn profile(flood: &Flood, spacing: f64, downstream: f64) -> Chart {
    let series = |name: &str, style, depth: &dyn Fn(f64) -> f64| ChartSeries {
        name: name.into(),
        style,
        points: (0..LENGTH as usize / 2).map(|k| 2.0 * k as f64 + 1.0).map(|x| [x, depth(x)]).collect(),
        ..ChartSeries::default()
    };
    let axis = |label: &str| ChartAxis { label: label.into(), unit: "m".into(), logarithmic: false };
    Chart {
        name: "profile".into(),
        title: format!("Depth {TIME:.0} s after the dam broke, particles {spacing:.0} m apart"),
        x: axis("Distance"),
        y: axis("Depth"),
        series: vec![
            series("computed", ChartStyle::Line, &|x| flood.sample(x, 7.0 * spacing).depth),
            series("exact", ChartStyle::Dashes, &|x| exact_depth((x - DAM) / TIME, downstream)),
        ],
        note: String::new(),
    }
}

/// Depth at x/t = `ray` from the dam: Ritter's parabola for a dry bed, Stoker's plateau and bore for a wet one.
pub(super) fn exact_depth(ray: f64, downstream: f64) -> f64 {
    let wave = (GRAVITY * UPSTREAM).sqrt();
    let parabola = || (2.0 * wave - ray).powi(2) / (9.0 * GRAVITY);
    if ray < -wave {
        return UPSTREAM;
    }
    if downstream == 0.0 {
        return if ray < 2.0 * wave { parabola() } else { 0.0 };
    }
    // The plateau's depth joins the rarefaction's invariant u + 2c to the bore's jump conditions; by bisection.
    let behind_rarefaction = |depth: f64| 2.0 * (wave - (GRAVITY * depth).sqrt());
    let behind_bore =
        |depth: f64| (depth - downstream) * (0.5 * GRAVITY * (depth + downstream) / (depth * downstream)).sqrt();
    let (mut low, mut high) = (downstream, UPSTREAM);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if behind_rarefaction(middle) > behind_bore(middle) { low = middle } else { high = middle }
    }
    let (plateau, speed) = (low, behind_bore(low));
    let bore = speed * plateau / (plateau - downstream);
    if ray < speed - (GRAVITY * plateau).sqrt() {
        parabola()
    } else if ray < bore {
        plateau
    } else {
        downstream
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exact_solution_holds_the_water_and_the_known_plateau() {
        for downstream in [0.0, 1.0] {
            let cells = 200_000;
            let dx = LENGTH / f64::from(cells);
            let depth = |k: i32| exact_depth(((f64::from(k) + 0.5) * dx - DAM) / TIME, downstream);
            let volume: f64 = (0..cells).map(|k| depth(k) * dx).sum();
            let before = DAM * (UPSTREAM + downstream);
            assert!((volume - before).abs() < 1e-3 * before, "{volume} {before}");
        }
        assert!((exact_depth(1e-9, 0.0) - 4.0 / 9.0 * UPSTREAM).abs() < 1e-6);
        assert!((exact_depth(5.0, 1.0) - 3.9617).abs() < 1e-3);
    }
}
