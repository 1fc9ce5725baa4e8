//! The dam of Malpasset, 2 December 1959.

use super::device::{ready, water_rounding};
use super::measured::Watched;
use super::{SEED, rows, settings};
use crate::{Case, Options, Row};
use corpuscle_flood::{Flood, InitialWater};
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::{Edges, Flood as Settings, Gauge, Manning, NoData, Terrain as TerrainScene, TerrainFile};
use corpuscle_terrain::{RasterField, Terrain};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

pub(super) const MALPASSET: Case = Case {
    name: "flood/malpasset",
    about: "The Malpasset dam break of 1959, particles 15 m apart in water 22.5 m deep (the reservoir's mean), n 0.033, \
            4000 s: highest levels of the police survey, arrival (0.05 m) at the scale model's gauges. Bounds: what \
            LISFLOOD-FP 8.1 FV1 gets on the same ground with 20 m cells.",
    slow: true,
    reduced: 6.0,
    run: malpasset,
};

/// Wholly west of the sea and east of the reservoir, m.
const SEA: f64 = 10_000.0;

/// Simulated time, s.
const TIME: f64 = 4000.0;

/// Time between looks at the water, s.
const LOOK: f64 = 2.0;

/// A place of the survey or of the scale model: its name, where it is, the highest level, m, and the arrival, s.
pub(super) struct Place {
    pub name: String,
    pub at: [f64; 2],
    pub level: f64,
    pub arrival: Option<f64>,
}

fn malpasset(options: &Options) -> Vec<Row> {
    match &options.data {
        None => vec![Row::without_data(MALPASSET.name, options)],
        Some(data) => rows(MALPASSET.name, measure(&data.join("malpasset"))),
    }
}

fn measure(folder: &Path) -> Result<Vec<Row>, ModelError> {
    let police = read(&folder.join("police-survey.csv"))?;
    let gauges = read(&folder.join("scale-model-gauges.csv"))?;
    let settings = malpasset_settings(police.iter().chain(&gauges));
    let ground = TerrainFile { path: folder.join("bed-20m.tif"), crs: None, no_data: NoData::Wall };
    let terrain =
        Terrain::open(&TerrainScene::File(ground), SEED, folder).map_err(|e| ModelError::Setup(e.to_string()))?;
    let terrain = Arc::new(terrain);
    let ground = Arc::clone(&terrain);
    let wet = RasterField::open(folder.join("initial-depth-20m.tif"), &terrain)
        .map_err(|e| ModelError::Setup(e.to_string()))?;
    let mut flood = ready(Flood::with_water(
        &settings,
        SEED,
        folder,
        terrain,
        &[pool(&ground, &wet, 100.0, 0.0..SEA), pool(&ground, &wet, 0.0, SEA..f64::INFINITY)],
    )?)?;
    let (highest, arrival) = watch(&mut flood, police.len() + gauges.len())?;
    let error = |place: usize, measured: &Place| highest[place] - measured.level;
    let police_errors: Vec<f64> = police.iter().enumerate().map(|(k, place)| error(k, place)).collect();
    let gauge_errors: Vec<f64> = gauges.iter().enumerate().map(|(k, place)| error(police.len() + k, place)).collect();
    let late = |(k, place): (usize, &Place)| place.arrival.map(|measured| (arrival[police.len() + k] - measured).abs());
    let late: Vec<f64> = gauges.iter().enumerate().filter_map(late).collect();
    let water = flood.ledger().balances[0].relative_error().abs();
    let at_most = |measure, value, unit, bound| Row::at_most(MALPASSET.name, measure, value, unit, bound);
    Ok(vec![
        at_most("police_rmse", root_mean_square(&police_errors), "m", 2.9),
        at_most("police_mae", mean_magnitude(&police_errors), "m", 2.3),
        Row::beside(
            MALPASSET.name,
            "gauge_rmse",
            root_mean_square(&gauge_errors),
            "m",
            3.88,
            "known to miss: LISFLOOD-FP 8.1 FV1 gets 3.88 m",
        ),
        at_most("arrival_mae", mean_magnitude(&late), "s", 107.0),
        at_most("water_relative_error", water, "", water_rounding()),
    ])
}

/// Highest level and time of arrival at each gauge; a gauge that stays dry has its bed's level and the end of the run.
pub(super) fn watch(flood: &mut impl Model, gauges: usize) -> Result<(Vec<f64>, Vec<f64>), ModelError> {
    let mut highest = vec![f64::NEG_INFINITY; gauges];
    let mut arrival = vec![TIME; gauges];
    for (time, row) in Watched::run(flood, TIME, LOOK)?.rows() {
        for (gauge, row) in row.chunks_exact(4).take(gauges).enumerate() {
            highest[gauge] = highest[gauge].max(row[1]);
            if row[0] >= 0.05 {
                arrival[gauge] = arrival[gauge].min(time);
            }
        }
    }
    Ok((highest, arrival))
}

fn malpasset_settings<'a>(places: impl Iterator<Item = &'a Place>) -> Settings {
    let mut settings = settings(TIME, 15.0, 22.5, Edges::default());
    settings.manning = Manning::Number(0.033);
    settings.map_every_s = Some(TIME);
    let gauge = |place: &Place| Gauge { name: place.name.clone(), at: Some(place.at), lon_lat: None };
    settings.gauge = places.map(gauge).collect();
    settings
}

/// Water at rest at a level where the raster of the initial depth has some, between two x.
fn pool<'a>(ground: &'a Terrain, wet: &'a RasterField, level: f64, between: Range<f64>) -> InitialWater<'a> {
    let inside = move |x: f64, y: f64| between.contains(&x) && wet.nearest(x, y).is_some_and(|depth| depth > 0.0);
    InitialWater {
        depth: Box::new(move |x, y| level - ground.height(x, y)),
        inside: Box::new(inside),
        within: ground.bounds(),
        velocity: Box::new(|_, _| [0.0; 2]),
    }
}

/// Reads name, x, y, highest level and, where there is one, arrival.
pub(super) fn read(path: &Path) -> Result<Vec<Place>, ModelError> {
    let text = std::fs::read_to_string(path)
        .map_err(|error| ModelError::Setup(format!("{} cannot be read: {error}", path.display())))?;
    let place = |line: &str| {
        let mut fields = line.split(',').map(str::trim);
        let name = fields.next()?.to_string();
        let mut number = || fields.next()?.parse::<f64>().ok();
        Some(Place { name, at: [number()?, number()?], level: number()?, arrival: number() })
    };
    let parsed = text.lines().skip(1).filter(|line| !line.trim().is_empty()).map(place);
    parsed.collect::<Option<_>>().ok_or_else(|| ModelError::Setup(format!("{} is not as expected", path.display())))
}

pub(super) fn root_mean_square(errors: &[f64]) -> f64 {
    (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt()
}

pub(super) fn mean_magnitude(errors: &[f64]) -> f64 {
    errors.iter().map(|error| error.abs()).sum::<f64>() / errors.len() as f64
}
