//! Gauges over time, those that belong together in one chart.

use crate::GaugeTable;
use corpuscle_model::{Chart, ChartAxis, ChartSeries, GaugeColumn};
use corpuscle_scene::{Gas, Units};

/// A chart for each kind of quantity: columns with the same first word and unit. Columns without any value, and those
/// that count up (`collisions`), have none.
pub(super) fn over_time(gas: &Gas, columns: &[GaugeColumn], table: &GaugeTable) -> Vec<Chart> {
    let mut groups: Vec<(String, &'static str, Vec<usize>)> = Vec::new();
    for (index, column) in columns.iter().enumerate() {
        let some = table.rows.iter().any(|row| row[index].is_finite());
        if !some || column.quantity == "collisions" {
            continue;
        }
        let kind = first_word(column.quantity).0;
        match groups.iter_mut().find(|(word, unit, _)| word == kind && *unit == column.unit) {
            Some((_, _, members)) => members.push(index),
            None => groups.push((kind.to_owned(), column.unit, vec![index])),
        }
    }
    groups.into_iter().map(|(kind, unit, members)| chart(gas, columns, table, &kind, unit, &members)).collect()
}

/// `pressure_virial` as `pressure` and `virial`; quantities of two words stay whole.
fn first_word(quantity: &str) -> (&str, &str) {
    const WHOLE: [&str; 6] =
        ["kinetic_energy", "potential_energy", "mixing_entropy", "collision_rate", "mean_free_path", "piston_work"];
    match quantity.split_once('_') {
        Some((word, rest)) if !WHOLE.contains(&quantity) => (word, rest),
        _ => (quantity, ""),
    }
}

fn chart(gas: &Gas, columns: &[GaugeColumn], table: &GaugeTable, kind: &str, unit: &str, members: &[usize]) -> Chart {
    let several = members.iter().any(|index| columns[*index].gauge != columns[members[0]].gauge);
    let title = capitalised(&kind.replace('_', " "));
    let series = members.iter().map(|&index| {
        let column = &columns[index];
        let rest = first_word(column.quantity).1.replace('_', " ");
        let name = match (several, rest.is_empty()) {
            (false, false) => rest,
            (true, false) => format!("{}, {rest}", column.gauge),
            _ => column.gauge.clone(),
        };
        let points = table.times.iter().zip(&table.rows).map(|(time, row)| [*time, row[index]]).collect();
        ChartSeries { name, points, ..ChartSeries::default() }
    });
    let time = if gas.units == Units::Si { "s" } else { "" };
    Chart {
        name: format!("{kind}_over_time"),
        title: format!("{title} over time"),
        x: ChartAxis { label: "Time".into(), unit: time.into(), logarithmic: false },
        y: ChartAxis { label: title, unit: printed(unit), logarithmic: false },
        series: series.collect(),
        note: String::new(),
    }
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A unit of a file's header as it is printed: `m2_per_s` as `m²/s`.
fn printed(unit: &str) -> String {
    unit.replace("_per_", "/").replace("m2", "m²").replace("m3", "m³").replace("s2", "s²")
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_scene::{ModelScene, Scene};

    #[test]
    fn columns_that_belong_together_stand_in_one_chart() {
        let text = "run.until_s = 1\n[gas]\nsize = [9, 9]\n[[gas.ball]]\nposition = [1, 1]\nradius = 1\nmass = 1";
        let ModelScene::Gas(gas) = Scene::parse(text, "test", &[]).unwrap().model else { panic!() };
        let column = |gauge: &str, quantity, unit| GaugeColumn { gauge: gauge.into(), quantity, unit };
        let columns = [
            column("gas", "pressure_virial", "N_per_m"),
            column("gas", "pressure_walls", "N_per_m"),
            column("light", "temperature", "K"),
            column("heavy", "temperature", "K"),
            column("gas", "collisions", ""),
            column("gas", "kinetic_energy", "J"),
            column("gas", "mixing_entropy", ""),
        ];
        let table = GaugeTable {
            columns: columns.iter().map(GaugeColumn::header).collect(),
            times: vec![0.0, 1.0],
            rows: vec![vec![1.0, 1.0, 1.0, 1.0, 1.0, 1.0, f64::NAN]; 2],
        };
        let charts = over_time(&gas, &columns, &table);
        let told: Vec<_> =
            charts.iter().map(|chart| (chart.name.as_str(), chart.series.len(), chart.y.unit.as_str())).collect();
        assert_eq!(
            told,
            [("pressure_over_time", 2, "N/m"), ("temperature_over_time", 2, "K"), ("kinetic_energy_over_time", 1, "J")]
        );
        assert_eq!(charts[0].series[1].name, "walls");
        assert_eq!(charts[1].series[1].name, "heavy");
    }
}
