//! Parameters of dew.

use crate::parameters::{Builder, Change, Control, Current, live, number_in, size, size_as_written};
use corpuscle_dew::{LiveChange, SourceChange as Source};
use corpuscle_scene::dew::{self, AirInflow};
use corpuscle_scene::{Axis, Dew, Series};

const SCHEMES: &[(&str, &str)] =
    &[("physical", "\"physical\""), ("particle condensation (as patented)", "\"particle-condensation\"")];
const TREATMENTS: &[(&str, &str)] = &[
    ("density correction", "\"density-correction\""),
    ("ghost particles", "\"ghost\""),
    ("virtual force", "\"virtual-force\""),
];

const SIDES: [&str; 6] = ["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"];

pub(super) fn parameters(builder: &mut Builder, dew: &Dew) {
    solids(builder, dew);
    builder
        .group("Air")
        .number(
            "dew.air.temperature_c",
            "Temperature",
            "°C",
            [0.0, 60.0],
            "Of the initial air, and of inflowing air without its own",
        )
        .number(
            "dew.air.relative_humidity",
            "Relative humidity",
            "",
            [0.05, 1.0],
            "Vapour pressure over saturation pressure",
        )
        .number("dew.air.dew_point_c", "Dew point", "°C", [-10.0, 50.0], "Temperature at which the air is saturated");
    for (number, side) in SIDES.into_iter().enumerate() {
        if let dew::Face::Inflow(inflow) = dew.faces.along(Axis::ALL[number / 2])[number % 2] {
            inflowing(builder, dew, side, inflow);
        }
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let path = format!("dew.faces.{side}.inflow.velocity_m_per_s.{axis}");
            let range = match (side.starts_with(name), side.ends_with("min")) {
                (false, _) => [-2.0, 2.0],
                // Into the box.
                (true, true) => [0.01, 2.0],
                (true, false) => [-2.0, -0.01],
            };
            let hint = "Velocity of the air that flows in here";
            builder.number(&*path, &format!("Wind at {side} along {name}"), "m/s", range, hint).live(&path, blow);
        }
    }
    for number in 0..dew.fan.len() {
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let path = format!("dew.fan.{number}.velocity_m_per_s.{axis}");
            let hint = "Velocity to which the fan drives the air";
            builder.number(&*path, &format!("Fan along {name}"), "m/s", [-2.0, 2.0], hint).live(&path, drive);
        }
    }
    builder.group("Tilt");
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let path = format!("dew.gravity_m_per_s2.{axis}");
        let hint = "Gravity along x or y tilts the box: drops slide, and cold air sinks, in that direction";
        builder.number(&*path, &format!("Gravity along {name}"), "m/s²", [-9.81, 9.81], hint).live(&path, tilt);
    }
    // The contact angle stays between the other two where the scene gives them.
    let contact = dew.drops.contact_angle_deg;
    let [receding, advancing] =
        [dew.drops.receding_angle_deg.unwrap_or(20.0), dew.drops.advancing_angle_deg.unwrap_or(140.0)];
    builder
        .group("Drops")
        .number(
            "dew.drops.contact_angle_deg",
            "Contact angle",
            "°",
            [receding, advancing],
            "Flat drops below 90, round ones above",
        )
        .number(
            "dew.drops.receding_angle_deg",
            "Receding angle",
            "°",
            [0.1 * contact, contact],
            "The larger, up to the contact angle, the smaller the drops that slide",
        )
        .number(
            "dew.drops.advancing_angle_deg",
            "Advancing angle",
            "°",
            [contact, 0.5 * (contact + 180.0)],
            "The smaller, down to the contact angle, the smaller the drops that slide",
        )
        .scaled("dew.drops.friction", "Friction that holds drops", "", "The smaller, the smaller the drops that slide");
    builder
        .group("Method")
        .number(
            "dew.time_factor",
            "Time factor",
            "",
            [1.0, 50.0],
            "Acceleration of the temperatures of solids and of the water on them",
        )
        .live("dew.time_factor", go_faster)
        .add("dew.scheme", "Scheme", "", "Laws of heat and vapour transport", Control::Choice(SCHEMES))
        .add(
            "dew.boundary.treatment",
            "Boundary treatment",
            "",
            "Method that keeps air out of solids",
            Control::Choice(TREATMENTS),
        )
        .between("dew.spacing_m", "Spacing", "m", [0.5, 2.0], "Half the spacing: eight times the particles");
}

fn solids(builder: &mut Builder, dew: &Dew) {
    for (number, solid) in dew.solid.iter().enumerate() {
        let path = |key: &str| format!("dew.solid.{number}.{key}");
        builder
            .group(format!("Solid: {}", solid.name))
            .number(
                path("temperature_c"),
                &format!("Temperature of {}", solid.name),
                "°C",
                [-10.0, 60.0],
                "Prescribed where the scene prescribes it; any other solid is set to it once",
            )
            .live(&path("temperature_c"), warm)
            .number(path("rotation_deg.1"), "Rotation about y", "°", [-90.0, 90.0], "Tilts an upright solid");
        sources(builder, solid, path);
    }
}

/// Parameters of the heater of a solid and of the heat that it exchanges with the outside.
fn sources(builder: &mut Builder, solid: &dew::Solid, path: impl Fn(&str) -> String) {
    let heater = solid.heater.iter().flat_map(|heater| {
        [("power_w", ("W", 10.0), &heater.power_w), ("power_w_per_m2", ("W/m²", 1000.0), &heater.power_w_per_m2)]
    });
    for (key, unit, power) in heater {
        if let Some(power) = power {
            let path = path(&format!("heater.{key}"));
            let hint = "Power of its heater, uniform over the solid";
            builder.series(&path, "Heater", unit, hint, power, [heat, heat_times]);
        }
    }
    let mut add = |key: &str, name: &str, unit, range, hint, change| {
        let path = path(key);
        builder.number(&*path, name, unit, range, hint).live(&path, change);
    };
    let air = "Of the air outside the side of the box that the solid reaches";
    add("outside.temperature_c", "Temperature outside", "°C", [-30.0, 60.0], air, cool_outside);
    let wind = "5 to 10 in still air, 25 in wind";
    add("outside.h_w_per_m2_k", "Heat transfer outside", "W/(m² K)", [0.0, 200.0], wind, change_transfer);
    let sky = "Mean radiant temperature outside, as of the sky";
    add("outside.surroundings_c", "Sky and ground outside", "°C", [-60.0, 100.0], sky, change_sky);
    let room = "Mean radiant temperature in the box";
    add("radiation.surroundings_c", "Surroundings", "°C", [-60.0, 500.0], room, change_surroundings);
}

/// Temperature and humidity of the inflowing air; by default those of the initial air.
fn inflowing(builder: &mut Builder, dew: &Dew, side: &str, inflow: &AirInflow) {
    let path = |key: &str| format!("dew.faces.{side}.inflow.{key}");
    let (warmth, humidity) = (path("temperature_c"), path("relative_humidity"));
    let measures = [&inflow.relative_humidity, &inflow.dew_point_c, &inflow.mixing_ratio];
    let own = measures.into_iter().flatten().count();
    // What the scene changes over time is no number.
    let changes =
        |series: &Option<Series>| series.as_ref().is_some_and(|series| !matches!(series, Series::Constant(_)));
    if changes(&inflow.temperature_c) || measures.into_iter().any(changes) {
        return;
    }
    builder.or(&warmth, dew.air.temperature_c);
    let hint = "Of the air that flows in here; its vapour is kept, or its relative humidity where that is given";
    builder.number(&*warmth, &format!("Temperature at {side}"), "°C", [0.0, 60.0], hint).live(&warmth, warm_inlet);
    if own == 0
        && let (Some(relative), None) = (dew.air.relative_humidity, &inflow.temperature_c)
    {
        builder.or(&humidity, relative);
    }
    let hint = "Of the air that flows in here: vapour pressure over saturation pressure";
    let name = format!("Relative humidity at {side}");
    builder.number(&*humidity, &name, "", [0.05, 1.0], hint).live(&humidity, moisten_inlet);
}

/// The face that a key names: its axis and its end.
fn face_in(path: &str) -> Option<[usize; 2]> {
    let number = SIDES.iter().position(|side| path.split('.').any(|word| word == *side))?;
    Some([number / 2, number % 2])
}

/// The axis at the end of a key.
fn axis_in(path: &str) -> Option<usize> {
    path.rsplit('.').next()?.parse().ok()
}

fn warm(path: &str, value: &str, _: &Current<'_>) -> Option<Change> {
    live(LiveChange::SolidTemperature { solid: number_in(path)?, celsius: value.parse().ok()? })
}

fn heat(path: &str, value: &str, _: &Current<'_>) -> Option<Change> {
    live(Source::HeaterPower { solid: number_in(path)?, power: value.parse().ok()? })
}

fn heat_times(path: &str, value: &str, current: &Current<'_>) -> Option<Change> {
    let (solid, wanted) = (number_in(path)?, size_as_written(value)?);
    let now = current.scene.dew().and_then(|dew| dew.solid.get(solid)?.heater.as_ref());
    let power = now.and_then(|heater| heater.power_w.as_ref().or(heater.power_w_per_m2.as_ref()));
    live(Source::HeaterTimes { solid, times: wanted / power.map_or(1.0, size) })
}

fn cool_outside(path: &str, value: &str, _: &Current<'_>) -> Option<Change> {
    live(Source::OutsideTemperature { solid: number_in(path)?, celsius: value.parse().ok()? })
}

fn change_transfer(path: &str, value: &str, _: &Current<'_>) -> Option<Change> {
    live(Source::OutsideTransfer { solid: number_in(path)?, coefficient: value.parse().ok()? })
}

fn change_sky(path: &str, value: &str, _: &Current<'_>) -> Option<Change> {
    live(Source::OutsideSurroundings { solid: number_in(path)?, celsius: value.parse().ok()? })
}

fn change_surroundings(path: &str, value: &str, _: &Current<'_>) -> Option<Change> {
    live(Source::Surroundings { solid: number_in(path)?, celsius: value.parse().ok()? })
}

fn warm_inlet(path: &str, value: &str, current: &Current<'_>) -> Option<Change> {
    let (face, celsius) = (face_in(path)?, value.parse().ok()?);
    let relative = (current.number)(&path.replace("temperature_c", "relative_humidity"));
    let moisten = relative.map(|relative| LiveChange::InletHumidity { face, relative }.into());
    Some(Change::Model([LiveChange::InletTemperature { face, celsius }.into()].into_iter().chain(moisten).collect()))
}

fn moisten_inlet(path: &str, value: &str, _: &Current<'_>) -> Option<Change> {
    live(LiveChange::InletHumidity { face: face_in(path)?, relative: value.parse().ok()? })
}

fn blow(path: &str, value: &str, _: &Current<'_>) -> Option<Change> {
    live(LiveChange::Wind { face: face_in(path)?, axis: axis_in(path)?, velocity: value.parse().ok()? })
}

fn drive(path: &str, value: &str, _: &Current<'_>) -> Option<Change> {
    live(LiveChange::FanVelocity { fan: number_in(path)?, axis: axis_in(path)?, velocity: value.parse().ok()? })
}

fn tilt(path: &str, value: &str, _: &Current<'_>) -> Option<Change> {
    live(LiveChange::Gravity { axis: axis_in(path)?, acceleration: value.parse().ok()? })
}

fn go_faster(_: &str, value: &str, _: &Current<'_>) -> Option<Change> {
    live(LiveChange::TimeFactor(value.parse().ok()?))
}
