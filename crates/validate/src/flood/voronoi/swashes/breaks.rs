//! Dam breaks, a lake that comes to rest, and water swinging in a parabola, along a strip.

use super::super::super::{GRAVITY, strip};
use super::super::{run, settings};
use super::{Profile, WIDTH};
use corpuscle_flood::{Filling, StartWater};
use corpuscle_model::ModelError;
use corpuscle_scene::{Edge, Flood, Friction};
use corpuscle_terrain::{Bounds, Terrain};
use std::f64::consts::TAU;
use std::path::Path;
use std::sync::Arc;

/// Position, depth, ground.
const COLUMNS: [usize; 3] = [0, 1, 3];

/// Two pools before and behind a dam in the middle of a strip between walls, depths `[before, behind]`, m, after `time` s.
struct Dam {
    depths: [f64; 2],
    /// The ground rises by this much at the dam, m.
    step: f64,
    time: f64,
    friction: Option<Friction>,
}

impl Dam {
    fn error(&self, path: &Path, spacing: f64, seed: u64) -> Result<f64, ModelError> {
        let profile = Profile::read(path, COLUMNS)?;
        let (length, width) = (profile.length(), WIDTH * spacing);
        let bounds = Bounds { x_min: 0.0, x_max: length, y_min: 0.0, y_max: width };
        let pool = |depth: f64, from: f64, to: f64| StartWater {
            filling: Filling::Depth(Box::new(move |_, _| depth)),
            polygon: Some(vec![[from, -width], [to, -width], [to, 2.0 * width], [from, 2.0 * width]]),
            velocity: Box::new(|_, _| [0.0; 2]),
        };
        let mut water = vec![pool(self.depths[0], -length, 0.5 * length)];
        if self.depths[1] > 0.0 {
            water.push(pool(self.depths[1], 0.5 * length, 2.0 * length));
        }
        let settings = Flood { friction: self.friction, ..settings(spacing, 0.0, strip(&Edge::Wall)) };
        let terrain = Arc::new(self.terrain(bounds, spacing));
        let flood = run(&settings, seed, &terrain, &water, self.time)?;
        Ok(profile.error_of(|x, y| flood.sample(x, y).depth, width))
    }

    /// Flat ground with a step, half a spacing to both sides of the dam.
    fn terrain(&self, bounds: Bounds, spacing: f64) -> Terrain {
        let (step, middle) = (self.step, 0.5 * (bounds.x_min + bounds.x_max));
        Terrain::analytic(bounds, spacing, move |x, _| {
            let along = (x - middle) / spacing + 0.5;
            let slope = if (0.0..1.0).contains(&along) { step / spacing } else { 0.0 };
            (step * along.clamp(0.0, 1.0), [slope, 0.0])
        })
    }
}

pub(super) fn stoker(path: &Path, spacing: f64, seed: u64) -> Result<f64, ModelError> {
    Dam { depths: [0.005, 0.001], step: 0.0, time: 6.0, friction: None }.error(path, spacing, seed)
}

pub(super) fn ritter(path: &Path, spacing: f64, seed: u64) -> Result<f64, ModelError> {
    Dam { depths: [0.005, 0.0], step: 0.0, time: 6.0, friction: None }.error(path, spacing, seed)
}

pub(super) fn dressler(path: &Path, spacing: f64, seed: u64) -> Result<f64, ModelError> {
    Dam { depths: [6.0, 0.0], step: 0.0, time: 40.0, friction: Some(Friction::Chezy(40.0)) }.error(path, spacing, seed)
}

pub(super) fn step(path: &Path, spacing: f64, seed: u64) -> Result<f64, ModelError> {
    Dam { depths: [4.0, 1.0], step: 1.0, time: 1.0, friction: None }.error(path, spacing, seed)
}

/// A lake on both sides of a bump that rises above it, after waves on it came to rest by linear friction.
pub(super) fn lake(path: &Path, spacing: f64, seed: u64) -> Result<f64, ModelError> {
    let profile = Profile::read(path, COLUMNS)?;
    let width = WIDTH * spacing;
    let bounds = Bounds { x_min: 0.0, x_max: profile.length(), y_min: 0.0, y_max: width };
    let height = |x: f64| (0.2 - 0.05 * (x - 10.0).powi(2)).max(0.0);
    let terrain = Arc::new(Terrain::analytic(bounds, spacing, move |x, _| {
        (height(x), [if height(x) > 0.0 { -0.1 * (x - 10.0) } else { 0.0 }, 0.0])
    }));
    // Waves over the flat ground before and behind the bump, which add no water.
    let level = |x: f64, _: f64| match x {
        ..8.0 => 0.1 + 0.02 * (TAU * x / 8.0).sin(),
        12.0.. => 0.1 + 0.02 * (TAU * (x - 12.0) / 13.0).sin(),
        _ => 0.1,
    };
    let water =
        StartWater { filling: Filling::Level(Box::new(level)), polygon: None, velocity: Box::new(|_, _| [0.0; 2]) };
    let friction = Some(Friction::Linear(0.05));
    let settings = Flood { friction, ..settings(spacing, 0.0, strip(&Edge::Wall)) };
    let flood = run(&settings, seed, &terrain, &[water], 100.0)?;
    Ok(profile.error_of(|x, y| flood.sample(x, y).depth, width))
}

/// A plane surface swinging in the parabola z = h0 ((x - 2)^2 - 1) with h0 0.5 m (Thacker 1981), after five periods.
pub(super) fn parabola(path: &Path, spacing: f64, seed: u64) -> Result<f64, ModelError> {
    let profile = Profile::read(path, COLUMNS)?;
    let (h0, width) = (0.5, WIDTH * spacing);
    let bounds = Bounds { x_min: 0.0, x_max: profile.length(), y_min: 0.0, y_max: width };
    let terrain = Arc::new(Terrain::analytic(bounds, spacing, move |x, _| {
        (h0 * ((x - 2.0).powi(2) - 1.0), [2.0 * h0 * (x - 2.0), 0.0])
    }));
    let period = TAU / (2.0 * GRAVITY * h0).sqrt();
    // At the start the surface stands highest on the side of small x.
    let depth = move |x: f64, _: f64| h0 * (1.0 - (x - 2.0 + 0.5).powi(2));
    let water =
        StartWater { filling: Filling::Depth(Box::new(depth)), polygon: None, velocity: Box::new(|_, _| [0.0; 2]) };
    let flood = run(&settings(spacing, 0.0, strip(&Edge::Wall)), seed, &terrain, &[water], 5.0 * period)?;
    Ok(profile.error_of(|x, y| flood.sample(x, y).depth, width))
}
