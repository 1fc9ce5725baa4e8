//! Gauges of dew over time.

use crate::GaugeTable;
use corpuscle_model::{Chart, ChartAxis, ChartSeries};
use corpuscle_scene::Dew;

/// A chart: name, title, unit, what a value is multiplied by, and the columns that it shows with their names.
type Kind<'a> = (&'a str, &'a str, &'a str, f64, Vec<(String, &'a str)>);

/// Charts of what changes.
pub(super) fn over_time(table: &GaugeTable, dew: &Dew) -> Vec<Chart> {
    let one = |header: &str| vec![(header.to_owned(), "")];
    let names = solids_and_faces(dew);
    let of = |all: bool, quantity: &str| -> Vec<(String, &str)> {
        let wanted = names.iter().filter(|(_, is_face)| all || !is_face);
        wanted.map(|(name, _)| (format!("{name}.{quantity}"), name.as_str())).collect()
    };
    let of_solids = |quantity: &str| of(false, quantity);
    let of_faces_too = |quantity: &str| of(true, quantity);
    let kinds: [Kind<'_>; 14] = [
        ("covered", "Part of the surface that drops cover", "%", 1e2, of_faces_too("covered_part")),
        ("water_per_area", "Water on the solids", "g/m²", 1e3, of_faces_too("water_per_area_kg_per_m2")),
        ("number_of_drops", "Drops", "", 1.0, one("drops.number")),
        ("largest_drop", "Radius of the largest drop", "mm", 1e3, one("drops.largest_radius_m")),
        ("heat_flow", "Heat flow from the air to the solids", "W", 1.0, of_solids("heat_flow_W")),
        ("water_left", "Water that ran off", "mg", 1e6, one("drops.left_kg")),
        ("heat_given", "Heat from solids at a held temperature", "J", 1.0, of_solids("heat_given_J")),
        ("heat_from_heater", "Heat from heaters", "J", 1.0, of_solids("heat_from_heater_J")),
        ("heat_from_outside", "Heat from outside (negative: lost)", "J", 1.0, of_solids("heat_from_outside_J")),
        ("heat_by_radiation", "Heat by radiation (negative: lost)", "J", 1.0, of_solids("heat_by_radiation_J")),
        ("solid_temperature", "Mean temperature of the solids", "K", 1.0, of_faces_too("mean_temperature_K")),
        ("nearest_air", "Nearest air (negative: inside)", "mm", 1e3, of_solids("nearest_air_m")),
        ("gap", "Vacuum before the surface", "mm", 1e3, of_solids("gap_m")),
        ("wall_pairs", "Pairs of air and wall per step", "", 1.0, of_solids("wall_pairs")),
    ];
    kinds.into_iter().filter_map(|kind| chart(table, kind)).collect()
}

/// Names of the solids, each followed by those of its faces as gauges have them, and whether it is that of a face.
fn solids_and_faces(dew: &Dew) -> Vec<(String, bool)> {
    let of_solid = |solid: &corpuscle_scene::dew::Solid| {
        let faces: Vec<_> = solid.face.iter().map(|face| (format!("{}.{}", solid.name, face.name), true)).collect();
        std::iter::once((solid.name.clone(), false)).chain(faces)
    };
    dew.solid.iter().flat_map(of_solid).collect()
}

/// None where nothing changes.
fn chart(table: &GaugeTable, (name, title, unit, factor, columns): Kind<'_>) -> Option<Chart> {
    let several = columns.len() > 1;
    let series: Vec<_> = columns
        .into_iter()
        .filter_map(|(header, word)| {
            let values = table.column(&header)?;
            let changes = values.iter().any(|value| *value != values[0]);
            let points = table.times.iter().zip(values).map(|(time, value)| [*time, factor * value]).collect();
            let name = if several { word.to_owned() } else { String::new() };
            changes.then_some(ChartSeries { name, points, ..ChartSeries::default() })
        })
        .collect();
    (!series.is_empty()).then(|| Chart {
        name: name.into(),
        title: title.into(),
        x: ChartAxis { label: "Time".into(), unit: "s".into(), logarithmic: false },
        y: ChartAxis { label: String::new(), unit: unit.into(), logarithmic: false },
        series,
        note: String::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_scene::Scene;

    #[test]
    fn what_changes_is_charted() {
        let text = "run.until_s = 1\n[dew]\nsize_m = [1, 1, 1]\nspacing_m = 0.1\nair = { temperature_c = 20, dew_point_c = 9 }";
        let scene = Scene::parse(text, "test", &[]).unwrap();
        let table = GaugeTable {
            columns: ["drops.number", "drops.left_kg"].map(String::from).to_vec(),
            times: vec![0.0, 1.0],
            rows: vec![vec![3.0, 0.0], vec![3.0, 2e-6]],
        };
        let charts = over_time(&table, scene.dew().unwrap());
        assert_eq!(charts.len(), 1);
        assert_eq!(charts[0].series[0].points, [[0.0, 0.0], [1.0, 2.0]]);
    }
}
