//! The dam of Malpasset, 2 December 1959, by scheme voronoi.

use super::super::measured::Watched;
use super::{SEEDS, ready, settings};
use crate::device::rounding;
use crate::flood::rows;
use crate::{Case, Options, Row};
use corpuscle_flood::VoronoiFlood;
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::{Edges, Gauge, NoData, TerrainFile, Water};
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;

pub(in crate::flood) const MALPASSET: Case = Case {
    name: "flood/voronoi/malpasset",
    about: "The Malpasset dam break of 1959 by scheme voronoi, started from the depth raster, particles 56, 40 and 28 m apart, n 0.033, 4000 s: \
            highest levels of the police survey with and without P1, arrival (0.05 m) at the scale model's gauges, and how far the highest levels of \
            all places still change from one spacing to the next. LISFLOOD-FP 8.1 FV1 with 20 m cells: police survey 2.87 m, arrival 107 s.",
    slow: true,
    reduced: 8.0,
    run: malpasset,
};

/// Distances of the particles, m.
const SPACINGS: [f64; 3] = [56.0, 40.0, 28.0];

/// Simulated time, s.
const TIME: f64 = 4000.0;

/// Interval of the samples, s.
const SAMPLE_PERIOD: f64 = 2.0;

/// A station of the survey or of the scale model: its name, where it is, the highest level, m, and the arrival, s.
struct Station {
    name: String,
    at: [f64; 2],
    level: f64,
    arrival: Option<f64>,
}

fn malpasset(options: &Options) -> Vec<Row> {
    match &options.data {
        None => vec![Row::without_data(MALPASSET.name, options)],
        Some(data) => rows(MALPASSET.name, measure(&data.join("malpasset"))),
    }
}

/// Results of a run.
struct Found {
    /// Highest level at each station, m.
    highest: Vec<f64>,
    /// Arrival at each station, s.
    arrival: Vec<f64>,
    water: f64,
}

fn measure(folder: &Path) -> Result<Vec<Row>, ModelError> {
    let police = read(&folder.join("police-survey.csv"))?;
    let gauges = read(&folder.join("scale-model-gauges.csv"))?;
    let found = SPACINGS.map(|spacing| run(folder, police.iter().chain(&gauges), spacing, SEEDS[0]));
    let [wide, middle, fine] = found;
    let (wide, middle, fine) = (wide?, middle?, fine?);
    let errors = |found: &Found| -> Vec<f64> {
        police.iter().zip(&found.highest).map(|(station, highest)| highest - station.level).collect()
    };
    let change = |a: &Found, b: &Found| {
        let changes: Vec<f64> = a.highest.iter().zip(&b.highest).map(|(a, b)| a - b).collect();
        root_mean_square(&changes)
    };
    let late = gauges.iter().zip(&fine.arrival[police.len()..]);
    let late: Vec<f64> = late.filter_map(|(station, arrival)| Some(arrival - station.arrival?)).collect();
    let changes = [change(&wide, &middle), change(&middle, &fine)];
    let at_most = |measure, value, unit, bound| Row::at_most(MALPASSET.name, measure, value, unit, bound);
    let fine_errors = errors(&fine);
    Ok(vec![
        at_most("police_rmse_without_P1", root_mean_square(&fine_errors[1..]), "m", 2.9),
        Row::beside(
            MALPASSET.name,
            "police_error_P1",
            fine_errors[0],
            "m",
            0.0,
            "just below the dam: it grows with every refinement in second-order schemes, and is told apart",
        ),
        at_most("arrival_mae", mean_magnitude(&late), "s", 60.0),
        at_most("rms_change_of_highest_levels", changes[1], "m", changes[0]),
        at_most(
            "water_relative_error",
            [wide, middle, fine].iter().map(|f| f.water).fold(0.0, f64::max),
            "",
            rounding(1e-12, 1e-10),
        ),
    ])
}

/// Runs it with particles `spacing` m apart.
fn run<'a>(
    folder: &Path,
    stations: impl Iterator<Item = &'a Station>,
    spacing: f64,
    seed: u64,
) -> Result<Found, ModelError> {
    let mut settings = settings(spacing, 0.033, Edges::default());
    let gauge = |station: &Station| Gauge { name: station.name.clone(), at: Some(station.at), lon_lat: None };
    settings.gauge = stations.map(gauge).collect();
    let raster = folder.join("initial-depth-20m.tif");
    settings.water = vec![Water { depth_raster: Some(raster), ..Water::default() }];
    let ground = TerrainFile { path: folder.join("bed-20m.tif"), crs: None, no_data: NoData::Wall };
    let terrain = Terrain::open(&corpuscle_scene::Terrain::File(ground), seed, folder)
        .map_err(|e| ModelError::Setup(e.to_string()))?;
    let count = settings.gauge.len();
    let mut flood = ready(VoronoiFlood::new(&settings, seed, folder, Arc::new(terrain))?)?;
    let (highest, arrival) = watch(&mut flood, count)?;
    Ok(Found { highest, arrival, water: flood.ledger().balances[0].relative_error().abs() })
}

/// Highest level and time of arrival at each gauge; a gauge that stays dry has its bed's level and the end of the run.
fn watch(flood: &mut impl Model, gauges: usize) -> Result<(Vec<f64>, Vec<f64>), ModelError> {
    let mut highest = vec![f64::NEG_INFINITY; gauges];
    let mut arrival = vec![TIME; gauges];
    for (time, row) in Watched::run(flood, TIME, SAMPLE_PERIOD)?.rows() {
        for (gauge, row) in row.chunks_exact(4).take(gauges).enumerate() {
            highest[gauge] = highest[gauge].max(row[1]);
            if row[0] >= 0.05 {
                arrival[gauge] = arrival[gauge].min(time);
            }
        }
    }
    Ok((highest, arrival))
}

/// Reads name, x, y, highest level and, where there is one, arrival.
fn read(path: &Path) -> Result<Vec<Station>, ModelError> {
    let text = std::fs::read_to_string(path)
        .map_err(|error| ModelError::Setup(format!("{} cannot be read: {error}", path.display())))?;
    let station = |line: &str| {
        let mut fields = line.split(',').map(str::trim);
        let name = fields.next()?.to_string();
        let mut number = || fields.next()?.parse::<f64>().ok();
        Some(Station { name, at: [number()?, number()?], level: number()?, arrival: number() })
    };
    let parsed = text.lines().skip(1).filter(|line| !line.trim().is_empty()).map(station);
    parsed.collect::<Option<_>>().ok_or_else(|| ModelError::Setup(format!("{} is not as expected", path.display())))
}

fn root_mean_square(errors: &[f64]) -> f64 {
    (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt()
}

fn mean_magnitude(errors: &[f64]) -> f64 {
    errors.iter().map(|error| error.abs()).sum::<f64>() / errors.len() as f64
}
