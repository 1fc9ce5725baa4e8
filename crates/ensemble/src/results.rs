//! Results of an ensemble: statistics over its finished members as files, and the report.

use crate::member::{axes, read_gauges, read_map};
use crate::statistics::{Absent, MEMORY, Moments, Values, moments, percentiles, share_above};
use crate::{Chosen, EnsembleError, Folder, Record, Source};
use corpuscle::Simulation;
use corpuscle::model::{Chart, ChartAxis, ChartSeries, ChartStyle};
use corpuscle::output::{EnsembleMap, EnsembleReport, EnsembleTable, GaugeTable};
use corpuscle::terrain::{MapGrid, write_geotiff};
use corpuscle_atomic_file::write_whole;
use serde_json::Value;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Folder of the results in the ensemble's folder.
const RESULTS: &str = "results";
/// Value of cells without data.
const NO_DATA: f32 = -9999.0;
/// Columns of gauges that are evaluated where none are chosen.
const GAUGES: usize = 12;
/// Words in the names of maps whose dry cells have the value 0.
const ZERO_WHERE_DRY: [&str; 8] =
    ["depth", "speed", "velocity", "fastest", "duration", "hazard", "infiltration", "discharge"];

/// The files that were written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// Folder of maps and tables.
    pub folder: PathBuf,
    /// The report.
    pub report: PathBuf,
    /// Number of maps.
    pub maps: usize,
}

/// Computes the chosen statistics over the members that are finished, and writes them.
///
/// Of each map GeoTIFF files of its mean, standard error and percentiles, and of the probability of being above a threshold; `gauges.csv` with bands over
/// time; `last_gauges.csv`; `members.csv`; and the report. What a dry cell counts as is told in the guide's page on ensembles.
///
/// # Errors
/// [`EnsembleError::Folder`] where no member is finished, maps lie on different grids, or a map or gauge is not there;
/// [`EnsembleError::File`] and [`EnsembleError::Scene`] where something cannot be read or written.
pub fn write_results(folder: &Folder, source: &Source, chosen: &Chosen) -> Result<Written, EnsembleError> {
    let members = Members::read(folder)?;
    let results = folder.path().join(RESULTS);
    fs::create_dir_all(&results).map_err(EnsembleError::file(&results))?;
    let simulation = source.open_to_read(&folder.plan().assignments(members.first().number))?;
    let computation = Computation { members: &members, chosen, results: &results, simulation: &simulation };
    let maps = computation.maps()?;
    let (charts, last) = computation.gauges()?;
    write_table(&results.join("members.csv"), &members.table(Names::AsInFiles))?;
    let count = maps.written;
    let report = folder.path().join("report.html");
    computation.report(folder, maps, charts, last).write(&report)?;
    Ok(Written { folder: results, report, maps: count })
}

/// The members of an ensemble.
struct Members<'a> {
    folder: &'a Folder,
    records: Vec<Option<Record>>,
    /// Numbers of those that are finished.
    finished: Vec<usize>,
}

/// How a table is written.
#[derive(Clone, Copy, PartialEq)]
enum Names {
    AsInFiles,
    InWords,
}

impl<'a> Members<'a> {
    fn read(folder: &'a Folder) -> Result<Self, EnsembleError> {
        let records = (0..folder.plan().rows.len()).map(|number| folder.record(number));
        let records: Vec<Option<Record>> = records.collect::<Result<_, _>>()?;
        let is_finished = |number: &usize| records[*number].as_ref().is_some_and(Record::is_finished);
        let finished: Vec<usize> = (0..records.len()).filter(is_finished).collect();
        if finished.is_empty() {
            let failure = records.iter().flatten().find_map(|record| Some((record.number, record.error.as_ref()?)));
            let told =
                failure.map_or_else(String::new, |(number, failure)| format!("; member {number}: {}", failure.message));
            let what = format!("no member of the ensemble in {} is finished{told}", folder.path().display());
            return Err(EnsembleError::Folder(what));
        }
        Ok(Self { folder, records, finished })
    }

    /// The first member that is finished.
    fn first(&self) -> &Record {
        self.finished_records().next().expect("there is a finished member")
    }

    fn finished_records(&self) -> impl Iterator<Item = &Record> {
        self.finished.iter().filter_map(|number| self.records[*number].as_ref())
    }

    fn failed(&self) -> impl Iterator<Item = (&Record, &crate::Failure)> {
        self.records.iter().flatten().filter_map(|record| Some((record, record.error.as_ref()?)))
    }

    /// Names of the maps.
    fn maps(&self) -> Vec<String> {
        self.first().maps.iter().flatten().map(|(name, _)| name.clone()).collect()
    }

    /// Headers of the gauges, in the order of the members' files.
    fn gauges(&self) -> Result<Vec<String>, EnsembleError> {
        Ok(self.gauges_of(0)?.columns)
    }

    fn gauges_of(&self, position: usize) -> Result<GaugeTable, EnsembleError> {
        read_gauges(&self.folder_of(position))
    }

    /// Folder of a member by its position among the finished.
    fn folder_of(&self, position: usize) -> PathBuf {
        self.folder.member(self.finished[position])
    }

    /// The number of the member that ran longest, of several the first, by position among the finished.
    fn longest(&self) -> usize {
        let times: Vec<f64> = self.finished_records().map(|record| record.last_time_s.unwrap_or(0.0)).collect();
        (0..times.len()).fold(0, |longest, number| if times[number] > times[longest] { number } else { longest })
    }

    /// A row for each member: changes, how it ended, and the last gauges.
    fn table(&self, names: Names) -> EnsembleTable {
        let plan = self.folder.plan();
        let gauges: Vec<String> = match names {
            Names::AsInFiles => self.first().final_gauges.iter().flatten().map(|(name, _)| name.clone()).collect(),
            Names::InWords => Vec::new(),
        };
        let own = match names {
            Names::AsInFiles => ["status", "attempts", "wall_time_s"],
            Names::InWords => ["status", "attempts", "wall time, s"],
        };
        let head = ["member"].into_iter().chain(plan.columns.iter().map(String::as_str)).chain(own);
        let head = head.chain(gauges.iter().map(String::as_str)).map(str::to_owned).collect();
        let row = |(number, record): (usize, &Option<Record>)| {
            let changes = plan.rows[number].iter().map(|value| shown(value, names));
            let status =
                record.as_ref().map_or("not run", |record| if record.is_finished() { "finished" } else { "failed" });
            let attempts = record.as_ref().map_or(0, |record| record.attempts);
            let wall = record.as_ref().and_then(|record| record.wall_time_s);
            let last = |name: &String| record.as_ref().and_then(|record| *record.final_gauges.as_ref()?.get(name)?);
            let cells = std::iter::once(number.to_string()).chain(changes);
            let cells = cells.chain([
                status.to_owned(),
                attempts.to_string(),
                wall.map_or_else(String::new, |wall| format!("{wall:.3}")),
            ]);
            cells
                .chain(gauges.iter().map(|name| last(name).map_or_else(String::new, |value| value.to_string())))
                .collect()
        };
        let rows = self.records.iter().enumerate().map(row).collect();
        EnsembleTable { title: "Plan".into(), about: String::new(), head, rows }
    }

    fn failures(&self) -> Option<EnsembleTable> {
        let row = |(record, failure): (&Record, &crate::Failure)| {
            let changes: Vec<String> =
                record.changes.iter().map(|(key, value)| format!("{key} = {}", shown(value, Names::InWords))).collect();
            vec![record.number.to_string(), changes.join(", "), failure.message.clone()]
        };
        let rows: Vec<Vec<String>> = self.failed().map(row).collect();
        let head = ["member", "changes", "error"].map(str::to_owned).to_vec();
        (!rows.is_empty()).then(|| EnsembleTable {
            title: "Members that failed".into(),
            about: String::new(),
            head,
            rows,
        })
    }
}

fn shown(value: &Value, names: Names) -> String {
    match value.as_f64() {
        Some(number) if names == Names::InWords && value.is_f64() => short(number),
        _ => crate::plan::encoded(value),
    }
}

/// A number with six digits at most.
fn short(number: f64) -> String {
    if number.is_nan() {
        return String::new();
    }
    let rounded: f64 = format!("{number:.5e}").parse().unwrap_or(number);
    rounded.to_string()
}

/// The maps of a report, and how many files there are.
#[derive(Default)]
struct Maps {
    probabilities: Vec<EnsembleMap>,
    statistics: Vec<(String, Vec<EnsembleMap>)>,
    written: usize,
}

/// What the statistics are computed from, and where they go.
struct Computation<'a> {
    members: &'a Members<'a>,
    chosen: &'a Chosen,
    results: &'a Path,
    /// The first member that is finished: its terrain has the grid of the maps.
    simulation: &'a Simulation,
}

impl Computation<'_> {
    fn maps(&self) -> Result<Maps, EnsembleError> {
        let Some(terrain) = self.simulation.terrain() else { return Ok(Maps::default()) };
        let (grid, members) = (terrain.map_grid(), self.members);
        let axes = axes(grid);
        let known = self.members.maps();
        let names = self.chosen.maps.clone().unwrap_or_else(|| known.clone());
        let above = self.chosen.above.clone().unwrap_or_else(|| {
            let depth = "max_depth".to_owned();
            if names.contains(&depth) { [(depth, vec![0.3])].into() } else { Default::default() }
        });
        for name in names.iter().chain(above.keys()) {
            self.need(name, &known, "map")?;
        }
        let mut maps = Maps::default();
        for (name, thresholds) in &above {
            for threshold in thresholds {
                let read = |position: usize| read_map(&members.folder_of(position), name, &axes);
                let shares = share_above(&self.values(grid, &read), *threshold)?;
                self.write_map(&format!("{name}_probability_above_{threshold}"), grid, &shares, &mut maps)?;
                maps.probabilities.push(self.probability(name, *threshold, &shares));
            }
        }
        for name in &names {
            let read = |position: usize| read_map(&members.folder_of(position), name, &axes);
            let statistics = self.statistics(name, grid, &self.values(grid, &read), &mut maps)?;
            maps.statistics.push((name.clone(), statistics));
        }
        Ok(maps)
    }

    /// Mean, standard error and percentiles of a map.
    fn statistics(
        &self,
        name: &str,
        grid: &MapGrid,
        values: &Values<'_, f32>,
        maps: &mut Maps,
    ) -> Result<Vec<EnsembleMap>, EnsembleError> {
        let absent = absent(name);
        let Moments { mean, standard_error, .. } = moments(values, absent)?;
        self.write_map(&format!("{name}_mean"), grid, &mean, maps)?;
        self.write_map(&format!("{name}_standard_error"), grid, &standard_error, maps)?;
        let mut on_page = Vec::new();
        let found = percentiles(values, &self.chosen.percentiles, absent, MEMORY)?;
        for (percent, values) in self.chosen.percentiles.iter().zip(&found) {
            self.write_map(&format!("{name}_p{percent}"), grid, values, maps)?;
            on_page.push(EnsembleMap { title: format!("Percentile {percent}"), values: seen(values) });
        }
        Ok(on_page)
    }

    fn probability(&self, name: &str, threshold: f64, shares: &[f64]) -> EnsembleMap {
        let described = self.members.first().maps.as_ref().and_then(|maps| maps.get(name));
        let (title, unit) = described.map_or((name, ""), |map| (map.long_name.as_str(), map.units.as_str()));
        let (first, rest) = title.split_at(title.chars().next().map_or(0, char::len_utf8));
        let title = format!("Probability of a {}{rest} above {threshold} {unit}", first.to_lowercase());
        EnsembleMap { title: title.trim_end().into(), values: seen(shares) }
    }

    fn values<'b, T>(
        &self,
        grid: &MapGrid,
        read: &'b (dyn Fn(usize) -> Result<Vec<T>, EnsembleError> + Sync),
    ) -> Values<'b, T> {
        Values { members: self.members.finished.len(), cells: grid.columns * grid.rows, read }
    }

    fn write_map(&self, name: &str, grid: &MapGrid, values: &[f64], maps: &mut Maps) -> Result<(), EnsembleError> {
        // Where the terrain has no data nothing is known: that it is dry neither.
        let has_data = |cell: usize| {
            let [column, row] = [cell % grid.columns, cell / grid.columns];
            self.simulation.terrain().is_none_or(|terrain| terrain.is_valid_cell(column, row))
        };
        let known = |(cell, value): (usize, &f64)| {
            if value.is_finite() && has_data(cell) { *value as f32 } else { f32::NAN }
        };
        let values: Vec<f32> = values.iter().enumerate().map(known).collect();
        let path = self.results.join(format!("{name}.tif"));
        write_geotiff(&path, grid, &values, NO_DATA).map_err(corpuscle::Error::from)?;
        maps.written += 1;
        Ok(())
    }

    fn need(&self, name: &str, known: &[String], what: &str) -> Result<(), EnsembleError> {
        if known.iter().any(|known| known == name) {
            return Ok(());
        }
        let known =
            if known.is_empty() { format!("its model has no {what}s") } else { format!("it has {}", known.join(", ")) };
        let folder = self.members.folder.path().display();
        Err(EnsembleError::Folder(format!("the ensemble in {folder} has no {what} {name}; {known}")))
    }

    /// Bands of gauges over time, and the means of the last values of all.
    fn gauges(&self) -> Result<(Vec<Chart>, Option<EnsembleTable>), EnsembleError> {
        let members = self.members;
        let known = members.gauges()?;
        if known.is_empty() {
            return Ok((Vec::new(), None));
        }
        let names = self.chosen.gauges.clone().unwrap_or_else(|| known.iter().take(GAUGES).cloned().collect());
        let times = self.members.gauges_of(self.members.longest())?.times;
        let percents = &self.chosen.percentiles;
        let head = ["gauge", "time_s", "mean", "standard_error", "members"].map(str::to_owned);
        let head = head.into_iter().chain(percents.iter().map(|percent| format!("p{percent}"))).collect();
        let mut table = EnsembleTable { title: String::new(), about: String::new(), head, rows: Vec::new() };
        let mut charts = Vec::new();
        for name in &names {
            self.need(name, &known, "gauge")?;
            let read = |position: usize| Ok(at_times(&members.gauges_of(position)?, name, &times));
            let values = Values { members: self.members.finished.len(), cells: times.len(), read: &read };
            let moments = moments(&values, Absent::LeftOut)?;
            let bands = percentiles(&values, percents, Absent::LeftOut, MEMORY)?;
            for (row, time) in times.iter().enumerate() {
                let numbers = [*time, moments.mean[row], moments.standard_error[row]].map(in_file);
                let cells = std::iter::once(name.clone()).chain(numbers).chain([moments.count[row].to_string()]);
                table.rows.push(cells.chain(bands.iter().map(|band| in_file(band[row]))).collect());
            }
            charts.push(chart(name, &times, percents, &bands, &moments.mean, self.time_unit()));
        }
        write_table(&self.results.join("gauges.csv"), &table)?;
        Ok((charts, Some(self.last_gauges(&known)?)))
    }

    /// Unit of time: empty in reduced units.
    fn time_unit(&self) -> &'static str {
        let scene = self.simulation.scene();
        let is_si = corpuscle::models::of(scene).is_ok_and(|kind| kind.has_si_units(scene));
        if is_si { "s" } else { "" }
    }

    /// Means of the last value of each gauge with their standard errors.
    fn last_gauges(&self, names: &[String]) -> Result<EnsembleTable, EnsembleError> {
        let records: Vec<&Record> = self.members.finished_records().collect();
        let last =
            |record: &Record, name: &String| record.final_gauges.as_ref().and_then(|gauges| *gauges.get(name)?);
        let read = |position: usize| -> Result<Vec<f64>, EnsembleError> {
            Ok(names.iter().map(|name| last(records[position], name).unwrap_or(f64::NAN)).collect())
        };
        let values = Values { members: records.len(), cells: names.len(), read: &read };
        let Moments { count, mean, standard_error } = moments(&values, Absent::LeftOut)?;
        let row = |number: usize, write: fn(f64) -> String| {
            vec![names[number].clone(), write(mean[number]), write(standard_error[number]), count[number].to_string()]
        };
        let table = |head: [&str; 4], write: fn(f64) -> String| EnsembleTable {
            title: "Last values of gauges".into(),
            about: String::new(),
            head: head.map(str::to_owned).to_vec(),
            rows: (0..names.len()).map(|number| row(number, write)).collect(),
        };
        write_table(
            &self.results.join("last_gauges.csv"),
            &table(["gauge", "mean", "standard_error", "members"], in_file),
        )?;
        Ok(table(["gauge", "mean", "standard error", "members"], short))
    }

    fn report(
        &self,
        folder: &Folder,
        maps: Maps,
        charts: Vec<Chart>,
        last: Option<EnsembleTable>,
    ) -> EnsembleReport<'_> {
        let (planned, finished) = (self.members.records.len(), self.members.finished.len());
        let failed = self.members.failed().count();
        let missing = planned - finished - failed;
        let not_run = if missing > 0 { format!(", {missing} not run") } else { String::new() };
        let about = format!(
            "{finished} of {planned} members are finished, {failed} failed{not_run}. Changed: {}.\n\nStatistics are over the finished members.",
            folder.plan().columns.join(", ")
        );
        let scene = self.simulation.scene();
        let ground = self.simulation.terrain().filter(|_| maps.written > 0).map(|terrain| (scene, &**terrain));
        let title = if scene.title.trim().is_empty() { folder.name().to_owned() } else { scene.title.clone() };
        let tables = self.members.failures().into_iter().chain(last).chain([self.members.table(Names::InWords)]);
        EnsembleReport {
            title,
            about,
            ground,
            probabilities: maps.probabilities,
            maps: maps.statistics,
            charts,
            tables: tables.collect(),
            scene_text: folder.scene().to_owned(),
        }
    }
}

/// What a dry cell of a map counts as.
fn absent(map: &str) -> Absent {
    if map.starts_with("arrival") {
        Absent::Never
    } else if ZERO_WHERE_DRY.iter().any(|word| map.contains(word)) {
        Absent::Zero
    } else {
        Absent::LeftOut
    }
}

/// Values as a map shows them: nothing where it is dry, never, or without a value.
fn seen(values: &[f64]) -> Vec<f32> {
    values.iter().map(|value| if value.is_finite() && *value != 0.0 { *value as f32 } else { f32::NAN }).collect()
}

/// The values of a gauge at other times, interpolated linearly; not-a-number beyond its own.
fn at_times(table: &GaugeTable, name: &str, times: &[f64]) -> Vec<f64> {
    let Some(values) = table.column(name) else { return vec![f64::NAN; times.len()] };
    if table.times == times {
        return values;
    }
    let own = &table.times;
    let at = |time: f64| match own.partition_point(|own| *own <= time) {
        0 => f64::NAN,
        after if after == own.len() => {
            if own[after - 1] == time {
                values[after - 1]
            } else {
                f64::NAN
            }
        }
        after => {
            let part = (time - own[after - 1]) / (own[after] - own[after - 1]);
            if part == 0.0 { values[after - 1] } else { values[after - 1] + part * (values[after] - values[after - 1]) }
        }
    };
    times.iter().map(|time| at(*time)).collect()
}

/// Percentiles and mean of a gauge over time.
fn chart(name: &str, times: &[f64], percents: &[f64], bands: &[Vec<f64>], mean: &[f64], time_unit: &str) -> Chart {
    let points = |values: &[f64]| times.iter().zip(values).map(|(time, value)| [*time, *value]).collect();
    let band = |(percent, values): (&f64, &Vec<f64>)| ChartSeries {
        name: format!("percentile {percent}"),
        points: points(values),
        ..ChartSeries::default()
    };
    let mean =
        ChartSeries { name: "mean".into(), style: ChartStyle::Dashes, points: points(mean), ..ChartSeries::default() };
    let x = ChartAxis { label: "Time".into(), unit: time_unit.into(), logarithmic: false };
    let series = percents.iter().zip(bands).map(band).chain([mean]).collect();
    Chart { name: name.into(), title: name.into(), x, series, ..Chart::default() }
}

/// A number in a file: empty where there is none.
fn in_file(number: f64) -> String {
    if number.is_nan() { String::new() } else { number.to_string() }
}

fn write_table(path: &Path, table: &EnsembleTable) -> Result<(), EnsembleError> {
    let write = |file: &mut dyn io::Write| -> io::Result<()> {
        let mut writer = csv::Writer::from_writer(file);
        writer.write_record(&table.head)?;
        table.rows.iter().try_for_each(|row| writer.write_record(row))?;
        writer.flush()
    };
    write_whole(path, |file| write(file)).map_err(EnsembleError::file(path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gauges_are_interpolated_within_their_own_times() {
        let table = GaugeTable {
            columns: vec!["a".into()],
            times: vec![0.0, 2.0, 4.0],
            rows: vec![vec![0.0], vec![4.0], vec![2.0]],
        };
        assert_eq!(at_times(&table, "a", &[0.0, 1.0, 2.0, 3.0, 4.0]), [0.0, 2.0, 4.0, 3.0, 2.0]);
        assert!(at_times(&table, "a", &[5.0])[0].is_nan());
        assert!(at_times(&table, "b", &[0.0])[0].is_nan());
    }

    #[test]
    fn what_is_dry_depends_on_the_map() {
        assert_eq!(
            ["max_depth", "arrival_s", "level", "duration_s"].map(absent),
            [Absent::Zero, Absent::Never, Absent::LeftOut, Absent::Zero]
        );
    }

    #[test]
    fn numbers_are_short_on_the_page() {
        assert_eq!([0.1 + 0.2, 1234567.0, f64::NAN, 1e-9].map(short), ["0.3", "1234570", "", "0.000000001"]);
    }
}
