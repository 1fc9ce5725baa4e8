//! The gas of a scene.

use crate::setup::{
    Amount, Ball, Measure, Method, Partition, Region, Setup, Shear, Side, Species, Speeds, SquareWell, Start, file,
};
use crate::{Gas, SetupError};
use corpuscle_model::{Model, ModelError};
use corpuscle_scene as scene;
use corpuscle_scene::{Axis, Units};
use std::path::Path;

/// Samples of the gas in a run.
const SAMPLES_PER_RUN: f64 = 400.0;

/// Number of balls beyond which there are fewer samples, in inverse proportion.
const MAX_BALLS_AT_FULL_RATE: f64 = 1e5;

/// Makes the gas of a scene whose defaults are filled in. `folder` is what relative paths refer to; `until` is the end of the run.
///
/// # Errors
/// [`ModelError::Setup`] where it cannot be.
pub fn open(gas: &scene::Gas, seed: u64, until: f64, folder: &Path) -> Result<Box<dyn Model>, ModelError> {
    match gas.dimensions() {
        2 => Ok(Box::new(make::<2>(gas, seed, until, folder)?)),
        3 => Ok(Box::new(make::<3>(gas, seed, until, folder)?)),
        other => Err(SetupError::Contradiction(format!("a gas has two or three dimensions, not {other}")).into()),
    }
}

fn make<const D: usize>(written: &scene::Gas, seed: u64, until: f64, folder: &Path) -> Result<Gas<D>, ModelError> {
    let mut setup = Setup::new(vector(&written.size));
    setup.seed = seed;
    setup.boltzmann = written.units.boltzmann();
    setup.gravity = written.gravity.as_deref().map_or([0.0; D], vector);
    setup.restitution = written.restitution;
    setup.contact_time = written.contact_time_s;
    setup.well = written.well.map(|well| SquareWell { depth: well.depth, width: well.width });
    setup.shear = written.shear.map(|shear| Shear { rate: shear.rate_per_s, temperature: shear.temperature });
    setup.reversed_at = written.reversed_at_s;
    setup.follow = written.follow.map(|ball| ball as usize);
    setup.method = match written.method {
        scene::Method::EventDriven => Method::EventDriven,
        scene::Method::List => Method::List,
        scene::Method::FixedStep { time_step_s } => Method::FixedStep(time_step_s),
    };
    for axis in Axis::ALL.into_iter().take(D) {
        let [low, high] = written.walls.along(axis);
        setup.sides[axis.index()] = [side(low, until, folder)?, side(high, until, folder)?];
    }
    setup.partition = written.partition.as_ref().map(|partition| Partition {
        axis: partition.axis.index(),
        at: partition.at,
        lifted_at: partition.lifted_at_s,
        hole: partition.hole.as_ref().map(|hole| hole.from.iter().zip(&hole.to).map(|(&a, &b)| [a, b]).collect()),
    });
    setup.balls = written.ball.iter().map(ball).collect();
    if let Some(path) = &written.start_file {
        setup.balls.extend(file::read(&folder.join(path))?);
    }
    setup.species = written.species.iter().map(species).collect();
    let count = setup.balls.len() + setup.species.iter().map(|species| setup.count_of(species)).sum::<usize>();
    if let Some(ball) = setup.follow.filter(|ball| *ball >= count) {
        let text = format!("gas.follow = {ball}: there is no such ball; ids run from 0 to {}", count.saturating_sub(1));
        return Err(SetupError::Contradiction(text).into());
    }
    let samples = (SAMPLES_PER_RUN * (MAX_BALLS_AT_FULL_RATE / count as f64).min(1.0)).max(40.0).round();
    setup.measure = Measure {
        from: written.measure.from_s.unwrap_or(0.0),
        until: Some(until),
        every: Some(until / samples),
        speed_bins: written.measure.speed_bins,
        profile_axis: written.measure.profile_axis.index(),
        profile_bins: written.measure.profile_bins,
        pair_distance: written.measure.pair_distance,
        pair_bins: written.measure.pair_bins,
        lag_collisions: written.measure.lag_collisions,
    };
    setup.regions = written.measure.region.iter().map(region).collect();
    let mut made = setup.build()?;
    let colours = written.ball.iter().map(|ball| (&ball.name, &ball.colour));
    for (name, colour) in colours.chain(written.species.iter().map(|species| (&species.name, &species.colour))) {
        made.paint(name, colour.as_deref());
    }
    made.count_in_si(written.units == Units::Si);
    Ok(made)
}

/// As many numbers as dimensions; scenes are checked for that.
fn vector<const D: usize>(numbers: &[f64]) -> [f64; D] {
    std::array::from_fn(|axis| numbers.get(axis).copied().unwrap_or(0.0))
}

fn side(wall: &scene::Wall, end: f64, folder: &Path) -> Result<Side, ModelError> {
    Ok(match wall {
        scene::Wall::Fixed => Side::Fixed,
        scene::Wall::Periodic => Side::Periodic,
        scene::Wall::Thermal { temperature } => Side::Thermal { temperature: *temperature },
        // A wall that is to move for ever moves to just beyond the end of the run: so whether there is room is known before.
        scene::Wall::Moving { velocity, until_s } => {
            Side::Moving { velocity: *velocity, until: Some(until_s.unwrap_or(end.next_up())) }
        }
        scene::Wall::Motion(scene::Motion::Sinusoid { amplitude, period_s }) => {
            Side::Swinging { amplitude: *amplitude, period: *period_s }
        }
        scene::Wall::Motion(scene::Motion::Displacement(series)) => {
            let table = series.load(folder).map_err(|error| ModelError::Setup(error.to_string()))?;
            Side::Displaced(table.rows().to_vec())
        }
        scene::Wall::Piston { mass, pressure, velocity } => {
            Side::Piston { mass: *mass, pressure: *pressure, velocity: *velocity }
        }
    })
}

fn region<const D: usize>(region: &scene::NamedRegion) -> Region<D> {
    Region { name: region.name.clone(), from: vector(&region.from), to: vector(&region.to) }
}

fn ball<const D: usize>(ball: &scene::Ball) -> Ball<D> {
    Ball {
        name: ball.name.clone(),
        position: vector(&ball.position),
        velocity: ball.velocity.as_deref().map_or([0.0; D], vector),
        radius: ball.radius,
        mass: ball.mass,
    }
}

fn species<const D: usize>(species: &scene::Species) -> Species<D> {
    Species {
        name: species.name.clone(),
        amount: match (species.packing, species.count) {
            (Some(packing), _) => Amount::Packing(packing),
            (None, count) => Amount::Count(count.unwrap_or(0) as usize),
        },
        radius: species.radius,
        mass: species.mass,
        temperature: species.temperature,
        speeds: match species.speeds {
            scene::Speeds::Maxwell => Speeds::Maxwell,
            scene::Speeds::Equal => Speeds::Equal,
        },
        velocity: species.velocity.as_deref().map_or([0.0; D], vector),
        region: species.region.as_ref().map(|region| [vector(&region.from), vector(&region.to)]),
        start: match species.start {
            scene::Start::Lattice => Start::Lattice,
            scene::Start::Random => Start::Random,
        },
    }
}
