//! Parameters of dew.

use super::{Builder, Control};
use corpuscle::scene::Dew;

const SCHEMES: &[(&str, &str)] = &[("physical", "\"physical\""), ("paper (as patented)", "\"paper\"")];
const TREATMENTS: &[(&str, &str)] = &[
    ("density correction", "\"density-correction\""),
    ("ghost particles", "\"ghost\""),
    ("virtual force", "\"virtual-force\""),
];

pub(super) fn parameters(builder: &mut Builder<'_>, dew: &Dew) {
    builder
        .group("Air")
        .number(
            "dew.air.temperature_c",
            "Temperature",
            "°C",
            [0.0, 60.0],
            "Of the air at the start and of what comes in, if that has none of its own",
        )
        .number(
            "dew.air.relative_humidity",
            "Relative humidity",
            "",
            [0.05, 1.0],
            "Vapour pressure over that of saturation",
        )
        .number("dew.air.dew_point_c", "Dew point", "°C", [-10.0, 50.0], "Temperature at which it would be saturated");
    for side in ["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"] {
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let path = format!("dew.faces.{side}.inflow.velocity_m_per_s.{axis}");
            let range = match (side.starts_with(name), side.ends_with("min")) {
                (false, _) => [-2.0, 2.0],
                // Into the box.
                (true, true) => [0.01, 2.0],
                (true, false) => [-2.0, -0.01],
            };
            let hint = "Velocity of the air that comes in here";
            builder.number(path, &format!("Wind at {side} along {name}"), "m/s", range, hint);
        }
    }
    for number in 0..dew.fan.len() {
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let path = format!("dew.fan.{number}.velocity_m_per_s.{axis}");
            builder.number(
                path,
                &format!("Fan along {name}"),
                "m/s",
                [-2.0, 2.0],
                "The velocity to which it drives the air",
            );
        }
    }
    for (number, solid) in dew.solid.iter().enumerate() {
        let path = |key: &str| format!("dew.solid.{number}.{key}");
        builder
            .group(format!("Solid: {}", solid.name))
            .number(
                path("temperature_c"),
                "Temperature",
                "°C",
                [-10.0, 60.0],
                "At the start; held, where the scene holds it",
            )
            .number(path("rotation_deg.1"), "Turned about y", "°", [-90.0, 90.0], "Tilts what stands upright");
    }
    builder
        .group("Drops")
        .number(
            "dew.drops.contact_angle_deg",
            "Contact angle",
            "°",
            [20.0, 140.0],
            "Flat drops below 90, round ones above",
        )
        .scaled("dew.drops.friction", "Friction that holds drops", "", "Less, and smaller drops slide");
    builder
        .group("Method")
        .number(
            "dew.time_factor",
            "Faster than reality",
            "",
            [1.0, 50.0],
            "Heat, vapour and phase change go so many times faster",
        )
        .add("dew.scheme", "Scheme", "", "Which laws of transport hold", Control::Choice(SCHEMES))
        .add(
            "dew.boundary.treatment",
            "Air kept out by",
            "",
            "How air is kept out of solids",
            Control::Choice(TREATMENTS),
        )
        .between("dew.spacing_m", "Distance of particles", "m", [0.5, 2.0], "Half of it: eight times the particles");
}
