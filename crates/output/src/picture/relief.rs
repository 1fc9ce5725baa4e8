//! Shaded relief with contour lines.

use super::ground::Ground;
use super::ticks;
use rayon::prelude::*;

/// Directions of light, degrees clockwise from north, and their shares: more than one, so that ridges along the main
/// light keep their form (after the multidirectional shading of Mark, 1992).
const LIGHTS: [(f64, f64); 3] = [(315.0, 0.6), (270.0, 0.2), (0.0, 0.2)];
/// Height of the light above the horizon, degrees.
const ALTITUDE: f64 = 45.0;
/// Slope up to which steep ground is drawn; flatter ground is exaggerated towards it.
const STEEP: f64 = 0.7;
/// Exaggeration at most.
const MOST_EXAGGERATION: f64 = 12.0;
/// Tints of low, middle and high ground.
const TINTS: [[f64; 3]; 3] = [[208.0, 216.0, 203.0], [227.0, 223.0, 210.0], [243.0, 241.0, 237.0]];
/// Colour where there is no data.
const NO_DATA: [u8; 3] = [233, 236, 239];
/// Colour of contour lines.
const CONTOUR: [f64; 3] = [122.0, 88.0, 52.0];
/// Contour lines on a map at most.
const MOST_CONTOURS: usize = 14;

/// Brightness, 0 to 1, of ground that rises by `slope` `[eastwards, northwards]`, lit from `azimuth` (degrees clockwise
/// from north) at `altitude` (degrees above the horizon): the cosine of the angle between light and normal.
fn hillshade([east, north]: [f64; 2], azimuth: f64, altitude: f64) -> f64 {
    let (azimuth, altitude) = (azimuth.to_radians(), altitude.to_radians());
    let light = [altitude.cos() * azimuth.sin(), altitude.cos() * azimuth.cos(), altitude.sin()];
    let dot = light[2] - east * light[0] - north * light[1];
    (dot / (1.0 + east * east + north * north).sqrt()).max(0.0)
}

/// Height between contour lines, m, that suits the ground.
pub(crate) fn contour_interval(ground: &Ground) -> Option<f64> {
    let [low, high] = ground.height_range();
    (high - low > 1e-6).then(|| ticks::step(high - low, MOST_CONTOURS))
}

/// The ground as red, green and blue bytes: tinted by height, shaded, with contour lines (every fifth stronger).
pub(crate) fn relief(ground: &Ground) -> Vec<u8> {
    let smooth = smoothed(&smoothed(&ground.heights, ground.pixels), ground.pixels);
    let exaggeration = exaggeration(ground);
    let [low, high] = ground.height_range();
    let interval = contour_interval(ground);
    let pixel = |index: usize| {
        let height = ground.heights[index];
        if height.is_nan() {
            return NO_DATA;
        }
        let slope = slope(ground, &ground.heights, index).map(|value| value * exaggeration);
        let flat = ALTITUDE.to_radians().sin();
        let shade: f64 = LIGHTS.iter().map(|(azimuth, share)| share * hillshade(slope, *azimuth, ALTITUDE)).sum();
        let light = (0.4 + 0.6 * shade / flat).min(1.05);
        let tint = tint((f64::from(height) - low) / (high - low).max(1e-9));
        let line = interval.map_or(0.0, |interval| contour_strength(ground, &smooth, index, interval));
        [0, 1, 2].map(|channel| {
            let shaded = (tint[channel] * light).min(255.0);
            (shaded + (CONTOUR[channel] - shaded) * line).round() as u8
        })
    };
    (0..ground.heights.len()).into_par_iter().map(pixel).collect::<Vec<[u8; 3]>>().into_flattened()
}

/// How strongly a contour line covers a pixel: by the distance to it in pixels.
fn contour_strength(ground: &Ground, heights: &[f32], index: usize, interval: f64) -> f64 {
    let height = f64::from(heights[index]);
    let [east, north] = slope(ground, heights, index);
    let rise_across_pixel = east.hypot(north) * ground.extent[0] / ground.pixels[0] as f64;
    let nearest = (height / interval).round();
    // On nearly level ground a line would become a blot.
    if rise_across_pixel < interval * 0.004 || !height.is_finite() {
        return 0.0;
    }
    let distance = (height - nearest * interval).abs() / rise_across_pixel;
    let strength = if nearest % 5.0 == 0.0 { 0.6 } else { 0.3 };
    strength * (1.2 - distance).clamp(0.0, 1.0)
}

/// Rise `[eastwards, northwards]`, m per m, by central differences.
fn slope(ground: &Ground, heights: &[f32], index: usize) -> [f64; 2] {
    let [width, height] = ground.pixels;
    let (x, y) = (index % width, index / width);
    let here = f64::from(heights[index]);
    let difference = |before: usize, after: usize, pixel: f64| {
        let steps = if before == index || after == index { 1.0 } else { 2.0 };
        let [before, after] = [before, after].map(|index| f64::from(heights[index]));
        let value = (after - before) / (steps * pixel);
        // Beside no-data the ground is drawn level.
        if value.is_finite() && here.is_finite() { value } else { 0.0 }
    };
    let west = if x > 0 { index - 1 } else { index };
    let east = if x + 1 < width { index + 1 } else { index };
    let north = if y > 0 { index - width } else { index };
    let south = if y + 1 < height { index + width } else { index };
    [
        difference(west, east, ground.extent[0] / width as f64),
        difference(south, north, ground.extent[1] / height as f64),
    ]
}

/// What slopes are multiplied with so that the steeper parts of this ground look steep.
fn exaggeration(ground: &Ground) -> f64 {
    let every = (ground.heights.len() / 20_000).max(1);
    let steepness = |index| {
        let [east, north] = slope(ground, &ground.heights, index);
        east.hypot(north)
    };
    let mut slopes: Vec<f64> = (0..ground.heights.len()).step_by(every).map(steepness).collect();
    slopes.sort_by(f64::total_cmp);
    let steep = slopes.get(slopes.len() * 9 / 10).copied().unwrap_or(0.0);
    (STEEP / steep.max(1e-9)).clamp(0.5, MOST_EXAGGERATION)
}

fn tint(part: f64) -> [f64; 3] {
    let position = part.clamp(0.0, 1.0) * 2.0;
    let from = (position as usize).min(1);
    let mix = position - from as f64;
    [0, 1, 2].map(|channel| TINTS[from][channel] + mix * (TINTS[from + 1][channel] - TINTS[from][channel]))
}

/// Means over 3 x 3 pixels, so that contour lines do not follow every ripple.
fn smoothed(heights: &[f32], [width, height]: [usize; 2]) -> Vec<f32> {
    let mean = |index: usize| {
        let (x, y) = (index % width, index / width);
        let (mut sum, mut count) = (0.0, 0.0);
        for row in y.saturating_sub(1)..=(y + 1).min(height - 1) {
            for column in x.saturating_sub(1)..=(x + 1).min(width - 1) {
                let value = heights[row * width + column];
                if !value.is_nan() {
                    sum += value;
                    count += 1.0;
                }
            }
        }
        sum / count
    };
    (0..heights.len()).into_par_iter().map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shading_of_known_slope_and_aspect() {
        let sine = |degrees: f64| degrees.to_radians().sin();
        // Level ground: the sine of the light's altitude, whatever its azimuth.
        assert!((hillshade([0.0, 0.0], 123.0, 45.0) - sine(45.0)).abs() < 1e-12);
        // A slope of 45 degrees falling towards the light faces it; falling away it gets none.
        let falls_north_west = [0.5f64.sqrt(), -(0.5f64.sqrt())];
        assert!((hillshade(falls_north_west, 315.0, 45.0) - 1.0).abs() < 1e-12);
        assert!(hillshade(falls_north_west.map(|value| -value), 315.0, 45.0) < 1e-12);
        // cos(zenith) cos(slope) + sin(zenith) sin(slope) cos(azimuth - aspect): slope 30 falling east, light from south.
        let rise = [-(30f64.to_radians().tan()), 0.0];
        assert!((hillshade(rise, 180.0, 60.0) - sine(60.0) * 30f64.to_radians().cos()).abs() < 1e-12);
    }

    #[test]
    fn tints_run_from_low_to_high() {
        assert_eq!((tint(0.0), tint(0.5), tint(1.0)), (TINTS[0], TINTS[1], TINTS[2]));
    }
}
