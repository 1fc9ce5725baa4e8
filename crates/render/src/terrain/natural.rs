//! The colours of ground that no photo shows.

use super::HeightField;
use corpuscle_gpu::Image;
use rayon::prelude::*;

/// Meadow, dry grass, rock, bare height; sRGB.
const MEADOW: [f32; 3] = [94.0, 108.0, 64.0];
const GRASS: [f32; 3] = [150.0, 146.0, 92.0];
const ROCK: [f32; 3] = [128.0, 118.0, 104.0];
const HEIGHTS: [f32; 3] = [172.0, 162.0, 140.0];
/// Slopes at which rock begins to show and at which nothing else does.
const STEEP: [f32; 2] = [0.45, 1.1];

/// Ground coloured by slope and height: meadows in the low and level, dry grass above, rock where it is steep.
pub fn natural_colours(field: &HeightField) -> Image {
    let [columns, rows] = field.nodes;
    let [low, high] = field.range();
    let mut rgba = vec![0; 4 * columns * rows];
    rgba.par_chunks_exact_mut(4 * columns).enumerate().for_each(|(from_north, line)| {
        let row = rows - 1 - from_north;
        for (column, pixel) in line.chunks_exact_mut(4).enumerate() {
            let index = row * columns + column;
            let height = f64::from(field.heights[index]);
            if height.is_nan() {
                continue;
            }
            let part = ((height - low) / (high - low).max(1e-9)) as f32;
            let [east, north] = field.slope(index);
            let mottle = mottle(column, row);
            let raised = part + 0.22 * (mottle - 0.5);
            let grown = mix(mix(MEADOW, GRASS, smooth(0.1, 0.6, raised)), HEIGHTS, smooth(0.6, 1.0, raised));
            let steep = smooth(STEEP[0], STEEP[1], east.hypot(north) + 0.25 * (mottle - 0.5));
            let [red, green, blue] =
                mix(grown, ROCK, steep).map(|channel| (channel * (0.92 + 0.16 * mottle)).clamp(0.0, 255.0) as u8);
            pixel.copy_from_slice(&[red, green, blue, 255]);
        }
    });
    Image { width: columns as u32, height: rows as u32, rgba }
}

fn smooth(from: f32, to: f32, value: f32) -> f32 {
    let part = ((value - from) / (to - from)).clamp(0.0, 1.0);
    part * part * (3.0 - 2.0 * part)
}

fn mix(from: [f32; 3], to: [f32; 3], part: f32) -> [f32; 3] {
    std::array::from_fn(|k| from[k] + (to[k] - from[k]) * part)
}

/// Smooth noise from 0 to 1, bumps of 24, 9 and 3 nodes over each other.
fn mottle(column: usize, row: usize) -> f32 {
    let octave = |length: f32| bumps(column as f32 / length, row as f32 / length);
    0.5 * octave(24.0) + 0.3 * octave(9.0) + 0.2 * octave(3.0)
}

fn bumps(x: f32, y: f32) -> f32 {
    let (left, below) = (x.floor(), y.floor());
    let [across, up] = [x - left, y - below].map(|part| part * part * (3.0 - 2.0 * part));
    let at = |dx: f32, dy: f32| scattered((left + dx) as u32, (below + dy) as u32);
    let south = at(0.0, 0.0) + (at(1.0, 0.0) - at(0.0, 0.0)) * across;
    let north = at(0.0, 1.0) + (at(1.0, 1.0) - at(0.0, 1.0)) * across;
    south + (north - south) * up
}

/// A number from 0 to 1 for a position (PCG hash: Jarzynski & Olano, Journal of Computer Graphics Techniques 9, 2020, 3).
fn scattered(x: u32, y: u32) -> f32 {
    let state = x.wrapping_mul(747_796_405).wrapping_add(y.wrapping_mul(2_891_336_453)).wrapping_add(1);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    ((word >> 22) ^ word) as f32 / u32::MAX as f32
}
