//! The valley below a failing dam of the Environment Agency's benchmark of flood models.

use super::super::device::water_rounding;
use super::super::measured::{Watched, table};
use super::measured::of_data;
use super::{set_up, settings};
use crate::{Case, Options, Row};
use corpuscle_flood::VoronoiFlood;
use corpuscle_model::{ChartSeries, ChartStyle, Model, ModelError};
use corpuscle_scene::{Edges, Flood, Gauge, Inflow, NoData, Series, TerrainFile};
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;

pub(in super::super) const EA_TEST5: Case = Case {
    name: "flood/voronoi/ea-test5",
    about: "A valley below a failing dam (test 5 of the Environment Agency's benchmark of 2D flood models, Neelz & Pender 2013) by scheme voronoi, three seeds, \
            particles 50 m apart as the cells of the peer: 3000 m3/s at most over a line of 260 m, n 0.04, the first 5 h; highest depth and arrival (0.05 m) at \
            seven gauges against LISFLOOD-FP 8.1 FV1 on cells of 50 m.",
    slow: true,
    reduced: 2.0,
    run: |options: &Options| of_data(EA_TEST5.name, "ea_test5", options, of_seed),
};

const TIME: f64 = 5.0 * 3600.0;

/// Distance of particles, m.
const SPACING: f64 = 50.0;

/// Interval of the samples, s.
const SAMPLE_PERIOD: f64 = 10.0;

/// Names of the measures at a gauge: of depth and of arrival.
const MEASURES: [[&str; 2]; 7] = [
    ["depth_error_G1", "relative_arrival_error_G1"],
    ["depth_error_G2", "relative_arrival_error_G2"],
    ["depth_error_G3", "relative_arrival_error_G3"],
    ["depth_error_G4", "relative_arrival_error_G4"],
    ["depth_error_G5", "relative_arrival_error_G5"],
    ["depth_error_G6", "relative_arrival_error_G6"],
    ["depth_error_G7", "relative_arrival_error_G7"],
];

fn of_seed(folder: &Path, seed: u64, options: &Options) -> Result<Vec<Row>, ModelError> {
    let ground = TerrainFile { path: folder.join("dem-10m.tif"), crs: None, no_data: NoData::Wall };
    let terrain = Terrain::open(&corpuscle_scene::Terrain::File(ground), seed, folder);
    let terrain = Arc::new(terrain.map_err(|error| ModelError::Setup(error.to_string()))?);
    compare(&mut set_up(&valley(folder)?, seed, &terrain, &[])?, folder, options)
}

/// Runs the flood and compares it with the peer.
fn compare(flood: &mut VoronoiFlood, folder: &Path, options: &Options) -> Result<Vec<Row>, ModelError> {
    let case = EA_TEST5.name;
    let peers = table(&folder.join("peers-50m-first-5h.csv"), 1)?;
    let seen = Watched::run(flood, TIME, SAMPLE_PERIOD)?;
    let mut out = Vec::new();
    for (gauge, (peer, [depth, arrival])) in peers.iter().zip(MEASURES).enumerate() {
        let fv1 = |column: usize| peer.get(column).copied().flatten().unwrap_or(f64::NAN);
        let mut chart = seen.chart(4 * gauge, &format!("G{}", gauge + 1), "Depth", "m", vec![[fv1(4), 0.05]]);
        chart.series[1].name = "arrival of FV1".into();
        let highest = [[0.0, fv1(2)], [TIME, fv1(2)]].to_vec();
        let style = ChartStyle::Dashes;
        chart.series.push(ChartSeries {
            name: "highest of FV1".into(),
            style,
            points: highest,
            ..ChartSeries::default()
        });
        options.draw(chart);
        let error = (seen.largest(4 * gauge) - fv1(2)).abs();
        out.push(Row::at_most(case, depth, error, "m", 0.3));
        let error = (seen.first(4 * gauge, 0.05) / fv1(4) - 1.0).abs();
        out.push(Row::at_most(case, arrival, error, "", 0.15));
    }
    let water = flood.ledger().balances[0].relative_error().abs();
    out.push(Row::at_most(case, "water_relative_error", water, "", water_rounding()));
    Ok(out)
}

/// The flood of the benchmark: inflow and gauges.
fn valley(folder: &Path) -> Result<Flood, ModelError> {
    let mut settings = settings(SPACING, 0.04, Edges::default());
    let line = table(&folder.join("inflow-line.csv"), 1)?;
    let discharge = table(&folder.join("inflow.csv"), 2)?;
    settings.inflow = vec![Inflow {
        name: "dam".into(),
        at: None,
        line: Some(line.iter().filter_map(|row| Some([row[0]?, row[1]?])).collect()),
        discharge_m3_per_s: Series::Table(discharge.iter().filter_map(|row| Some([row[0]?, row[1]?])).collect()),
        velocity_m_per_s: [0.0; 2],
    }];
    let gauge = |(number, row): (usize, &Vec<Option<f64>>)| {
        Some(Gauge { name: format!("G{}", number + 1), at: Some([row[1]?, row[2]?]), lon_lat: None })
    };
    settings.gauge = table(&folder.join("gauges.csv"), 1)?.iter().enumerate().filter_map(gauge).collect();
    Ok(settings)
}
