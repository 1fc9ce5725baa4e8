//! A dam break over a triangular sill in a channel (CADAM).

use super::measured::{Watched, root_mean_square, table};
use super::{SEED, rows, settings};
use crate::{Case, Options, Row};
use corpuscle_flood::{Flood, InitialWater};
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::{Edge, Edges, Flood as Settings, Gauge, Manning};
use corpuscle_terrain::{Bounds, Terrain};
use std::path::Path;
use std::sync::Arc;

pub(super) const TRIANGULAR_OBSTACLE: Case = Case {
    name: "flood/triangular-obstacle",
    about: "A dam break over a triangular sill (CADAM; Hiver 2000): channel of 38 m, 0.75 m of water in the first 15.5 m, \
            a sill 0.4 m high from 25.5 to 31.5 m and a pool of 0.15 m behind it, n 0.0125; depths 4, 10, 13 and 20 m \
            below the dam over 40 s.",
    slow: true,
    run: triangular_obstacle,
};

const LENGTH: f64 = 38.0;
const WIDTH: f64 = 0.75;
const DAM: f64 = 15.5;
const CREST: f64 = 28.5;
const TIME: f64 = 40.0;

/// Distance of particles in the reservoir, m.
const SPACING: f64 = 0.05;

/// Time between looks, s.
const LOOK: f64 = 0.02;

/// Water has arrived at this depth, m: the least in the measured series.
const ARRIVED: f64 = 0.01;

/// A gauge: how far below the dam, m, whether it starts dry, and what its measures are called.
struct Place {
    below: f64,
    file: &'static str,
    depth: &'static str,
    arrival: Option<&'static str>,
}

const PLACES: [Place; 4] = [
    Place { below: 4.0, file: "G4", depth: "depth_rmse_G4", arrival: Some("arrival_error_G4") },
    Place { below: 10.0, file: "G10", depth: "depth_rmse_G10", arrival: Some("arrival_error_G10") },
    Place { below: 13.0, file: "G13", depth: "depth_rmse_G13", arrival: Some("arrival_error_G13") },
    Place { below: 20.0, file: "G20", depth: "depth_rmse_G20", arrival: None },
];

fn triangular_obstacle(options: &Options) -> Vec<Row> {
    match &options.data {
        None => vec![Row::without_data(TRIANGULAR_OBSTACLE.name, options)],
        Some(data) => rows(TRIANGULAR_OBSTACLE.name, measure(&data.join("triangular_obstacle"))),
    }
}

/// Height of the bed and its slope: flat but for the sill, 3 m up and 3 m down.
fn bed(x: f64) -> (f64, [f64; 2]) {
    let height = 0.4 * (1.0 - (x - CREST).abs() / 3.0);
    if height > 0.0 { (height, [0.4 / 3.0 * (CREST - x).signum(), 0.0]) } else { (0.0, [0.0; 2]) }
}

fn measure(folder: &Path) -> Result<Vec<Row>, ModelError> {
    let bounds = Bounds { x_min: 0.0, x_max: LENGTH, y_min: 0.0, y_max: WIDTH };
    let terrain = Arc::new(Terrain::analytic(bounds, SPACING, |x, _| bed(x)));
    let water = |level: f64, from: f64, to: f64| InitialWater {
        depth: Box::new(move |x, _| level - bed(x).0),
        inside: Box::new(move |x, _| (from..to).contains(&x)),
        within: Bounds { x_min: from, x_max: to, ..bounds },
        velocity: Box::new(|_, _| [0.0; 2]),
    };
    let bodies = [water(0.75, 0.0, DAM), water(0.15, CREST, LENGTH)];
    let mut flood = Flood::with_water(&channel(), SEED, folder, terrain, &bodies)?;
    let seen = Watched::run(&mut flood, TIME, LOOK)?;
    let mut out = Vec::new();
    for (gauge, place) in PLACES.iter().enumerate() {
        let measured = depths(&folder.join(format!("{}_Experimental.csv", place.file)))?;
        let pairs = measured.iter().map(|&[time, depth]| [seen.at(time, 4 * gauge), depth]);
        out.push(Row::at_most(TRIANGULAR_OBSTACLE.name, place.depth, root_mean_square(pairs), "m", 0.05));
        if let Some(name) = place.arrival {
            let first = measured.iter().map(|[time, _]| *time).fold(f64::INFINITY, f64::min);
            let error = (seen.first(4 * gauge, ARRIVED) - first).abs();
            out.push(Row::at_most(TRIANGULAR_OBSTACLE.name, name, error, "s", 0.3));
        }
    }
    let water = flood.ledger().balances[0].relative_error().abs();
    out.push(Row::at_most(TRIANGULAR_OBSTACLE.name, "water_relative_error", water, "", 1e-12));
    Ok(out)
}

/// The channel, closed at both ends: behind the sill the measured water stays as high as its crest.
fn channel() -> Settings {
    let edges = Edges { west: Edge::Wall, east: Edge::Wall, south: Edge::Wall, north: Edge::Wall };
    let mut settings = settings(TIME, SPACING, 0.75, edges);
    settings.manning = Manning::Number(0.0125);
    settings.map_every_s = Some(TIME);
    settings.wet_depth_m = 1e-3;
    let gauge =
        |place: &Place| Gauge { name: place.file.into(), at: Some([DAM + place.below, 0.5 * WIDTH]), lon_lat: None };
    settings.gauge = PLACES.iter().map(gauge).collect();
    settings
}

/// Time, s, and depth, m, as digitised: in no order, with empty lines.
fn depths(path: &Path) -> Result<Vec<[f64; 2]>, ModelError> {
    let rows = table(path, 1)?;
    Ok(rows.iter().filter_map(|row| Some([row[0]?, (*row.get(1)?)?])).collect())
}
