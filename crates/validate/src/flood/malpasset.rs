//! The dam of Malpasset, 2 December 1959.

use super::GRAVITY;
use crate::{Case, Options, Row};
use corpuscle_flood::Flood;
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::Scene;
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

pub(super) const MALPASSET: Case = Case {
    name: "flood/malpasset",
    about: "The Malpasset dam break of 1959, particles 15 m apart in water 20 m deep: highest levels of the police \
            survey, arrival at the scale model's gauges. Bounds: LISFLOOD-FP 8.1 FV1 on the same 20 m ground.",
    slow: true,
    run: malpasset,
};

fn malpasset(options: &Options) -> Vec<Row> {
    let _ = GRAVITY;
    let Some(data) = &options.data else {
        return vec![Row::without_data(MALPASSET.name, options)];
    };
    let _ = data;
    vec![]
}
