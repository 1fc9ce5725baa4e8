//! Scenes of gases.

use super::Maker;
use corpuscle_scene::{
    Axis, Ball, Gas, Hole, Measure, Method, Motion, NamedRegion, Partition, Region, Shear, Species, Speeds, SquareWell,
    Start, Units, Wall, Walls,
};

/// A gas of at most some sixty balls.
pub(super) fn scene(maker: &mut Maker<'_>) -> String {
    let until = 50.0;
    let dimensions = if maker.has(0.5) { 3 } else { 2 };
    let size: Vec<f64> = (0..3).map(|_| maker.between(8.0, 30.0)).take(dimensions).collect();
    let gravity =
        maker.maybe(0.3, |maker| (0..3).map(|_| maker.between(-1.0, 1.0)).take(dimensions).collect::<Vec<_>>());
    let axes: [[Wall; 2]; 3] = std::array::from_fn(|axis| pair(maker, size.get(axis).copied().unwrap_or(1.0), until));
    let falls = |axis: usize| gravity.as_ref().is_some_and(|gravity| gravity.get(axis).is_some_and(|g| *g != 0.0));
    let mut axes = axes;
    for (axis, pair) in axes.iter_mut().enumerate().filter(|(_, pair)| pair[0] == Wall::Periodic) {
        if falls(axis) {
            *pair = [Wall::Fixed, Wall::Fixed];
        }
    }
    let partition = maker.maybe(0.3, |maker| partition(maker, &size)).filter(|partition| {
        let [low, high] = &axes[partition.axis.index()];
        [low, high] == [&Wall::Fixed, &Wall::Fixed]
    });
    let [[x_min, x_max], [y_min, y_max], [z_min, z_max]] = axes;
    let third = dimensions == 3;
    let walls = Walls { x_min, x_max, y_min, y_max, z_min: third.then_some(z_min), z_max: third.then_some(z_max) };
    let species: Vec<Species> = (0..3)
        .filter_map(|number| maker.maybe(if number == 0 { 1.0 } else { 0.5 }, |maker| species(maker, number, &size)))
        .collect();
    let ball = maker.list(0.4, 2, |maker, number| Ball {
        name: format!("ball {number}"),
        position: size.iter().map(|length| length * (0.25 + 0.35 * number as f64)).collect(),
        velocity: maker.maybe(0.5, |maker| (0..3).map(|_| maker.between(-2.0, 2.0)).take(dimensions).collect()),
        radius: maker.between(0.2, 1.2),
        mass: maker.between(0.5, 100.0),
        colour: maker.maybe(0.3, |_| "#0072b2".into()),
    });
    let restitution = maker.maybe(0.3, |maker| maker.between(0.3, 1.0)).unwrap_or(1.0);
    let mut gas = Gas {
        units: if maker.has(0.2) { Units::Si } else { Units::Reduced },
        method: match maker.random.below(5) {
            0 => Method::List,
            1 if maker.has(0.5) => Method::FixedStep { time_step_s: maker.between(0.001, 0.05) },
            _ => Method::EventDriven,
        },
        restitution,
        contact_time_s: maker.maybe(0.2, |maker| maker.between(0.0, 0.01)),
        reversed_at_s: maker.maybe(0.2, |maker| maker.between(0.1, 5.0)),
        // Those given one by one have the first numbers, and there is a species.
        follow: maker.maybe(0.5, |maker| maker.random.below(ball.len() + 1) as u64),
        measure: measure(maker, &size),
        start_file: None,
        well: maker.maybe(0.2, |maker| SquareWell { depth: maker.between(-1.0, 2.0), width: maker.between(1.1, 2.0) }),
        shear: maker.maybe(0.1, |maker| Shear {
            rate_per_s: maker.between(0.01, 0.3),
            temperature: maker.maybe(0.5, |maker| maker.between(0.2, 2.0)),
        }),
        size,
        gravity,
        walls,
        partition,
        ball,
        species,
    };
    leave_out_what_does_not_go_together(&mut gas);
    super::text(maker, until, &[("gas", &gas)])
}

/// Leaves out what wells and shear refuse.
fn leave_out_what_does_not_go_together(gas: &mut Gas) {
    if gas.shear.is_some() {
        let pair = || (Wall::Periodic, Wall::Periodic);
        let walls = &mut gas.walls;
        (walls.x_min, walls.x_max) = pair();
        (walls.y_min, walls.y_max) = pair();
        [&mut walls.z_min, &mut walls.z_max].into_iter().flatten().for_each(|wall| *wall = Wall::Periodic);
        (gas.gravity, gas.partition, gas.reversed_at_s, gas.well) = (None, None, None, None);
        gas.measure.region.clear();
    }
    if gas.well.is_some() {
        gas.restitution = 1.0;
    }
    if gas.well.is_some() || gas.shear.is_some() {
        gas.method = if matches!(gas.method, Method::List) { Method::List } else { Method::EventDriven };
    }
}

fn pair(maker: &mut Maker<'_>, length: f64, until: f64) -> [Wall; 2] {
    let is_periodic = maker.has(0.25);
    let low = maker.maybe(0.4, |maker| wall(maker, length, until, 1.0)).unwrap_or(Wall::Fixed);
    let high = maker.maybe(0.4, |maker| wall(maker, length, until, -1.0)).unwrap_or(Wall::Fixed);
    if is_periodic { [Wall::Periodic, Wall::Periodic] } else { [low, high] }
}

/// A wall; `inwards` is the way into the box along its axis.
fn wall(maker: &mut Maker<'_>, length: f64, until: f64, inwards: f64) -> Wall {
    let kind = maker.random.below(5);
    let (a, b, c) = (maker.between(0.1, 3.0), maker.between(0.01, 0.1), maker.between(-0.1, 0.1));
    let series = [[0.0, 0.0], [0.2 * until, inwards * b * length], [until, -inwards * b * length]];
    match kind {
        0 => Wall::Thermal { temperature: a },
        1 => Wall::Moving { velocity: inwards * b, until_s: Some(0.1 * length / b) },
        2 => Wall::Motion(Motion::Displacement(corpuscle_scene::Series::Table(series.to_vec()))),
        3 => Wall::Motion(Motion::Sinusoid { amplitude: b * length, period_s: a }),
        _ => Wall::Piston { mass: 50.0 * a, pressure: b, velocity: c },
    }
}

fn partition(maker: &mut Maker<'_>, size: &[f64]) -> Partition {
    let axis = maker.one_of(&Axis::ALL[..size.len()]);
    let others: Vec<f64> = (0..size.len()).filter(|other| *other != axis.index()).map(|other| size[other]).collect();
    Partition {
        axis,
        at: size[axis.index()] * 0.5,
        lifted_at_s: maker.maybe(0.3, |maker| maker.between(0.1, 3.0)),
        hole: maker.maybe(0.5, |_| Hole {
            from: others.iter().map(|length| 0.4 * length).collect(),
            to: others.iter().map(|length| 0.7 * length).collect(),
        }),
    }
}

fn species(maker: &mut Maker<'_>, number: usize, size: &[f64]) -> Species {
    let radius = maker.between(0.1, 0.6);
    let by_count = maker.random.chance(0.8);
    let count = 1 + maker.random.below(20) as u64;
    let packing = maker.between(0.005, 0.02);
    let region = maker.maybe(0.3, |_| Region {
        from: size.iter().map(|length| 0.55 * length).collect(),
        to: size.iter().map(|length| 0.95 * length).collect(),
    });
    let colour = maker.maybe(0.3, |_| "#d55e00".into());
    Species {
        name: format!("species {number}"),
        count: by_count.then_some(count),
        packing: (!by_count).then_some(packing),
        radius,
        mass: maker.between(0.1, 10.0),
        temperature: maker.between(0.0, 3.0),
        speeds: maker.one_of(&[Speeds::Maxwell, Speeds::Equal]),
        velocity: maker.maybe(0.3, |maker| size.iter().map(|_| maker.between(-1.0, 1.0)).collect()),
        region,
        start: maker.one_of(&[Start::Lattice, Start::Random, Start::Random]),
        colour,
    }
}

fn measure(maker: &mut Maker<'_>, size: &[f64]) -> Measure {
    Measure {
        from_s: maker.maybe(0.5, |maker| maker.between(0.0, 5.0)),
        speed_bins: 1 + maker.random.below(60),
        profile_axis: maker.one_of(&Axis::ALL[..size.len()]),
        profile_bins: 1 + maker.random.below(60),
        pair_distance: maker.maybe(0.3, |maker| {
            let shortest = size.iter().copied().fold(f64::INFINITY, f64::min);
            0.5 * shortest * maker.between(0.1, 1.0)
        }),
        pair_bins: 1 + maker.random.below(60),
        lag_collisions: maker.between(0.5, 40.0),
        region: maker.list(0.4, 2, |maker, number| NamedRegion {
            name: format!("region {number}"),
            from: size.iter().map(|length| 0.1 * length).collect(),
            to: size.iter().map(|length| maker.between(0.2, 0.9) * length).collect(),
        }),
    }
}
