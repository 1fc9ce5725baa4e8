//! Parameters of a flood.

use super::{Builder, Control};
use corpuscle::scene::Flood;

const SCHEMES: &[(&str, &str)] = &[("balanced", "\"balanced\""), ("paper (published)", "\"paper\"")];
const CONTROL: &[(&str, &str)] = &[("on", "true"), ("off", "false")];

pub(super) fn parameters(builder: &mut Builder<'_>, flood: &Flood) {
    builder.group("Water");
    for number in 0..flood.inflow.len() {
        let path = |key: &str| format!("flood.inflow.{number}.{key}");
        builder.scaled(path("discharge_m3_per_s"), "Inflow", "m³/s", "Water that comes in");
    }
    for number in 0..flood.water.len() {
        let path = |key: &str| format!("flood.water.{number}.{key}");
        builder.scaled(path("depth_m"), "Depth at the start", "m", "Depth of the water that is there at first").number(
            path("level_m"),
            "Level at the start",
            "m",
            around(flood, number),
            "Level of the water that is there at first",
        );
    }
    for number in 0..flood.stage.len() {
        builder.scaled(format!("flood.stage.{number}.level_m"), "Level held", "m", "Level that is held at an edge");
    }
    builder.scaled("flood.rain.intensity_mm_per_h", "Rain", "mm/h", "How hard it rains");
    builder
        .group("Ground")
        .number(
            "flood.manning",
            "Manning's n",
            "s/m^(1/3)",
            [0.0, 0.15],
            "Roughness: 0 for none, 0.03 for grass, 0.1 for woods",
        )
        .number("flood.gravity_m_per_s2", "Gravity", "m/s²", [1.0, 25.0], "9.81 on Earth, 3.7 on Mars");
    builder
        .group("Method")
        .add("flood.scheme", "Scheme", "", "Which formulation moves the water", Control::Choice(SCHEMES))
        .add(
            "flood.paper.control_force",
            "Control force (paper)",
            "",
            "The published scheme's guard of particles",
            Control::Choice(CONTROL),
        )
        .scaled("flood.spacing_m", "Distance of particles", "m", "Half of it: four times the particles")
        .number(
            "flood.balanced.viscosity",
            "Viscosity",
            "",
            [0.0, 1.0],
            "Share of the dissipation of an unreconstructed Riemann problem",
        );
}

/// Some metres below and above a level.
fn around(flood: &Flood, number: usize) -> [f64; 2] {
    let level = flood.water.get(number).and_then(|water| water.level_m).unwrap_or_default();
    [level - 5.0, level + 5.0]
}
