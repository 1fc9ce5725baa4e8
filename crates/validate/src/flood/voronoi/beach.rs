//! Solitary waves on a plane beach (Synolakis 1987), and waves sent in through a side.

use super::super::measured::table;
use super::super::{GRAVITY, order, rows};
use super::{advance, set_up, settings, worst};
use crate::{Case, Options, Row};
use corpuscle_flood::{Filling, StartWater, VoronoiFlood};
use corpuscle_model::ModelError;
use corpuscle_scene::{Edge, Edges, Flood, Series, Wave};
use corpuscle_terrain::{Bounds, Terrain};
use std::path::Path;
use std::sync::Arc;

pub(in super::super) const BEACH: Case = Case {
    name: "flood/voronoi/beach",
    about: "A solitary wave of 0.019 of the depth d on a plane beach 1:19.85 by scheme voronoi, three seeds, spacings of 0.05, 0.1 and 0.2 d: \
            profiles at eight times and the highest run-up against the exact solution of the shallow-water equations (Synolakis, J. Fluid Mech. \
            185, 1987, 523; NTHMP benchmark 1).",
    slow: true,
    reduced: 4.0,
    run: canonical,
};

pub(in super::super) const RUN_UP: Case = Case {
    name: "flood/voronoi/run-up",
    about: "Run-up of solitary waves of 0.04 to 0.3 of the depth on the beach 1:19.85 by scheme voronoi, three seeds, spacing 0.1 d, against the runs of the \
            laboratory (Synolakis 1987; NTHMP benchmark 4). All but the lowest break. n 0.01, that of glass (Chow 1959, table 5-6).",
    slow: true,
    reduced: 4.0,
    run: laboratory,
};

pub(in super::super) const SENT_WAVE: Case = Case {
    name: "flood/voronoi/sent-wave",
    about: "A wave sent in through a side by scheme voronoi, three seeds: the volume that it brings, and what is left of it after it came back from a \
            wall and left by the same side.",
    slow: false,
    reduced: 2.0,
    run: |_: &Options| rows(SENT_WAVE.name, sent_wave()),
};

/// Horizontal over vertical of the beach.
const COTANGENT: f64 = 19.85;

/// Width of a strip in spacings; its long sides are joined.
const WIDTH: f64 = 5.0;

/// Lines along the strip on which the water is sampled.
const LINES: usize = 5;

/// Height of the canonical wave over the depth.
const HEIGHT: f64 = 0.019;

/// Highest run-up of the canonical wave over the depth, by [`run_up`].
const HIGHEST: f64 = 0.09125;

/// Spacings over the depth, and the names of their rows.
const SPACINGS: [(f64, [&str; 3]); 3] = [
    (0.05, ["farthest_profile_error_005d", "rms_profile_error_005d", "run_up_error_005d"]),
    (0.1, ["farthest_profile_error_010d", "rms_profile_error_010d", "run_up_error_010d"]),
    (0.2, ["farthest_profile_error_020d", "rms_profile_error_020d", "run_up_error_020d"]),
];

/// Water shallower than this is no part of the run-up, in depths: of the exact solution, and in the laboratory, where it is 0.2 mm.
const DRY: f64 = 1e-4;
const DRY_IN_LABORATORY: f64 = 1e-3;

/// Manning's n of glass, s/m^(1/3) (Chow 1959, table 5-6).
const MANNING: f64 = 0.01;

/// Times of the profiles, in sqrt(d/g).
const TIMES: [f64; 8] = [35.0, 40.0, 45.0, 50.0, 55.0, 60.0, 65.0, 70.0];

/// Solitary wave that begins on the way to the beach.
#[derive(Debug, Clone, Copy)]
struct Solitary {
    /// Depth of the still water, m.
    depth: f64,
    /// Height over the depth.
    height: f64,
}

impl Solitary {
    /// Decay length of the wave: eta = H sech^2(gamma (x - X1)/d) with gamma = sqrt(3H/4d) (Synolakis 1987, section 3).
    fn gamma(&self) -> f64 {
        (0.75 * self.height).sqrt()
    }

    /// Position of the crest at the start, in depths: half a wave length before the toe (Synolakis 1987, section 3).
    fn crest(&self) -> f64 {
        COTANGENT + 20.0_f64.sqrt().acosh() / self.gamma()
    }

    /// Level at the start, m, at `x` m.
    fn level(&self, x: f64) -> f64 {
        let along = self.gamma() * (x / self.depth - self.crest());
        self.depth * self.height / along.cosh().powi(2)
    }

    /// Time in which a long wave passes one depth, s.
    fn time_unit(&self) -> f64 {
        (self.depth / GRAVITY).sqrt()
    }

    /// Ground from `land` depths inland to beyond the wave.
    fn ground(&self, land: f64, spacing: f64) -> Arc<Terrain> {
        let sea = self.crest() + 4.0 / self.gamma();
        let bounds = Bounds {
            x_min: -land * self.depth,
            x_max: sea * self.depth,
            y_min: 0.0,
            y_max: WIDTH * spacing * self.depth,
        };
        beach(bounds, self.depth, spacing)
    }

    /// The wave at its start over particles `spacing` depths apart, with Manning's n.
    fn begin(&self, land: f64, spacing: f64, manning: f64, seed: u64) -> Result<VoronoiFlood, ModelError> {
        self.begin_with(land, &self.settings(spacing, manning), seed)
    }

    /// Settings for particles `spacing` depths apart, with Manning's n.
    fn settings(&self, spacing: f64, manning: f64) -> Flood {
        let edges = Edges { west: Edge::Wall, east: Edge::Open, south: Edge::Periodic, north: Edge::Periodic };
        settings(spacing * self.depth, manning, edges)
    }

    /// The wave at its start with settings.
    fn begin_with(&self, land: f64, settings: &Flood, seed: u64) -> Result<VoronoiFlood, ModelError> {
        let spacing = settings.spacing_m.unwrap_or(1.0) / self.depth;
        let wave = *self;
        let water = StartWater {
            filling: Filling::Level(Box::new(move |x, _| wave.level(x))),
            polygon: None,
            velocity: Box::new(move |x, _| [-(GRAVITY / wave.depth).sqrt() * wave.level(x), 0.0]),
        };
        set_up(settings, seed, &self.ground(land, spacing), &[water])
    }
}

/// A beach that rises inland from its toe at 19.85 depths; still water is level with 0.
fn beach(bounds: Bounds, depth: f64, spacing: f64) -> Arc<Terrain> {
    Arc::new(Terrain::analytic(bounds, spacing * depth, move |x, _| {
        let height = -x / COTANGENT;
        if height > -depth { (height, [-1.0 / COTANGENT, 0.0]) } else { (-depth, [0.0; 2]) }
    }))
}

/// Depth of the water on a line, in depths.
fn depth_at(flood: &VoronoiFlood, wave: &Solitary, spacing: f64, x: f64, line: usize) -> f64 {
    let y = WIDTH * spacing * (line as f64 + 0.5) / LINES as f64;
    flood.sample(x * wave.depth, y * wave.depth).depth / wave.depth
}

/// Height of the shoreline, mean of the lines, in depths: searched from `land` seawards.
fn shoreline(flood: &VoronoiFlood, wave: &Solitary, spacing: f64, land: f64, dry: f64) -> f64 {
    let step = 0.1 * spacing;
    let on_line = |line: usize| {
        let is_wet = |index: &usize| depth_at(flood, wave, spacing, *index as f64 * step - land, line) > dry;
        let wet = (0..).find(is_wet).unwrap_or(0);
        (land - wet as f64 * step) / COTANGENT
    };
    (0..LINES).map(on_line).sum::<f64>() / LINES as f64
}

/// Relative error of the highest run-up of the canonical wave over particles `spacing` depths apart, with settings that `adapted` makes of those of the case; and
/// the flood.
pub(super) fn run_up(
    adapted: impl FnOnce(Flood) -> Flood,
    spacing: f64,
    seed: u64,
) -> Result<(f64, VoronoiFlood), ModelError> {
    let (wave, land) = (Solitary { depth: 1.0, height: HEIGHT }, 3.0);
    let mut flood = wave.begin_with(land, &adapted(wave.settings(spacing, 0.0)), seed)?;
    let mut highest = 0.0_f64;
    // The wave is at the shore from 45 on and has turned back by 60.
    for half in 90..=120 {
        advance(&mut flood, 0.5 * f64::from(half) * wave.time_unit())?;
        highest = highest.max(shoreline(&flood, &wave, spacing, land, DRY));
    }
    Ok(((highest / HIGHEST - 1.0).abs(), flood))
}

fn canonical(options: &Options) -> Vec<Row> {
    match &options.data {
        None => vec![Row::without_data(BEACH.name, options)],
        Some(data) => rows(BEACH.name, profiles(&data.join("beach"))),
    }
}

fn profiles(folder: &Path) -> Result<Vec<Row>, ModelError> {
    let exact = table(&folder.join("canonical-profiles.csv"), 1)?;
    let (mut out, mut found) = (Vec::new(), Vec::new());
    for (spacing, measures) in SPACINGS {
        let errors = worst(|seed| against_exact(&exact, spacing, seed))?;
        found.push(errors);
        let bounds = [(2e-3, "d"), (2e-3, "d"), (0.02, "")];
        for ((measure, error), (bound, unit)) in measures.into_iter().zip(errors).zip(bounds) {
            out.push(if spacing == SPACINGS[0].0 {
                Row::at_most(BEACH.name, measure, error, unit, bound)
            } else {
                Row::beside(BEACH.name, measure, error, unit, bound, "for the order")
            });
        }
    }
    let why = "off the beach the exact solution is that of linear waves: 2.1e-3 from the shallow-water equations at one position";
    for (measure, k) in [("profile_order", 1), ("run_up_order", 2)] {
        out.push(Row::beside(BEACH.name, measure, order(found[0][k], found[2][k], 4.0), "", 1.0, why));
    }
    Ok(out)
}

/// Farthest distance of the profiles from the exact ones and root of the mean square, in depths, and the relative error of the highest run-up.
fn against_exact(exact: &[Vec<Option<f64>>], spacing: f64, seed: u64) -> Result<[f64; 3], ModelError> {
    let (wave, land) = (Solitary { depth: 1.0, height: HEIGHT }, 3.0);
    let mut flood = wave.begin(land, spacing, 0.0, seed)?;
    let (mut far, mut sum, mut count, mut highest) = (0.0_f64, 0.0, 0.0, 0.0_f64);
    for half in 0..=140 {
        let time = 0.5 * f64::from(half);
        advance(&mut flood, time * wave.time_unit())?;
        if time >= 45.0 {
            highest = highest.max(shoreline(&flood, &wave, spacing, land, DRY));
        }
        let Some(column) = TIMES.iter().position(|of_profile| *of_profile == time) else { continue };
        let level = |row: &Vec<Option<f64>>| row.get(column + 1).copied().flatten();
        let shore = exact.iter().position(|row| level(row).is_some()).unwrap_or(0);
        for (index, row) in exact.iter().enumerate() {
            let Some(x) = row[0] else { continue };
            let ground = (-x / COTANGENT).max(-1.0);
            let depth = (0..LINES).map(|line| depth_at(&flood, &wave, spacing, x, line)).sum::<f64>() / LINES as f64;
            // Inland of the shore the depth itself is the error; one position at sea has no value.
            let Some(level) = level(row).or((index < shore).then_some(ground)) else { continue };
            let error = (ground + depth - level).abs();
            (far, sum, count) = (far.max(error), sum + error * error, count + 1.0);
        }
    }
    Ok([far, (sum / count).sqrt(), (highest / HIGHEST - 1.0).abs()])
}

/// Heights of waves over the depth, and the names of their rows.
const HEIGHTS: [(f64, &str); 4] = [
    (0.04, "run_up_error_height_004"),
    (0.09, "run_up_error_height_009"),
    (0.19, "run_up_error_height_019"),
    (0.3, "run_up_error_height_030"),
];

/// Runs of waves whose height differs by at most this part count as runs of the same height.
const ALIKE: f64 = 0.15;

/// Height over the depth from which on waves break, on the way up or down (Synolakis 1987, section 5).
const BREAKS: f64 = 0.055;

fn laboratory(options: &Options) -> Vec<Row> {
    match &options.data {
        None => vec![Row::without_data(RUN_UP.name, options)],
        Some(data) => rows(RUN_UP.name, run_ups(&data.join("beach"))),
    }
}

/// A run of the laboratory.
#[derive(Debug, Clone, Copy)]
struct Measured {
    /// Height over depth, and run-up over depth.
    height: f64,
    run_up: f64,
    /// Depth, m.
    depth: f64,
}

fn run_ups(folder: &Path) -> Result<Vec<Row>, ModelError> {
    let rows = table(&folder.join("lab-runup.csv"), 1)?;
    let run = |row: &Vec<Option<f64>>| {
        let [height, run_up, centimetres] = [row[0]?, *row.get(1)?.as_ref()?, *row.get(2)?.as_ref()?];
        Some(Measured { height, run_up, depth: 0.01 * centimetres })
    };
    let runs: Vec<Measured> = rows.iter().filter_map(run).collect();
    let mut out = Vec::new();
    for (height, measure) in HEIGHTS {
        let [mean, spread, depth] = measured_run_up(&runs, height);
        let [off] = worst(|seed| {
            let highest = highest_run_up(&Solitary { depth, height }, MANNING, seed)?;
            Ok([(highest / mean - 1.0).abs()])
        })?;
        out.push(Row::at_most(RUN_UP.name, measure, off, "", spread));
    }
    let [mean, _, depth] = measured_run_up(&runs, 0.19);
    let slippery = highest_run_up(&Solitary { depth, height: 0.19 }, 0.0, 1)?;
    let why = "without friction, beside what was measured: the thin tip of a broken wave depends on it";
    out.push(Row::beside(RUN_UP.name, "run_up_without_friction_height_019", slippery, "d", mean, why));
    Ok(out)
}

/// Run-up of a wave of a height over the depth, the part by which runs scatter about that, and the mean depth of runs of about that height, m. Of
/// waves that break the run-up is 1.109 height^0.583, fitted to the runs by Synolakis (1987, section 5), and the scatter the farthest of all of them. Of lower
/// ones it is the mean of runs of about that height, brought to it by height^1.25 (the run-up law, Synolakis 1987, section 3), and the farthest of these.
fn measured_run_up(runs: &[Measured], height: f64) -> [f64; 3] {
    let alike: Vec<&Measured> = runs.iter().filter(|run| (run.height / height - 1.0).abs() <= ALIKE).collect();
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let farthest = |ratios: &[f64]| ratios.iter().map(|ratio| (ratio - 1.0).abs()).fold(0.0, f64::max);
    let depth = mean(&alike.iter().map(|run| run.depth).collect::<Vec<_>>());
    if height >= BREAKS {
        let law = |height: f64| 1.109 * height.powf(0.583);
        let broken = runs.iter().filter(|run| run.height >= BREAKS);
        let ratios: Vec<f64> = broken.map(|run| run.run_up / law(run.height)).collect();
        return [law(height), farthest(&ratios), depth];
    }
    let brought: Vec<f64> = alike.iter().map(|run| run.run_up * (height / run.height).powf(1.25)).collect();
    let mean = mean(&brought);
    let ratios: Vec<f64> = brought.iter().map(|run_up| run_up / mean).collect();
    [mean, farthest(&ratios), depth]
}

/// Highest run-up over the depth.
fn highest_run_up(wave: &Solitary, manning: f64, seed: u64) -> Result<f64, ModelError> {
    let spacing = 0.1;
    // Three times as far as the runs of the laboratory go.
    let land = 3.0 * COTANGENT * 1.109 * wave.height.powf(0.583);
    let mut flood = wave.begin(land, spacing, manning, seed)?;
    let mut highest = 0.0_f64;
    // From when the crest comes to the shore until the water falls.
    for half in 0..=60 {
        advance(&mut flood, (wave.crest() + 0.5 * f64::from(half)) * wave.time_unit())?;
        let height = shoreline(&flood, wave, spacing, land, DRY_IN_LABORATORY);
        if height > wave.height && height < 0.9 * highest {
            break;
        }
        highest = highest.max(height);
    }
    Ok(highest)
}

/// Length of the flat tank, m; the water is 1 m deep.
const TANK: f64 = 40.0;

fn sent_wave() -> Result<Vec<Row>, ModelError> {
    let [brought, back, highest] = worst(sent)?;
    let at_most = |measure, value, bound| Row::at_most(SENT_WAVE.name, measure, value, "", bound);
    Ok(vec![
        at_most("volume_error", brought, 0.01),
        at_most("volume_left", back, 0.02),
        at_most("height_left", highest, 0.02),
    ])
}

/// Error of the volume that a wave brings, and after it left again what is left of volume and height, over those of the wave.
fn sent(seed: u64) -> Result<[f64; 3], ModelError> {
    let (spacing, height) = (0.25, 0.05);
    let celerity = GRAVITY.sqrt();
    let gamma = (0.75_f64 * height).sqrt();
    let middle = 5.0 / gamma / celerity;
    let level = move |time: f64| height / (gamma * celerity * (time - middle)).cosh().powi(2);
    let series: Vec<[f64; 2]> = (0..=400).map(|k| f64::from(k) * middle / 200.0).map(|t| [t, level(t)]).collect();
    // A simple wave: u = 2 (c - c0) (Stoker 1957, section 10.2).
    let discharge = |level: f64| (1.0 + level) * 2.0 * ((GRAVITY * (1.0 + level)).sqrt() - celerity);
    let volume: f64 = series
        .windows(2)
        .map(|rows| 0.5 * (rows[1][0] - rows[0][0]) * (discharge(rows[0][1]) + discharge(rows[1][1])))
        .sum();
    let bounds = Bounds { x_min: 0.0, x_max: TANK, y_min: 0.0, y_max: WIDTH * spacing };
    let terrain = Arc::new(Terrain::analytic(bounds, spacing, |_, _| (-1.0, [0.0; 2])));
    let wave = Wave { rest_level_m: 0.0, level_m: Some(Series::Table(series)), velocity_m_per_s: None };
    let edges = Edges { west: Edge::Wave(wave), east: Edge::Wall, south: Edge::Periodic, north: Edge::Periodic };
    let water = StartWater {
        filling: Filling::Level(Box::new(|_, _| 0.0)),
        polygon: None,
        velocity: Box::new(|_, _| [0.0; 2]),
    };
    let mut flood = set_up(&settings(spacing, 0.0, edges), seed, &terrain, &[water])?;
    let still = TANK * bounds.y_max;
    let excess = |flood: &VoronoiFlood| flood.wet_cells().map(|cell| cell.area * cell.depth).sum::<f64>() - still;
    let whole = volume * bounds.y_max;
    // When all of it has come, and none has come back yet.
    advance(&mut flood, 2.0 * middle)?;
    let brought = (excess(&flood) / whole - 1.0).abs();
    advance(&mut flood, 2.0 * middle + 3.0 * TANK / celerity)?;
    let left = flood.wet_cells().map(|cell| (cell.depth - 1.0).abs()).fold(0.0, f64::max);
    Ok([brought, excess(&flood).abs() / whole, left / height])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Height of the shoreline at `time` over the depth by the series of Synolakis (1987, section 3); I0 and I1 are scaled by exp(-x).
    fn exact_run_up(time: f64) -> f64 {
        let wave = Solitary { depth: 1.0, height: HEIGHT };
        let (gamma, crest) = (wave.gamma(), wave.crest());
        let term = |n: i32| {
            let sign = if n % 2 == 0 { -1.0 } else { 1.0 };
            let bessel = scaled_bessel(4.0 * gamma * COTANGENT * f64::from(n));
            sign * f64::from(n) * (-2.0 * gamma * (crest + COTANGENT - time) * f64::from(n)).exp() / bessel
        };
        8.0 * HEIGHT * (1..60).map(term).sum::<f64>()
    }

    /// exp(-x) (I0(x) + I1(x)) by its integral (Abramowitz & Stegun 1964, equation 9.6.19).
    fn scaled_bessel(x: f64) -> f64 {
        let parts = 2000;
        let angle = |k: usize| std::f64::consts::PI * (k as f64 + 0.5) / parts as f64;
        let of = |angle: f64| (x * (angle.cos() - 1.0)).exp() * (1.0 + angle.cos());
        (0..parts).map(|k| of(angle(k))).sum::<f64>() / parts as f64
    }

    #[test]
    fn the_highest_run_up_is_that_of_the_exact_solution() {
        let highest = (4500..5700).map(|k| exact_run_up(0.01 * f64::from(k))).fold(0.0, f64::max);
        assert!((highest / HIGHEST - 1.0).abs() < 1e-3, "{highest}");
    }
}
