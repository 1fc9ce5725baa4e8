//! What a set-up must hold to.

use super::random::Placed;
use super::{Method, Setup, Side};
use crate::SetupError;
use crate::hash::Hash;
use crate::setup::ball_volume;
use crate::setup::positions::closest;

const AXES: [char; 3] = ['x', 'y', 'z'];

/// Balls are distinguished from walls by the last two bits of a word of 32.
const MOST_BALLS: f64 = 1e9;

/// Depth over the radius at which balls overlap and not just touch.
const TOUCH: f64 = 1e-12;

/// True for balls that do more than touch, or whose depth of overlap is not a number.
fn overlaps(depth: f64, radius: f64) -> bool {
    depth.is_nan() || depth > TOUCH * radius
}

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
        self.check_well()?;
        self.check_shear()?;
        if let Method::FixedStep(step) = self.method {
            positive("the time step", step)?;
        }
        if let Some(every) = self.measure.every {
            positive("the time between samples", every)?;
        }
        for region in &self.regions {
            for axis in 0..D {
                let (from, to) = (region.from[axis], region.to[axis]);
                number(format!("the end of region {:?}", region.name), to, from < to, "above its beginning")?;
            }
        }
        for ball in &self.balls {
            let what = |which: &str| format!("the {which} of ball {:?}", ball.name);
            positive(what("radius"), ball.radius)?;
            positive(what("mass"), ball.mass)?;
            for axis in 0..D {
                number(what("position"), ball.position[axis], true, "a number")?;
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
            for axis in 0..D {
                number(what("velocity"), species.velocity[axis], true, "a number")?;
                let [from, to] = self.region_of(species).map(|corner| corner[axis]);
                let end = self.size[axis] * (1.0 + 1e-12);
                number(
                    what("region's beginning"),
                    from,
                    (0.0..to).contains(&from),
                    "in the box and before the region's end",
                )?;
                number(what("region's end"), to, to <= end, "in the box")?;
                let (diameter, repeats) = (2.0 * species.radius, self.repeats(&[[0.0; D], self.size])[axis]);
                number(
                    what("radius"),
                    species.radius,
                    repeats || species.region.is_none() || diameter <= to - from,
                    "at most half of its region's width",
                )?;
            }
        }
        self.check_partition()?;
        self.check_times()?;
        self.check_count()?;
        self.check_widths()
    }

    fn check_well(&self) -> Result<(), SetupError> {
        let Some(well) = self.well else { return Ok(()) };
        number("the depth of the square well", well.depth, well.depth != 0.0, "a number other than 0")?;
        number("the width of the square well", well.width, well.width > 1.0, "larger than 1")?;
        let refused = |what: &str| Err(SetupError::Contradiction(format!("balls with square wells {what}")));
        match self.method {
            Method::FixedStep(_) => {
                refused("are not moved on by fixed time steps: these miss rims of wells, and energy with them")
            }
            _ if self.restitution != 1.0 => {
                refused("have no restitution below 1: pairs would lose energy in their wells without end")
            }
            _ => Ok(()),
        }
    }

    fn check_shear(&self) -> Result<(), SetupError> {
        let Some(shear) = self.shear else { return Ok(()) };
        positive("the rate of shear", shear.rate)?;
        if let Some(temperature) = shear.temperature {
            positive("the temperature of the sheared gas", temperature)?;
        }
        let contradictions = [
            ((0..D).any(|axis| !self.repeats_along(axis)), "must be periodic along all axes"),
            (self.gravity != [0.0; D], "has no gravity"),
            (self.well.is_some(), "has no square wells"),
            (
                self.reversed_at.is_some(),
                "has no time at which velocities are reversed: the shear would have to be reversed too",
            ),
            (matches!(self.method, Method::FixedStep(_)), "is not moved on by fixed time steps"),
            (!self.regions.is_empty(), "has no regions of measurement, through which its images slide"),
        ];
        match contradictions.iter().find(|(wrong, _)| *wrong) {
            Some((_, what)) => Err(SetupError::Contradiction(format!("a sheared box {what}"))),
            None => Ok(()),
        }
    }

    fn check_partition(&self) -> Result<(), SetupError> {
        let Some(partition) = &self.partition else { return Ok(()) };
        if partition.axis >= D || self.sides[partition.axis][0] == Side::Periodic {
            let text = "a partition must stand across an axis of the box with walls at its ends";
            return Err(SetupError::Contradiction(text.into()));
        }
        let inside = partition.at > 0.0 && partition.at < self.size[partition.axis];
        number("the position of the partition", partition.at, inside, "inside the box")?;
        match &partition.hole {
            Some(hole)
                if hole.len() != D - 1 || hole.iter().any(|[from, to]| from.is_nan() || to.is_nan() || from >= to) =>
            {
                Err(SetupError::Contradiction(
                    "a hole must have, along each axis but the partition's, a beginning and an end".into(),
                ))
            }
            _ => Ok(()),
        }
    }

    fn check_times(&self) -> Result<(), SetupError> {
        let lifted = self.partition.as_ref().and_then(|partition| partition.lifted_at);
        let times = [
            ("the time when the partition is lifted", lifted),
            ("the time when velocities turn round", self.reversed_at),
        ];
        for (what, time) in times.into_iter().chain([("the contact time", self.contact_time)]) {
            let time = time.unwrap_or(0.0);
            number(what, time, time >= 0.0, "a number from 0 on")?;
        }
        let measure = &self.measure;
        for (what, bins) in
            [("speed", measure.speed_bins), ("profile", measure.profile_bins), ("g(r)", measure.pair_bins)]
        {
            number(format!("the number of bins of {what}"), bins as f64, bins > 0, "at least 1")?;
        }
        Ok(())
    }

    /// No more balls than can be counted.
    fn check_count(&self) -> Result<(), SetupError> {
        let count =
            self.balls.len() as f64 + self.species.iter().map(|species| self.count_of(species) as f64).sum::<f64>();
        number("the number of balls", count, count < MOST_BALLS, "less than a thousand million")
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
                Side::Moving { velocity, until } => {
                    number("the velocity of a wall", *velocity, true, "a number")?;
                    let until = until.unwrap_or(0.0);
                    number("the time when a wall stops", until, until >= 0.0, "a number from 0 on")?;
                }
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

    /// Every ball fits between walls, and three times, with its well, across periodic sides, so that no two balls meet twice.
    fn check_widths(&self) -> Result<(), SetupError> {
        let radii = self.balls.iter().map(|ball| ball.radius).chain(self.species.iter().map(|species| species.radius));
        let radius = radii.fold(0.0, f64::max);
        for axis in 0..D {
            let length = self.size[axis];
            let width = self.well.map_or(1.0, |well| well.width);
            let (least, must) = if self.sides[axis][0] == Side::Periodic {
                (
                    6.0 * width * radius * (1.0 + 1e-8),
                    "across periodic sides a box must be wider than three balls, with their wells",
                )
            } else {
                (2.0 * radius, "a box must be at least as wide as a ball")
            };
            if length < least {
                return Err(SetupError::TooWide { radius, length, axis: AXES[axis], must });
            }
        }
        Ok(())
    }

    /// What moves by plan leaves room for all balls. (A wall that never stops is stopped when it presses the balls together.)
    pub(crate) fn check_plans(&self, balls: &[Placed<D>]) -> Result<(), SetupError> {
        let filled: f64 = balls.iter().map(|placed| ball_volume::<D>(placed.radius)).sum();
        let largest = balls.iter().map(|placed| placed.radius).fold(0.0, f64::max);
        let alike = balls.iter().all(|placed| placed.radius == largest);
        let limit = if alike { closest::<D>() } else { 1.0 };
        for axis in 0..D {
            let rest: f64 = (0..D).filter(|&other| other != axis).map(|other| self.size[other]).product();
            for (time, length) in self.planned_lengths(axis) {
                if length < 2.0 * largest || filled > limit * length * rest {
                    let text = format!(
                        "at t = {time} the walls across {} would leave a length of {length}, too little for the balls: they need {:.6} \
                         at least. Stop the wall earlier, or take fewer or smaller balls",
                        AXES[axis],
                        (2.0 * largest).max(filled / limit / rest)
                    );
                    return Err(SetupError::Contradiction(text));
                }
            }
        }
        Ok(())
    }

    /// No ball overlaps another, a wall or the partition.
    pub(crate) fn check_overlaps(&self, balls: &[Placed<D>]) -> Result<(), SetupError> {
        let period =
            std::array::from_fn(|axis| if self.sides[axis][0] == Side::Periodic { self.size[axis] } else { 0.0 });
        let largest = balls.iter().map(|placed| placed.radius).fold(0.0, f64::max);
        let mut hash = Hash::new([0.0; D], self.size, period, 2.0 * largest, balls.len());
        let order = hash.in_order(balls.iter().map(|placed| placed.position));
        for &number in &order {
            let placed = &balls[number];
            let what = || format!("ball {number} of radius {} at {:?}", placed.radius, placed.position);
            for axis in (0..D).filter(|&axis| period[axis] == 0.0) {
                let x = placed.position[axis];
                let depth = placed.radius - x.min(self.size[axis] - x);
                if overlaps(depth, placed.radius) {
                    return Err(SetupError::Overlap {
                        what: what(),
                        other: format!("a wall across {}", AXES[axis]),
                        depth,
                    });
                }
            }
            if let Some(partition) = &self.partition {
                let depth = placed.radius - (placed.position[partition.axis] - partition.at).abs();
                if overlaps(depth, placed.radius) {
                    return Err(SetupError::Overlap { what: what(), other: "the partition".into(), depth });
                }
            }
            if let Some((other, depth)) = hash.overlap(&placed.position, placed.radius)
                && overlaps(depth, placed.radius)
            {
                return Err(SetupError::Overlap { what: what(), other: format!("ball {}", order[other]), depth });
            }
            hash.add(placed.position, placed.radius);
        }
        Ok(())
    }
}
