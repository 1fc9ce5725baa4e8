//! Water of scheme sph-swe round solids: the paper's cuboid and cylinder.

use super::device::ready;
use super::{built_in, rows};
use crate::{Case, Options, Row};
use corpuscle_flood::SphSweFlood;
use corpuscle_model::{Model, ModelError};
use std::path::Path;
use std::sync::atomic::AtomicBool;

pub(super) const CUBOID: Case = Case {
    name: "flood/cuboid",
    about: "The built-in scene flood/cuboid, by scheme sph-swe: no particle inside the cuboid at any step.",
    slow: true,
    reduced: 4.0,
    run: cuboid,
};

pub(super) const CYLINDER: Case = Case {
    name: "flood/cylinder",
    about: "The built-in scene flood/cylinder, by scheme sph-swe: no particle inside the cylinder at any step.",
    slow: true,
    reduced: 4.0,
    run: cylinder,
};

fn cuboid(_: &Options) -> Vec<Row> {
    // The cuboid of the scene: 18 m x 18 m round (91, 45).
    let distance = |x: f64, y: f64| (x - 91.0).abs().max((y - 45.0).abs()) - 9.0;
    rows(CUBOID.name, none_inside(CUBOID.name, distance))
}

fn cylinder(_: &Options) -> Vec<Row> {
    rows(CYLINDER.name, none_inside(CYLINDER.name, |x, y| (x - 91.0).hypot(y - 45.0) - 9.0))
}

/// Runs the scene of a case and measures after each step how deep any particle is inside; `distance` is that from the solid, m, negative inside.
fn none_inside(case: &'static str, distance: impl Fn(f64, f64) -> f64) -> Result<Vec<Row>, ModelError> {
    let (scene, settings, terrain) = built_in(case, &[])?;
    let until = scene.run.until_s;
    let mut flood = ready(SphSweFlood::new(&settings, scene.seed, Path::new("."), terrain)?)?;
    let mut nearest = f64::INFINITY;
    while flood.time() < until {
        flood.advance_to((flood.time() + flood.time_step()).min(until), &AtomicBool::new(false))?;
        nearest = flood.particles().iter().map(|p| distance(p.x, p.y)).fold(nearest, f64::min);
    }
    let share = flood.put_back() as f64 / flood.particle_steps() as f64;
    let why = "how often a particle had to be put back to the wall, of all particle-steps";
    Ok(vec![
        Row::at_least(case, "nearest_m", nearest, "m", 0.0),
        Row::beside(case, "put_back_share", share, "", 0.0, why),
    ])
}
