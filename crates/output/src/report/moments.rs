//! The moments that a report shows, from the start of a run to its end.

use corpuscle_scene::{Run, read_bytes};
use std::path::{Path, PathBuf};

/// How many there are.
const MOMENTS: usize = 6;

/// Numbers of the frames that are shown, evenly spread from the first to the last.
pub(super) fn numbers(run: &Run) -> Vec<usize> {
    let last = frame_number(run.until_s, run.frame_period_s());
    let mut numbers: Vec<usize> = (0..MOMENTS).map(|k| (k * last + (MOMENTS - 1) / 2) / (MOMENTS - 1)).collect();
    numbers.dedup();
    numbers
}

/// Number of the frame at a time: they come at multiples of the period and at the end.
pub(super) fn frame_number(time: f64, period: f64) -> usize {
    (time / period - 1e-6).ceil().max(0.0) as usize
}

/// The picture of a moment in a run's folder, with the number of the particle file.
pub(super) fn path(folder: &Path, number: usize) -> PathBuf {
    folder.join("pictures").join(format!("frame_{number:06}.svg"))
}

/// The pictures that there are; moments that were not reached, as in a run that broke down, have none.
pub(super) fn read(folder: &Path, run: &Run) -> Vec<Vec<u8>> {
    numbers(run).into_iter().filter_map(|number| read_bytes(&path(folder, number)).ok()).collect()
}
