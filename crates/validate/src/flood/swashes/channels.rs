//! Steady flow along channels, rain included.

use super::super::{GRAVITY, run, settings, spacing_of, strip, water_everywhere};
use super::profile::Profile;
use corpuscle_flood::Flood;
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::{Edge, Edges, Flood as Settings, Friction, Manning};
use corpuscle_terrain::Bounds;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Place, depth, velocity, ground.
const COLUMNS: [usize; 4] = [0, 1, 2, 3];

/// A channel that runs on evenly at both ends, and how long it is watched, s.
struct Channel {
    profile: Profile,
    manning: f64,
    time: f64,
}

impl Channel {
    fn read(path: &Path, manning: f64, time: f64) -> Result<Self, ModelError> {
        Ok(Self { profile: Profile::read(path, COLUMNS)?, manning, time })
    }

    /// Flow at an end: depth and velocity.
    fn end(&self, last: bool) -> [f64; 2] {
        let at = if last { self.profile.x.len() - 1 } else { 0 };
        [self.profile.depth[at], self.profile.velocity[at]]
    }

    /// How far a channel runs on at an end so that nothing from beyond comes in: the way of the fastest wave.
    fn lead(&self, last: bool) -> f64 {
        let [depth, velocity] = self.end(last);
        let wave = (GRAVITY * depth).sqrt();
        1.2 * self.time * if last { (wave - velocity).max(velocity) } else { wave + velocity }
    }

    /// The error after the time, with rain of `rain` m/s on the channel proper.
    fn error(&self, spacing: f64, rain: Option<f64>) -> Result<f64, ModelError> {
        let width = 14.0 * spacing;
        // Whole cells of the rain, so that it begins and ends where it should.
        let whole = |length: f64| (length / (6.0 * spacing)).ceil() * 6.0 * spacing;
        let length = self.profile.length();
        let (before, behind) = (whole(self.lead(false)), whole(length + self.lead(true)) - length);
        let bounds = Bounds { x_min: -before, x_max: length + behind, y_min: 0.0, y_max: width };
        // Even flow: the ground falls by n^2 u^2 / d^(4/3) (Manning).
        let fall = |[depth, velocity]: [f64; 2]| -(self.manning * velocity).powi(2) / depth.powf(4.0 / 3.0);
        let slopes = [false, true].map(|last| fall(self.end(last)));
        let terrain = Arc::new(self.profile.terrain(bounds, spacing, slopes));
        let mean = self.profile.depth.iter().sum::<f64>() / self.profile.depth.len() as f64;
        let edges = Edges { west: Edge::Wall, ..strip(&Edge::Open) };
        let settings = Settings { manning: Manning::Number(self.manning), ..settings(self.time, spacing, mean, edges) };
        let (depth, velocity) = (|x, _| self.profile.depth_at(x), |x, _| [self.profile.velocity_at(x), 0.0]);
        let mut flood = run(&settings, &terrain, &[water_everywhere(bounds, depth, velocity)], 0.0)?;
        if let Some(rain) = rain {
            flood.rain(Box::new(move |x, _, _| if (0.0..length).contains(&x) { rain } else { 0.0 }));
        }
        flood.advance_to(self.time, &AtomicBool::new(false))?;
        Ok(self.profile.error(&flood, width))
    }
}

pub(super) fn bump_subcritical(path: &Path, spacing: f64) -> Result<f64, ModelError> {
    Channel::read(path, 0.0, 12.0)?.error(spacing, None)
}

pub(super) fn bump_transcritical(path: &Path, spacing: f64) -> Result<f64, ModelError> {
    Channel::read(path, 0.0, 15.0)?.error(spacing, None)
}

pub(super) fn bump_shock(path: &Path, spacing: f64) -> Result<f64, ModelError> {
    Channel::read(path, 0.0, 30.0)?.error(spacing, None)
}

pub(super) fn long_subcritical(path: &Path, spacing: f64) -> Result<f64, ModelError> {
    Channel::read(path, 0.033, 400.0)?.error(spacing, None)
}

pub(super) fn long_jump(path: &Path, spacing: f64) -> Result<f64, ModelError> {
    Channel::read(path, 0.0218, 400.0)?.error(spacing, None)
}

pub(super) fn short_shock(path: &Path, spacing: f64) -> Result<f64, ModelError> {
    Channel::read(path, 0.0328, 60.0)?.error(spacing, None)
}

/// Rain of 1 mm/s on 1000 m brings 1 m2/s to the 1 m2/s that come in.
pub(super) fn rain(path: &Path, spacing: f64) -> Result<f64, ModelError> {
    Channel::read(path, 0.033, 500.0)?.error(spacing, Some(1e-3))
}

/// Five periods of a wavy channel, joined end to end.
pub(super) fn undulating(path: &Path, spacing: f64) -> Result<f64, ModelError> {
    let profile = Profile::read(path, COLUMNS)?;
    let settings =
        Settings { manning: Manning::Number(0.03), ..settings(1500.0, spacing, 1.1, strip(&Edge::Periodic)) };
    let fall = (profile.ground[profile.ground.len() - 1] - profile.ground[0]) / (profile.length() - profile.step());
    let flood = joined(&settings, &profile, 1500.0, [fall; 2], |_| {})?;
    Ok(profile.error(&flood, width(spacing)))
}

/// One wave of rain and the dry stretch before the next, m: the water comes round in a shorter channel than that of the solution.
const ROUND: f64 = 5000.0;

/// Rain that moves along with water 0.25 m deep at 8 m/s: the friction slope is 0.01125 s/m times the velocity, the ground falls by
/// 0.09. The rain swells and fades as sin(pi t / 1000 s).
pub(super) fn mobile_rain(path: &Path, spacing: f64) -> Result<f64, ModelError> {
    let exact = Profile::of_mobile_rain(path, ROUND)?;
    let places = 500;
    let step = ROUND / f64::from(places);
    let x: Vec<f64> = (0..places).map(|k| (f64::from(k) + 0.5) * step).collect();
    let [depth, velocity] = [0.25, 8.0].map(|value| vec![value; x.len()]);
    let start = Profile { ground: x.iter().map(|x| -0.09 * x).collect(), depth, velocity, x };
    let settings = Settings {
        friction: Some(Friction::Linear(0.01125)),
        ..settings(500.0, spacing, 0.25, strip(&Edge::Periodic))
    };
    let rain = |flood: &mut Flood| {
        flood.rain(Box::new(mobile_rain_at));
    };
    let flood = joined(&settings, &start, 500.0, [-0.09; 2], rain)?;
    Ok(exact.error(&flood, width(spacing)))
}

/// The rain of [`mobile_rain`], m/s, at a position, m, and a time, s.
pub(in crate::flood) fn mobile_rain_at(x: f64, _: f64, time: f64) -> f64 {
    let along = (x - 8.0 * time - 2250.0).rem_euclid(ROUND);
    let shape = ((along - 900.0) * std::f64::consts::TAU / 3600.0).sin() + 1.0;
    let swell = (std::f64::consts::PI * time / 1000.0).sin();
    if along <= 3600.0 { 0.5 * 5e-5 * shape * swell } else { 0.0 }
}

fn width(spacing: f64) -> f64 {
    14.0 * spacing
}

/// A channel whose ends are joined.
fn joined(
    settings: &Settings,
    profile: &Profile,
    time: f64,
    slopes: [f64; 2],
    change: impl Fn(&mut Flood),
) -> Result<Flood, ModelError> {
    let spacing = spacing_of(settings);
    let bounds = Bounds { x_min: 0.0, x_max: profile.length(), y_min: 0.0, y_max: width(spacing) };
    let terrain = Arc::new(profile.terrain(bounds, spacing, slopes));
    let (depth, velocity) = (|x, _| profile.depth_at(x), |x, _| [profile.velocity_at(x), 0.0]);
    let mut flood = run(settings, &terrain, &[water_everywhere(bounds, depth, velocity)], 0.0)?;
    change(&mut flood);
    flood.advance_to(time, &AtomicBool::new(false))?;
    Ok(flood)
}
