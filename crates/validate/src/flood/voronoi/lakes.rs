//! Lakes at rest, and after waves, on rough ground.

use super::super::rows;
use super::noise::squares;
use super::{SEEDS, advance, all_sides, set_up, settings};
use crate::device::{is_reduced, reduced, reduction, rounding};
use crate::{Case, Options, Row};
use corpuscle_flood::{Filling, StartWater, VoronoiFlood};
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::{Edge, NoData, TerrainFile};
use corpuscle_terrain::{Bounds, Terrain};
use std::path::Path;
use std::sync::Arc;

pub(in super::super) const BLOCKS: Case = Case {
    name: "flood/voronoi/lake-blocks",
    about: "A lake of level 1.5 m on blocks of 6 m at heights of 0 to 3 m, particles 1.5 m apart, n 0.05, 300 s by scheme voronoi, three seeds: \
            undisturbed, stirred by 1e-6 m/s, and after waves of 0.2 m. Peers: smoothed particles of fixed volumes come to 0.43 m/s, in a \
            variational scheme to 5e-4 m/s and 4e-3 m/s after waves.",
    slow: false,
    reduced: 2.0,
    run: blocks,
};

pub(in super::super) const ISLANDS: Case = Case {
    name: "flood/voronoi/lake-islands",
    about: "A lake between random hills that stand out of it, on a grid of 5 m, particles 4 m apart, n 0.05, 300 s by scheme voronoi, three seeds: \
            undisturbed, stirred by 1e-6 m/s, and after waves of 0.2 m.",
    slow: false,
    reduced: 2.0,
    run: |_: &Options| rows(ISLANDS.name, islands()),
};

pub(in super::super) const JACKSBORO: Case = Case {
    name: "flood/voronoi/lake-jacksboro",
    about: "A lake of level 330 m on the Jacksboro terrain, particles 200 m and 100 m apart, n 0.05, 1800 s by scheme voronoi, three seeds: \
            undisturbed, stirred by 1e-6 m/s, and after waves of 0.2 m. Peers at 100 m: smoothed particles of fixed volumes come to 1.3 m/s and gain \
            energy, in a variational scheme to 6e-3 m/s and 1.3e-2 m/s after waves.",
    slow: true,
    reduced: 6.0,
    run: jacksboro,
};

pub(in super::super) const LONG: Case = Case {
    name: "flood/voronoi/lake-long",
    about: "The lake on the Jacksboro terrain, particles 800 m apart, through 100,000 steps by scheme voronoi, n 0.05, undisturbed and after waves of 0.2 m: what the \
            rounding of so many steps adds up to, which is for single precision on a GPU to show. The waves leave pools above the lake's level.",
    slow: true,
    reduced: 2.0,
    run: long,
};

fn blocks(options: &Options) -> Vec<Row> {
    let Some(data) = &options.data else { return vec![Row::without_data(BLOCKS.name, options)] };
    let lake = || {
        Lake { case: BLOCKS.name, level: 1.5, spacing: 1.5, time: 300.0 }
            .rows(&file(&data.join("blocks/blocks.asc"))?, "")
    };
    rows(BLOCKS.name, lake())
}

fn jacksboro(options: &Options) -> Vec<Row> {
    let Some(data) = &options.data else { return vec![Row::without_data(JACKSBORO.name, options)] };
    let lakes = || {
        let terrain = file(&data.join("jacksboro/dem.tif"))?;
        let lake = |spacing| Lake { case: JACKSBORO.name, level: 330.0, spacing, time: 1800.0 };
        let mut rows = lake(200.0).rows(&terrain, "_200m")?;
        rows.extend(lake(100.0).rows(&terrain, "_100m")?);
        Ok(rows)
    };
    rows(JACKSBORO.name, lakes())
}

/// A step of that lake takes about so long, s: how often it is looked whether there have been enough.
const STEP_AT_800M: f64 = 8.0;

/// Steps of the long run, and of it at its reduced size.
const STEPS: [u64; 2] = [100_000, 1_000];

fn long(options: &Options) -> Vec<Row> {
    let Some(data) = &options.data else { return vec![Row::without_data(LONG.name, options)] };
    rows(LONG.name, file(&data.join("jacksboro/dem.tif")).and_then(|terrain| after_many_steps(&terrain)))
}

fn after_many_steps(terrain: &Arc<Terrain>) -> Result<Vec<Row>, ModelError> {
    let steps = STEPS[usize::from(is_reduced())];
    let lake = Lake { case: LONG.name, level: 330.0, spacing: 800.0, time: 0.0 };
    let after = |stir: Stir| {
        let mut flood = lake.set_up(terrain, SEEDS[0], stir)?;
        let mut taken = 0;
        while taken < steps {
            // Some hundred samples.
            let time = flood.time() + 0.01 * steps as f64 * STEP_AT_800M * reduction();
            advance(&mut flood, time)?;
            taken = flood.particle_steps() / flood.wet_cells().count() as u64;
        }
        let water = flood.ledger().balances[0].relative_error().abs();
        Ok::<_, ModelError>((taken as f64, lake.settled(&flood, 0.0), water))
    };
    let water_bound = rounding(1e-13, 1e-7);
    let row = |measure, value, unit, bound| Row::at_most(LONG.name, measure, value, unit, bound);
    let at_least = |measure, value| Row::at_least(LONG.name, measure, value, "", steps as f64);
    let (taken, settled, water) = after(Stir::Nothing)?;
    let (taken_after_waves, after_waves, water_after_waves) = after(Stir::Surface(0.2))?;
    Ok(vec![
        at_least("steps_undisturbed", taken),
        row("level_undisturbed", settled.level, "m", rounding(1e-9, 1e-3)),
        row("rms_speed_undisturbed", settled.rms, "m/s", rounding(1e-9, 1e-4)),
        row("water_relative_error_undisturbed", water, "", water_bound),
        at_least("steps_after_waves", taken_after_waves),
        row("rms_speed_after_waves", after_waves.rms, "m/s", 1e-3),
        row("water_relative_error_after_waves", water_after_waves, "", water_bound),
    ])
}

fn islands() -> Result<Vec<Row>, ModelError> {
    let bounds = Bounds { x_min: 0.0, x_max: 200.0, y_min: 0.0, y_max: 160.0 };
    // From the bottom of the lake up to as much above it.
    let [hills, rough] = [squares(20.0, 11), squares(5.0, 12)];
    let terrain = Terrain::gridded(bounds, 5.0, |x, y| 4.0 * hills(x, y) + 2.0 * rough(x, y));
    Lake { case: ISLANDS.name, level: 1.0, spacing: 4.0, time: 300.0 }.rows(&Arc::new(terrain), "")
}

fn file(path: &Path) -> Result<Arc<Terrain>, ModelError> {
    let ground = TerrainFile { path: path.into(), crs: None, no_data: NoData::Wall };
    let terrain = Terrain::open(&corpuscle_scene::Terrain::File(ground), 0, Path::new("."));
    terrain.map(Arc::new).map_err(|error| ModelError::Setup(error.to_string()))
}

/// Samples of the energy within a run.
const SAMPLES: usize = 60;

struct Lake {
    case: &'static str,
    /// m.
    level: f64,
    spacing: f64,
    /// s.
    time: f64,
}

/// What stirs a lake.
#[derive(Clone, Copy)]
enum Stir {
    Nothing,
    /// Velocities up to so many m/s.
    Velocity(f64),
    /// Heights of the surface up to so many m.
    Surface(f64),
}

/// A lake at its end.
struct Settled {
    /// m/s.
    rms: f64,
    /// Farthest level of a cell from the lake's, m.
    level: f64,
    /// Most energy beyond that at the start, over the latter, at any sample.
    gained: f64,
}

impl Lake {
    fn rows(&self, terrain: &Arc<Terrain>, suffix: &str) -> Result<Vec<Row>, ModelError> {
        let worst = |stir: Stir| {
            let mut worst = Settled { rms: 0.0, level: 0.0, gained: f64::NEG_INFINITY };
            for &seed in reduced(&SEEDS) {
                let settled = self.settle(terrain, seed, stir)?;
                worst.rms = worst.rms.max(settled.rms);
                worst.level = worst.level.max(settled.level);
                worst.gained = worst.gained.max(settled.gained);
            }
            Ok::<Settled, ModelError>(worst)
        };
        let row = |measure: &str, value, unit, bound| {
            Row::at_most(self.case, &format!("{measure}{suffix}"), value, unit, bound)
        };
        let still = worst(Stir::Nothing)?;
        // Single precision itself stirs by 1e-6 m/s.
        let stirred = worst(Stir::Velocity(rounding(1e-6, 1e-3)))?;
        let waves = worst(Stir::Surface(0.2))?;
        Ok(vec![
            row("level_undisturbed", still.level, "m", rounding(1e-9, 1e-5)),
            row("rms_speed_undisturbed", still.rms, "m/s", rounding(1e-9, 1e-4)),
            row("rms_speed_stirred", stirred.rms, "m/s", 1e-3),
            row("energy_gained_stirred", stirred.gained, "", 0.0),
            row("rms_speed_after_waves", waves.rms, "m/s", 1e-3),
            row("energy_gained_after_waves", waves.gained, "", 0.0),
        ])
    }

    fn settle(&self, terrain: &Arc<Terrain>, seed: u64, stir: Stir) -> Result<Settled, ModelError> {
        let mut flood = self.set_up(terrain, seed, stir)?;
        let start = flood.energy_above_lake(self.level);
        let mut most = f64::NEG_INFINITY;
        for sample in 1..=SAMPLES {
            advance(&mut flood, self.time * sample as f64 / SAMPLES as f64)?;
            most = most.max(flood.energy_above_lake(self.level));
        }
        let gained = if start > 0.0 { most / start - 1.0 } else { 0.0 };
        Ok(self.settled(&flood, gained))
    }

    /// State at its end.
    fn settled(&self, flood: &VoronoiFlood, gained: f64) -> Settled {
        let (mut moving, mut volume, mut farthest) = (0.0, 0.0, 0.0_f64);
        for cell in flood.wet_cells() {
            let [u, v] = cell.velocity;
            moving += cell.area * cell.depth * (u * u + v * v);
            volume += cell.area * cell.depth;
            farthest = farthest.max((cell.level - self.level).abs());
        }
        Settled { rms: (moving / volume).sqrt(), level: farthest, gained }
    }

    fn set_up(&self, terrain: &Arc<Terrain>, seed: u64, stir: Stir) -> Result<VoronoiFlood, ModelError> {
        let noise = [1, 2, 3].map(|k| squares(self.spacing, 10 * seed + k));
        let level = self.level;
        let [surface, velocity] = match stir {
            Stir::Nothing => [0.0; 2],
            Stir::Velocity(most) => [0.0, most],
            Stir::Surface(most) => [most, 0.0],
        };
        let settings = settings(self.spacing, 0.05, all_sides(&Edge::Wall));
        let water = StartWater {
            filling: Filling::Level(Box::new(move |x, y| level + surface * noise[0](x, y))),
            polygon: None,
            velocity: Box::new(move |x, y| [noise[1], noise[2]].map(|noise| velocity * noise(x, y))),
        };
        set_up(&settings, seed, terrain, &[water])
    }
}
