//! Steady shear flow without walls: a periodic box whose images above and below slide along x (Lees & Edwards, J. Phys. C 5, 1972, 1921).
//!
//! The mean velocity is along x and grows along y. The image above moves at the rate of shear times the height of the box; a ball that
//! leaves at the top comes in at the bottom, displaced and slower by as much.

use super::contact::{Field, Sheared};
use super::{Ball, World};
use corpuscle_model::CompensatedSum;
use serde::{Deserialize, Serialize};

/// How the image of the box above it slides; a speed of 0 for a box at rest.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Slide {
    pub speed: f64,
    /// Displacement at the beginning of the window, from 0 to the length of the box.
    pub displacement: f64,
}

/// What the slide does to the gas: at crossings of the faces and in collisions across them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct ShearTally {
    /// Work, where it is gained and where it is lost.
    pub gained: CompensatedSum,
    pub lost: CompensatedSum,
    /// Momentum along x.
    pub momentum: CompensatedSum,
}

impl ShearTally {
    pub fn work(&self) -> f64 {
        self.gained.value() - self.lost.value()
    }

    pub fn book(&mut self, energy: f64) {
        if energy >= 0.0 { self.gained.add(energy) } else { self.lost.add(-energy) }
    }
}

impl<const D: usize> Field<D> {
    pub fn is_sheared(&self) -> bool {
        self.slide.speed != 0.0
    }

    /// Displacement of the image above at a time of the window.
    #[inline(always)]
    pub fn slid_at(&self, time: f64) -> f64 {
        self.slide.displacement + self.slide.speed * time
    }

    /// A ball as it is in the box's `images`-th image above, but for the height.
    #[inline(always)]
    pub fn image_above(&self, ball: &Ball<D>, images: f64) -> Ball<D> {
        let mut image = *ball;
        image.position[0] += images * self.slid_at(ball.time);
        image.velocity[0] += images * self.slide.speed;
        image
    }

    /// As [`Field::nearest`], with images above and below where they are at a time. Returns in which image above the end of the line is.
    #[inline(always)]
    pub fn nearest_in_shear(&self, apart: &mut [f64; D], time: f64) -> f64 {
        let images = -(apart[1] / self.period[1]).round_ties_even();
        apart[0] += images * self.slid_at(time);
        self.nearest(apart);
        images
    }

    /// Mean velocity along x at a height, where the whole gas is at rest.
    #[inline(always)]
    pub fn flow_at(&self, low: f64, height: f64) -> f64 {
        self.slide.speed * ((height - low) / self.period[1] - 0.5)
    }
}

impl<const D: usize> World<D> {
    /// Velocity of a ball relative to the flow where it is.
    pub fn thermal_velocity(&self, ball: usize, time: f64) -> [f64; D] {
        let (position, mut velocity) = self.state(ball, time);
        if self.field.is_sheared() {
            velocity[0] -= self.field.flow_at(self.low[1], position[1]);
        }
        velocity
    }

    /// Velocity of a ball relative to the flow, in the middle of a flight that begins where it is kept.
    #[inline(always)]
    pub(super) fn velocity_in_flight(&self, ball: &Ball<D>, flown: f64) -> [f64; D] {
        let mut velocity = ball.velocity;
        velocity[0] -= self.field.flow_at(self.low[1], ball.position[1] + 0.5 * flown * velocity[1]);
        velocity
    }

    /// A ball that leaves the box above (1) or below (-1) comes in at the opposite face.
    pub fn wrap_in_shear(&mut self, ball: usize, direction: i32) {
        self.book_flight::<Sheared>(ball);
        self.bring::<Sheared>(ball);
        let before = self.balls[ball].position;
        let images = f64::from(direction);
        let mut moved = self.field.image_above(&self.balls[ball], -images);
        moved.position[1] -= images * self.field.period[1];
        let over = ((moved.position[0] - self.low[0]) / self.field.period[0]).floor();
        moved.position[0] -= over * self.field.period[0];
        let (old, new) = (self.balls[ball].velocity[0], moved.velocity[0]);
        let mass = self.mass(ball);
        self.tally.shear.book(0.5 * mass * (new - old) * (new + old));
        self.tally.shear.momentum.add(mass * (new - old));
        self.balls[ball] = moved;
        self.records[ball].image[1] += direction;
        self.note_jump(ball, before);
    }
}
