//! What cases share that compare with measured series, or with those of a peer.

use super::super::rows;
use super::SEEDS;
use crate::device::reduced;
use crate::{Options, Row};
use corpuscle_flood::{Filling, StartWater};
use corpuscle_model::ModelError;
use corpuscle_terrain::Bounds;
use std::path::Path;

/// The rows of a seed, given the folder of the data; charts go to the options.
pub(super) type OfSeed = fn(&Path, u64, &Options) -> Result<Vec<Row>, ModelError>;

/// Each row of the seed that has it worst; the charts are the first seed's.
pub(super) fn of_data(case: &'static str, folder: &str, options: &Options, of_seed: OfSeed) -> Vec<Row> {
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
pub(super) fn pool<'a>(level: f64, [from, to]: [f64; 2], bounds: Bounds) -> StartWater<'a> {
    let [south, north] = [bounds.y_min - 1.0, bounds.y_max + 1.0];
    StartWater {
        filling: Filling::Level(Box::new(move |_, _| level)),
        polygon: Some(vec![[from, south], [to, south], [to, north], [from, north]]),
        velocity: Box::new(|_, _| [0.0; 2]),
    }
}
