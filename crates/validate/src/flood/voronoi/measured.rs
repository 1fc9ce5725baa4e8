//! Floods that were measured, or that a peer has computed, by scheme `voronoi`.

use super::super::{ea_test5, isolated_building, rows, triangular_obstacle};
use super::{SEEDS, set_up};
use crate::device::{reduced, sized};
use crate::{Case, Options, Row};
use corpuscle_flood::{Filling, StartWater};
use corpuscle_model::ModelError;
use corpuscle_scene::Flood as Settings;
use corpuscle_terrain::{Bounds, Terrain};
use std::path::Path;
use std::sync::Arc;

pub(in super::super) const TRIANGULAR_OBSTACLE: Case = Case {
    name: "flood/voronoi/triangular-obstacle",
    about: "The dam break over a triangular sill of `flood/triangular-obstacle` by scheme voronoi, three seeds, particles 0.1 m apart; bounds of scheme \
            balanced with 0.05 m.",
    slow: true,
    reduced: 2.0,
    run: |options: &Options| of_data(TRIANGULAR_OBSTACLE.name, "triangular_obstacle", options, sill),
};

pub(in super::super) const ISOLATED_BUILDING: Case = Case {
    name: "flood/voronoi/isolated-building",
    about: "The dam break against an oblique building of `flood/isolated-building` by scheme voronoi, three seeds, particles 0.12 m apart; bounds of \
            scheme balanced with 0.06 m.",
    slow: true,
    reduced: 2.0,
    run: |options: &Options| of_data(ISOLATED_BUILDING.name, "isolated_building", options, building),
};

pub(in super::super) const EA_TEST5: Case = Case {
    name: "flood/voronoi/ea-test5",
    about: "The valley below a failing dam of `flood/ea-test5` by scheme voronoi, three seeds, particles 50 m apart as the cells of the peer; bounds of \
            scheme balanced with 25 m.",
    slow: true,
    reduced: 2.0,
    run: |options: &Options| of_data(EA_TEST5.name, "ea_test5", options, valley),
};

/// The rows of a seed, given the folder of the data; charts go to the options.
type OfSeed = fn(&Path, u64, &Options) -> Result<Vec<Row>, ModelError>;

/// Each row of the seed that has it worst; the charts are the first seed's.
fn of_data(case: &'static str, folder: &str, options: &Options, of_seed: OfSeed) -> Vec<Row> {
    let Some(data) = &options.data else { return vec![Row::without_data(case, options)] };
    let measure = || {
        let mut worst = of_seed(&data.join(folder), SEEDS[0], options)?;
        for seed in &reduced(&SEEDS)[1..] {
            let others = of_seed(&data.join(folder), *seed, &Options::default())?;
            for (worst, other) in worst.iter_mut().zip(others) {
                // A value that is not a number is the worst, too.
                if worst.value.is_some_and(|value| other.value.is_none_or(|other| other.is_nan() || other > value)) {
                    *worst = other;
                }
            }
        }
        Ok(worst)
    };
    rows(case, measure())
}

/// Water at rest at a level, m, between two x.
fn pool<'a>(level: f64, [from, to]: [f64; 2], bounds: Bounds) -> StartWater<'a> {
    let [south, north] = [bounds.y_min - 1.0, bounds.y_max + 1.0];
    StartWater {
        filling: Filling::Level(Box::new(move |_, _| level)),
        polygon: Some(vec![[from, south], [to, south], [to, north], [from, north]]),
        velocity: Box::new(|_, _| [0.0; 2]),
    }
}

/// The same set-up with particles `spacing_m` apart everywhere.
fn with_spacing(settings: Settings, spacing_m: f64) -> Settings {
    Settings {
        spacing_m: Some(sized(spacing_m)),
        spacing_depth_m: None,
        wet_depth_m: 1e-6,
        map_every_s: None,
        ..settings
    }
}

fn sill(folder: &Path, seed: u64, options: &Options) -> Result<Vec<Row>, ModelError> {
    use triangular_obstacle::{CREST, DAM, LENGTH, WIDTH, bed, channel, compare};
    let spacing = 0.1;
    let bounds = Bounds { x_min: 0.0, x_max: LENGTH, y_min: 0.0, y_max: WIDTH };
    let terrain = Arc::new(Terrain::analytic(bounds, spacing, |x, _| bed(x)));
    let water = [pool(0.75, [-1.0, DAM], bounds), pool(0.15, [CREST, LENGTH + 1.0], bounds)];
    let mut flood = set_up(&with_spacing(channel(), spacing), seed, &terrain, &water)?;
    compare(TRIANGULAR_OBSTACLE.name, &mut flood, folder, options)
}

fn building(folder: &Path, seed: u64, options: &Options) -> Result<Vec<Row>, ModelError> {
    use isolated_building::{compare, flume, ground};
    let terrain = ground();
    let bounds = terrain.bounds();
    let water = [pool(0.4, [-1.0, 6.75], bounds), pool(0.02, [6.75, bounds.x_max + 1.0], bounds)];
    let mut flood = set_up(&with_spacing(flume(folder)?, 0.12), seed, &terrain, &water)?;
    compare(ISOLATED_BUILDING.name, &mut flood, folder, options)
}

fn valley(folder: &Path, seed: u64, options: &Options) -> Result<Vec<Row>, ModelError> {
    use ea_test5::{compare, ground, valley};
    let mut flood = set_up(&with_spacing(valley(folder)?, 50.0), seed, &ground(folder)?, &[])?;
    compare(EA_TEST5.name, &mut flood, folder, options)
}
