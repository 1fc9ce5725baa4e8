//! Parts of the box in which the momentum that balls exchange is counted.

use super::World;
use serde::{Deserialize, Serialize};

/// A part of the box with sides along the axes, which stays where it is.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CountedRegion<const D: usize> {
    pub from: [f64; D],
    pub to: [f64; D],
    /// The part of the virial that belongs to it: of each collision as much as of the line between the centres lies in it (Lutsko, J. Appl.
    /// Phys. 64, 1988, 1152; Cormier, Rickman & Delph, J. Appl. Phys. 89, 2001, 99), and of a hit as much as of the line from the wall to
    /// the centre.
    pub virial: f64,
}

/// What a region holds at one time, and has counted so far.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct RegionSample {
    pub number: f64,
    pub mass: f64,
    pub kinetic: f64,
    /// Sums over the balls of momentum and of velocity, along each axis.
    pub momentum: [f64; 3],
    pub velocity: [f64; 3],
    /// Area (in three dimensions volume) in the box.
    pub volume: f64,
    /// The virial since the start.
    pub virial: f64,
}

impl<const D: usize> CountedRegion<D> {
    /// True where the centre of a ball is in it. A position on a border between two regions is in one of them.
    fn holds(&self, position: &[f64; D], period: &[f64; D]) -> bool {
        (0..D).all(|axis| {
            let wrapped = if period[axis] > 0.0 { position[axis].rem_euclid(period[axis]) } else { position[axis] };
            self.from[axis] <= wrapped && wrapped < self.to[axis]
        })
    }

    /// Area (in three dimensions volume) of the part that lies in a box.
    pub fn volume(&self, extent: &[[f64; 2]; D]) -> f64 {
        let along = |axis: usize| self.to[axis].min(extent[axis][1]) - self.from[axis].max(extent[axis][0]);
        (0..D).map(|axis| along(axis).max(0.0)).product()
    }

    /// The part, 0 to 1, of a line that lies in it or, in a box that repeats, in one of its images.
    fn part_of(&self, start: &[f64; D], line: &[f64; D], period: &[f64; D]) -> f64 {
        self.part_along(0, [0.0, 1.0], start, line, period)
    }

    /// The part of a piece of a line that lies between the borders along this axis and those after it.
    fn part_along(&self, axis: usize, piece: [f64; 2], start: &[f64; D], line: &[f64; D], period: &[f64; D]) -> f64 {
        if axis == D {
            return piece[1] - piece[0];
        }
        let images = if period[axis] > 0.0 { -1..=1 } else { 0..=0 };
        images
            .map(|image| {
                let shift = f64::from(image) * period[axis] - start[axis];
                let [from, to] = [self.from[axis] + shift, self.to[axis] + shift];
                let [low, high] = if line[axis] == 0.0 {
                    // Along the borders: all of it or nothing.
                    if from <= 0.0 && 0.0 < to { piece } else { [0.0, 0.0] }
                } else {
                    let [a, b] = [from, to].map(|border| border / line[axis]);
                    [a.min(b).max(piece[0]), a.max(b).min(piece[1])]
                };
                if high > low { self.part_along(axis + 1, [low, high], start, line, period) } else { 0.0 }
            })
            .sum()
    }
}

impl<const D: usize> World<D> {
    /// Counts the virial of a collision, or of a hit, in the regions through which the line between the two goes.
    #[cold]
    pub(super) fn count_in_regions(&mut self, start: [f64; D], line: [f64; D], virial: f64) {
        for region in &mut self.regions {
            region.virial += virial * region.part_of(&start, &line, &self.field.period);
        }
    }

    /// The regions at a time of the window.
    pub fn sample_regions(&self, time: f64) -> Vec<RegionSample> {
        let extent: [[f64; 2]; D] = std::array::from_fn(|axis| self.extent(axis, time));
        let empty = |region: &CountedRegion<D>| RegionSample {
            volume: region.volume(&extent),
            virial: region.virial,
            ..RegionSample::default()
        };
        let mut samples: Vec<RegionSample> = self.regions.iter().map(empty).collect();
        if samples.is_empty() {
            return samples;
        }
        for ball in 0..self.balls.len() {
            let (position, velocity) = self.state(ball, time);
            let mass = self.mass(ball);
            let inside = |region: &CountedRegion<D>| region.holds(&position, &self.field.period);
            for (_, sample) in self.regions.iter().zip(&mut samples).filter(|(region, _)| inside(region)) {
                sample.number += 1.0;
                sample.mass += mass;
                for axis in 0..D {
                    sample.kinetic += 0.5 * mass * velocity[axis] * velocity[axis];
                    sample.momentum[axis] += mass * velocity[axis];
                    sample.velocity[axis] += velocity[axis];
                }
            }
        }
        samples
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn region(from: [f64; 2], to: [f64; 2]) -> CountedRegion<2> {
        CountedRegion { from, to, virial: 0.0 }
    }

    #[test]
    fn the_part_of_a_line_in_a_region() {
        let region = region([2.0, 0.0], [4.0, 10.0]);
        let part = |start, line, period| region.part_of(&start, &line, &period);
        assert_eq!(part([1.0, 5.0], [4.0, 0.0], [0.0; 2]), 0.5);
        assert_eq!(part([3.0, 5.0], [0.0, 1.0], [0.0; 2]), 1.0);
        assert_eq!(part([5.0, 5.0], [0.0, 1.0], [0.0; 2]), 0.0);
        assert_eq!(part([9.0, 9.5], [4.0, 1.0], [10.0, 10.0]), 0.25);
        assert_eq!(part([3.0, 9.5], [0.5, 1.0], [10.0, 10.0]), 1.0);
    }

    proptest! {
        /// Regions that share out the box share out every line, across its edges too.
        #[test]
        fn regions_that_fill_the_box_share_out_every_line(
            start in [0.0..10.0, 0.0..8.0], line in [-3.0..3.0, -3.0..3.0], cut in [0.5..9.5, 0.5..7.5],
        ) {
            let [x, y] = cut;
            let four = [
                region([0.0, 0.0], [x, y]), region([x, 0.0], [10.0, y]), region([0.0, y], [x, 8.0]), region([x, y], [10.0, 8.0]),
            ];
            let sum: f64 = four.iter().map(|region| region.part_of(&start, &line, &[10.0, 8.0])).sum();
            prop_assert!((sum - 1.0).abs() < 1e-12, "{sum}");
        }
    }
}
