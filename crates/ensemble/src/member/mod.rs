//! One member of an ensemble: its run, and its files.

mod maps;

pub(crate) use maps::{axes, read_map};

use crate::record::{Axis, Described};
use crate::{EnsembleError, Failure, Folder, Record, Source};
use corpuscle::model::Map;
use corpuscle::output::{GaugeTable, Status, Summary};
use corpuscle::terrain::MapGrid;
use corpuscle::{Error, Progress, Simulation, Sink};
use corpuscle_atomic_file::{clear_unfinished, write_whole};
use rayon::ThreadPoolBuilder;
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

const GAUGES: &str = "gauges.csv";

/// What the run of a member gave.
struct Computed {
    summary: Summary,
    gauges: GaugeTable,
    maps: Vec<Map>,
    grid: Option<MapGrid>,
}

/// Takes the rows of gauges.
#[derive(Default)]
struct Rows(GaugeTable);

impl Sink for Rows {
    fn gauges(&mut self, time: f64, row: &[f64]) -> Result<(), Error> {
        self.0.times.push(time);
        self.0.rows.push(row.to_vec());
        Ok(())
    }
}

/// Runs a member on so many threads and writes its files; a run that fails is recorded as failed. None where it was stopped: nothing is recorded then.
pub(crate) fn compute(
    folder: &Folder,
    source: &Source,
    number: usize,
    threads: usize,
    stop: &AtomicBool,
    on_progress: &mut (dyn FnMut(&Progress) + Send),
) -> Result<Option<Record>, EnsembleError> {
    let member_folder = folder.member(number);
    fs::create_dir_all(&member_folder).map_err(EnsembleError::file(&member_folder))?;
    clear_unfinished(&member_folder).map_err(EnsembleError::file(&member_folder))?;
    let attempts = folder.record(number)?.map_or(0, |record| record.attempts) + 1;
    let start = Instant::now();
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| EnsembleError::file(&member_folder)(io::Error::other(error)))?;
    let changes = folder.plan().assignments(number);
    let simulated = catch_unwind(AssertUnwindSafe(|| pool.install(|| simulate(source, &changes, stop, on_progress))));
    let mut record = Record::new(number, folder.plan().changes(number), attempts);
    match simulated {
        Ok(Ok(None)) => return Ok(None),
        Ok(Ok(Some(computed))) => {
            write_files(&member_folder, &computed)?;
            describe(&mut record, computed);
        }
        Ok(Err(error)) => record.fail(Failure::of(&error)),
        Err(panic) => record.fail(Failure::of_panic(&*panic)),
    }
    record.wall_time_s = Some(start.elapsed().as_secs_f64());
    record.write(&member_folder)?;
    Ok(Some(record))
}

fn simulate(
    source: &Source,
    changes: &[(String, String)],
    stop: &AtomicBool,
    on_progress: &mut (dyn FnMut(&Progress) + Send),
) -> Result<Option<Computed>, Error> {
    let mut simulation: Simulation = source.open(changes)?;
    let mut rows = Rows::default();
    let summary = simulation.run(&mut [&mut rows], stop, on_progress)?;
    if summary.status == Status::Stopped {
        return Ok(None);
    }
    let model = simulation.model();
    let columns = model.gauge_columns().iter().map(|column| column.header()).collect();
    let gauges = GaugeTable { columns, ..rows.0 };
    let grid = simulation.terrain().map(|terrain| terrain.map_grid().clone());
    Ok(Some(Computed { summary, gauges, maps: model.maps(), grid }))
}

fn write_files(member_folder: &Path, computed: &Computed) -> Result<(), EnsembleError> {
    if let Some(grid) = computed.grid.as_ref().filter(|_| !computed.maps.is_empty()) {
        maps::write(member_folder, &computed.maps, grid)?;
    }
    let path = member_folder.join(GAUGES);
    write_whole(&path, |file| write_gauges(file, &computed.gauges)).map_err(EnsembleError::file(&path))
}

fn write_gauges(file: &mut dyn io::Write, table: &GaugeTable) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(file);
    writer.write_record(std::iter::once("time_s").chain(table.columns.iter().map(String::as_str)))?;
    for (time, row) in table.times.iter().zip(&table.rows) {
        writer.write_record(std::iter::once(time).chain(row).map(f64::to_string))?;
    }
    writer.flush()
}

/// Puts into a record what the results of its run are.
fn describe(record: &mut Record, computed: Computed) {
    let Computed { summary, gauges, maps, grid } = computed;
    record.summary = Some(summary);
    record.last_time_s = gauges.times.last().copied();
    let last = gauges.rows.last().cloned().unwrap_or_default();
    record.final_gauges = Some(gauges.columns.into_iter().zip(last.into_iter().map(finite)).collect());
    let described = |map: &Map| {
        let units = if map.unit.is_empty() { "1" } else { map.unit };
        (map.name.to_owned(), Described { long_name: map.title.into(), units: units.into() })
    };
    record.maps = Some(maps.iter().map(described).collect());
    record.coordinates = Some(grid.as_ref().map_or_else(BTreeMap::new, Axis::both));
    record.crs = grid.and_then(|grid| grid.georeference.system).map(|system| system.name);
}

/// A number as JSON has it: null where it is not finite.
fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// The gauges of a member over time. An empty cell is a time at which a gauge has no value.
pub(crate) fn read_gauges(folder: &Path) -> Result<GaugeTable, EnsembleError> {
    let path = folder.join(GAUGES);
    let read = || -> Result<GaugeTable, Box<dyn std::error::Error>> {
        let mut reader = csv::Reader::from_path(&path)?;
        let columns = reader.headers()?.iter().skip(1).map(str::to_owned).collect();
        let mut table = GaugeTable { columns, ..GaugeTable::default() };
        for record in reader.records() {
            let number = |cell: &str| if cell.is_empty() { Ok(f64::NAN) } else { cell.parse() };
            let mut row = record?.iter().map(number).collect::<Result<Vec<f64>, _>>()?;
            table.times.push(row.remove(0));
            table.rows.push(row);
        }
        Ok(table)
    };
    read().map_err(|error| EnsembleError::damaged(&path, error))
}
