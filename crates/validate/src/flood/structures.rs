//! Outflows by rating, weirs, and water held at a level.

use super::device::water_rounding;
use super::{rows, run, settings, strip, water_everywhere};
use crate::{Case, Row};
use corpuscle_flood::{Flood, InitialWater};
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::{Edge, Edges, Flood as Settings, Link, LinkLaw, Manning, Outflow, Series, Weir};
use corpuscle_terrain::{Bounds, Terrain};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

pub(super) const STRUCTURES: Case = Case {
    name: "flood/structures",
    about: "What a weir (Poleni, Villemonte 1947) leads from one pool to another in 120 s, and what an outflow takes by its rating in \
            200 s, against their equations solved by small steps.",
    slow: false,
    reduced: 2.0,
    run: |_| rows(STRUCTURES.name, structures()),
};

pub(super) const TIDE: Case = Case {
    name: "flood/tide",
    about: "A basin 60 m long, open to a tide of 0.3 m about a depth of 1.5 m with a period of 400 s, long beside the 31 s that a wave \
            takes there and back: the level in it is that of the tide. Two periods.",
    slow: false,
    reduced: 2.0,
    run: |_| rows(TIDE.name, tide()),
};

fn structures() -> Result<Vec<Row>, ModelError> {
    let weir = Weir { crest_m: 1.0, width_m: 2.0, coefficient: 1.705 };
    let link = Link {
        name: "weir".into(),
        from: [15.0, 15.0],
        to: [50.0, 15.0],
        both_ways: true,
        law: LinkLaw::Weir(weir.clone()),
    };
    let before = [1.6, 0.8];
    let over = |upper: f64, lower: f64| {
        let (head, behind) = ((upper - weir.crest_m).max(0.0), (lower - weir.crest_m).max(0.0));
        weir.coefficient * weir.width_m * head.powf(1.5) * (1.0 - (behind / head).powf(1.5)).powf(0.385)
    };
    let led = passed(before, 120.0, |settings| settings.link = vec![link], over)?;
    let outflow = Outflow {
        name: "sluice".into(),
        at: None,
        line: Some(vec![[20.0, 2.0], [20.0, 28.0]]),
        polygon: None,
        rating: vec![[0.0, 0.0], [2.0, 4.0]],
    };
    let taken = passed([1.5, 0.0], 200.0, |settings| settings.outflow = vec![outflow], |level, _| 2.0 * level)?;
    let row = |measure, value| Row::at_most(STRUCTURES.name, measure, value, "", 0.05);
    Ok(vec![row("relative_error_of_weir", led), row("relative_error_of_outflow", taken)])
}

/// How far what has left the first of two pools of 30 m by 30 m after `time` s is from what `discharge` of the two levels gives.
fn passed(
    depths: [f64; 2],
    time: f64,
    change: impl FnOnce(&mut Settings),
    discharge: impl Fn(f64, f64) -> f64,
) -> Result<f64, ModelError> {
    let bounds = Bounds { x_min: 0.0, x_max: 66.0, y_min: 0.0, y_max: 30.0 };
    let bank = Terrain::gridded(bounds, 0.5, |x, _| if (30.0..36.0).contains(&x) { 5.0 } else { 0.0 });
    let walls = Edges { west: Edge::Wall, east: Edge::Wall, south: Edge::Wall, north: Edge::Wall };
    let mut settings = settings(time, 1.5, 1.0, walls);
    change(&mut settings);
    let pool = |depth: f64, from: f64| InitialWater {
        depth: Box::new(move |_, _| depth),
        inside: Box::new(move |x, _| (from..from + 30.0).contains(&x)),
        within: Bounds { x_min: from, x_max: from + 30.0, ..bounds },
        velocity: Box::new(|_, _| [0.0; 2]),
    };
    let water: Vec<_> = depths.into_iter().zip([0.0, 36.0]).filter(|(depth, _)| *depth > 0.0).collect();
    let water: Vec<_> = water.into_iter().map(|(depth, from)| pool(depth, from)).collect();
    let mut flood = run(&settings, &Arc::new(bank), &water, 0.0)?;
    let volume = |flood: &Flood, side: fn(f64) -> bool| -> f64 {
        flood.particles().iter().filter(|particle| side(particle.x)).map(|particle| particle.volume).sum()
    };
    let start = [volume(&flood, |x| x < 33.0), volume(&flood, |x| x >= 33.0)];
    flood.advance_to(time, &AtomicBool::new(false))?;
    let [mut first, mut second] = start;
    let steps = 10_000;
    for _ in 0..steps {
        let out = discharge(first / 900.0, second / 900.0) * time / f64::from(steps);
        (first, second) = (first - out, second + out);
    }
    Ok(((start[0] - volume(&flood, |x| x < 33.0)) / (start[0] - first) - 1.0).abs())
}

fn tide() -> Result<Vec<Row>, ModelError> {
    let (length, width, period) = (60.0, 20.0, 400.0);
    let bounds = Bounds { x_min: 0.0, x_max: length, y_min: 0.0, y_max: width };
    let terrain = Arc::new(Terrain::analytic(bounds, 1.0, |_, _| (0.0, [0.0; 2])));
    let level = |time: f64| 1.5 + 0.3 * (std::f64::consts::TAU * time / period).sin();
    let series = (0..=200).map(|k| 4.0 * f64::from(k)).map(|time| [time, level(time)]).collect();
    let edges = Edges { west: Edge::Wall, east: Edge::Stage(Series::Table(series)), ..strip(&Edge::Wall) };
    let settings = Settings { manning: Manning::Number(0.05), ..settings(2.0 * period, 1.5, 1.5, edges) };
    let water = water_everywhere(bounds, |_, _| 1.5, |_, _| [0.0; 2]);
    let mut flood = run(&settings, &terrain, &[water], 0.0)?;
    let looks = 80;
    let mut squares = 0.0;
    for look in 1..=looks {
        let time = 2.0 * period * f64::from(look) / f64::from(looks);
        flood.advance_to(time, &AtomicBool::new(false))?;
        let depths = (0..20).map(|k| flood.sample(5.0 + f64::from(k % 5) * 10.0, 2.5 + f64::from(k / 5) * 5.0).depth);
        squares += (depths.sum::<f64>() / 20.0 - level(time)).powi(2);
    }
    let rmse = (squares / f64::from(looks)).sqrt();
    let water = flood.ledger().balances[0].relative_error().abs();
    Ok(vec![
        Row::at_most(TIDE.name, "rmse_of_level", rmse, "m", 0.03),
        Row::at_most(TIDE.name, "water_relative_error", water, "", water_rounding()),
    ])
}
