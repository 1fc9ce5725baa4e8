//! The picture of a gas from its model.

use crate::picture::{Across, Balls, Colour, Disc, Key, Side, from_hex, of_part, short_number};
use corpuscle_model::{Container, Frame, Model, ParticleSet};
use corpuscle_scene::{Axis, Gas, Units, Wall, colour_of_kind, padded};
use std::collections::BTreeSet;

/// Speed of the last colour, over the root mean square at the start.
const FASTEST: f64 = 2.0;

/// Colour of balls without their own.
const GREY: Colour = [0x6b, 0x78, 0x85];

/// The picture of a gas at the model's time. Kinds of balls have different colours; balls of a single kind are coloured by speed.
pub(super) fn balls(gas: &Gas, model: &dyn Model) -> Balls {
    let frame = model.frame();
    let container = model.container().unwrap_or(Container { from: [0.0; 3], to: padded(&gas.size) });
    let size = padded(&gas.size);
    let key = gas_key(gas, &frame);
    Balls {
        dimensions: gas.dimensions(),
        from: container.from,
        to: container.to,
        view: [
            std::array::from_fn(|k| container.from[k].min(0.0)),
            std::array::from_fn(|k| container.to[k].max(size[k])),
        ],
        sides: Axis::ALL.map(|axis| gas.walls.along(axis).map(side)),
        partition: partition(gas, model.time()),
        discs: frame.sets.iter().enumerate().flat_map(|(kind, set)| discs(gas, kind, set, &key)).collect(),
        trajectory: model.paths().into_iter().next().map(|path| path.points).unwrap_or_default(),
        followed: gas.follow.and_then(|id| followed(gas, &frame, id, &key)),
        key,
        unit: match gas.units {
            Units::Reduced => "",
            Units::Si => "m",
        },
    }
}

fn side(wall: &Wall) -> Side {
    match wall {
        Wall::Fixed => Side::Wall,
        Wall::Periodic => Side::Open,
        Wall::Thermal { .. } => Side::Hot,
        Wall::Moving { .. } | Wall::Motion(_) | Wall::Piston { .. } => Side::Piston,
    }
}

fn partition(gas: &Gas, time: f64) -> Option<Across> {
    let partition = gas.partition.as_ref()?;
    let stands = partition.lifted_at_s.is_none_or(|lifted| time < lifted);
    stands.then(|| Across {
        axis: partition.axis.index(),
        at: partition.at,
        hole: partition.hole.as_ref().map(|hole| [hole.from.clone(), hole.to.clone()]),
    })
}

/// The legend of the colours of a gas at a time: its kinds, one for each particle set, or the speed of the only kind.
pub fn gas_key(gas: &Gas, frame: &Frame) -> Key {
    if let [_] = frame.sets[..] {
        let unit = match gas.units {
            Units::Reduced => "",
            Units::Si => "m/s",
        };
        return Key::Speed { most: fastest(gas, frame), unit };
    }
    let kind = |(kind, set): (usize, &ParticleSet)| {
        let count = if set.len() == 1 { String::new() } else { format!(": {}", short_number(set.len() as f64)) };
        (format!("{}{count}", set.name), colour_of(gas, kind, &set.name))
    };
    Key::Kinds(frame.sets.iter().enumerate().map(kind).collect())
}

/// The speed that has the last colour: the same at all times, so that pictures can be compared; in a gas that cools by itself
/// that of the moment.
fn fastest(gas: &Gas, frame: &Frame) -> f64 {
    if gas.restitution < 1.0 {
        let squares = || frame.sets.iter().flat_map(|set| &set.velocity).map(|velocity| length(*velocity).powi(2));
        let mean = squares().sum::<f64>() / squares().count() as f64;
        return if mean > 0.0 { FASTEST * mean.sqrt() } else { 1.0 };
    }
    let freedom = gas.dimensions() as f64 * gas.units.boltzmann();
    let thermal = gas.species.iter().map(|species| (freedom * species.temperature / species.mass).sqrt());
    let given = gas.ball.iter().filter_map(|ball| ball.velocity.as_deref()).map(|velocity| length(padded(velocity)));
    let from_start = FASTEST * thermal.fold(0.0, f64::max);
    let now = || frame.sets.iter().flat_map(|set| &set.velocity).map(|velocity| length(*velocity)).fold(0.0, f64::max);
    [from_start, given.fold(0.0, f64::max), now()].into_iter().find(|speed| *speed > 0.0).unwrap_or(1.0)
}

fn length(vector: [f64; 3]) -> f64 {
    vector.iter().map(|component| component * component).sum::<f64>().sqrt()
}

/// The colour that the scene gives to a set; of one that it does not name, as from a file, the next that none of those has.
fn colour_of(gas: &Gas, kind: usize, name: &str) -> Colour {
    let species = gas.species.iter().filter(|species| species.name == name).map(|species| &species.colour);
    let balls = gas.ball.iter().filter(|ball| ball.name == name).map(|ball| &ball.colour);
    let colour = species.chain(balls).flatten().next();
    let named = || gas.species.iter().map(|species| &species.name).chain(gas.ball.iter().map(|ball| &ball.name));
    let next = || colour_of_kind(named().collect::<BTreeSet<_>>().len() + kind);
    let colour = colour.map_or_else(next, String::as_str);
    from_hex(colour).unwrap_or(GREY)
}

fn discs<'a>(gas: &Gas, kind: usize, set: &'a ParticleSet, key: &Key) -> impl Iterator<Item = Disc> + use<'a> {
    let of_kind = colour_of(gas, kind, &set.name);
    let most = match key {
        Key::Speed { most, .. } => Some(*most),
        Key::Kinds(_) => None,
    };
    (0..set.len()).map(move |i| Disc {
        position: set.position[i],
        radius: set.radius[i],
        colour: most.map_or(of_kind, |most| of_part(length(set.velocity[i]) / most)),
    })
}

fn followed(gas: &Gas, frame: &Frame, id: u64, key: &Key) -> Option<Disc> {
    let mut sets = frame.sets.iter().enumerate();
    let (kind, set, index) =
        sets.find_map(|(kind, set)| Some((kind, set, set.id.iter().position(|found| *found == id)?)))?;
    discs(gas, kind, set, key).nth(index)
}
