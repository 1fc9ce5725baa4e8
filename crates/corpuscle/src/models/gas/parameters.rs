//! Parameters of a gas.

use crate::parameters::{Builder, Change, Control, Current, live};
use corpuscle_gas::LiveChange;
use corpuscle_scene::{Axis, Gas, Species, Wall};
use std::f64::consts::PI;

/// Methods of a gas: names, and values as a scene writes them. The step of the last is a parameter of its own.
const METHODS: &[(&str, &str)] = &[
    ("event driven", "\"event-driven\""),
    ("list (as published)", "\"list\""),
    ("equal steps of 0.02", "{ fixed-step = { time_step_s = 0.02 } }"),
];
const STARTS: &[(&str, &str)] = &[("random", "\"random\""), ("on a lattice", "\"lattice\"")];
const SPEEDS: &[(&str, &str)] = &[("Maxwell distribution", "\"maxwell\""), ("equal", "\"equal\"")];

pub(super) fn parameters(builder: &mut Builder, gas: &Gas) {
    // The ball that is followed must be there.
    let least = gas.follow.map_or(1.0, |ball| ball as f64 + 1.0);
    for (number, species) in gas.species.iter().enumerate() {
        let path = |key: &str| format!("gas.species.{number}.{key}");
        let room = room(gas, species);
        let most = (species.count.unwrap_or_default() as f64 * room.min(10.0)).floor().clamp(least, 1e6);
        let wider = room.powf(1.0 / gas.dimensions() as f64).min(10.0);
        builder
            .group(format!("Balls: {}", species.name))
            .add(path("count"), "Number", "", "Number of balls", Control::Whole([least, most]))
            .scaled(
                path("temperature"),
                "Temperature at the start",
                "",
                "Initial temperature, from the mean energy of a ball",
            )
            .between(path("radius"), "Radius", "", [0.1 * wider.min(1.0), wider], "Radius of a ball")
            .scaled(path("mass"), "Mass", "", "Mass of a ball")
            .add(
                path("speeds"),
                "Speeds at the start",
                "",
                "Initial distribution of the speeds",
                Control::Choice(SPEEDS),
            )
            .add(
                path("start"),
                "Positions at the start",
                "",
                "Initial positions of the balls",
                Control::Choice(STARTS),
            );
    }
    builder
        .group("Motion")
        .number(
            "gas.restitution",
            "Coefficient of restitution",
            "",
            [0.5, 1.0],
            "Speed of separation over speed of approach: below 1 a collision dissipates energy",
        )
        .add(
            "gas.method",
            "Method",
            "",
            "The first two are exact; equal steps let balls overlap",
            Control::Choice(METHODS),
        );
    for axis in Axis::ALL.into_iter().take(gas.dimensions()) {
        let sides = ["x", "y", "z"][axis.index()];
        for (end, wall) in gas.walls.along(axis).into_iter().enumerate() {
            let side = format!("{sides}_{}", ["min", "max"][end]);
            let path = |key: &str| format!("gas.walls.{side}.{key}");
            match wall {
                Wall::Thermal { .. } => {
                    let key = path("thermal.temperature");
                    builder
                        .group(format!("Thermal wall {side}"))
                        .scaled(
                            &*key,
                            "Temperature",
                            "",
                            "Balls leave the wall with the speeds of a gas at this temperature",
                        )
                        .live(&key, warm_wall);
                }
                Wall::Piston { .. } => {
                    let key = path("piston.pressure");
                    builder
                        .group(format!("Piston {side}"))
                        .scaled(&*key, "Pressure outside", "", "Pressure behind the piston")
                        .live(&key, press_piston)
                        .scaled(path("piston.mass"), "Mass", "", "Mass of the piston");
                }
                Wall::Moving { .. } => {
                    builder.group(format!("Moving wall {side}")).scaled(
                        path("moving.velocity"),
                        "Velocity",
                        "",
                        "Positive towards larger coordinates",
                    );
                }
                Wall::Fixed | Wall::Periodic | Wall::Motion(_) => {}
            }
        }
    }
}

/// Packing fraction of all species up to which larger or more balls are offered; far below what can be set up.
const FULL: [f64; 2] = [0.6, 0.42];

/// Factor by which the volume of the balls of a species may grow.
fn room(gas: &Gas, species: &Species) -> f64 {
    let box_volume: f64 = gas.size.iter().product();
    let own =
        species.region.as_ref().map(|region| region.from.iter().zip(&region.to).map(|(from, to)| to - from).product());
    let volume = own.unwrap_or(box_volume);
    let ball = match gas.dimensions() {
        2 => PI * species.radius.powi(2),
        _ => 4.0 / 3.0 * PI * species.radius.powi(3),
    };
    let filled = species.count.map_or(species.packing.unwrap_or(1.0), |count| count as f64 * ball / volume);
    let full = FULL[usize::from(gas.dimensions() > 2)] / gas.species.len() as f64;
    (full / filled).max(1.0)
}

/// The wall that a path names: its axis and its end.
fn wall_of(path: &str) -> [usize; 2] {
    let side = path.split('.').nth(2).unwrap_or_default();
    let axis = ["x", "y", "z"].iter().position(|axis| side.starts_with(axis)).unwrap_or_default();
    [axis, usize::from(side.ends_with("max"))]
}

fn warm_wall(path: &str, value: &str, _: &Current<'_>) -> Option<Change> {
    live(LiveChange::WallTemperature { wall: wall_of(path), temperature: value.parse().ok()? })
}

fn press_piston(path: &str, value: &str, _: &Current<'_>) -> Option<Change> {
    live(LiveChange::PistonPressure { wall: wall_of(path), pressure: value.parse().ok()? })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_names_its_wall() {
        assert_eq!(wall_of("gas.walls.x_min.thermal.temperature"), [0, 0]);
        assert_eq!(wall_of("gas.walls.z_max.piston.pressure"), [2, 1]);
    }
}
