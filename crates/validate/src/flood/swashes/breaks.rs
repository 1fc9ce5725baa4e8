//! Dam breaks, a lake at rest, and water swinging in a parabola, along a strip.

use super::super::{GRAVITY, run, settings, strip, water_everywhere};
use super::profile::Profile;
use corpuscle_flood::InitialWater;
use corpuscle_model::ModelError;
use corpuscle_scene::{Edge, Flood as Settings, Friction};
use corpuscle_terrain::{Bounds, Terrain};
use std::path::Path;
use std::sync::Arc;

/// Place, depth, velocity, ground.
const COLUMNS: [usize; 4] = [0, 1, 2, 3];

/// Two pools before and behind a dam in the middle of a strip between walls, depths `[before, behind]`, m, after `time` s.
struct Dam {
    depths: [f64; 2],
    /// The ground rises by this much at the dam, m.
    step: f64,
    time: f64,
    friction: Option<Friction>,
}

impl Dam {
    fn error(&self, path: &Path, spacing: f64) -> Result<f64, ModelError> {
        let profile = Profile::read(path, COLUMNS)?;
        let (length, width) = (profile.length(), 14.0 * spacing);
        let bounds = Bounds { x_min: 0.0, x_max: length, y_min: 0.0, y_max: width };
        let middle = 0.5 * length;
        let pool = |depth: f64, from: f64, to: f64| InitialWater {
            depth: Box::new(move |_, _| depth),
            inside: Box::new(move |x, _| (from..to).contains(&x)),
            within: Bounds { x_min: from, x_max: to, ..bounds },
            velocity: Box::new(|_, _| [0.0; 2]),
        };
        let mut water = vec![pool(self.depths[0], 0.0, middle)];
        if self.depths[1] > 0.0 {
            water.push(pool(self.depths[1], middle, length));
        }
        let mut settings =
            Settings { friction: self.friction, ..settings(self.time, spacing, self.depths[0], strip(&Edge::Wall)) };
        settings.wet_depth_m = 1e-4 * self.depths[0];
        let terrain = Arc::new(self.terrain(bounds, spacing));
        Ok(profile.error(&run(&settings, &terrain, &water, self.time)?, width))
    }

    /// Flat ground with a step as steep as particles can see, half a spacing to both sides of the dam.
    fn terrain(&self, bounds: Bounds, spacing: f64) -> Terrain {
        let (step, middle) = (self.step, 0.5 * (bounds.x_min + bounds.x_max));
        Terrain::analytic(bounds, spacing, move |x, _| {
            let along = (x - middle) / spacing + 0.5;
            let slope = if (0.0..1.0).contains(&along) { step / spacing } else { 0.0 };
            (step * along.clamp(0.0, 1.0), [slope, 0.0])
        })
    }
}

pub(super) fn stoker(path: &Path, spacing: f64) -> Result<f64, ModelError> {
    Dam { depths: [0.005, 0.001], step: 0.0, time: 6.0, friction: None }.error(path, spacing)
}

pub(super) fn ritter(path: &Path, spacing: f64) -> Result<f64, ModelError> {
    Dam { depths: [0.005, 0.0], step: 0.0, time: 6.0, friction: None }.error(path, spacing)
}

pub(super) fn dressler(path: &Path, spacing: f64) -> Result<f64, ModelError> {
    Dam { depths: [6.0, 0.0], step: 0.0, time: 40.0, friction: Some(Friction::Chezy(40.0)) }.error(path, spacing)
}

pub(super) fn step(path: &Path, spacing: f64) -> Result<f64, ModelError> {
    Dam { depths: [4.0, 1.0], step: 1.0, time: 1.0, friction: None }.error(path, spacing)
}

/// A lake round a bump that rises above it, after 20 s.
pub(super) fn lake(path: &Path, spacing: f64) -> Result<f64, ModelError> {
    let profile = Profile::read(path, COLUMNS)?;
    let width = 14.0 * spacing;
    let bounds = Bounds { x_min: 0.0, x_max: profile.length(), y_min: 0.0, y_max: width };
    let height = |x: f64| (0.2 - 0.05 * (x - 10.0).powi(2)).max(0.0);
    let terrain = Arc::new(Terrain::analytic(bounds, spacing, move |x, _| {
        (height(x), [if height(x) > 0.0 { -0.1 * (x - 10.0) } else { 0.0 }, 0.0])
    }));
    let mut settings = settings(20.0, spacing, 0.1, strip(&Edge::Wall));
    settings.wet_depth_m = 1e-4;
    let water = water_everywhere(bounds, |x, _| 0.1 - height(x), |_, _| [0.0; 2]);
    Ok(profile.error(&run(&settings, &terrain, &[water], 20.0)?, width))
}

/// A plane surface swinging in the parabola z = h0 ((x - 2)^2 - 1) with h0 0.5 m (Thacker 1981), after five periods.
pub(super) fn parabola(path: &Path, spacing: f64) -> Result<f64, ModelError> {
    let profile = Profile::read(path, COLUMNS)?;
    let (h0, width) = (0.5, 14.0 * spacing);
    let bounds = Bounds { x_min: 0.0, x_max: profile.length(), y_min: 0.0, y_max: width };
    let terrain = Arc::new(Terrain::analytic(bounds, spacing, move |x, _| {
        (h0 * ((x - 2.0).powi(2) - 1.0), [2.0 * h0 * (x - 2.0), 0.0])
    }));
    let period = std::f64::consts::TAU / (2.0 * GRAVITY * h0).sqrt();
    let mut settings = settings(5.0 * period, spacing, 0.3, strip(&Edge::Wall));
    settings.wet_depth_m = 1e-3;
    // At the start the surface stands highest on the side of small x.
    let water = water_everywhere(bounds, |x, _| h0 * (1.0 - (x - 2.0 + 0.5).powi(2)), |_, _| [0.0; 2]);
    Ok(profile.error(&run(&settings, &terrain, &[water], 5.0 * period)?, width))
}
