//! A meandering valley.

use super::noise::{Noise, fade, mix};
use super::{bounds, finite, not_negative, positive};
use crate::{Terrain, TerrainError};
use corpuscle_scene::Valley;

/// The channel's banks: from this part of its half width the bed rises, at the other it meets the plain.
const BANK: [f64; 2] = [0.4, 1.1];

/// Natural levees, in half widths of the channel: their foot in the bank, their crest, their end on the plain.
const LEVEE: [f64; 3] = [0.9, 1.3, 3.0];

/// Height of the levees over the channel's depth.
const LEVEE_HEIGHT: f64 = 0.1;

/// Unevenness of the plain over the channel's depth.
const PLAIN_ROUGHNESS: f64 = 0.12;

/// Where the middle of the channel lies, m north of the south side, at `x` m east of the west side. At `x` = 0 it is
/// the middle of the width, and the channel comes in straight eastwards.
pub fn valley_centre(valley: &Valley, seed: u64, x: f64) -> f64 {
    Landscape::new(valley, seed).channel(x)
}

/// The ground of a valley.
pub(crate) fn make(valley: &Valley, seed: u64) -> Result<Terrain, TerrainError> {
    let bounds = bounds("valley", &valley.extent)?;
    finite("valley", &[("slope", valley.slope)])?;
    positive("valley", &[("channel_width_m", valley.channel_width_m), ("meander_length_m", valley.meander_length_m)])?;
    not_negative(
        "valley",
        &[
            ("channel_depth_m", valley.channel_depth_m),
            ("plain_width_m", valley.plain_width_m),
            ("meander_m", valley.meander_m),
            ("hills_m", valley.hills_m),
        ],
    )?;
    let landscape = Landscape::new(valley, seed);
    let course = Course::new(&landscape);
    Ok(Terrain::gridded(bounds, valley.extent.cell_m, |x, y| landscape.height(x, y, &course)))
}

/// A valley and its noise.
struct Landscape<'a> {
    valley: &'a Valley,
    /// Along the valley: how its axis, its meanders and its plain's width vary.
    course: Noise,
    /// Over the ground: hills and unevenness.
    ground: Noise,
}

impl<'a> Landscape<'a> {
    fn new(valley: &'a Valley, seed: u64) -> Self {
        Self { valley, course: Noise::new(seed, 0), ground: Noise::new(seed, 1) }
    }

    /// How much of its winding the valley has at `x`: none at the west side.
    fn winding(&self, x: f64) -> f64 {
        fade(x / (0.5 * self.valley.meander_length_m))
    }

    /// Smooth noise along the valley, -1 to 1 or so.
    fn along(&self, x: f64, wavelength: f64, line: f64) -> f64 {
        1.5 * self.course.at(2.0 * x / wavelength + 0.37, line + 0.41)
    }

    /// Middle of the flood plain.
    fn axis(&self, x: f64) -> f64 {
        let Valley { extent, plain_width_m, meander_length_m, .. } = self.valley;
        let room = (0.5 * (extent.width_m - plain_width_m)).max(0.0);
        0.5 * extent.width_m + 0.35 * room * self.winding(x) * self.along(x, 3.0 * meander_length_m, 0.0)
    }

    /// Middle of the channel: meanders about the axis of the plain, each of its own size and length.
    fn channel(&self, x: f64) -> f64 {
        let Valley { meander_m, meander_length_m, .. } = *self.valley;
        let swing = 0.85 + 0.15 * self.along(x, 1.7 * meander_length_m, 10.0);
        let phase = x / meander_length_m + 0.12 * self.along(x, 2.3 * meander_length_m, 20.0);
        self.axis(x) + self.winding(x) * meander_m * swing * wave(phase)
    }

    /// Height of the ground.
    fn height(&self, x: f64, y: f64, course: &Course) -> f64 {
        let Valley { extent, slope, channel_width_m, channel_depth_m, .. } = self.valley;
        let across = course.distance(x, y) / (0.5 * channel_width_m);
        let bed = 1.0 - fade((across - BANK[0]) / (BANK[1] - BANK[0]));
        let levee = fade((across - LEVEE[0]) / (LEVEE[1] - LEVEE[0]))
            * (1.0 - fade((across - LEVEE[1]) / (LEVEE[2] - LEVEE[1])));
        let unevenness = self.ground.fractal(x / 45.0, y / 45.0, 0.5, 2.0 * extent.cell_m / 45.0);
        let plain = slope * (extent.length_m - x) + channel_depth_m * PLAIN_ROUGHNESS * (1.0 - 0.7 * bed) * unevenness;
        plain + channel_depth_m * (LEVEE_HEIGHT * levee - bed) + (1.0 - bed) * self.hills(x, y)
    }

    /// Height of the hills above the plain: spurs that come down to the plain, with gullies between them.
    fn hills(&self, x: f64, y: f64) -> f64 {
        let &Valley { ref extent, plain_width_m, meander_length_m, hills_m, .. } = self.valley;
        let reach = (0.5 * (extent.width_m - plain_width_m)).max(extent.cell_m);
        let size = 0.35 * meander_length_m;
        // The sharp bottoms of gullies need more cells than smooth waves do.
        let finest = 4.0 * extent.cell_m / size;
        let noise = &self.ground;
        // Gullies run down the slope: their pattern is longer across the valley than along it, and is bent by noise.
        let bend = 0.5 * noise.fractal(x / (2.0 * size) + 7.0, y / (2.0 * size) + 3.0, 0.5, 0.25);
        let [along, across] = [x / size + bend, y / (1.8 * size) - 0.5 * bend];
        let spurs = noise.eroded(along, across, 0.45, finest);
        // The foot of the slope comes forward with the spurs and goes back with the gullies.
        let foot = 0.5 * plain_width_m + 0.12 * reach * (1.0 - 2.0 * spurs);
        let up = ((y - self.axis(x)).abs() - foot) / reach;
        if up <= 0.0 {
            return 0.0;
        }
        // Bends up from the plain within a short way, then flattens towards rounded tops.
        let rise = 1.5 * up * up / ((up + 0.08) * (1.0 + 0.5 * up));
        hills_m * rise * mix(0.45, 1.25, spurs)
    }
}

/// The channel's middle as a chain of points, to measure distances from.
struct Course {
    points: Vec<[f64; 2]>,
    step: f64,
    /// Distances beyond this do not matter.
    reach: f64,
}

impl Course {
    fn new(landscape: &Landscape) -> Self {
        let Valley { extent, channel_width_m, .. } = landscape.valley;
        let reach = 0.5 * LEVEE[2] * channel_width_m;
        // Bends are resolved by cells; the number of points is bounded for channels much narrower than a cell.
        let step = (0.25 * channel_width_m).max(0.5 * extent.cell_m);
        let count = ((extent.length_m + 2.0 * reach) / step).ceil() as usize + 2;
        let points = (0..count)
            .map(|index| {
                let x = index as f64 * step - reach;
                [x, landscape.channel(x)]
            })
            .collect();
        Self { points, step, reach }
    }

    /// Distance from the middle of the channel, at most `reach`.
    fn distance(&self, x: f64, y: f64) -> f64 {
        // Points start at -reach, so those from x - reach to x + reach begin here.
        let first = (x / self.step).floor().max(0.0) as usize;
        let count = (2.0 * self.reach / self.step).ceil() as usize + 2;
        let last = (first + count).min(self.points.len());
        self.points[first.min(last)..last]
            .windows(2)
            .map(|ends| square_distance([x, y], ends[0], ends[1]))
            .fold(self.reach * self.reach, f64::min)
            .sqrt()
    }
}

/// Square of the distance of a point from a line between two ends.
fn square_distance(point: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
    let line = [to[0] - from[0], to[1] - from[1]];
    let offset = [point[0] - from[0], point[1] - from[1]];
    let along = (offset[0] * line[0] + offset[1] * line[1]) / (line[0] * line[0] + line[1] * line[1]);
    let along = along.clamp(0.0, 1.0);
    let [dx, dy] = [offset[0] - along * line[0], offset[1] - along * line[1]];
    dx * dx + dy * dy
}

/// sin(2 pi t) to 1e-7, by its power series: the library's sine differs in its last bits between machines.
fn wave(t: f64) -> f64 {
    let t = t - (t + 0.5).floor();
    let folded = if t.abs() > 0.25 { 0.5_f64.copysign(t) - t } else { t };
    let a = std::f64::consts::TAU * folded;
    let square = a * a;
    let series = [110.0, 72.0, 42.0, 20.0, 6.0].iter().fold(1.0, |tail, divisor| 1.0 - square / divisor * tail);
    a * series
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wave_is_the_sine() {
        for step in -400..400 {
            let t = f64::from(step) / 123.0;
            assert!((wave(t) - (std::f64::consts::TAU * t).sin()).abs() < 1e-7, "{t}");
        }
    }

    #[test]
    fn the_channel_comes_in_at_the_middle_and_is_the_lowest_ground() {
        let valley = Valley::default();
        for seed in [1, 2, 3] {
            assert_eq!(valley_centre(&valley, seed, 0.0), 500.0);
            let terrain = make(&valley, seed).unwrap();
            for x in [10.0, 400.0, 900.0, 1500.0, 1990.0] {
                let middle = valley_centre(&valley, seed, x);
                let depth_below = |y: f64| terrain.height(x, y) - terrain.height(x, middle);
                let lowest = (0..200).map(|i| depth_below(5.0 * f64::from(i))).fold(f64::INFINITY, f64::min);
                assert!(lowest > -0.6, "seed {seed}, x {x}: {lowest} m below the channel");
                assert!(depth_below(5.0) > 5.0 && depth_below(995.0) > 5.0, "no hills at x {x}");
            }
        }
    }

    #[test]
    fn the_same_bits_on_every_machine() {
        let terrain = make(&Valley::default(), 1).unwrap();
        let bits = [[402.5, 507.5], [1202.5, 902.5], [1752.5, 102.5]].map(|[x, y]| terrain.height(x, y).to_bits());
        assert_eq!(bits, [4_619_191_555_452_966_674, 4_625_291_878_908_992_813, 4_629_187_781_952_673_086]);
    }

    #[test]
    fn the_channel_falls_and_is_as_deep_as_asked() {
        let valley = Valley::default();
        let terrain = make(&valley, 1).unwrap();
        let bed = |x: f64| terrain.height(x, valley_centre(&valley, 1, x));
        assert!((bed(100.0) - bed(1900.0) - 0.004 * 1800.0).abs() < 0.5);
        let plain = terrain.height(20.0, 500.0 + 0.8 * valley.channel_width_m);
        assert!((2.5..4.0).contains(&(plain - bed(20.0))), "{plain} {}", bed(20.0));
    }
}
