//! What a set-up must hold to.

use super::random::Placed;
use super::{Method, Setup, Side};
use crate::SetupError;
use crate::hash::Hash;

const AXES: [char; 3] = ['x', 'y', 'z'];

/// Depth over the radius at which balls overlap and not just touch.
const TOUCH: f64 = 1e-12;

fn number(what: impl Into<String>, value: f64, good: bool, must: &'static str) -> Result<(), SetupError> {
    if good && value.is_finite() { Ok(()) } else { Err(SetupError::Value { what: what.into(), value, must }) }
}

fn positive(what: impl Into<String>, value: f64) -> Result<(), SetupError> {
    number(what, value, value > 0.0, "a positive number")
}

impl<const D: usize> Setup<D> {
    /// Numbers are numbers and balls fit.
    pub(crate) fn check(&self) -> Result<(), SetupError> {
        if D != 2 && D != 3 {
            return Err(SetupError::Contradiction(format!("a gas has two or three dimensions, not {D}")));
        }
        for axis in 0..D {
            positive(format!("the box's length along {}", AXES[axis]), self.size[axis])?;
            number("gravity", self.gravity[axis], true, "a number")?;
            self.check_sides(axis)?;
        }
        let e = self.restitution;
        number("the restitution", e, e > 0.0 && e <= 1.0, "larger than 0 and at most 1")?;
        positive("Boltzmann's constant", self.boltzmann)?;
        if let Method::FixedStep(step) = self.method {
            positive("the time step", step)?;
        }
        if let Some(every) = self.measure.every {
            positive("the time between looks", every)?;
        }
        for ball in &self.balls {
            let what = |which: &str| format!("the {which} of ball {:?}", ball.name);
            positive(what("radius"), ball.radius)?;
            positive(what("mass"), ball.mass)?;
            for axis in 0..D {
                number(what("place"), ball.position[axis], true, "a number")?;
                number(what("velocity"), ball.velocity[axis], true, "a number")?;
            }
        }
        for species in &self.species {
            let what = |which: &str| format!("the {which} of species {:?}", species.name);
            positive(what("radius"), species.radius)?;
            positive(what("mass"), species.mass)?;
            number(what("temperature"), species.temperature, species.temperature >= 0.0, "a number from 0 on")?;
            if let super::Amount::Packing(packing) = species.amount {
                positive(what("packing"), packing)?;
            }
        }
        self.check_widths()
    }

    fn check_sides(&self, axis: usize) -> Result<(), SetupError> {
        let [low, high] = &self.sides[axis];
        if (*low == Side::Periodic) != (*high == Side::Periodic) {
            return Err(SetupError::Contradiction(format!(
                "one side along {} is periodic and the other is not; both must be, or neither",
                AXES[axis]
            )));
        }
        for side in [low, high] {
            match side {
                Side::Thermal { temperature } => positive("the temperature of a wall", *temperature)?,
                Side::Piston { mass, pressure, velocity } => {
                    positive("the mass of a piston", *mass)?;
                    number("the pressure on a piston", *pressure, *pressure >= 0.0, "a number from 0 on")?;
                    number("the velocity of a piston", *velocity, true, "a number")?;
                }
                Side::Moving { velocity, .. } => number("the velocity of a wall", *velocity, true, "a number")?,
                Side::Swinging { amplitude, period } => {
                    number("the amplitude of a wall", *amplitude, true, "a number")?;
                    positive("the period of a wall", *period)?;
                }
                Side::Displaced(rows) => {
                    let rising = rows.windows(2).all(|pair| pair[0][0] < pair[1][0]);
                    let numbers = rows.iter().flatten().all(|x| x.is_finite());
                    if !(rising && numbers && rows.first().is_some_and(|row| row[0] >= 0.0 && row[1] == 0.0)) {
                        let text = "a wall's motion must have rows of numbers, at rising times from 0 on, and begin without displacement";
                        return Err(SetupError::Contradiction(text.into()));
                    }
                }
                Side::Fixed | Side::Periodic => {}
            }
        }
        Ok(())
    }

    /// Every ball fits between walls, and three times across periodic sides, so that no two balls meet twice.
    fn check_widths(&self) -> Result<(), SetupError> {
        let radii = self.balls.iter().map(|ball| ball.radius).chain(self.species.iter().map(|species| species.radius));
        let radius = radii.fold(0.0, f64::max);
        for axis in 0..D {
            let length = self.size[axis];
            let (least, must) = if self.sides[axis][0] == Side::Periodic {
                (6.0 * radius * (1.0 + 1e-8), "across periodic sides a box must be wider than three balls")
            } else {
                (2.0 * radius, "a box must be at least as wide as a ball")
            };
            if length < least {
                return Err(SetupError::TooWide { radius, length, axis: AXES[axis], must });
            }
        }
        Ok(())
    }

    /// No ball overlaps another, a wall or the partition.
    pub(crate) fn check_overlaps(&self, places: &[Placed<D>]) -> Result<(), SetupError> {
        let period =
            std::array::from_fn(|axis| if self.sides[axis][0] == Side::Periodic { self.size[axis] } else { 0.0 });
        let largest = places.iter().map(|placed| placed.radius).fold(0.0, f64::max);
        let mut hash = Hash::new([0.0; D], self.size, period, 2.0 * largest, places.len());
        for (number, placed) in places.iter().enumerate() {
            let what = || format!("ball {number} of radius {} at {:?}", placed.radius, placed.position);
            for axis in (0..D).filter(|&axis| period[axis] == 0.0) {
                let x = placed.position[axis];
                let depth = placed.radius - x.min(self.size[axis] - x);
                if depth > TOUCH * placed.radius {
                    return Err(SetupError::Overlap {
                        what: what(),
                        other: format!("a wall across {}", AXES[axis]),
                        depth,
                    });
                }
            }
            if let Some(partition) = &self.partition {
                let depth = placed.radius - (placed.position[partition.axis] - partition.at).abs();
                if depth > TOUCH * placed.radius {
                    return Err(SetupError::Overlap { what: what(), other: "the partition".into(), depth });
                }
            }
            if let Some((other, depth)) = hash.overlap(&placed.position, placed.radius)
                && depth > TOUCH * placed.radius
            {
                return Err(SetupError::Overlap { what: what(), other: format!("ball {other}"), depth });
            }
            hash.add(placed.position, placed.radius);
        }
        Ok(())
    }
}
