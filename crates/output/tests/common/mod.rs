#![allow(dead_code, missing_docs, reason = "each test uses a part of it")]
//! A made-up flood in a generated valley, written as a run writes it.

use corpuscle_model::{Balance, Column, Frame, GaugeColumn, Ledger, Map, ParticleSet, Values};
use corpuscle_output::{Clock, FrameFormat, RunFolder, Status, Summary, ledger_entries};
use corpuscle_scene::Scene;
use corpuscle_terrain::Terrain;
use std::path::Path;

pub const SCENE: &str = r#"
title = "A flood wave in a meandering valley"
description = """
A river rises within minutes, fills its channel, leaves its banks and spreads over the flood plain. The ground is
generated from the seed; the flood is made up to test the report."""
seed = 7

[run]
until_s = 5400.0
frame_every_s = 300.0
gauge_every_s = 30.0

[terrain.valley]
extent = { length_m = 2000.0, width_m = 1000.0, cell_m = 5.0 }
slope = 0.004
channel_width_m = 40.0
channel_depth_m = 3.0
plain_width_m = 260.0
meander_m = 110.0
meander_length_m = 700.0
hills_m = 60.0

[flood]
spacing_m = 6.0
manning = 0.035

[[flood.inflow]]
name = "river"
at = [30.0, 500.0]
discharge_m3_per_s = [[0.0, 100.0], [1200.0, 900.0], [5400.0, 100.0]]

[[flood.gauge]]
name = "upper bridge"
at = [400.0, 480.0]

[[flood.gauge]]
name = "mill weir"
at = [1000.0, 520.0]

[[flood.gauge]]
name = "lower"
at = [1500.0, 480.0]

[[flood.gauge]]
name = "hill"
at = [1200.0, 900.0]

[[flood.section]]
name = "mid-valley"
line = [[1000.0, 700.0], [1000.0, 300.0]]
"#;

pub fn scene() -> Scene {
    Scene::parse(SCENE, "sample", &[]).unwrap()
}

pub fn terrain(scene: &Scene) -> Terrain {
    Terrain::open(&scene.flood().unwrap().terrain, scene.seed, Path::new(".")).unwrap()
}

/// A flood wave that is a function of position and time: a level that rises, travels down the valley and falls.
pub struct Wave<'a> {
    terrain: &'a Terrain,
    /// Lowest ground across the valley at each column of the grid, m.
    floor: Vec<f64>,
}

impl<'a> Wave<'a> {
    pub fn new(terrain: &'a Terrain) -> Self {
        let grid = terrain.map_grid();
        let height = |column: usize, row: usize| {
            let [x, y] = grid.centre(column, row);
            terrain.height(x, y)
        };
        let lowest = |column| (0..grid.rows).map(|row| height(column, row)).fold(f64::INFINITY, f64::min);
        let raw: Vec<f64> = (0..grid.columns).map(lowest).collect();
        let around = |column: usize| &raw[column.saturating_sub(20)..(column + 21).min(raw.len())];
        let floor = (0..raw.len()).map(|c| around(c).iter().sum::<f64>() / around(c).len() as f64).collect();
        Self { terrain, floor }
    }

    /// Depth, m, and speed, m/s, at a position and time; none where dry.
    pub fn at(&self, [x, y]: [f64; 2], time: f64) -> Option<[f64; 2]> {
        let bounds = self.terrain.bounds();
        let along = (x - bounds.x_min) / (bounds.x_max - bounds.x_min);
        let column = ((along * self.floor.len() as f64) as usize).min(self.floor.len() - 1);
        let phase = (time - 1600.0 * along) / 1500.0;
        let level = self.floor[column] + if phase > 0.0 { 5.2 * phase.sqrt() * (1.0 - phase).exp() } else { 0.0 };
        let depth = level - self.terrain.height(x, y);
        (depth > 0.01).then(|| [depth, 0.9 * depth.powf(0.6)])
    }

    /// The maps as a model gives them at a time, looking back every `period`.
    pub fn maps(&self, time: f64, period: f64) -> Vec<Map> {
        let grid = self.terrain.map_grid();
        let (columns, rows) = (grid.columns, grid.rows);
        let names = [
            ("depth", "Depth", "m"),
            ("max_depth", "Maximum depth", "m"),
            ("max_speed", "Maximum speed", "m/s"),
            ("arrival_s", "Arrival", "s"),
            ("duration_s", "Duration", "s"),
            ("hazard", "Hazard", ""),
        ];
        let map =
            |(name, title, unit)| Map { name, title, unit, columns, rows, values: vec![f32::NAN; columns * rows] };
        let mut maps = names.map(map);
        for cell in 0..columns * rows {
            let position = grid.centre(cell % columns, cell / columns);
            if !self.terrain.is_valid_cell(cell % columns, cell / columns) {
                continue;
            }
            if let Some([depth, _]) = self.at(position, time) {
                maps[0].values[cell] = depth as f32;
            }
            for sample in 0..=(time / period) as usize {
                let Some([depth, speed]) = self.at(position, sample as f64 * period) else { continue };
                let larger = |map: &mut Map, value: f64| map.values[cell] = map.values[cell].max(value as f32);
                larger(&mut maps[1], depth);
                larger(&mut maps[2], speed);
                larger(&mut maps[5], depth * (speed + 0.5));
                maps[3].values[cell] = maps[3].values[cell].min((sample as f64 * period) as f32);
                maps[4].values[cell] = maps[4].values[cell].max(0.0) + period as f32;
            }
        }
        maps.to_vec()
    }

    pub fn frame(&self, time: f64) -> Frame {
        let bounds = self.terrain.bounds();
        let mut water = ParticleSet { name: "water".into(), ..ParticleSet::default() };
        let (mut depths, mut flows) = (Vec::new(), Vec::new());
        let [east, north] = bounds.size().map(|length| (length / 25.0) as usize);
        for i in 0..east * north {
            let position =
                [bounds.x_min + (i % east) as f64 * 25.0 + 12.1, bounds.y_min + (i / east) as f64 * 25.0 + 12.3];
            let Some([depth, speed]) = self.at(position, time) else { continue };
            water.id.push(i as u64 + (1 << 60));
            water.position.push([position[0], position[1], self.terrain.height(position[0], position[1]) + depth]);
            water.velocity.push([speed, -0.1 * speed, 0.0]);
            water.radius.push(3.0);
            water.mass.push(54_000.0);
            depths.push(depth);
            flows.push([speed * depth, 0.0, 1e-9 * depth]);
        }
        water.columns = vec![
            Column { name: "depth", unit: "m", values: Values::Scalar(depths) },
            Column { name: "flow", unit: "m2/s", values: Values::Vector(flows) },
        ];
        Frame { time, sets: vec![water] }
    }

    pub fn gauge_row(&self, scene: &Scene, time: f64) -> Vec<f64> {
        let mut row = Vec::new();
        for gauge in &scene.flood().unwrap().flood.gauge {
            let position = gauge.at.unwrap();
            let [depth, speed] = self.at(position, time).unwrap_or([0.0, 0.0]);
            row.extend([depth, self.terrain.height(position[0], position[1]) + depth, speed, -0.1 * speed]);
        }
        let section = 780.0 * (-((time - 2300.0) / 1100.0).powi(2)).exp();
        row.extend([section, 500.0 * time.min(2500.0), 620_000.0 + 500.0 * time, 90.0 * (time - 1800.0).max(0.0)]);
        row
    }
}

pub fn gauge_columns(scene: &Scene) -> Vec<GaugeColumn> {
    let column = |gauge: &str, quantity, unit| GaugeColumn { gauge: gauge.into(), quantity, unit };
    let of_gauge = |gauge: &corpuscle_scene::Gauge| {
        [
            column(&gauge.name, "depth", "m"),
            column(&gauge.name, "level", "m"),
            column(&gauge.name, "velocity_east", "m_per_s"),
            column(&gauge.name, "velocity_north", "m_per_s"),
        ]
    };
    let mut columns: Vec<GaugeColumn> = scene.flood().unwrap().flood.gauge.iter().flat_map(of_gauge).collect();
    columns.extend([
        column("mid-valley", "discharge", "m3_per_s"),
        column("water", "stored", "m3"),
        column("water", "total_inflow", "m3"),
        column("water", "total_outflow", "m3"),
    ]);
    columns
}

pub fn summary() -> Summary {
    let water =
        Balance { quantity: "water_m3", initial: 0.0, inflow: 2.31e6, outflow: 1.87e6, now: 440_000.0, least: 0.0 };
    let momentum =
        Balance { quantity: "momentum", initial: 0.0, inflow: 2.5e9, outflow: 1.5e9, now: 1.0e9, least: 0.0 };
    Summary {
        model: "flood".into(),
        backend: "cpu".into(),
        version: env!("CARGO_PKG_VERSION").into(),
        status: Status::Done,
        particles: 41_327,
        steps: 18_211,
        simulated_time_s: 5400.0,
        wall_time_s: 97.3,
        particle_steps_per_s: Some(2.4e6),
        collisions: None,
        collisions_per_s: None,
        warnings: vec!["The terrain has no reference system: maps are in metres without a place on Earth.".into()],
        ledger: ledger_entries(&Ledger { balances: vec![water, momentum] }),
        extent: None,
    }
}

/// Writes the outputs from index `first` on as a run loop would; stops after `until` s without finishing.
pub fn advance(folder: &mut RunFolder, scene: &Scene, terrain: &Terrain, first: usize, until: f64) {
    let wave = Wave::new(terrain);
    for index in first.. {
        let time = index as f64 * scene.run.gauge_period_s();
        if time > until {
            break;
        }
        folder.append_gauges(time, &wave.gauge_row(scene, time)).unwrap();
        if index % 10 == 0 {
            folder.write_frame(&wave.frame(time), None).unwrap();
            // Looking back from the time itself: only the depth is kept of these.
            folder.write_snapshot(time, &wave.maps(time, time + 1.0)[..1], terrain).unwrap();
        }
    }
}

/// A whole run.
pub fn write_run(path: &Path, scene: &Scene, terrain: &Terrain, frames: FrameFormat) -> RunFolder {
    let mut folder = RunFolder::create(path, &scene.to_toml().unwrap(), &gauge_columns(scene), frames).unwrap();
    advance(&mut folder, scene, terrain, 0, scene.run.until_s);
    finish(&mut folder, scene, terrain);
    folder
}

/// What comes at the end of a run.
pub fn finish(folder: &mut RunFolder, scene: &Scene, terrain: &Terrain) {
    let until = scene.run.until_s;
    folder.write_final_maps(&Wave::new(terrain).maps(until, 120.0), terrain).unwrap();
    folder.write_checkpoint(Clock { time_s: until, wall_time_s: 1.0 }, b"the end").unwrap();
    folder.finish(&summary()).unwrap();
}
