//! Numbers in the report: key figures and tables, as cells of text.

use super::parts::{KeyFigure, Table, how_it_ended};
use super::{Report, figures::FieldFigure, gauges};
use crate::picture::{area, number, short_number, time, volume};
use corpuscle_scene::{Scheme, Terrain};
use std::path::Path;

/// The key figures.
pub(super) fn key_figures(report: &Report) -> Vec<KeyFigure> {
    let mut figures = Vec::new();
    let mut add = |label, value, remark| figures.push(KeyFigure { label, value, remark });
    if let Some(depth) = report.field("max_depth") {
        let wet = report.area_of(depth, |value| !value.is_nan());
        let total: f64 = report.cell_areas.iter().sum();
        let part = 100.0 * wet / total;
        add(
            "Flooded area",
            area(wet),
            format!("{part:.1} % of the terrain, deeper than {} m", report.flood.flood.wet_depth_m),
        );
    }
    for (name, label, unit) in [("max_depth", "Largest depth", "m"), ("max_speed", "Largest speed", "m/s")] {
        if let Some(field) = report.field(name) {
            let largest = field.values.iter().copied().filter(|value| !value.is_nan()).reduce(f32::max);
            let value = largest.map_or("none".into(), |value| format!("{} {unit}", number(f64::from(value))));
            add(label, value, "anywhere, at any time".into());
        }
    }
    let all = gauges::series(report);
    let discharges = all.iter().filter(|series| series.unit == "m³/s").filter_map(|s| Some((s, s.peak()?)));
    if let Some((series, peak)) = discharges.reduce(|best, next| if next.1[1] > best.1[1] { next } else { best }) {
        add("Peak discharge", format!("{} m³/s", number(peak[1])), format!("{}, at {}", series.gauge, time(peak[0])));
    }
    if let Some(water) = report.summary.ledger.get("water_m3") {
        add("Water in", volume(water.inflow), format!("at the start {}", volume(water.initial)));
        add("Water out", volume(water.outflow), format!("at the end {}", volume(water.end)));
        let error = number(water.relative_error.abs());
        add("Water balance error", error, "relative to all water".into());
    }
    if let Some(hazard) = report.field("hazard") {
        let extreme = report.area_of(hazard, |value| value >= 2.0);
        add("Danger for all", area(extreme), "hazard rating of 2 and above".into());
    }
    figures
}

/// Area in each class of a field, from the lowest to the highest.
pub(super) fn areas_by_class(report: &Report, figure: &FieldFigure) -> Vec<(String, [u8; 3], f64)> {
    let Some(field) = report.field(figure.kind.name) else { return Vec::new() };
    let classes = &figure.classes;
    let area =
        |class: usize| report.area_of(field, |value| !value.is_nan() && classes.class_of(f64::from(value)) == class);
    classes.colours.iter().enumerate().map(|(class, colour)| (classes.range(class), *colour, area(class))).collect()
}

/// First water, largest depth and speed at each gauge.
pub(super) fn gauge_peaks(report: &Report) -> Table {
    let all = gauges::series(report);
    let wet = report.flood.flood.wet_depth_m;
    let of = |gauge: &str, quantity: &str| all.iter().find(|s| s.gauge == gauge && s.quantity == quantity);
    let peak = |gauge: &str, quantity: &str| of(gauge, quantity).and_then(gauges::GaugeSeries::peak);
    let value = |peak: Option<[f64; 2]>| peak.map_or("–".into(), |peak| number(peak[1]));
    let row = |depth: &gauges::GaugeSeries| {
        let gauge = depth.gauge.as_str();
        let first = depth.points.iter().find(|point| point[1] > wet);
        let deepest = peak(gauge, "depth").filter(|peak| peak[1] > wet);
        vec![
            gauge.to_owned(),
            first.map_or("stays dry".into(), |point| time(point[0])),
            value(deepest),
            deepest.map_or("–".into(), |peak| time(peak[0])),
            value(deepest.and(peak(gauge, "level"))),
            value(deepest.and(peak(gauge, "speed"))),
        ]
    };
    Table {
        head: vec!["gauge", "first wet at", "max depth, m", "at", "max level, m", "max speed, m/s"],
        rows: all.iter().filter(|series| series.quantity == "depth").map(row).collect(),
    }
}

/// Names and values of the facts of the run.
pub(super) fn run_facts(report: &Report) -> Vec<(&'static str, String)> {
    let (summary, scene) = (&report.summary, &report.flood);
    let (ground, whole) = (&report.ground, &report.whole);
    let [columns, rows] = whole.grid.map(|count| number(count as f64).replace(".0", ""));
    let cell = whole.cell.map(short_number);
    let cell = if cell[0] == cell[1] { format!("{} m", cell[0]) } else { format!("{} m × {} m", cell[0], cell[1]) };
    let [low, high] = whole.heights.map(short_number);
    let scheme = match scene.flood.scheme {
        Scheme::Voronoi => "voronoi",
        Scheme::SphSwe if scene.flood.sph_swe.control_force => "sph-swe, control force on",
        Scheme::SphSwe => "sph-swe, control force off",
    };
    vec![
        ("Model", format!("{}, scheme {scheme}", summary.model)),
        ("Terrain", terrain_words(&scene.terrain)),
        ("Grid", format!("{columns} × {rows} cells of {cell}; heights {low} to {high} m")),
        ("Maps show", shown_words(report)),
        ("Reference system", ground.system.clone().unwrap_or_else(|| "none (metres)".into())),
        ("Simulated time", format!("{} ({})", time(summary.simulated_time_s), how_it_ended(summary))),
        (
            "Spacing",
            scene.flood.spacing_m.map_or_else(|| "by the terrain".into(), |spacing| format!("{} m", number(spacing))),
        ),
        ("Particles", number(summary.particles as f64).replace(".0", "")),
        ("Steps", number(summary.steps as f64).replace(".0", "")),
        ("Computed in", format!("{} on the {}", time(summary.wall_time_s), summary.backend.to_uppercase())),
        ("Rate", format!("{} particle steps per second", number(summary.particle_steps_per_s.unwrap_or(f64::NAN)))),
        ("Corpuscle", format!("version {}", summary.version)),
    ]
}

/// How much of the terrain the maps show.
fn shown_words(report: &Report) -> String {
    if report.window.count == report.whole.grid {
        return "the whole terrain".into();
    }
    let [east, north] = report.ground.extent.map(|length| short_number((length / 10.0).round() * 10.0));
    format!("the part round the water and the marked positions, {east} m × {north} m")
}

fn terrain_words(terrain: &Terrain) -> String {
    let name = |path: &Path| path.file_name().map_or_else(|| "file".into(), |name| name.to_string_lossy().into_owned());
    match terrain {
        Terrain::File(file) => name(&file.path),
        Terrain::Tiles(tiles) => match tiles.paths.as_slice() {
            [only] => name(only),
            [first, others @ ..] => format!("{} and {} more files", name(first), others.len()),
            [] => "no file".into(),
        },
        Terrain::Fetch(_) => "Copernicus GLO-30".into(),
        Terrain::Valley(_) => "generated valley".into(),
        Terrain::RoughHills(_) => "generated rough hills".into(),
        Terrain::Plane(_) => "plane".into(),
        Terrain::Bump(_) => "flat bed with bumps".into(),
        Terrain::Bowl(_) => "paraboloid bowl".into(),
    }
}
