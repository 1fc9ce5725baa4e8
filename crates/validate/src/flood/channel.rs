//! Steady flow along channels.

use super::{GRAVITY, order, rows, run, settings, spacing_of, strip, water_everywhere};
use crate::{Case, Options, Row};
use corpuscle_flood::Flood;
use corpuscle_model::ModelError;
use corpuscle_scene::{Edge, Flood as Settings, Manning};
use corpuscle_terrain::{Bounds, Terrain};
use std::sync::Arc;

pub(super) const BUMP: Case = Case {
    name: "flood/bump",
    about: "Subcritical flow over a bump (Goutal & Maurel 1997; SWASHES: 25 m, q 4.42 m2/s, 2 m downstream), periodic \
            along the channel, started from the exact steady state and watched for 20 s: does it stay, and at what \
            discharge?",
    slow: true,
    reduced: 2.0,
    run: bump,
};

pub(super) const MACDONALD: Case = Case {
    name: "flood/macdonald",
    about: "Steady flow with Manning friction in an undulating channel (MacDonald et al. 1997; SWASHES: one period of \
            1000 m, q 2 m2/s, n 0.03), found by the water itself from rest within 1500 s.",
    slow: true,
    reduced: 2.0,
    run: macdonald,
};

/// A channel's exact depth along x, m, and its discharge, m2/s.
struct Channel {
    length: f64,
    discharge: f64,
    depth: fn(f64) -> f64,
    terrain: fn(Bounds, f64) -> Terrain,
}

fn bump(_: &Options) -> Vec<Row> {
    let channel = Channel { length: 25.0, discharge: 4.42, depth: depth_over_bump, terrain: bump_ground };
    let error = |spacing: f64| {
        let settings = settings(20.0, spacing, 2.0, strip(&Edge::Periodic));
        channel.run(&settings, 20.0, |x| channel.discharge / depth_over_bump(x))
    };
    let measure = || {
        let [fine, coarse] = [error(0.1)?, error(0.4)?];
        Ok(vec![
            Row::at_most(BUMP.name, "relative_l1_error_10cm", fine.depth, "", 5e-3),
            Row::at_most(BUMP.name, "relative_discharge_error_10cm", fine.discharge, "", 1e-2),
            Row::at_least(BUMP.name, "order", order(fine.depth, coarse.depth, 4.0), "", 0.45),
        ])
    };
    rows(BUMP.name, measure())
}

fn macdonald(_: &Options) -> Vec<Row> {
    let channel = Channel { length: 1000.0, discharge: 2.0, depth: macdonald_depth, terrain: macdonald_ground };
    let error = |spacing: f64| {
        let mut settings = settings(1500.0, spacing, 1.125, strip(&Edge::Periodic));
        settings.manning = Manning::Number(MACDONALD_MANNING);
        channel.run(&settings, 1500.0, |_| 0.0)
    };
    let measure = || {
        let [fine, coarse] = [error(5.0)?, error(20.0)?];
        Ok(vec![
            Row::at_most(MACDONALD.name, "relative_l1_error_5m", fine.depth, "", 5e-3),
            Row::at_most(MACDONALD.name, "relative_discharge_error_5m", fine.discharge, "", 1e-2),
            Row::at_least(MACDONALD.name, "order", order(fine.depth, coarse.depth, 4.0), "", 0.45),
        ])
    };
    rows(MACDONALD.name, measure())
}

struct Errors {
    /// mean |h - h_exact| / mean h_exact.
    depth: f64,
    /// |mean q - q_exact| / q_exact.
    discharge: f64,
}

impl Channel {
    /// Runs the channel to `time` s from its exact depth and the given velocity, and compares.
    fn run(&self, settings: &Settings, time: f64, velocity: impl Fn(f64) -> f64 + Sync) -> Result<Errors, ModelError> {
        let spacing = spacing_of(settings);
        let width = 14.0 * spacing;
        let bounds = Bounds { x_min: 0.0, x_max: self.length, y_min: 0.0, y_max: width };
        let terrain = Arc::new((self.terrain)(bounds, spacing));
        let water = water_everywhere(bounds, |x, _| (self.depth)(x), move |x, _| [velocity(x), 0.0]);
        let flood = run(settings, &terrain, &[water], time)?;
        Ok(self.compare(&flood, width))
    }

    fn compare(&self, flood: &Flood, width: f64) -> Errors {
        let (places, lines) = (500, 7);
        let (mut wrong, mut right, mut discharge) = (0.0, 0.0, 0.0);
        for place in 0..places {
            let x = self.length * (place as f64 + 0.5) / places as f64;
            for line in 0..lines {
                let sample = flood.sample(x, width * (line as f64 + 0.5) / lines as f64);
                right += (self.depth)(x);
                wrong += (sample.depth - (self.depth)(x)).abs();
                discharge += sample.depth * sample.velocity[0];
            }
        }
        let mean = discharge / (places * lines) as f64;
        Errors { depth: wrong / right, discharge: (mean - self.discharge).abs() / self.discharge }
    }
}

/// z = max(0, 0.2 - 0.05 (x - 10)^2).
fn bump_height(x: f64) -> f64 {
    (0.2 - 0.05 * (x - 10.0).powi(2)).max(0.0)
}

fn bump_ground(bounds: Bounds, cell: f64) -> Terrain {
    Terrain::analytic(bounds, cell, |x, _| {
        let slope = if bump_height(x) > 0.0 { -0.1 * (x - 10.0) } else { 0.0 };
        (bump_height(x), [slope, 0.0])
    })
}

/// Bernoulli: q^2/(2 g h^2) + h + z is what it is downstream; the subcritical root, by bisection above critical depth.
fn depth_over_bump(x: f64) -> f64 {
    let (q, downstream) = (4.42, 2.0);
    let head = |depth: f64| q * q / (2.0 * GRAVITY * depth * depth) + depth;
    let wanted = head(downstream) - bump_height(x);
    let critical = (q * q / GRAVITY).cbrt();
    let (mut low, mut high) = (critical, downstream);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if head(middle) < wanted { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

const MACDONALD_MANNING: f64 = 0.03;

/// h = 9/8 + 1/4 sin(pi x / 500).
fn macdonald_depth(x: f64) -> f64 {
    1.125 + 0.25 * (std::f64::consts::PI * x / 500.0).sin()
}

/// dz/dx = (q^2/(g h^3) - 1) dh/dx - n^2 q^2 / h^(10/3): the ground that makes this depth steady.
fn macdonald_slope(x: f64) -> f64 {
    let q: f64 = 2.0;
    let depth = macdonald_depth(x);
    let rise = 0.25 * std::f64::consts::PI / 500.0 * (std::f64::consts::PI * x / 500.0).cos();
    (q * q / (GRAVITY * depth.powi(3)) - 1.0) * rise - (MACDONALD_MANNING * q).powi(2) / depth.powf(10.0 / 3.0)
}

fn macdonald_ground(bounds: Bounds, cell: f64) -> Terrain {
    // Integrated once by Simpson's rule over pieces of 1 m; between them by the cubic with the right slopes.
    let mut heights = vec![0.0];
    for metre in 0..1000 {
        let x = f64::from(metre);
        let rise = (macdonald_slope(x) + 4.0 * macdonald_slope(x + 0.5) + macdonald_slope(x + 1.0)) / 6.0;
        heights.push(heights[metre as usize] + rise);
    }
    Terrain::analytic(bounds, cell, move |x, _| {
        let metre = (x.floor().max(0.0) as usize).min(999);
        let part = x - metre as f64;
        let (z0, z1) = (heights[metre], heights[metre + 1]);
        let (s0, s1) = (macdonald_slope(metre as f64), macdonald_slope(metre as f64 + 1.0));
        let (p2, p3) = (part * part, part * part * part);
        let height = z0 * (1.0 - 3.0 * p2 + 2.0 * p3)
            + z1 * (3.0 * p2 - 2.0 * p3)
            + s0 * (part - 2.0 * p2 + p3)
            + s1 * (p3 - p2);
        (height, [macdonald_slope(x), 0.0])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flow_over_the_bump_dips_and_recovers() {
        assert!((depth_over_bump(0.0) - 2.0).abs() < 1e-9);
        let top = depth_over_bump(10.0);
        assert!(top + 0.2 < 2.0, "the surface must dip over a bump in subcritical flow");
        let head = 4.42_f64.powi(2) / (2.0 * GRAVITY * top * top) + top + 0.2;
        assert!((head - (4.42_f64.powi(2) / (2.0 * GRAVITY * 4.0) + 2.0)).abs() < 1e-9);
    }
}
