//! Water round solids: the paper's cuboid and cylinder, and the force of a stream on a cylinder.

use super::device::ready;
use super::{SEED, built_in, rows, settings, water_everywhere};
use crate::{Case, Options, Row};
use corpuscle_flood::Flood;
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::{Circle, Edge, Edges, Flood as Settings, Obstacle, Scheme};
use corpuscle_terrain::{Bounds, Terrain};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

pub(super) const CUBOID: Case = Case {
    name: "flood/cuboid",
    about: "The built-in scene flood/cuboid in both schemes: no particle inside the cuboid at any step.",
    slow: true,
    reduced: 2.0,
    run: cuboid,
};

pub(super) const CYLINDER: Case = Case {
    name: "flood/cylinder",
    about: "The built-in scene flood/cylinder in both schemes: no particle inside the cylinder at any step. A stream of 4 m/s, 1 m \
            deep, in a channel 12 m wide past a cylinder of 3 m: the force on its wall against the momentum that a control section \
            before it takes in and one behind it gives out.",
    slow: true,
    reduced: 2.0,
    run: cylinder,
};

fn cuboid(_: &Options) -> Vec<Row> {
    // The cuboid of the scene: 18 m x 18 m round (91, 45).
    let distance = |x: f64, y: f64| (x - 91.0).abs().max((y - 45.0).abs()) - 9.0;
    rows(CUBOID.name, none_inside(CUBOID.name, distance))
}

fn cylinder(_: &Options) -> Vec<Row> {
    let measure = || {
        let mut rows = none_inside(CYLINDER.name, |x, y| (x - 91.0).hypot(y - 45.0) - 9.0)?;
        rows.extend(force()?);
        Ok(rows)
    };
    rows(CYLINDER.name, measure())
}

/// Runs the scene of a case in both schemes and looks after each step how deep any particle is inside; `distance` is that from the
/// solid, m, negative inside.
fn none_inside(case: &'static str, distance: impl Fn(f64, f64) -> f64) -> Result<Vec<Row>, ModelError> {
    let mut rows = Vec::new();
    for (scheme, deepest_name, put_back_name) in [
        (Scheme::SphSwe, "nearest_m_sph_swe", "put_back_share_sph_swe"),
        (Scheme::Balanced, "nearest_m_balanced", "put_back_share_balanced"),
    ] {
        let (scene, settings, terrain) = built_in(case, &[])?;
        let until = scene.run.until_s;
        let settings = Settings { scheme, ..settings };
        let mut flood = ready(Flood::new(&settings, scene.seed, Path::new("."), terrain)?)?;
        let mut nearest = f64::INFINITY;
        while flood.time() < until {
            flood.advance_to((flood.time() + flood.time_step()).min(until), &AtomicBool::new(false))?;
            nearest = flood.particles().iter().map(|p| distance(p.x, p.y)).fold(nearest, f64::min);
        }
        let share = flood.put_back() as f64 / flood.particle_steps() as f64;
        rows.push(Row::at_least(case, deepest_name, nearest, "m", 0.0));
        let why = "how often a particle had to be put back to the wall, of all particle-steps";
        rows.push(Row::beside(case, put_back_name, share, "", 0.0, why));
    }
    Ok(rows)
}

const LENGTH: f64 = 40.0;
const WIDTH: f64 = 12.0;
const RADIUS: f64 = 1.5;
const MIDDLE: [f64; 2] = [16.0, 6.0];
const SPEED: f64 = 4.0;
const DEPTH: f64 = 1.0;

/// Force of a steady stream on a cylinder against the loss of momentum between two control sections.
fn force() -> Result<Vec<Row>, ModelError> {
    let bounds = Bounds { x_min: 0.0, x_max: LENGTH, y_min: 0.0, y_max: WIDTH };
    let terrain = Arc::new(Terrain::gridded(bounds, 0.5, |_, _| 0.0));
    let edges = Edges { west: Edge::Periodic, east: Edge::Periodic, south: Edge::Wall, north: Edge::Wall };
    let mut settings = settings(30.0, 0.25, DEPTH, edges);
    settings.obstacle = vec![Obstacle {
        name: "cylinder".into(),
        circle: Some(Circle { centre: MIDDLE, radius_m: RADIUS }),
        ..Obstacle::default()
    }];
    let water = water_everywhere(bounds, |_, _| DEPTH, |_, _| [SPEED, 0.0]);
    let mut flood = ready(Flood::with_water(&settings, SEED, Path::new("."), terrain, &[water])?)?;
    let column = |flood: &Flood| {
        let columns = flood.gauge_columns();
        columns.iter().position(|column| column.header() == "cylinder.impulse_east_N_s").unwrap_or(0)
    };
    let impulse = column(&flood);
    flood.advance_to(1.0, &AtomicBool::new(false))?;
    let momentum = |flood: &Flood| momentum_between(flood, SECTIONS);
    let (start, at_start) = (flood.gauge_row()[impulse], momentum(&flood));
    let (mut through, mut looks) = (0.0, 0);
    for look in 1..=200 {
        flood.advance_to(1.0 + 0.01 * f64::from(look), &AtomicBool::new(false))?;
        through += flux(&flood, SECTIONS[0]) - flux(&flood, SECTIONS[1]);
        looks += 1;
    }
    let on_wall = (flood.gauge_row()[impulse] - start) / 2.0;
    let lost = through / f64::from(looks) - (momentum(&flood) - at_start) / 2.0;
    Ok(vec![
        Row::at_most(CYLINDER.name, "force_error", (on_wall / lost - 1.0).abs(), "", 0.02),
        Row::beside(
            CYLINDER.name,
            "force_on_wall",
            on_wall / 1000.0,
            "kN",
            lost / 1000.0,
            "beside the loss of momentum",
        ),
    ])
}

/// The control sections before and behind the cylinder, m.
const SECTIONS: [f64; 2] = [8.0, 26.0];

/// Flux of momentum and pressure through a section across the channel, N: rho (d u^2 + g d^2 / 2).
fn flux(flood: &Flood, x: f64) -> f64 {
    let parts = 240;
    let width = WIDTH / f64::from(parts);
    let at = |part: i32| {
        let water = flood.sample(x, (f64::from(part) + 0.5) * width);
        1000.0 * water.depth * (water.velocity[0].powi(2) + 0.5 * super::GRAVITY * water.depth) * width
    };
    (0..parts).map(at).sum()
}

/// Momentum along the channel of the water between two sections, N s.
fn momentum_between(flood: &Flood, [from, to]: [f64; 2]) -> f64 {
    let between = flood.particles().iter().filter(|particle| (from..to).contains(&particle.x));
    between.map(|particle| 1000.0 * particle.volume * particle.u).sum()
}
