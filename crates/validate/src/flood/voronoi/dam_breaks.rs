//! Dam breaks with exact solutions.

use super::super::{GRAVITY, rows, strip};
use super::{Convergence, run, settings, worst};
use crate::device::{rounding, sized};
use crate::{Case, Options};
use corpuscle_flood::{Filling, StartWater, VoronoiFlood};
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::{Edge, Finer, Flood};
use corpuscle_terrain::{Bounds, Terrain};
use std::ops::Range;
use std::sync::Arc;

pub(in super::super) const STOKER: Case = Case {
    name: "flood/voronoi/stoker",
    about: "Dam break onto a wet bed (Stoker 1957) by scheme voronoi: 1000 m, 10 m against 1 m, 20 s, three seeds, spacings of 1, 2 and 4 m. \
            Peers: GeoClaw 5.14 of second order 1.1e-3 at 1 m and 4.2e-3 at 4 m, LISFLOOD-FP 8.1 FV1 3.2e-3 and 1.0e-2, \
            ANUGA 4.1 DE1 4.3e-4 on squares of 2 m of four triangles each. Bounds at 2 m and 4 m: GeoClaw and FV1 at 4 m.",
    slow: true,
    reduced: 2.0,
    run: stoker,
};

pub(in super::super) const RITTER: Case = Case {
    name: "flood/voronoi/ritter",
    about: "Dam break onto a dry bed (Ritter 1892) by scheme voronoi: 1000 m, 10 m of water, 20 s, three seeds, spacings of 1, 2 and 4 m. \
            Peers: GeoClaw 5.14 of second order 1.6e-3 at 1 m and 5.7e-3 at 4 m, LISFLOOD-FP 8.1 FV1 4.4e-3 and 1.2e-2, \
            ANUGA 4.1 DE1 5.8e-4 on squares of 2 m of four triangles each. Bounds at 2 m and 4 m: GeoClaw and FV1 at 4 m.",
    slow: true,
    reduced: 4.0,
    run: ritter,
};

pub(in super::super) const FINER: Case = Case {
    name: "flood/voronoi/finer",
    about: "The dam break of `flood/voronoi/stoker` with particles 4 m apart, and 1 m from 20 m above the dam on, three seeds: where cells are finer \
            the depth has less than half of the error, and it is none the worse elsewhere.",
    slow: true,
    reduced: 2.0,
    run: finer,
};

/// Length of the channel and position of the dam, m, depth above it, m, and time, s.
const LENGTH: f64 = 1000.0;
const DAM: f64 = 500.0;
const UPSTREAM: f64 = 10.0;
pub(in super::super) const TIME: f64 = 20.0;

/// Width of the channel in spacings; its long sides are joined.
pub(in super::super) const WIDTH: f64 = 8.0;

/// Lines along the channel on which depths are compared.
const LINES: usize = 8;

fn stoker(_: &Options) -> Vec<crate::Row> {
    let convergence = Convergence {
        case: STOKER.name,
        spacings: [
            (1.0, "relative_l1_error_1m", 8e-4),
            (2.0, "relative_l1_error_2m", 4.2e-3),
            (4.0, "relative_l1_error_4m", 1.0e-2),
        ],
        order: ("order", 0.95),
    };
    rows(STOKER.name, convergence.rows(|spacing, seed| Ok(error(&broken(TIME, spacing, seed, 1.0)?, spacing, 1.0))))
}

fn ritter(_: &Options) -> Vec<crate::Row> {
    let convergence = Convergence {
        case: RITTER.name,
        spacings: [
            (1.0, "relative_l1_error_1m", 8e-4),
            (2.0, "relative_l1_error_2m", 5.7e-3),
            (4.0, "relative_l1_error_4m", 1.2e-2),
        ],
        order: ("order", 0.95),
    };
    rows(RITTER.name, convergence.rows(|spacing, seed| Ok(error(&broken(TIME, spacing, seed, 0.0)?, spacing, 0.0))))
}

fn finer(_: &Options) -> Vec<crate::Row> {
    rows(FINER.name, measure_finer())
}

/// Errors of the depth below and above the dam, over those with all cells coarse.
fn measure_finer() -> Result<Vec<crate::Row>, ModelError> {
    let part = Finer {
        spacing_m: sized(1.0),
        polygon: Some(vec![[DAM - 20.0, -1.0], [LENGTH + 1.0, -1.0], [LENGTH + 1.0, 99.0], [DAM - 20.0, 99.0]]),
        ..Finer::default()
    };
    let [below, above, water] = worst(|seed| {
        let graded = dam(TIME, &Flood { finer: vec![part.clone()], ..even(4.0) }, seed, 4.0, 1.0)?;
        let coarse = dam(TIME, &even(4.0), seed, 4.0, 1.0)?;
        let of = |flood: &VoronoiFlood, range| error_within(flood, 4.0, 1.0, range);
        let (below, above) = (DAM as usize..LENGTH as usize, 0..DAM as usize);
        let water = graded.ledger().balances[0].relative_error().abs();
        let share = |range: Range<usize>| of(&graded, range.clone()) / of(&coarse, range);
        Ok([share(below), share(above), water])
    })?;
    let row = |measure, value, bound| crate::Row::at_most(FINER.name, measure, value, "", bound);
    Ok(vec![
        row("error_below_the_dam_over_coarse", below, 0.5),
        row("error_above_the_dam_over_coarse", above, 1.0),
        row("water_relative_error", water, rounding(1e-13, 1e-11)),
    ])
}

/// The dam break at a time, s.
pub(in super::super) fn broken(
    time: f64,
    spacing: f64,
    seed: u64,
    downstream: f64,
) -> Result<VoronoiFlood, ModelError> {
    dam(time, &even(spacing), seed, spacing, downstream)
}

/// Cells of one size.
fn even(spacing: f64) -> Flood {
    settings(spacing, 0.0, strip(&Edge::Wall))
}

/// The dam break at a time, s, in a channel [`WIDTH`] times `spacing` m wide.
fn dam(time: f64, settings: &Flood, seed: u64, spacing: f64, downstream: f64) -> Result<VoronoiFlood, ModelError> {
    let bounds = Bounds { x_min: 0.0, x_max: LENGTH, y_min: 0.0, y_max: WIDTH * spacing };
    let terrain = Arc::new(Terrain::analytic(bounds, spacing, |_, _| (0.0, [0.0; 2])));
    let pool = |depth: f64, from: f64, to: f64| StartWater {
        filling: Filling::Depth(Box::new(move |_, _| depth)),
        polygon: Some(vec![[from, -1.0], [to, -1.0], [to, bounds.y_max + 1.0], [from, bounds.y_max + 1.0]]),
        velocity: Box::new(|_, _| [0.0; 2]),
    };
    let mut water = vec![pool(UPSTREAM, -1.0, DAM)];
    if downstream > 0.0 {
        water.push(pool(downstream, DAM, LENGTH + 1.0));
    }
    run(settings, seed, &terrain, &water, time)
}

/// mean |h - h_exact| / mean h_exact on a uniform 1 m grid over the whole channel.
pub(in super::super) fn error(flood: &VoronoiFlood, spacing: f64, downstream: f64) -> f64 {
    error_within(flood, spacing, downstream, 0..LENGTH as usize)
}

/// The same between two positions along the channel, m.
fn error_within(flood: &VoronoiFlood, spacing: f64, downstream: f64, metres: Range<usize>) -> f64 {
    let (mut wrong, mut right) = (0.0, 0.0);
    for metre in metres {
        let x = metre as f64 + 0.5;
        let exact = exact_depth((x - DAM) / TIME, downstream);
        let depth = |line: usize| flood.sample(x, WIDTH * spacing * (line as f64 + 0.5) / LINES as f64).depth;
        right += exact;
        wrong += (0..LINES).map(|line| (depth(line) - exact).abs()).sum::<f64>() / LINES as f64;
    }
    wrong / right
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
