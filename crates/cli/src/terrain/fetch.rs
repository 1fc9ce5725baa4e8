//! `corpuscle terrain fetch`, and terrain that a scene fetches.

use super::{check_is_new, write};
use crate::args::FetchOptions;
use crate::interrupt::stop_on_interrupt;
use crate::output::{number, print_json};
use corpuscle::fetch::{self, ATTRIBUTION, FetchObserver, Progress, Source};
use corpuscle::scene::{Scene, Terrain};
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Fetches a box into a file.
pub fn fetch(options: &FetchOptions, as_json: bool) -> anyhow::Result<()> {
    check_is_new(&options.output)?;
    let mut source = Source::from_environment().map_err(corpuscle::Error::from)?;
    if let Some(base) = &options.from {
        source = Source::new(base, source.cache);
    }
    let (bar, watch) = shown(&stop_on_interrupt()?)?;
    let fetched = fetch::fetch(&source, &options.bbox, &watch);
    bar.finish_and_clear();
    let fetched = fetched.map_err(corpuscle::Error::from)?;
    tell!("{} MB downloaded", megabytes(fetched.bytes));
    write(&options.output, &fetched.raster)?;
    if as_json {
        print_json(&json!({
            "file": options.output,
            "columns": fetched.raster.columns,
            "rows": fetched.raster.rows,
            "tiles": fetched.tiles,
            "sea_tiles": fetched.sea,
            "bytes_fetched": fetched.bytes,
            "attribution": ATTRIBUTION,
            "warnings": fetched.raster.warnings,
        }))?;
    }
    Ok(())
}

/// Downloads the terrain of a scene with `[terrain.fetch]`, unless it is in the cache already.
pub fn fetch_for(scene: &Scene, stop: &Arc<AtomicBool>) -> anyhow::Result<()> {
    let Some(Terrain::Fetch(_)) = scene.flood().map(|scene| &scene.terrain) else { return Ok(()) };
    let (bar, watch) = shown(stop)?;
    let came = corpuscle::fetch_terrain(scene, &watch);
    bar.finish_and_clear();
    if came? > 0 {
        tell!("the terrain was downloaded into the cache");
    }
    Ok(())
}

/// The progress bar of a download on standard error; hidden where that is not a terminal.
fn shown(stop: &Arc<AtomicBool>) -> anyhow::Result<(ProgressBar, FetchObserver)> {
    let bar = ProgressBar::new(1);
    bar.set_style(ProgressStyle::with_template("downloading terrain {bar:30} tile {pos} of {len}, {msg}")?);
    let shown = bar.clone();
    let show = move |progress: Progress| {
        shown.set_length(progress.of_tiles as u64);
        shown.set_position(progress.tiles as u64);
        shown.set_message(format!("{} MB", megabytes(progress.bytes)));
    };
    Ok((bar, FetchObserver { stop: stop.clone(), show: Arc::new(show) }))
}

fn megabytes(bytes: u64) -> String {
    number((bytes as f64 / 1e4).round() / 1e2)
}
