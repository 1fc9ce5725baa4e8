//! Charts of gauges over time, related gauges in one chart.

use crate::GaugeTable;
use corpuscle_model::{Chart, ChartAxis, ChartSeries, GaugeColumn};
use corpuscle_scene::{Gas, Speeds, Units};

/// Quantities and their names in the legend.
type Quantities = &'static [(&'static str, &'static str)];

/// Charts and their quantities, in the order of the report.
const KINDS: [(&str, Quantities); 10] = [
    ("Pressure", &[("pressure_virial", "from collisions"), ("pressure_walls", "on the walls")]),
    ("Pressure on the walls", &[("pressure", "")]),
    ("Temperature", &[("temperature", "")]),
    (
        "Energy",
        &[
            ("kinetic_energy", "kinetic"),
            ("potential_energy", "potential"),
            ("energy", "total"),
            ("work", "work and heat"),
        ],
    ),
    ("Position of the wall", &[("position", "")]),
    ("Collisions of a ball per unit of time", &[("collision_rate", "")]),
    ("Mean free path", &[("mean_free_path", "")]),
    ("Entropy of mixing", &[("mixing_entropy", "")]),
    ("Agreement with Maxwell: p-value", &[("maxwell_p_value", "")]),
    ("Errors of equal steps", &[("overlaps", "overlaps"), ("missed_hits", "missed hits")]),
];

/// The same for the species.
const OF_SPECIES: [(&str, Quantities); 1] = [("Kinetic energy of each species", &[("kinetic_energy", "")])];

/// The same for the regions of measurement.
const OF_REGIONS: [(&str, Quantities); 4] = [
    ("Balls in regions", &[("number", "")]),
    ("Pressure in regions", &[("pressure", "")]),
    ("Temperature in regions", &[("temperature", "")]),
    ("Flow in regions", &[("flow_x", "along x"), ("flow_y", "along y"), ("flow_z", "along z")]),
];

/// A chart for each kind of quantity that changes. What the model charts itself has none.
pub(super) fn over_time(gas: &Gas, columns: &[GaugeColumn], table: &GaugeTable, known: &[Chart]) -> Vec<Chart> {
    let drawn = |(title, quantities): &(&str, Quantities), group: Group| {
        let of_kind = |index: &usize| {
            let column = &columns[*index];
            Group::of(gas, column) == group
                && (group == Group::Region || is_told(gas, column))
                && quantities.iter().any(|(quantity, _)| column.quantity == *quantity)
        };
        let members: Vec<usize> = (0..columns.len()).filter(of_kind).filter(|index| changes(table, *index)).collect();
        let is_known = group == Group::Gas && known.iter().any(|chart| chart.name == quantities[0].0);
        let drawn = || chart(gas, columns, table, (title, quantities), &members);
        let drawn = (!members.is_empty() && !is_known).then(drawn)?;
        Some(Chart { name: format!("{}{}", group.prefix(), drawn.name), ..drawn })
    };
    let of_gas = KINDS.iter().filter_map(|kind| drawn(kind, Group::Gas));
    let of_species = OF_SPECIES.iter().filter_map(|kind| drawn(kind, Group::Species));
    let of_regions = OF_REGIONS.iter().filter_map(|kind| drawn(kind, Group::Region));
    of_gas.chain(of_species).chain(of_regions).collect()
}

/// What a column is about, where its chart depends on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Group {
    Gas,
    Species,
    Region,
}

impl Group {
    fn of(gas: &Gas, column: &GaugeColumn) -> Self {
        match column.quantity {
            _ if gas.measure.region.iter().any(|region| region.name == column.gauge) => Self::Region,
            "kinetic_energy" if column.gauge != "gas" => Self::Species,
            _ => Self::Gas,
        }
    }

    /// Beginning of the names of its charts.
    fn prefix(self) -> &'static str {
        match self {
            Self::Gas => "",
            Self::Species => "species_",
            Self::Region => "regions_",
        }
    }
}

/// False for what says nothing in this gas: one pressure for all of a box with a partition or gravity in it, or else that on
/// each wall; energy that is all kinetic, or goes as the temperature does; agreement with Maxwell where it was there from the
/// start; mixing where nothing parts the kinds at first.
fn is_told(gas: &Gas, column: &GaugeColumn) -> bool {
    let parted = gas.partition.as_ref().map(|partition| partition.axis.index());
    let uneven = parted.or_else(|| gas.gravity().iter().position(|&gravity| gravity != 0.0));
    match column.quantity {
        "pressure_virial" | "pressure_walls" => uneven.is_none(),
        "pressure" => uneven.is_some_and(|axis| column.gauge.starts_with(["x", "y", "z"][axis])),
        "energy" => gas.gravity() != [0.0; 3] || gas.well.is_some(),
        "kinetic_energy" => gas.restitution == 1.0,
        "maxwell_p_value" => gas.species.iter().any(|species| species.speeds == Speeds::Equal),
        "mixing_entropy" => gas.partition.as_ref().is_some_and(|partition| partition.lifted_at_s.is_some()),
        _ => true,
    }
}

/// The colour of a kind of balls.
fn colour_of(gas: &Gas, name: &str) -> Option<String> {
    let species = gas.species.iter().map(|species| (&species.name, &species.colour));
    let balls = gas.ball.iter().map(|ball| (&ball.name, &ball.colour));
    species.chain(balls).find(|(known, _)| *known == name)?.1.clone()
}

/// True where a column has different values, beyond rounding.
fn changes(table: &GaugeTable, index: usize) -> bool {
    let values = table.rows.iter().map(|row| row[index]).filter(|value| value.is_finite());
    let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)]);
    high - low > 1e-9 * high.abs().max(low.abs())
}

fn chart(
    gas: &Gas,
    columns: &[GaugeColumn],
    table: &GaugeTable,
    (title, quantities): (&str, Quantities),
    members: &[usize],
) -> Chart {
    let several = members.iter().any(|index| columns[*index].gauge != columns[members[0]].gauge);
    let series = members.iter().map(|&index| {
        let GaugeColumn { gauge, quantity, .. } = &columns[index];
        let words = quantities.iter().find(|(known, _)| known == quantity).map_or("", |(_, words)| *words);
        let name = match (several, words) {
            (true, "") => gauge.clone(),
            (true, words) => format!("{gauge}, {words}"),
            (false, words) => words.to_owned(),
        };
        let points = table.times.iter().zip(&table.rows).map(|(time, row)| [*time, row[index]]).collect();
        ChartSeries { name, points, colour: colour_of(gas, gauge), ..ChartSeries::default() }
    });
    let time = if gas.units == Units::Si { "s" } else { "" };
    Chart {
        name: format!("{}_over_time", quantities[0].0),
        title: title.into(),
        x: ChartAxis { label: "Time".into(), unit: time.into(), logarithmic: false },
        y: ChartAxis { label: String::new(), unit: printed(columns[members[0]].unit), logarithmic: false },
        series: series.collect(),
        note: String::new(),
    }
}

/// A unit of a file's header as it is printed: `m2_per_s` as `m²/s`.
fn printed(unit: &str) -> String {
    // What counts up has no unit above the line: `per_s` is 1/s.
    let unit = unit.strip_prefix("per_").map_or_else(|| unit.to_owned(), |below| format!("1/{below}"));
    // Several units below the line stand in brackets.
    let unit = unit.replace("_per_", "/").replace("m2", "m²").replace("m3", "m³").replace("s2", "s²");
    match unit.split_once('/') {
        Some((above, below)) if below.contains('_') => format!("{above}/({})", below.replace('_', " ")),
        _ => unit.replace('_', " "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_scene::Scene;

    #[test]
    fn columns_that_belong_together_stand_in_one_chart() {
        let text = "run.until_s = 1\n[gas]\nsize = [9, 9]\n[[gas.ball]]\nposition = [1, 1]\nradius = 1\nmass = 1";
        let scene = Scene::parse(text, "test", &[]).unwrap();
        let gas = scene.gas().unwrap();
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
            rows: vec![vec![1.0; 7], vec![2.0, 2.0, 2.0, 2.0, 2.0, 1.0, f64::NAN]],
        };
        let told = |known: &[Chart]| -> Vec<_> {
            let charts = over_time(gas, &columns, &table, known);
            charts.into_iter().map(|chart| (chart.name, chart.series.len(), chart.y.unit)).collect()
        };
        let entry = |name: &str, series, unit: &str| (name.to_owned(), series, unit.to_owned());
        let pressure = entry("pressure_virial_over_time", 2, "N/m");
        assert_eq!(told(&[]), [pressure.clone(), entry("temperature_over_time", 2, "K")]);
        assert_eq!(told(&[Chart { name: "temperature".into(), ..Chart::default() }]), [pressure]);
        let charts = over_time(gas, &columns, &table, &[]);
        assert_eq!(charts[0].series[1].name, "on the walls");
        assert_eq!(charts[1].series[1].name, "heavy");
    }

    #[test]
    fn species_and_regions_have_charts_of_their_own() {
        let text = "run.until_s = 1\n[gas]\nsize = [9, 9]\ngravity = [0, -1]\n[[gas.ball]]\nposition = [1, 1]\nradius = 1\nmass = 1\n\
                    [[gas.measure.region]]\nname = \"yard\"\nfrom = [0, 0]\nto = [9, 4]";
        let scene = Scene::parse(text, "test", &[]).unwrap();
        let column = |gauge: &str, quantity| GaugeColumn { gauge: gauge.into(), quantity, unit: "" };
        let columns = [
            column("y_min", "pressure"),
            column("yard", "pressure"),
            column("yard", "number"),
            column("yard", "flow_y"),
            column("ball", "kinetic_energy"),
        ];
        let table = GaugeTable {
            columns: columns.iter().map(GaugeColumn::header).collect(),
            times: vec![0.0, 1.0],
            rows: vec![vec![1.0; 5], vec![2.0; 5]],
        };
        let charts = over_time(scene.gas().unwrap(), &columns, &table, &[]);
        let told: Vec<_> = charts.iter().map(|chart| (&*chart.name, chart.series.len())).collect();
        let expected = [
            "pressure_over_time",
            "species_kinetic_energy_over_time",
            "regions_number_over_time",
            "regions_pressure_over_time",
            "regions_flow_x_over_time",
        ];
        assert_eq!(told, expected.map(|name| (name, 1)));
    }
}
