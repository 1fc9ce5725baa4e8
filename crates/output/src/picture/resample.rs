//! From a map's cells to a picture's pixels.

use rayon::prelude::*;

/// Cells and weights that make one pixel, along one axis.
type Taps = Vec<(usize, f32)>;

/// A field at the pixels of a picture: linear between cells where pixels are smaller than these, a weighted mean where
/// they are larger. Cells that are not a number take no part; a pixel stays without value where they prevail.
pub(crate) fn resample(values: &[f32], [columns, rows]: [usize; 2], [width, height]: [usize; 2]) -> Vec<f32> {
    let across = taps(columns, width);
    let down = taps(rows, height);
    // In a reduced picture a stream narrower than a pixel should still be seen.
    let least = if columns > width || rows > height { 0.15 } else { 0.5 };
    let pixel = |vertical: &Taps, horizontal: &Taps| {
        let (mut sum, mut weight) = (0.0, 0.0);
        for (row, share_down) in vertical {
            for (column, share_across) in horizontal {
                let value = values[row * columns + column];
                if !value.is_nan() {
                    sum += share_down * share_across * value;
                    weight += share_down * share_across;
                }
            }
        }
        if weight >= least { sum / weight } else { f32::NAN }
    };
    let line = |vertical| across.iter().map(move |horizontal| pixel(vertical, horizontal));
    down.par_iter().flat_map_iter(line).collect()
}

/// For each pixel the cells under a triangle as wide as two cells or two pixels, whichever is more; weights add to 1.
fn taps(cells: usize, pixels: usize) -> Vec<Taps> {
    let scale = cells as f32 / pixels as f32;
    let reach = scale.max(1.0);
    let tap = |pixel: usize| {
        let centre = (pixel as f32 + 0.5) * scale - 0.5;
        let first = (centre - reach).ceil().max(0.0) as usize;
        let last = ((centre + reach).floor() as usize).min(cells - 1);
        let share = |cell: usize| 1.0 - (cell as f32 - centre).abs() / reach;
        let taps: Taps = (first..=last).map(|cell| (cell, share(cell))).filter(|tap| tap.1 > 0.0).collect();
        let sum: f32 = taps.iter().map(|tap| tap.1).sum();
        taps.into_iter().map(|(cell, share)| (cell, share / sum)).collect()
    };
    (0..pixels).map(tap).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_stays_and_wet_area_is_kept() {
        let half: Vec<f32> = (0..200).map(|cell| if cell % 20 < 10 { 3.0 } else { f32::NAN }).collect();
        for size in [[100, 50], [7, 5], [20, 10]] {
            let pixels = resample(&half, [20, 10], size);
            assert_eq!(pixels.len(), size[0] * size[1]);
            let wet = pixels.iter().filter(|value| !value.is_nan());
            assert!(wet.clone().all(|value| (value - 3.0).abs() < 1e-5));
            let part = wet.count() as f32 / pixels.len() as f32;
            assert!((part - 0.5).abs() < 0.15, "{size:?}: {part}");
        }
    }

    #[test]
    fn enlarging_is_linear_between_cells() {
        let pixels = resample(&[0.0, 4.0], [2, 1], [8, 1]);
        let expected = [0.0, 0.0, 0.5, 1.5, 2.5, 3.5, 4.0, 4.0];
        pixels.iter().zip(expected).for_each(|(pixel, value)| assert!((pixel - value).abs() < 1e-5, "{pixels:?}"));
    }

    #[test]
    fn a_stream_of_one_cell_survives_reduction() {
        let stream: Vec<f32> = (0..90 * 90).map(|cell| if cell / 90 == 44 { 1.0 } else { f32::NAN }).collect();
        let pixels = resample(&stream, [90, 90], [30, 30]);
        assert!(pixels.iter().filter(|value| !value.is_nan()).count() >= 30);
    }
}
