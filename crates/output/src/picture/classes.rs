//! Classes of values and their colours, as a legend shows them.

use super::colour::Colour;
use super::text::short_number;
use super::ticks::{self, TimeUnit};

/// A kind of quantity and its colours. The lightness of all ramps is monotonic, so they can be read without colour vision too.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ramp {
    /// Depth, m: light to dark blue.
    Depth,
    /// Speed, m/s: yellow through red to violet.
    Speed,
    /// Arrival, s: early dark, late light (viridis).
    Arrival,
    /// Duration, s: light to dark green.
    Duration,
    /// UK hazard rating: four fixed classes.
    Hazard,
}

impl Ramp {
    fn colours(self) -> &'static [u32] {
        match self {
            Self::Depth => &[0xd3ebfb, 0xa4d3f4, 0x6fb5e8, 0x3d93d8, 0x1d6fbd, 0x114c93, 0x0a2d63],
            Self::Speed => &[0xfff0b0, 0xfdd277, 0xf8a65b, 0xea7258, 0xc94571, 0x8e2a7a, 0x4f1c66],
            Self::Arrival => &[0x440154, 0x443983, 0x31688e, 0x21918c, 0x35b779, 0x90d743, 0xfde725],
            Self::Duration => &[0xdff1e4, 0xb3dfc6, 0x7fc6a8, 0x49a88c, 0x238573, 0x12605a, 0x0a3b40],
            Self::Hazard => &[0xfde9a6, 0xfbb14e, 0xe2562d, 0x85102c],
        }
    }
}

/// Edges between classes where they are not counted in time: halving and doubling, in round numbers.
const LADDER: [f64; 17] =
    [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0];

/// Names of the UK hazard classes (Defra and Environment Agency, FD2321 and its 2008 supplement).
const HAZARD: [&str; 4] = ["Low", "Moderate", "Significant", "Extreme"];

/// Classes of a quantity: `edges.len() + 1` of them, open at both ends.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Classes {
    /// The quantity with its unit: `Maximum depth, m`.
    pub title: String,
    /// Edges between the classes, rising.
    pub edges: Vec<f64>,
    /// The edges as printed.
    pub labels: Vec<String>,
    /// A colour for each class.
    pub colours: Vec<Colour>,
    /// A name for each class; none where classes have no names.
    pub names: Vec<String>,
}

impl Classes {
    /// Classes in round numbers that suit the values (not-a-number is passed over).
    pub(crate) fn of(ramp: Ramp, title: &str, values: &[f32]) -> Self {
        let sorted = sorted(values);
        let quantile = |part: f64| {
            let index = (part * sorted.len().saturating_sub(1) as f64).round() as usize;
            sorted.get(index).map_or(0.0, |value| f64::from(*value))
        };
        match ramp {
            Ramp::Depth | Ramp::Speed => {
                let edges = ladder_below(quantile(0.995));
                let labels = edges.iter().map(|edge| edge.to_string()).collect();
                Self::new(ramp, title.to_owned(), edges, labels)
            }
            Ramp::Arrival | Ramp::Duration if quantile(0.0) == quantile(1.0) => {
                let unit = TimeUnit::of(quantile(1.0));
                let name = match sorted.first() {
                    Some(_) => format!("{} everywhere", short_number(quantile(1.0) / unit.seconds)),
                    None => "nowhere".into(),
                };
                let classes = Self::new(ramp, format!("{title}, {}", unit.name), Vec::new(), Vec::new());
                Self { names: vec![name], ..classes }
            }
            Ramp::Arrival | Ramp::Duration => {
                let (edges, labels, unit) = time_edges(quantile(0.005), quantile(0.995));
                Self::new(ramp, format!("{title}, {unit}"), edges, labels)
            }
            Ramp::Hazard => {
                let labels = ["0.75", "1.25", "2"].map(str::to_owned).to_vec();
                let classes = Self::new(ramp, title.to_owned(), vec![0.75, 1.25, 2.0], labels);
                Self { names: HAZARD.map(str::to_owned).to_vec(), ..classes }
            }
        }
    }

    /// Classes of a probability, 0 to 1.
    pub(crate) fn of_probability() -> Self {
        let edges = vec![0.05, 0.2, 0.4, 0.6, 0.8, 0.95];
        let labels = edges.iter().map(|edge| format!("{:.0} %", 100.0 * edge)).collect();
        Self::new(Ramp::Depth, "Probability".into(), edges, labels)
    }

    fn new(ramp: Ramp, title: String, edges: Vec<f64>, labels: Vec<String>) -> Self {
        let all = ramp.colours();
        let count = edges.len() + 1;
        let pick = |class: usize| match count {
            1 => all.len() / 2,
            _ => (class * (all.len() - 1) + (count - 1) / 2) / (count - 1),
        };
        let colours = (0..count).map(|class| all[pick(class)]);
        let colours = colours.map(|hex| [(hex >> 16) as u8, (hex >> 8) as u8, hex as u8]).collect();
        Self { title, edges, labels, colours, names: Vec::new() }
    }

    /// The class of a value: edges belong to the class above.
    pub(crate) fn class_of(&self, value: f64) -> usize {
        self.edges.partition_point(|edge| *edge <= value)
    }

    /// The values of a class: `0.5 – 1`; empty where there is only one class.
    pub(crate) fn values(&self, class: usize) -> String {
        let below = class.checked_sub(1).map(|edge| &self.labels[edge]);
        match (below, self.labels.get(class)) {
            (None, Some(high)) => format!("below {high}"),
            (Some(low), None) => format!("{low} and above"),
            (Some(low), Some(high)) => format!("{low} – {high}"),
            (None, None) => String::new(),
        }
    }

    /// A class as text: its values, or its name and values.
    pub(crate) fn range(&self, class: usize) -> String {
        let range = self.values(class);
        match self.names.get(class) {
            Some(name) if range.is_empty() => name.clone(),
            Some(name) => format!("{name} ({range})"),
            None => range,
        }
    }
}

fn sorted(values: &[f32]) -> Vec<f32> {
    let mut numbers: Vec<f32> = values.iter().copied().filter(|value| !value.is_nan()).collect();
    numbers.sort_by(f32::total_cmp);
    numbers
}

/// Up to six steps of the ladder, the last of them not above `high`.
fn ladder_below(high: f64) -> Vec<f64> {
    let end = LADDER.partition_point(|edge| *edge <= high).max(1);
    LADDER[end.saturating_sub(6)..end].to_vec()
}

/// Edges in round times between `low` and `high`, s; their labels, and the unit of these.
fn time_edges(low: f64, high: f64) -> (Vec<f64>, Vec<String>, &'static str) {
    let unit = TimeUnit::of(high);
    let [low, high] = [low, high].map(|value| value / unit.seconds);
    let step = unit.step((high - low).max(1e-9), 6);
    let inside: Vec<f64> = ticks::multiples(low, high, step).into_iter().filter(|edge| *edge > low).take(6).collect();
    let edges = if inside.is_empty() { vec![high.ceil().max(1.0)] } else { inside };
    let labels = edges.iter().map(|edge| ticks::label(*edge, step.min(1.0))).collect();
    (edges.iter().map(|edge| edge * unit.seconds).collect(), labels, unit.name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_classes_are_round_and_follow_the_data() {
        let classes = Classes::of(Ramp::Depth, "Depth, m", &[0.02, 5.3, f32::NAN, 5.2]);
        assert_eq!(classes.edges, [0.1, 0.25, 0.5, 1.0, 2.0, 4.0]);
        assert_eq!(classes.colours.len(), 7);
        assert_eq!((classes.class_of(0.01), classes.class_of(0.5), classes.class_of(9.0)), (0, 3, 6));
        assert_eq!((classes.range(0).as_str(), classes.range(2).as_str()), ("below 0.1", "0.25 – 0.5"));
        let shallow = Classes::of(Ramp::Depth, "Depth, m", &[0.03]);
        assert_eq!(shallow.edges.last(), Some(&0.02));
    }

    #[test]
    fn nothing_wet_still_has_classes() {
        for ramp in [Ramp::Depth, Ramp::Speed, Ramp::Arrival, Ramp::Duration, Ramp::Hazard] {
            let classes = Classes::of(ramp, "x", &[f32::NAN]);
            assert_eq!(classes.colours.len(), classes.edges.len() + 1);
            assert_eq!(classes.labels.len(), classes.edges.len());
        }
    }

    #[test]
    fn times_are_classed_in_round_minutes_or_hours() {
        let classes = Classes::of(Ramp::Arrival, "Arrival", &[0.0, 600.0, 1500.0]);
        assert_eq!(classes.title, "Arrival, min");
        assert_eq!(classes.edges, [300.0, 600.0, 900.0, 1200.0, 1500.0]);
        assert_eq!(classes.labels[1], "10");
    }

    #[test]
    fn a_time_that_is_the_same_everywhere_is_one_class_with_its_value() {
        assert_eq!(Classes::of(Ramp::Arrival, "Arrival", &[f32::NAN]).range(0), "nowhere");
        let classes = Classes::of(Ramp::Duration, "Time under water", &[60.0, f32::NAN, 60.0]);
        assert_eq!((classes.colours.len(), classes.range(0).as_str()), (1, "60 everywhere"));
        assert_eq!(classes.title, "Time under water, s");
    }

    #[test]
    fn hazard_classes_are_the_official_ones() {
        let classes = Classes::of(Ramp::Hazard, "Hazard", &[9.0]);
        assert_eq!([0.7, 0.75, 1.3, 2.0].map(|value| classes.class_of(value)), [0, 1, 2, 3]);
        assert_eq!(classes.range(2), "Significant (1.25 – 2)");
    }
}
