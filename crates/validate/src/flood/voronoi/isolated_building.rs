//! A dam break against an oblique building in a flume (Soares-Frazao & Zech 2007).

use super::super::device::water_rounding;
use super::super::measured::{Watched, root_mean_square, table};
use super::measured::{of_data, pool};
use super::{set_up, settings};
use crate::{Case, Options, Row};
use corpuscle_flood::VoronoiFlood;
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::{Edge, Edges, Flood, Gauge, Obstacle};
use corpuscle_terrain::{Bounds, Terrain};
use std::path::Path;
use std::sync::Arc;

pub(in super::super) const ISOLATED_BUILDING: Case = Case {
    name: "flood/voronoi/isolated-building",
    about: "A dam break against an oblique building (Soares-Frazao & Zech, J. Hydraul. Res. 45 extra issue, 2007, 27) by scheme voronoi, three seeds, particles \
            0.12 m apart: flume of 35.8 m x 3.6 m, 0.4 m of water behind the gate, 0.02 m before it, n 0.01; depths at six gauges over 30 s, velocities at \
            five.",
    slow: true,
    reduced: 3.0,
    run: |options: &Options| of_data(ISOLATED_BUILDING.name, "isolated_building", options, of_seed),
};

const LENGTH: f64 = 35.8;
const WIDTH: f64 = 3.6;
const TIME: f64 = 30.0;

/// Distance of particles, m.
const SPACING: f64 = 0.12;

/// Interval of the samples, s.
const SAMPLE_PERIOD: f64 = 0.05;

/// Depth of the bed: flat but for a slope along each side.
fn bed(_: f64, y: f64) -> f64 {
    let from_side = y.min(WIDTH - y);
    (0.155 / 0.34 * (0.34 - from_side)).max(0.0)
}

fn of_seed(folder: &Path, seed: u64, options: &Options) -> Result<Vec<Row>, ModelError> {
    let bounds = Bounds { x_min: 0.0, x_max: LENGTH, y_min: 0.0, y_max: WIDTH };
    let terrain = Arc::new(Terrain::gridded(bounds, 0.02, bed));
    let water = [pool(0.4, [-1.0, 6.75], bounds), pool(0.02, [6.75, LENGTH + 1.0], bounds)];
    compare(&mut set_up(&flume(folder)?, seed, &terrain, &water)?, folder, options)
}

/// Runs the flood and compares it with the measurements.
fn compare(flood: &mut VoronoiFlood, folder: &Path, options: &Options) -> Result<Vec<Row>, ModelError> {
    let case = ISOLATED_BUILDING.name;
    let depths = table(&folder.join("building_gauges_h.txt"), 2)?;
    let velocities = table(&folder.join("building_gauges_uv.txt"), 2)?;
    let seen = Watched::run(flood, TIME, SAMPLE_PERIOD)?;
    let at = |time: f64, column: usize| seen.at(time, column);
    let mut out = Vec::new();
    for gauge in 0..6 {
        let measured = depths.iter().filter_map(|row| Some([row[0]?, row[gauge + 1]?])).collect();
        options.draw(seen.chart(4 * gauge, &format!("G{}", gauge + 1), "Depth", "m", measured));
        let pairs = depths.iter().filter_map(|row| Some([at(row[0]?, 4 * gauge), row[gauge + 1]?]));
        let name =
            ["depth_rmse_G1", "depth_rmse_G2", "depth_rmse_G3", "depth_rmse_G4", "depth_rmse_G5", "depth_rmse_G6"];
        out.push(Row::at_most(case, name[gauge], root_mean_square(pairs), "m", 0.04));
    }
    for gauge in 0..5 {
        let of = |axis: usize| {
            let (column, at) = (1 + 2 * gauge + axis, &at);
            velocities.iter().filter_map(move |row| Some([at(row[0]?, 4 * gauge + 2 + axis), (*row.get(column)?)?]))
        };
        for (axis, component) in ["Velocity along the flume", "Velocity across the flume"].into_iter().enumerate() {
            let column = 1 + 2 * gauge + axis;
            let measured = velocities.iter().filter_map(|row| Some([row[0]?, (*row.get(column)?)?])).collect();
            options.draw(seen.chart(4 * gauge + 2 + axis, &format!("G{}", gauge + 1), component, "m/s", measured));
        }
        let both = root_mean_square(of(0)).hypot(root_mean_square(of(1)));
        let measured = |axis: usize| root_mean_square(of(axis).map(|[_, measured]| [measured, 0.0]));
        let fast = measured(0).hypot(measured(1));
        let name =
            ["velocity_rmse_G1", "velocity_rmse_G2", "velocity_rmse_G3", "velocity_rmse_G4", "velocity_rmse_G5"][gauge];
        out.push(Row::beside(case, name, both, "m/s", fast, "beside it the measured velocity's own root mean square"));
    }
    let water = flood.ledger().balances[0].relative_error().abs();
    out.push(Row::at_most(case, "water_relative_error", water, "", water_rounding()));
    Ok(out)
}

/// The flume with its gate's walls, the building and its gauges.
fn flume(folder: &Path) -> Result<Flood, ModelError> {
    let edges = Edges { west: Edge::Wall, east: Edge::Open, south: Edge::Wall, north: Edge::Wall };
    let mut settings = settings(SPACING, 0.01, edges);
    let obstacle = |name: &str| Obstacle {
        name: name.into(),
        file: Some(folder.join(name).with_extension("csv")),
        ..Obstacle::default()
    };
    settings.obstacle = ["dam_1", "dam_2", "building"].map(obstacle).into();
    let positions = table(&folder.join("point_gauges.csv"), 1)?;
    let gauge = |(number, position): (usize, &Vec<Option<f64>>)| {
        let at = Some([position[0].unwrap_or(0.0), position[1].unwrap_or(0.0)]);
        Gauge { name: format!("G{}", number + 1), at, lon_lat: None }
    };
    settings.gauge = positions.iter().take(6).enumerate().map(gauge).collect();
    Ok(settings)
}
