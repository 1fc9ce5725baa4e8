//! A run's folder: particle files, gauges, maps, checkpoint, summary, pictures and the report.
//!
//! [`RunFolder`] is written while a run goes on. The [`Report`] of a flood is made from the folder, at the end of the run
//! or any time later; the [`GasReport`] and the [`DewReport`] from the folder and the model at its end.

mod album;
mod charts;
mod checkpoint;
mod error;
mod extent;
mod finite;
mod frames;
mod gauge_chart;
mod gauges;
mod maps;
mod number;
mod picture;
mod report;
mod run_folder;
mod stills;
mod summary;
mod wall_positions;
mod whole;

pub use album::put_into_report;
pub use checkpoint::Clock;
pub use error::OutputError;
pub use extent::{ExtentScores, compare_extent, write_extent, write_run_up};
pub use frames::{FrameFiles, FrameFormat, write_extended_xyz};
pub use gauge_chart::gauge_chart;
pub use gauges::GaugeTable;
pub use maps::{MAP_OVER_TIME, MapFiles};
pub use picture::Key as GasKey;
pub use report::{
    DewReport, EnsembleMap, EnsembleReport, EnsembleTable, GasReport, PlainReport, Report, ValidatedCase,
    ValidatedMeasure, ValidationReport, gas_key,
};
pub use run_folder::{RunFolder, followed_paths, next_run_folder};
pub use stills::{write_drawing, write_picture};
pub use summary::{LedgerEntry, Status, Summary, ledger_entries};
pub use wall_positions::WallPositions;
