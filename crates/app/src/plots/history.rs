//! Gauges over time.

use corpuscle::model::{Chart, ChartAxis, ChartSeries};

/// Most rows; beyond that every other one is dropped, so that the rows kept reach from the start to now.
const MOST: usize = 4000;

/// Rows of gauges.
#[derive(Debug, Default)]
pub struct History {
    rows: Vec<(f64, Vec<f64>)>,
    /// Rows added so far; one of so many is kept.
    every: usize,
    come: usize,
    /// True for a finished run, whose rows are complete.
    whole: bool,
}

impl History {
    /// The gauges of a finished run.
    pub fn whole(rows: Vec<(f64, Vec<f64>)>) -> Self {
        Self { rows, whole: true, ..Self::default() }
    }

    /// Adds a row, if its time is later.
    pub fn take(&mut self, time: f64, row: &[f64]) {
        let later = self.rows.last().is_none_or(|(last, _)| time > *last);
        if self.whole || row.is_empty() || !later {
            return;
        }
        self.come += 1;
        if self.come.is_multiple_of(self.every.max(1)) {
            self.rows.push((time, row.to_vec()));
        }
        if self.rows.len() >= MOST {
            let mut number = 0;
            self.rows.retain(|_| {
                number += 1;
                number % 2 == 1
            });
            self.every = 2 * self.every.max(1);
        }
    }

    /// Gives rows other columns: the number of each before, none for what is new.
    pub fn rename(&mut self, before: &[Option<usize>]) {
        for (_, row) in &mut self.rows {
            let value = |before: &Option<usize>| before.and_then(|before| row.get(before).copied()).unwrap_or(f64::NAN);
            *row = before.iter().map(value).collect();
        }
    }

    /// A gauge over time; none before there are two rows.
    pub fn chart(&self, index: usize, header: &str, time_unit: &str) -> Option<Chart> {
        let points: Vec<[f64; 2]> =
            self.rows.iter().filter_map(|(time, row)| row.get(index).map(|value| [*time, *value])).collect();
        if points.iter().filter(|point| point[1].is_finite()).count() < 2 {
            return None;
        }
        let axis = |label: &str, unit: &str| ChartAxis { label: label.into(), unit: unit.into(), logarithmic: false };
        let series = ChartSeries { name: header.into(), points, ..ChartSeries::default() };
        Some(Chart {
            name: header.replace('.', "_"),
            title: header.into(),
            x: axis("Time", time_unit),
            y: axis(header, ""),
            series: vec![series],
            note: String::new(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gauge_that_comes_later_has_its_own_column() {
        let mut history = History::default();
        (0..3).for_each(|step| history.take(f64::from(step), &[1.0, 2.0]));
        history.rename(&[Some(1), None, Some(0)]);
        history.take(3.0, &[2.0, 5.0, 1.0]);
        let values = |index| {
            let chart = history.chart(index, "x", "s").unwrap();
            chart.series[0].points.iter().map(|point| point[1]).collect::<Vec<_>>()
        };
        assert_eq!([values(0), values(2)], [vec![2.0; 4], vec![1.0; 4]]);
        assert!(history.rows[2].1[1].is_nan() && history.rows[3].1[1] == 5.0);
    }

    #[test]
    fn what_is_kept_reaches_from_the_start_to_now() {
        let mut history = History::default();
        (0..50_000).for_each(|step| history.take(f64::from(step), &[f64::from(step)]));
        history.take(3.0, &[0.0]);
        assert!(history.rows.len() < MOST && history.rows.len() >= MOST / 4, "{}", history.rows.len());
        assert!(history.rows.windows(2).all(|pair| pair[0].0 < pair[1].0));
        assert!(history.rows[0].0 == 0.0 && history.rows.last().is_some_and(|row| row.0 > 49_900.0));
        assert!(history.chart(0, "gas.energy", "").is_some() && history.chart(7, "none", "").is_none());
    }
}
