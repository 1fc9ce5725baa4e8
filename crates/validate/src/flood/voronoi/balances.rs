//! Volume, momentum and energy.

use super::super::rows;
use super::noise::squares;
use super::{advance, all_sides, run, set_up, settings, worst};
use crate::device::rounding;
use crate::{Case, Options, Row};
use corpuscle_flood::{Filling, StartWater, VoronoiFlood};
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::{
    Culvert, Edge, Edges, Flood, GreenAmpt, Infiltration, Inflow, Link, LinkLaw, Outflow, Rain, Series, Stage, Weir,
};
use corpuscle_terrain::{Bounds, Terrain};
use std::f64::consts::TAU;
use std::sync::Arc;

pub(in super::super) const MOMENTUM: Case = Case {
    name: "flood/voronoi/momentum",
    about: "Water 2 m deep with waves and whirls in a flat periodic box, and a column of water that falls onto dry ground there, 30 s by scheme \
            voronoi, three seeds: drift of momentum over the sum of its magnitudes. Peer: smoothed particles of fixed volumes 1.2e-2.",
    slow: false,
    reduced: 2.0,
    run: |_: &Options| rows(MOMENTUM.name, momentum()),
};

pub(in super::super) const LEDGER: Case = Case {
    name: "flood/voronoi/ledger",
    about: "A slope with rain, infiltration, an inflow, a culvert, a weir, an outflow by rating, a held level, a tide at its foot and an open \
            side, all at once for 300 s by scheme voronoi, three seeds: what is there must be what was there and came, less what went.",
    slow: false,
    reduced: 2.0,
    run: |_: &Options| rows(LEDGER.name, ledger()),
};

pub(in super::super) const ENERGY: Case = Case {
    name: "flood/voronoi/energy",
    about: "Closed water without friction by scheme voronoi, three seeds: a dam break across a box with walls onto dry ground, 60 s, and a lake \
            that sloshes on rough ground with islands, 120 s. Its energy must never be above that at the start; how far it rises from step to step is told beside.",
    slow: false,
    reduced: 2.0,
    run: |_: &Options| rows(ENERGY.name, energy()),
};

fn flat(bounds: Bounds) -> Arc<Terrain> {
    Arc::new(Terrain::analytic(bounds, 1.0, |_, _| (0.0, [0.0; 2])))
}

fn square(length: f64) -> Bounds {
    Bounds { x_min: 0.0, x_max: length, y_min: 0.0, y_max: length }
}

fn momentum() -> Result<Vec<Row>, ModelError> {
    let length = 40.0;
    let waves = |seed| {
        let k = TAU / length;
        let depth = move |x: f64, y: f64| 2.0 + 0.4 * (k * x).sin() * (k * y).cos();
        let velocity = move |x: f64, y: f64| [0.7 + 0.3 * (k * y).sin(), -0.2 + 0.3 * (2.0 * k * x).cos()];
        drift(length, seed, None, depth, velocity)
    };
    // An irregular column, so that its momentum does not cancel by symmetry.
    let column = vec![[8.0, 9.0], [27.0, 12.0], [24.0, 22.0], [13.0, 29.0]];
    let falls = |seed| drift(length, seed, Some(column.clone()), |_, _| 2.0, |_, _| [0.5, 0.2]);
    let [waves] = worst(|seed| waves(seed).map(|drift| [drift]))?;
    let [falls] = worst(|seed| falls(seed).map(|drift| [drift]))?;
    Ok(vec![
        Row::at_most(MOMENTUM.name, "drift_of_waves", waves, "", rounding(1e-12, 1e-6)),
        Row::beside(
            MOMENTUM.name,
            "drift_with_dry_fronts",
            falls,
            "",
            1e-12,
            "water thinner than 1e-6 m gives momentum up",
        ),
    ])
}

/// Change of the momentum in 30 s over the sum of its magnitudes at the start and at the end.
fn drift(
    length: f64,
    seed: u64,
    polygon: Option<Vec<[f64; 2]>>,
    depth: impl Fn(f64, f64) -> f64 + Sync,
    velocity: impl Fn(f64, f64) -> [f64; 2] + Sync,
) -> Result<f64, ModelError> {
    let water = StartWater { filling: Filling::Depth(Box::new(depth)), polygon, velocity: Box::new(velocity) };
    let settings = settings(1.0, 0.0, all_sides(&Edge::Periodic));
    let mut flood = set_up(&settings, seed, &flat(square(length)), &[water])?;
    let sums = |flood: &VoronoiFlood| {
        flood.wet_cells().fold(([0.0; 2], 0.0), |(sum, size): ([f64; 2], f64), cell| {
            let volume = cell.area * cell.depth;
            let [p, q] = cell.velocity.map(|velocity| volume * velocity);
            ([sum[0] + p, sum[1] + q], size + p.hypot(q))
        })
    };
    let (before, size) = sums(&flood);
    advance(&mut flood, 30.0)?;
    let (after, size_after) = sums(&flood);
    Ok((after[0] - before[0]).hypot(after[1] - before[1]) / (size + size_after))
}

fn ledger() -> Result<Vec<Row>, ModelError> {
    let found = worst(|seed| {
        let flood = everything(seed)?;
        let water = &flood.ledger().balances[0];
        let rain = gauge(&flood, "water", "total_rain");
        let soaked = gauge(&flood, "water", "total_infiltration");
        let culvert = gauge(&flood, "culvert", "discharge");
        // Those that must not be too small change their sign.
        Ok([water.relative_error().abs(), rain - water.inflow, soaked - water.outflow, -soaked, -culvert])
    })?;
    let [error, inflow, outflow, soaked, culvert] = found;
    let at_least = |measure, value: f64, unit, bound| Row::at_least(LEDGER.name, measure, -value, unit, bound);
    Ok(vec![
        Row::at_most(LEDGER.name, "water_relative_error", error, "", rounding(1e-13, 1e-11)),
        at_least("inflow_besides_rain", inflow, "m3", 50.0),
        at_least("outflow_besides_infiltration", outflow, "m3", 50.0),
        at_least("infiltration", soaked, "m3", 10.0),
        at_least("discharge_of_culvert", culvert, "m3/s", 1e-3),
    ])
}

fn gauge(flood: &VoronoiFlood, name: &str, quantity: &str) -> f64 {
    let columns = flood.gauge_columns();
    let column = columns.iter().position(|column| column.gauge == name && column.quantity == quantity);
    column.map_or(f64::NAN, |column| flood.gauge_row()[column])
}

/// A slope on which all that brings and takes water does so.
fn everything(seed: u64) -> Result<VoronoiFlood, ModelError> {
    let bounds = Bounds { x_min: 0.0, x_max: 100.0, y_min: 0.0, y_max: 50.0 };
    let rough = squares(4.0, 3);
    let terrain = Arc::new(Terrain::gridded(bounds, 2.0, move |x, y| -0.01 * x + 0.05 * rough(x, y)));
    let tide = Series::Table(vec![[0.0, -0.8], [150.0, -0.6], [300.0, -0.9]]);
    let edges = Edges { west: Edge::Wall, east: Edge::Stage(tide), south: Edge::Open, north: Edge::Wall };
    let ground = GreenAmpt { conductivity_mm_per_h: 20.0, suction_m: 0.1, deficit: 0.3 };
    let culvert = Culvert {
        diameter_m: Some(0.5),
        width_m: None,
        height_m: None,
        length_m: None,
        floor_m: None,
        manning: 0.013,
        entrance_loss: 0.5,
        barrels: 1,
    };
    let link = |name: &str, from, to, law| Link { name: name.into(), from, to, both_ways: true, law };
    let settings = Flood {
        rain: Some(Rain { intensity_mm_per_h: Series::Constant(200.0), raster: None }),
        infiltration: Some(Infiltration::GreenAmpt(ground)),
        inflow: vec![Inflow {
            name: "spring".into(),
            at: Some([20.0, 25.0]),
            line: None,
            discharge_m3_per_s: Series::Constant(0.2),
            velocity_m_per_s: [0.1, 0.0],
        }],
        outflow: vec![Outflow {
            name: "pump".into(),
            at: Some([70.0, 40.0]),
            line: None,
            polygon: None,
            rating: vec![[-0.75, 0.0], [-0.65, 0.1]],
        }],
        stage: vec![Stage {
            name: "pond".into(),
            line: None,
            polygon: Some(vec![[45.0, 5.0], [55.0, 5.0], [55.0, 15.0], [45.0, 15.0]]),
            level_m: Series::Constant(-0.35),
        }],
        link: vec![
            link(
                "weir",
                [30.0, 25.0],
                [60.0, 25.0],
                LinkLaw::Weir(Weir { crest_m: -0.29, width_m: 1.0, coefficient: 1.7 }),
            ),
            link("culvert", [22.0, 25.0], [80.0, 30.0], LinkLaw::Culvert(culvert)),
        ],
        ..settings(2.0, 0.03, edges)
    };
    run(&settings, seed, &terrain, &[], 300.0)
}

fn energy() -> Result<Vec<Row>, ModelError> {
    let broken = worst(|seed| {
        let bounds = square(40.0);
        let dam = vec![[-1.0, -1.0], [17.0, -1.0], [9.0, 41.0], [-1.0, 41.0]];
        let water = StartWater {
            filling: Filling::Depth(Box::new(|_, _| 2.0)),
            polygon: Some(dam),
            velocity: Box::new(|_, _| [0.0; 2]),
        };
        rises(&flat(bounds), seed, &water, 60.0)
    })?;
    let sloshing = worst(|seed| {
        let bounds = square(60.0);
        let [hills, rough] = [squares(12.0, 21), squares(3.0, 22)];
        let terrain = Terrain::gridded(bounds, 3.0, |x, y| 1.5 * hills(x, y) + 0.7 * rough(x, y));
        let water = StartWater {
            filling: Filling::Level(Box::new(|x, y| {
                0.8 + 0.5 * (TAU * x / 120.0).cos() + 0.2 * (TAU * y / 60.0).cos()
            })),
            polygon: None,
            velocity: Box::new(|_, _| [0.0; 2]),
        };
        rises(&Arc::new(terrain), seed, &water, 120.0)
    })?;
    let within = "cells count by their means; what waves hold within them comes back where they turn round";
    let highest = |measure, value| Row::at_most(ENERGY.name, measure, value, "", 0.0);
    let rise = |measure, value| Row::beside(ENERGY.name, measure, value, "", 0.0, within);
    Ok(vec![
        highest("highest_energy_of_dam_break", broken[0]),
        rise("largest_rise_of_dam_break", broken[1]),
        highest("highest_energy_of_sloshing", sloshing[0]),
        rise("largest_rise_of_sloshing", sloshing[1]),
    ])
}

/// Highest energy after any step less that at the start, and farthest that it rises above the lowest before, both over what is lost by the end.
fn rises(terrain: &Arc<Terrain>, seed: u64, water: &StartWater, time: f64) -> Result<[f64; 2], ModelError> {
    let settings = settings(1.0, 0.0, all_sides(&Edge::Wall));
    let mut flood = set_up(&settings, seed, terrain, std::slice::from_ref(water))?;
    let energy = |flood: &VoronoiFlood| flood.energy(0.0).iter().sum::<f64>();
    let start = energy(&flood);
    let (mut highest, mut lowest, mut rise, mut at) = (f64::NEG_INFINITY, start, f64::NEG_INFINITY, 0.0);
    while at < time {
        // Less than a step: no step goes unseen.
        at += 0.9 * flood.time_step();
        advance(&mut flood, at)?;
        let now = energy(&flood);
        highest = highest.max(now);
        rise = rise.max(now - lowest);
        lowest = lowest.min(now);
    }
    let lost = start - energy(&flood);
    Ok([(highest - start) / lost, rise / lost])
}
