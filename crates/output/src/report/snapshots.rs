//! Depth maps over time, as many as fit on a page.

use crate::OutputError;
use crate::maps::{read_map, read_times, snapshot_path};
use std::path::Path;

/// Snapshots on a page at most.
const MOST: usize = 6;

/// The depth at one time.
#[derive(Debug)]
pub(super) struct Snapshot {
    /// Time, s.
    pub time: f64,
    /// Depth of each cell of the map grid, m; not-a-number where dry.
    pub depth: Vec<f32>,
}

/// Reads depth maps, evenly spread from the first after the start to the last.
pub(super) fn read(maps: &Path, cells: usize) -> Result<Vec<Snapshot>, OutputError> {
    let times = read_times(maps)?;
    let read = |index: usize| Ok(Snapshot { time: times[index], depth: read_map(&snapshot_path(maps, index), cells)? });
    chosen(times.len()).into_iter().map(read).collect()
}

/// Which of `count` maps are shown: the start only where there is hardly more.
fn chosen(count: usize) -> Vec<usize> {
    if count <= MOST {
        return (0..count).collect();
    }
    (1..=MOST).map(|number| (number * (count - 1) + MOST / 2) / MOST).collect()
}

#[cfg(test)]
mod tests {
    use super::chosen;

    #[test]
    fn snapshots_are_spread_evenly_and_end_with_the_last() {
        assert_eq!(chosen(0), Vec::<usize>::new());
        assert_eq!(chosen(1), [0]);
        assert_eq!(chosen(6), [0, 1, 2, 3, 4, 5]);
        assert_eq!(chosen(7), [1, 2, 3, 4, 5, 6]);
        assert_eq!(chosen(21), [3, 7, 10, 13, 17, 20]);
    }
}
