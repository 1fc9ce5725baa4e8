//! Steady flow along channels, rain included, from dry ground or still water.

use super::super::super::{GRAVITY, strip};
use super::super::{advance, cells, set_up, settings};
use super::{Profile, WIDTH};
use corpuscle_flood::{Filling, StartWater, VoronoiFlood};
use corpuscle_model::ModelError;
use corpuscle_scene::{Edge, Edges, Flood, Friction, Series, Wave};
use corpuscle_terrain::{Bounds, Terrain};
use std::path::Path;
use std::sync::Arc;

/// Position, depth, ground.
const COLUMNS: [usize; 3] = [0, 1, 3];

/// Flow is steady when depths change by less than this part of their mean while a wave crosses the channel.
const STEADY: f64 = 3e-5;

/// Crossings after which what still changes is noise.
const MOST_CROSSINGS: usize = 40;

/// A channel into which water comes at its beginning, and which it leaves at its end by a rating that has the depth of the solution at its discharge.
struct Channel {
    /// Discharge that comes in, m2/s.
    discharge: f64,
    /// Depth of what comes in, m, where it comes faster than waves.
    supercritical: Option<f64>,
    /// Depth at the end, m, while the flow is slower than waves there.
    depth: f64,
    manning: f64,
    /// Level of the still water at the start, m; none where it is dry.
    level: Option<f64>,
    /// Rain, m/s.
    rain: f64,
}

impl Channel {
    fn error(&self, path: &Path, spacing: f64, seed: u64) -> Result<f64, ModelError> {
        let profile = Profile::read(path, COLUMNS)?;
        let width = WIDTH * spacing;
        let bounds = Bounds { x_min: 0.0, x_max: profile.length(), y_min: 0.0, y_max: width };
        let slopes = [0.0, profile.length()].map(|x| profile.slope_at(x));
        let terrain = Arc::new(profile.terrain(bounds, spacing, slopes));
        let start = self.level.unwrap_or(f64::NEG_INFINITY);
        let still = StartWater {
            filling: Filling::Level(Box::new(move |_, _| start)),
            polygon: None,
            velocity: Box::new(|_, _| [0.0; 2]),
        };
        let bodies = if self.level.is_some() { vec![still] } else { Vec::new() };
        let mut flood = set_up(&self.settings(&terrain, bounds, spacing), seed, &terrain, &bodies)?;
        if self.rain > 0.0 {
            let rain = self.rain;
            flood.rain(Box::new(move |_, _, _| rain))?;
        }
        let crossing = profile.length() / (GRAVITY * self.depth).sqrt();
        settle(&mut flood, crossing)?;
        Ok(profile.error_of(|x, y| flood.sample(x, y).depth, width))
    }

    /// Discharge at the end, m2/s.
    fn discharge_out(&self, length: f64) -> f64 {
        self.discharge + self.rain * length
    }

    fn settings(&self, terrain: &Terrain, bounds: Bounds, spacing: f64) -> Flood {
        let [beginning, end] = [bounds.x_min, bounds.x_max].map(|x| terrain.height(x, 0.5 * bounds.y_max));
        let constant = |value: f64| Some(Series::Constant(value));
        let west = match self.supercritical {
            None => Edge::Discharge(Series::Constant(self.discharge * bounds.y_max)),
            Some(depth) => Edge::Wave(Wave {
                rest_level_m: beginning,
                level_m: constant(beginning + depth),
                velocity_m_per_s: constant(self.discharge / depth),
            }),
        };
        // Around the depth at the end as much more passes as a wave brings that leaves: (u + c) dh.
        let out = self.discharge_out(bounds.x_max);
        let across = out / self.depth + (GRAVITY * self.depth).sqrt();
        let level = |share: f64| end + self.depth + (share - 1.0) * out / across;
        let rating = [0.0, 1.0, 10.0].map(|share| [level(share), share * out * bounds.y_max]);
        let east = Edge::Rating(rating.to_vec());
        settings(spacing, self.manning, Edges { west, east, ..strip(&Edge::Periodic) })
    }
}

/// Goes on until the flow is steady, looking after each crossing of the channel by waves, s.
fn settle(flood: &mut VoronoiFlood, crossing: f64) -> Result<(), ModelError> {
    let volumes = |flood: &VoronoiFlood| cells(flood).iter().map(|cell| cell.area * cell.depth).collect::<Vec<f64>>();
    let mut before = volumes(flood);
    for number in 1..=MOST_CROSSINGS {
        advance(flood, number as f64 * crossing)?;
        let now = volumes(flood);
        let change = before.iter().zip(&now).map(|(before, now)| (now - before).abs()).sum::<f64>();
        let is_steady = before.len() == now.len() && change < STEADY * now.iter().sum::<f64>();
        if is_steady {
            return Ok(());
        }
        before = now;
    }
    Ok(())
}

const BUMP: Channel =
    Channel { discharge: 4.42, supercritical: None, depth: 2.0, manning: 0.0, level: Some(2.0), rain: 0.0 };

pub(super) fn bump_subcritical(path: &Path, spacing: f64, seed: u64) -> Result<f64, ModelError> {
    BUMP.error(path, spacing, seed)
}

pub(super) fn bump_transcritical(path: &Path, spacing: f64, seed: u64) -> Result<f64, ModelError> {
    Channel { discharge: 1.53, depth: 0.66, level: Some(0.66), ..BUMP }.error(path, spacing, seed)
}

pub(super) fn bump_shock(path: &Path, spacing: f64, seed: u64) -> Result<f64, ModelError> {
    Channel { discharge: 0.18, depth: 0.33, level: Some(0.33), ..BUMP }.error(path, spacing, seed)
}

/// Discharge, end and friction as the headers of the files give them.
const LONG: Channel =
    Channel { discharge: 2.0, supercritical: None, depth: 0.748324, manning: 0.033, level: None, rain: 0.0 };

pub(super) fn long_subcritical(path: &Path, spacing: f64, seed: u64) -> Result<f64, ModelError> {
    LONG.error(path, spacing, seed)
}

pub(super) fn long_jump(path: &Path, spacing: f64, seed: u64) -> Result<f64, ModelError> {
    Channel { supercritical: Some(0.543791), depth: 1.33475, manning: 0.0218, ..LONG }.error(path, spacing, seed)
}

pub(super) fn short_shock(path: &Path, spacing: f64, seed: u64) -> Result<f64, ModelError> {
    Channel { depth: 2.87871, manning: 0.0328, level: Some(2.87871), ..LONG }.error(path, spacing, seed)
}

pub(super) fn undulating(path: &Path, spacing: f64, seed: u64) -> Result<f64, ModelError> {
    Channel { depth: 1.125, manning: 0.03, level: Some(1.125), ..LONG }.error(path, spacing, seed)
}

/// Rain of 1 mm/s on 1000 m brings 1 m2/s to the 1 m2/s that come in.
pub(super) fn rain(path: &Path, spacing: f64, seed: u64) -> Result<f64, ModelError> {
    Channel { discharge: 1.0, rain: 1e-3, ..LONG }.error(path, spacing, seed)
}

/// One wave of rain and the dry stretch before the next, m: the water comes round in a shorter channel than that of the solution.
const ROUND: f64 = 5000.0;

/// Rain that moves along with water 0.25 m deep at 8 m/s: the friction slope is 0.01125 s/m times the velocity, the ground falls by
/// 0.09. The rain swells and fades as sin(pi t / 1000 s).
pub(super) fn mobile_rain(path: &Path, spacing: f64, seed: u64) -> Result<f64, ModelError> {
    let exact = Profile::of_mobile_rain(path, ROUND)?;
    let width = WIDTH * spacing;
    let bounds = Bounds { x_min: 0.0, x_max: ROUND, y_min: 0.0, y_max: width };
    let terrain = Arc::new(Terrain::analytic(bounds, spacing, |x, _| (-0.09 * x, [-0.09, 0.0])));
    let water = StartWater {
        filling: Filling::Depth(Box::new(|_, _| 0.25)),
        polygon: None,
        velocity: Box::new(|_, _| [8.0, 0.0]),
    };
    let settings =
        Flood { friction: Some(Friction::Linear(0.01125)), ..settings(spacing, 0.0, strip(&Edge::Periodic)) };
    let mut flood = set_up(&settings, seed, &terrain, &[water])?;
    flood.rain(Box::new(mobile_rain_at))?;
    advance(&mut flood, 500.0)?;
    Ok(exact.error_of(|x, y| flood.sample(x, y).depth, width))
}

/// The rain of [`mobile_rain`], m/s, at a position, m, and a time, s.
fn mobile_rain_at(x: f64, _: f64, time: f64) -> f64 {
    let along = (x - 8.0 * time - 2250.0).rem_euclid(ROUND);
    let shape = ((along - 900.0) * std::f64::consts::TAU / 3600.0).sin() + 1.0;
    let swell = (std::f64::consts::PI * time / 1000.0).sin();
    if along <= 3600.0 { 0.5 * 5e-5 * shape * swell } else { 0.0 }
}
