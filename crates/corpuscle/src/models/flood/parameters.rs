//! Parameters of a flood.

use crate::parameters::{Builder, Change, Control, Current, MOST_TIMES, live, number_in, size, size_as_written};
use corpuscle_flood::LiveChange;
use corpuscle_scene::{Edge, Flood, Rain, Scheme, Series};

const SCHEMES: &[(&str, &str)] = &[("voronoi", "\"voronoi\""), ("sph-swe (published)", "\"sph-swe\"")];
const CONTROL: &[(&str, &str)] = &[("on", "true"), ("off", "false")];

/// Least upper end of the range of the rain, mm/h: a cloudburst.
const CLOUDBURST: f64 = 200.0;

/// The parameters of a flood; `now` is the flood with the changes that have been applied.
pub(super) fn parameters(builder: &mut Builder, flood: &Flood, now: &Flood) {
    builder.group("Water");
    for (number, inflow) in flood.inflow.iter().enumerate() {
        builder.series(
            &format!("flood.inflow.{number}.discharge_m3_per_s"),
            &format!("Inflow: {}", inflow.name),
            ("m³/s", 100.0),
            "Discharge of the inflow",
            &inflow.discharge_m3_per_s,
            [flow, flow_times],
        );
    }
    for number in 0..flood.water.len() {
        let path = |key: &str| format!("flood.water.{number}.{key}");
        builder.scaled(path("depth_m"), "Depth at the start", "m", "Initial depth of the water").number(
            path("level_m"),
            "Level at the start",
            "m",
            around(flood, number),
            "Initial level of the water",
        );
    }
    levels(builder, flood);
    if now.scheme == Scheme::Voronoi {
        rain(builder, flood.rain.as_ref());
    }
    builder.group("Terrain").number(
        "flood.manning",
        "Manning's n",
        "s/m^(1/3)",
        [0.0, 0.15],
        "Roughness coefficient: 0 for none, 0.03 for grass, 0.1 for woods",
    );
    if now.friction.is_none() {
        builder.live("flood.manning", roughen);
    }
    builder.number("flood.gravity_m_per_s2", "Gravity", "m/s²", [1.0, 25.0], "9.81 on Earth, 3.7 on Mars");
    method(builder, flood, now);
    builder.scaled("flood.spacing_m", "Spacing", "m", "Half the spacing: four times the particles");
}

/// The scheme, where the other scheme supports the scene, and its own parameters.
fn method(builder: &mut Builder, flood: &Flood, now: &Flood) {
    builder.group("Method");
    if flood.only_of_voronoi().is_none() {
        let hint = "Numerical method of the flood";
        builder.add("flood.scheme", "Scheme", "", hint, Control::Choice(SCHEMES));
    }
    if now.scheme == Scheme::SphSwe {
        let path = "flood.sph_swe.control_force";
        let hint = "Force of scheme sph-swe that holds water back on rough terrain";
        builder.add(path, "Control force", "", hint, Control::Choice(CONTROL)).live(path, control);
    }
}

/// The range of an initial level: some metres below and above it.
fn around(flood: &Flood, number: usize) -> [f64; 2] {
    let level = flood.water.get(number).and_then(|water| water.level_m.as_ref()?.number()).unwrap_or_default();
    [level - 5.0, level + 5.0]
}

fn levels(builder: &mut Builder, flood: &Flood) {
    let range = |level: f64| [level - 5.0, level + 5.0];
    for (number, stage) in flood.stage.iter().enumerate() {
        if let Series::Constant(level) = stage.level_m {
            let path = format!("flood.stage.{number}.level_m");
            let name = format!("Prescribed level: {}", stage.name);
            builder.number(&*path, &name, "m", range(level), "Level that is prescribed here").live(&path, hold_stage);
        }
    }
    let edges = &flood.edges;
    for (side, edge) in SIDES.into_iter().zip([&edges.west, &edges.east, &edges.south, &edges.north]) {
        if let Edge::Stage(Series::Constant(level)) = edge {
            let path = format!("flood.edges.{side}.stage");
            let name = format!("Prescribed level in the {side}");
            builder
                .number(&*path, &name, "m", range(*level), "Level that is prescribed at this side")
                .live(&path, hold_edge);
        }
    }
}

const SIDES: [&str; 4] = ["west", "east", "south", "north"];

fn rain(builder: &mut Builder, rain: Option<&Rain>) {
    let path = "flood.rain.intensity_mm_per_h";
    let hint = "Rain intensity";
    match rain.map(|rain| &rain.intensity_mm_per_h) {
        None => {
            builder.or(path, 0.0).number(path, "Rain", "mm/h", [0.0, CLOUDBURST], hint).live(path, let_rain);
        }
        Some(Series::Constant(value)) => {
            let most = CLOUDBURST.max(MOST_TIMES * value);
            builder.number(path, "Rain", "mm/h", [0.0, most], hint).live(path, let_rain);
        }
        Some(Series::Table(_) | Series::File { .. }) => {
            builder.add(path, "Rain, times", "", hint, Control::Times([0.0, MOST_TIMES])).live(path, rain_times);
        }
    }
}

fn flow(path: &str, value: &str, _: &Current<'_>) -> Option<Change> {
    live(LiveChange::Discharge { inflow: number_in(path)?, discharge: value.parse().ok()? })
}

fn flow_times(path: &str, value: &str, current: &Current<'_>) -> Option<Change> {
    let (inflow, wanted) = (number_in(path)?, size_as_written(value)?);
    let now = current.scene.flood().and_then(|scene| scene.flood.inflow.get(inflow));
    let times = wanted / now.map_or(1.0, |inflow| size(&inflow.discharge_m3_per_s));
    live(LiveChange::DischargeTimes { inflow, times })
}

fn rain_times(_: &str, value: &str, current: &Current<'_>) -> Option<Change> {
    let now = current.scene.flood().and_then(|scene| scene.flood.rain.as_ref());
    let times = size_as_written(value)? / now.map_or(1.0, |rain| size(&rain.intensity_mm_per_h));
    live(LiveChange::RainTimes(times))
}

fn let_rain(_: &str, value: &str, _: &Current<'_>) -> Option<Change> {
    live(LiveChange::Rain(value.parse().ok()?))
}

fn hold_stage(path: &str, value: &str, _: &Current<'_>) -> Option<Change> {
    live(LiveChange::Level { stage: number_in(path)?, level: value.parse().ok()? })
}

fn hold_edge(path: &str, value: &str, _: &Current<'_>) -> Option<Change> {
    let side = SIDES.iter().position(|side| path.split('.').any(|word| word == *side))?;
    live(LiveChange::EdgeLevel { side, level: value.parse().ok()? })
}

fn roughen(_: &str, value: &str, _: &Current<'_>) -> Option<Change> {
    live(LiveChange::Manning(value.parse().ok()?))
}

fn control(_: &str, value: &str, _: &Current<'_>) -> Option<Change> {
    live(LiveChange::ControlForce(value.parse().ok()?))
}
