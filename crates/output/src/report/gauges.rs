//! From the columns of `gauges.csv` to charts and peaks.

use super::Report;
use crate::GaugeTable;
use crate::picture::{Chart, Series, number, time};
use corpuscle_drawing::ticks::TimeUnit;
use corpuscle_scene::Inflow;

/// Units as they end a header, and as printed; the longer before those that end like them.
const UNITS: [(&str, &str); 5] =
    [("m3_per_s", "m³/s"), ("m2_per_s", "m²/s"), ("m_per_s", "m/s"), ("m3", "m³"), ("m", "m")];

/// Most gauges whose hydrographs are drawn; the others are in `gauges.csv`.
pub(super) const MOST_GAUGES: usize = 24;

/// One column of the table.
#[derive(Debug, Clone)]
pub(super) struct GaugeSeries {
    /// The gauge: `G1`.
    pub gauge: String,
    /// What it measures: `depth`.
    pub quantity: String,
    /// Unit as printed.
    pub unit: &'static str,
    /// Time, s, and value.
    pub points: Vec<[f64; 2]>,
}

impl GaugeSeries {
    /// Time, s, and value of the largest value; none where nothing was measured.
    pub(super) fn peak(&self) -> Option<[f64; 2]> {
        self.line("", 0, false).peak()
    }

    fn changes(&self) -> bool {
        self.points.iter().any(|point| point[1] != self.points[0][1])
    }

    /// The peak in words: `max 2.5 m at 10 s`.
    fn peak_in_words(&self) -> String {
        self.peak()
            .map_or_else(String::new, |peak| format!("max {} {} at {}", number(peak[1]), self.unit, time(peak[0])))
    }

    fn line(&self, name: &str, colour: usize, filled: bool) -> Series {
        Series { name: name.to_owned(), points: self.points.clone(), colour, filled }
    }
}

/// The curves of the report over time: the gauges, and the inflows as the scene prescribes them.
pub(super) fn series(report: &Report) -> Vec<GaugeSeries> {
    let mut all = gauge_series(&report.gauges);
    all.extend(report.flood.flood.inflow.iter().filter_map(|inflow| prescribed(inflow, report)));
    all
}

/// An inflow at the times of the gauges; none where its file is not there any more.
fn prescribed(inflow: &Inflow, report: &Report) -> Option<GaugeSeries> {
    let discharge = inflow.load_discharge(&report.folder).ok()?;
    Some(GaugeSeries {
        gauge: inflow.name.clone(),
        quantity: "inflow".into(),
        unit: "m³/s",
        points: report.gauges.times.iter().map(|time| [*time, discharge.at(*time)]).collect(),
    })
}

/// All columns of a table, with the speed of gauges that give only its components.
fn gauge_series(table: &GaugeTable) -> Vec<GaugeSeries> {
    let mut all: Vec<GaugeSeries> =
        table.columns.iter().enumerate().filter_map(|(index, header)| column(table, index, header)).collect();
    let speeds: Vec<GaugeSeries> = all.iter().filter_map(|east| speed(&all, east)).collect();
    all.extend(speeds);
    all
}

fn column(table: &GaugeTable, index: usize, header: &str) -> Option<GaugeSeries> {
    let (gauge, rest) = header.rsplit_once('.')?;
    let named = UNITS.iter().find_map(|(suffix, unit)| Some((rest.strip_suffix(suffix)?.strip_suffix('_')?, *unit)));
    let (quantity, unit) = named.unwrap_or((rest, ""));
    let points = table.times.iter().zip(&table.rows).map(|(time, row)| [*time, row[index]]).collect();
    Some(GaugeSeries { gauge: gauge.to_owned(), quantity: quantity.to_owned(), unit, points })
}

/// The speed that goes with an eastward velocity, unless the gauge gives it itself.
fn speed(all: &[GaugeSeries], east: &GaugeSeries) -> Option<GaugeSeries> {
    let of_gauge = |quantity: &str| all.iter().find(|s| s.gauge == east.gauge && s.quantity == quantity);
    if east.quantity != "velocity_east" || of_gauge("speed").is_some() {
        return None;
    }
    let north = of_gauge("velocity_north")?;
    let points = east.points.iter().zip(&north.points).map(|(e, n)| [e[0], e[1].hypot(n[1])]).collect();
    Some(GaugeSeries { gauge: east.gauge.clone(), quantity: "speed".into(), unit: "m/s", points })
}

/// Depth and speed at each gauge that became wet: two charts a gauge.
pub(super) fn hydrographs(all: &[GaugeSeries], span: [f64; 2], width: f64) -> Vec<[Chart; 2]> {
    let is_wet = |series: &&GaugeSeries| series.peak().is_some_and(|peak| peak[1] > 0.0);
    let depths = all.iter().filter(|series| series.quantity == "depth").filter(is_wet).take(MOST_GAUGES);
    let chart = |series: Option<&GaugeSeries>, title: String, unit: &str, height: f64, colour: usize| Chart {
        remark: series.map_or_else(String::new, GaugeSeries::peak_in_words),
        unit: unit.to_owned(),
        size: [width, height],
        span,
        time_unit: TimeUnit::of(span[1]),
        time_named: title.is_empty(),
        title,
        series: series.map(|s| s.line("", colour, true)).into_iter().collect(),
        now: None,
    };
    let pair = |depth: &GaugeSeries| {
        let speed = all.iter().find(|s| s.gauge == depth.gauge && s.quantity == "speed");
        [
            chart(Some(depth), depth.gauge.clone(), "depth, m", 166.0, 0),
            chart(speed, String::new(), "speed, m/s", 132.0, 1),
        ]
    };
    depths.map(pair).collect()
}

/// Volumes that change: what neither came in nor went out has no line, and all is left out where nothing changes.
pub(super) fn changing_volumes(all: &[GaugeSeries]) -> Vec<GaugeSeries> {
    all.iter().filter(|series| series.unit == "m³" && series.changes()).cloned().collect()
}

/// One chart of all columns in a unit; none where there is none.
pub(super) fn together(all: &[GaugeSeries], unit: &str, title: &str, span: [f64; 2], size: [f64; 2]) -> Option<Chart> {
    let chosen: Vec<&GaugeSeries> = all.iter().filter(|series| series.unit == unit).collect();
    let several_quantities = chosen.iter().any(|series| series.quantity != chosen[0].quantity);
    let several_gauges = chosen.iter().any(|series| series.gauge != chosen[0].gauge);
    let named = |series: &GaugeSeries| match (several_gauges, several_quantities) {
        (true, true) => format!("{}, {}", series.gauge, series.quantity.replace('_', " ")),
        (_, false) => series.gauge.clone(),
        (false, true) => series.quantity.replace('_', " "),
    };
    let lines =
        chosen.iter().enumerate().map(|(colour, series)| series.line(&named(series), colour, chosen.len() == 1));
    (!chosen.is_empty()).then(|| Chart {
        title: title.to_owned(),
        remark: match chosen.as_slice() {
            [only] => format!("{}: {}", named(only), only.peak_in_words()),
            _ => String::new(),
        },
        unit: unit.to_owned(),
        size,
        span,
        time_unit: TimeUnit::of(span[1]),
        time_named: true,
        series: lines.collect(),
        now: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> GaugeTable {
        let columns =
            ["G.1.depth_m", "G.1.velocity_east_m_per_s", "G.1.velocity_north_m_per_s", "weir.discharge_m3_per_s"];
        GaugeTable {
            columns: columns.map(str::to_owned).to_vec(),
            times: vec![0.0, 10.0],
            rows: vec![vec![0.0, f64::NAN, f64::NAN, 1.0], vec![2.0, 3.0, -4.0, 7.0]],
        }
    }

    #[test]
    fn headers_are_taken_apart() {
        let all = gauge_series(&table());
        assert_eq!((all[0].gauge.as_str(), all[0].quantity.as_str(), all[0].unit), ("G.1", "depth", "m"));
        assert_eq!((all[3].gauge.as_str(), all[3].quantity.as_str(), all[3].unit), ("weir", "discharge", "m³/s"));
        assert_eq!(all[3].peak(), Some([10.0, 7.0]));
    }

    #[test]
    fn speed_comes_from_its_components() {
        let all = gauge_series(&table());
        let speed = all.iter().find(|series| series.quantity == "speed").unwrap();
        assert!(speed.points[0][1].is_nan());
        assert_eq!(speed.points[1], [10.0, 5.0]);
    }

    #[test]
    fn volumes_that_stay_the_same_have_no_line() {
        let columns = ["water.stored_m3", "water.total_inflow_m3", "water.total_outflow_m3"].map(str::to_owned);
        let rows = vec![vec![9.0, 0.0, 0.0], vec![8.0, 0.0, 1.0]];
        let all = gauge_series(&GaugeTable { columns: columns.to_vec(), times: vec![0.0, 10.0], rows });
        let kept: Vec<String> = changing_volumes(&all).into_iter().map(|series| series.quantity).collect();
        assert_eq!(kept, ["stored", "total_outflow"]);
        assert!(changing_volumes(&all[1..2]).is_empty());
    }

    #[test]
    fn charts_for_what_is_there() {
        let all = gauge_series(&table());
        let [depth, speed] = &hydrographs(&all, [0.0, 10.0], 300.0)[0];
        assert_eq!((depth.series.len(), speed.series.len()), (1, 1));
        assert_eq!(depth.remark, "max 2.00 m at 10 s");
        let discharge = together(&all, "m³/s", "Discharge", [0.0, 10.0], [900.0, 240.0]).unwrap();
        assert_eq!(discharge.remark, "weir: max 7.00 m³/s at 10 s");
        assert!(together(&all, "m³", "Volume", [0.0, 10.0], [900.0, 240.0]).is_none());
    }
}
