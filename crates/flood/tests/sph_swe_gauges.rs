//! Gauges of scheme sph-swe that the GPU reads itself show what they show where the water is brought back for them.

mod common;

use common::on_gpu::on_gpu;
use corpuscle_flood::SphSweFlood;
use corpuscle_gpu::{Gpu, require_gpu};
use corpuscle_model::{AdvanceObserver, Model, ModelProgress};
use std::sync::atomic::AtomicBool;

/// Fast water between walls, over an open side and round two houses; a gauge in one of them, one that falls dry and one that is wetted.
const HOUSES: &str = r#"
run.until_s = 60
terrain.plane = { extent = { length_m = 80, width_m = 30, cell_m = 2 }, slope_east = -0.02 }
[flood]
scheme = "sph-swe"
spacing_m = 1
spacing_depth_m = 2
map_every_s = 60
edges = { west = "wall", east = "open", south = "wall", north = "wall" }
[[flood.water]]
depth_m = 2
polygon = [[0, 0], [30, 0], [30, 30], [0, 30]]
velocity_m_per_s = [3, 0]
[[flood.water]]
depth_m = 1
polygon = [[70, 0], [80, 0], [80, 30], [70, 30]]
[[flood.obstacle]]
name = "house"
polygon = [[36, 8], [42, 10], [40, 18], [34, 16]]
[[flood.obstacle]]
name = "tower"
circle = { centre = [38, 23], radius_m = 2 }
[[flood.gauge]]
name = "behind the wall"
at = [0.6, 20]
[[flood.gauge]]
name = "in the house"
at = [38, 13]
[[flood.gauge]]
name = "before the house"
at = [33.6, 12]
[[flood.gauge]]
name = "beyond"
at = [60, 15]
[[flood.section]]
name = "across"
line = [[28, 1], [30, 29]]
"#;

/// Water between walls and sides that are joined, into which a spring brings more.
const SPRING: &str = r#"
run.until_s = 60
terrain.plane = { extent = { length_m = 60, width_m = 30, cell_m = 1 }, slope_east = -0.03, slope_north = 0.02 }
[flood]
scheme = "sph-swe"
spacing_m = 1.5
spacing_depth_m = 1
map_every_s = 60
manning = 0.03
edges = { west = "wall", east = "wall", south = "periodic", north = "periodic" }
gauge = [{ name = "at the seam", at = [12, 0.3] }]
[[flood.water]]
depth_m = 1.6
polygon = [[0, 0], [25, 0], [25, 30], [0, 30]]
[[flood.inflow]]
name = "spring"
at = [40, 20]
discharge_m3_per_s = 19.3
"#;

/// A block that falls.
const FALL: &str = r#"
run.until_s = 60
terrain.plane = { extent = { length_m = 40, width_m = 30, cell_m = 1 }, slope_east = -0.03 }
[flood]
scheme = "sph-swe"
spacing_m = 1
spacing_depth_m = 1
map_every_s = 60
edges = { west = "wall", east = "wall", south = "wall", north = "wall" }
gauge = [{ name = "under it", at = [16, 15] }]
[[flood.water]]
depth_m = 0.6
polygon = [[0, 0], [20, 0], [20, 30], [0, 30]]
velocity_m_per_s = [1, 0]
[[flood.water]]
block = { from = [10, 8], to = [30, 22], height_m = 0.7, layers = 2 }
velocity_m_per_s = [1, -0.5]
"#;

fn flood(text: &str, gpu: &Gpu) -> SphSweFlood {
    on_gpu(common::sph_swe(&common::scene(text)), gpu)
}

/// Takes rows at multiples of a period, and calls the water back after each of some.
struct Notes {
    period: f64,
    call_back_after: usize,
    rows: Vec<(f64, Vec<f64>)>,
    /// Rows recorded at each report of progress.
    rows_at_progress: Vec<usize>,
}

impl Notes {
    fn new(period: f64, call_back_after: usize) -> Self {
        Self { period, call_back_after, rows: Vec::new(), rows_at_progress: Vec::new() }
    }
}

impl AdvanceObserver for Notes {
    fn gauges_after(&self, time: f64) -> Option<f64> {
        let mut count = (time / self.period).floor();
        while count * self.period <= time {
            count += 1.0;
        }
        Some(count * self.period)
    }

    fn gauges(&mut self, time: f64, row: &[f64]) {
        self.rows.push((time, row.to_vec()));
    }

    fn progressed(&mut self, progress: ModelProgress) -> bool {
        assert!(progress.particles > 0 && progress.particle_steps > 0 && progress.time > 0.0);
        let before = self.rows_at_progress.last().map_or(0, |rows| rows / self.call_back_after);
        self.rows_at_progress.push(self.rows.len());
        self.rows.len() / self.call_back_after == before
    }
}

/// Goes on to a time however often it is called back.
fn go_on(flood: &mut SphSweFlood, time: f64, notes: &mut Notes) {
    let mut parts = 0;
    while flood.time() < time {
        flood.advance_with(time, &AtomicBool::new(false), notes).unwrap();
        parts += 1;
    }
    assert!(parts > 0 && (notes.call_back_after == usize::MAX) == (parts == 1), "{parts} parts");
}

/// Rows as they are where the water is brought back for each.
fn brought_back(flood: &mut SphSweFlood, times: impl Iterator<Item = f64>) -> Vec<Vec<f64>> {
    times
        .map(|time| {
            flood.advance_to(time, &AtomicBool::new(false)).unwrap();
            flood.gauge_row()
        })
        .collect()
}

/// Compares them, times that are no multiples of steps among them, some of which lie within one step.
fn compare(text: &str, gpu: &Gpu, period: f64, until: f64) {
    let [mut measured, mut plain] = [(); 2].map(|()| flood(text, gpu));
    for flood in [&mut measured, &mut plain] {
        flood.place_gauge("by hand", [21.0, 14.0]).unwrap();
    }
    let mut notes = Notes::new(period, usize::MAX);
    go_on(&mut measured, until, &mut notes);
    let expected = brought_back(&mut plain, notes.rows.iter().map(|(time, _)| *time));
    plain.advance_to(until, &AtomicBool::new(false)).unwrap();
    assert_eq!(measured.steps(), plain.steps());
    let other = measured.particles().iter().zip(plain.particles()).find(|(one, other)| one != other);
    assert!(other.is_none(), "{other:?} after {} steps", plain.steps());
    let count = (until / period * (1.0 + 1e-12)).floor() as usize;
    assert_eq!(notes.rows.len(), count);
    // Most are taken while the host knows of nothing.
    assert!(
        2 * notes.rows_at_progress.len() < notes.rows.len(),
        "{} rows, {:?}",
        notes.rows.len(),
        notes.rows_at_progress
    );
    for (at, column) in measured.gauge_columns().iter().enumerate() {
        let largest = expected.iter().map(|row| row[at].abs()).fold(1.0, f64::max);
        let off = notes.rows.iter().zip(&expected).map(|((time, row), other)| ((row[at] - other[at]).abs(), *time));
        let (most, time) = off.max_by(|one, other| one.0.total_cmp(&other.0)).unwrap();
        assert!(most < 2e-5 * largest, "{}.{}: off by {most} at {time} s, of {largest}", column.gauge, column.quantity);
    }
}

#[test]
fn rows_read_on_the_gpu_are_those_of_the_water_that_comes_back() {
    let Some(gpu) = require_gpu("gauges on the GPU") else { return };
    compare(HOUSES, &gpu, 0.0137, 1.2);
    compare(SPRING, &gpu, 0.03, 1.5);
    compare(FALL, &gpu, 0.0137, 0.6);
}

#[test]
fn who_is_called_back_goes_on_with_the_next_row() {
    let Some(gpu) = require_gpu("gauges on the GPU") else { return };
    let [mut plain, mut interrupted] = [(); 2].map(|()| flood(HOUSES, &gpu));
    let [mut all, mut parts] = [usize::MAX, 20].map(|rows| Notes::new(0.0137, rows));
    go_on(&mut plain, 0.8, &mut all);
    go_on(&mut interrupted, 0.8, &mut parts);
    assert!(plain.particles() == interrupted.particles());
    assert_eq!(all.rows.len(), parts.rows.len());
    for ((time, row), (same_time, same_row)) in all.rows.iter().zip(&parts.rows) {
        assert_eq!(time, same_time);
        let near = row.iter().zip(same_row).all(|(one, other)| (one - other).abs() <= 1e-5 * one.abs().max(1.0));
        assert!(near, "{time} s: {row:?} and {same_row:?}");
    }
}
