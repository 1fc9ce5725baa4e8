//! A small chart of one gauge, for a corner of a picture.

use crate::GaugeTable;
use crate::picture::{Chart, Figure, Series};
use corpuscle_drawing::ticks::TimeUnit;
use corpuscle_model::GaugeColumn;

/// Width and height, CSS pixels.
const SIZE: [f64; 2] = [310.0, 170.0];

/// A chart of a column of a run's gauges over the whole run, drawn in full up to a time and pale after it; none where the table does not
/// have the column. Time is in seconds or, where `has_si_units` is false, in reduced units.
pub fn gauge_chart(column: &GaugeColumn, table: &GaugeTable, now: f64, has_si_units: bool) -> Option<Figure> {
    let values = table.column(&column.header())?;
    let points: Vec<[f64; 2]> = table.times.iter().zip(values).map(|(time, value)| [*time, value]).collect();
    let ends = [table.times.first(), table.times.last()].map(|time| time.copied().unwrap_or(0.0));
    let quantity = column.quantity.replace('_', " ");
    let unit = unit_in_words(column.unit);
    let chart = Chart {
        title: column.gauge.clone(),
        remark: String::new(),
        unit: if unit.is_empty() { quantity } else { format!("{quantity}, {unit}") },
        size: SIZE,
        span: ends,
        time_unit: if has_si_units { TimeUnit::of(ends[1]) } else { TimeUnit::REDUCED },
        time_named: true,
        series: vec![Series { name: String::new(), points, colour: 0, filled: true }],
        now: Some(now),
    };
    Some(chart.figure())
}

/// A unit of a header as it is printed: `m3_per_s` as m³/s.
fn unit_in_words(unit: &str) -> String {
    let raised = |letter: char| match letter {
        '2' => '²',
        '3' => '³',
        other => other,
    };
    unit.replace("_per_", "/").replace('_', " ").chars().map(raised).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chart_is_named_by_its_gauge_and_unit() {
        let column = GaugeColumn { gauge: "Mill".into(), quantity: "discharge", unit: "m3_per_s" };
        let table = GaugeTable {
            columns: vec![column.header()],
            times: vec![0.0, 10.0, 20.0],
            rows: vec![vec![0.0], vec![f64::NAN], vec![3.0]],
        };
        let text = gauge_chart(&column, &table, 10.0, true).unwrap().inline();
        assert!(text.contains(">time, s<"), "{text}");
        let reduced = gauge_chart(&column, &table, 10.0, false).unwrap().inline();
        assert!(reduced.contains(">time<") && !reduced.contains("time, s"), "{reduced}");
        assert!(text.contains(">Mill<") && text.contains("discharge, m³/s") && !text.contains("NaN"), "{text}");
        let other = GaugeColumn { gauge: "Weir".into(), ..column };
        assert_eq!(gauge_chart(&other, &table, 10.0, true), None);
        assert_eq!(unit_in_words("kg_per_m2"), "kg/m²");
        assert_eq!(unit_in_words("N_s"), "N s");
    }
}
