//! A basin open to a tide.

use super::super::device::water_rounding;
use super::super::{rows, strip};
use super::{advance, set_up, settings, worst};
use crate::{Case, Options, Row};
use corpuscle_flood::{Filling, StartWater};
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::{Edge, Edges, Series};
use corpuscle_terrain::{Bounds, Terrain};
use std::f64::consts::TAU;
use std::sync::Arc;

pub(in super::super) const TIDE: Case = Case {
    name: "flood/voronoi/tide",
    about: "A basin 60 m long, open to a tide of 0.3 m about a depth of 1.5 m with a period of 400 s by scheme voronoi, three seeds: the level in it \
            follows the tide, and exactly as much comes in and goes out as it holds. Long waves of small height (Lamb 1932, section 185): the level at x \
            from the wall is cos(k x) / cos(k l) times the tide, within 0.8 % here. Two periods.",
    slow: false,
    reduced: 2.0,
    run: |_: &Options| rows(TIDE.name, measure()),
};

const LENGTH: f64 = 60.0;
const WIDTH: f64 = 20.0;
const PERIOD: f64 = 400.0;
const SAMPLES: u32 = 80;

fn measure() -> Result<Vec<Row>, ModelError> {
    let [rmse, water] = worst(of_seed)?;
    Ok(vec![
        Row::at_most(TIDE.name, "rmse_of_level", rmse, "m", 0.03),
        Row::at_most(TIDE.name, "water_relative_error", water, "", water_rounding()),
    ])
}

fn of_seed(seed: u64) -> Result<[f64; 2], ModelError> {
    let bounds = Bounds { x_min: 0.0, x_max: LENGTH, y_min: 0.0, y_max: WIDTH };
    let terrain = Arc::new(Terrain::analytic(bounds, 1.0, |_, _| (0.0, [0.0; 2])));
    let level = |time: f64| 1.5 + 0.3 * (TAU * time / PERIOD).sin();
    let series = (0..=200).map(|k| 4.0 * f64::from(k)).map(|time| [time, level(time)]).collect();
    let edges = Edges { west: Edge::Wall, east: Edge::Stage(Series::Table(series)), ..strip(&Edge::Wall) };
    let water = StartWater {
        filling: Filling::Level(Box::new(|_, _| 1.5)),
        polygon: None,
        velocity: Box::new(|_, _| [0.0; 2]),
    };
    let mut flood = set_up(&settings(1.5, 0.05, edges), seed, &terrain, &[water])?;
    let mut squares = 0.0;
    for sample in 1..=SAMPLES {
        let time = 2.0 * PERIOD * f64::from(sample) / f64::from(SAMPLES);
        advance(&mut flood, time)?;
        let depths = (0..20).map(|k| flood.sample(5.0 + f64::from(k % 5) * 10.0, 2.5 + f64::from(k / 5) * 5.0).depth);
        squares += (depths.sum::<f64>() / 20.0 - level(time)).powi(2);
    }
    Ok([(squares / f64::from(SAMPLES)).sqrt(), flood.ledger().balances[0].relative_error().abs()])
}
