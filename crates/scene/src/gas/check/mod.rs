//! Checks of `[gas]`.

mod balls;
mod walls;

use crate::check::{Check, Checked, SIDES};
use crate::{Axis, Gas, Measure, Method, Partition, Region, Shear, SquareWell};

/// Close packing: the densest that there is, pi / sqrt(12) of a plane (Thue 1910) and pi / sqrt(18) of space (Hales 2005).
pub(super) const CLOSE_PACKING: [f64; 2] = [0.906_899_682_117_089_3, 0.740_480_489_693_061_1];

/// More balls than this do not fit in the memory of usual machines.
const MOST_BALLS: f64 = 2e8;

/// More bars than this are no picture.
const MOST_BINS: usize = 10_000;

impl Check {
    pub(crate) fn gas(&self, gas: &Gas) -> Checked {
        self.require("gas.size", (2..=3).contains(&gas.dimensions()), || {
            format!("must be the sides of a box, two or three numbers, not {}", gas.dimensions())
        })?;
        for (axis, &length) in gas.size.iter().enumerate() {
            self.above(&format!("gas.size.{axis}"), length, 0.0)?;
        }
        self.as_many(gas, "gas.gravity", gas.gravity.as_deref())?;
        self.require("gas.restitution", gas.restitution > 0.0 && gas.restitution <= 1.0, || {
            "must be larger than 0 and at most 1 (1: no loss)".into()
        })?;
        self.at_least("gas.contact_time_s", gas.contact_time_s.unwrap_or(0.0), 0.0)?;
        if let Some(well) = &gas.well {
            self.square_well(gas, well)?;
        }
        if let Some(shear) = &gas.shear {
            self.shear(gas, shear)?;
        }
        if let Some(time) = gas.reversed_at_s {
            self.above("gas.reversed_at_s", time, 0.0)?;
        }
        if let Method::FixedStep { time_step_s } = gas.method {
            self.above("gas.method.fixed-step.time_step_s", time_step_s, 0.0)?;
        }
        self.walls(gas)?;
        if let Some(partition) = &gas.partition {
            self.partition(gas, partition)?;
        }
        self.measure(gas, &gas.measure)?;
        self.balls(gas)
    }

    /// A square well, and what does not go with it.
    fn square_well(&self, gas: &Gas, well: &SquareWell) -> Checked {
        self.require("gas.well.depth", well.depth != 0.0, || {
            "must not be 0: a well without depth changes nothing; take [gas.well] out".into()
        })?;
        self.above("gas.well.width", well.width, 1.0)?;
        self.require("gas.method", !matches!(gas.method, Method::FixedStep { .. }), || {
            "fixed time steps miss the rims of square wells, and energy with them; choose \"event-driven\" or \"list\", or take \
             [gas.well] out"
                .into()
        })?;
        self.require("gas.restitution", gas.restitution == 1.0, || {
            "must be 1 with square wells: pairs would lose energy in their wells without end; leave it out, or take [gas.well] out"
                .into()
        })?;
        let radii = gas.species.iter().map(|species| species.radius).chain(gas.ball.iter().map(|ball| ball.radius));
        let reach = 2.0 * well.width * radii.fold(0.0, f64::max);
        for axis in Axis::ALL.into_iter().take(gas.dimensions()) {
            let (length, periodic) = (gas.size[axis.index()], *gas.walls.along(axis)[0] == crate::Wall::Periodic);
            self.require("gas.well.width", !periodic || length > 3.0 * reach, || {
                format!("periodic sides {length} apart must be more than three wells apart, and the widest well reaches {reach}")
            })?;
        }
        Ok(())
    }

    /// Steady shear, and what does not go with it.
    fn shear(&self, gas: &Gas, shear: &Shear) -> Checked {
        self.above("gas.shear.rate_per_s", shear.rate_per_s, 0.0)?;
        if let Some(temperature) = shear.temperature {
            self.above("gas.shear.temperature", temperature, 0.0)?;
        }
        for axis in Axis::ALL.into_iter().take(gas.dimensions()) {
            let key = format!("gas.walls.{}", SIDES[axis.index()][0]);
            self.require(&key, *gas.walls.along(axis)[0] == crate::Wall::Periodic, || {
                "a sheared box must be periodic along all axes; make it \"periodic\", with the opposite side, or take [gas.shear] out".into()
            })?;
        }
        let still = gas.gravity() == [0.0; 3];
        for (key, goes, why) in [
            ("gas.gravity", still, "would make the gas fall for ever"),
            ("gas.well", gas.well.is_none(), "does not go with it yet"),
            ("gas.reversed_at_s", gas.reversed_at_s.is_none(), "would have to reverse the shear too"),
            (
                "gas.method",
                !matches!(gas.method, Method::FixedStep { .. }),
                "has no images that slide with fixed time steps",
            ),
            ("gas.measure.region", gas.measure.region.is_empty(), "would have images sliding through it"),
        ] {
            self.require(key, goes, || format!("{why} in a sheared box; take it out, or [gas.shear]"))?;
        }
        Ok(())
    }

    /// A vector has as many numbers as the box has sides.
    fn as_many(&self, gas: &Gas, key: &str, numbers: Option<&[f64]>) -> Checked {
        let Some(numbers) = numbers else { return Ok(()) };
        let dimensions = gas.dimensions();
        self.require(key, numbers.len() == dimensions, || {
            format!("must have {dimensions} numbers, as many as size has, not {}", numbers.len())
        })
    }

    fn axis(&self, gas: &Gas, key: &str, axis: Axis) -> Checked {
        self.require(key, axis.index() < gas.dimensions(), || {
            "there is no z in two dimensions; choose \"x\" or \"y\", or give size three numbers".into()
        })
    }

    /// A part of the box: in it, and not empty.
    fn region(&self, gas: &Gas, key: &str, Region { from, to }: &Region) -> Checked {
        self.corners(gas, key, from, to)
    }

    fn corners(&self, gas: &Gas, key: &str, all_from: &[f64], all_to: &[f64]) -> Checked {
        for (end, corner) in [("from", all_from), ("to", all_to)] {
            self.as_many(gas, &format!("{key}.{end}"), Some(corner))?;
        }
        for (axis, &length) in gas.size.iter().enumerate() {
            let (from, to) = (all_from[axis], all_to[axis]);
            self.require(&format!("{key}.from"), from >= 0.0, || "must not lie outside the box, below 0".into())?;
            self.require(&format!("{key}.to"), to <= length, || {
                format!("must not lie outside the box, above size = {:?}", gas.size)
            })?;
            self.require(&format!("{key}.to"), from < to, || {
                format!("must be larger than from = {all_from:?} along each axis")
            })?;
        }
        Ok(())
    }

    fn partition(&self, gas: &Gas, partition: &Partition) -> Checked {
        let axis = partition.axis.index();
        self.axis(gas, "gas.partition.axis", partition.axis)?;
        let length = gas.size[axis];
        self.require("gas.partition.at", partition.at > 0.0 && partition.at < length, || {
            format!("must lie inside the box, between 0 and {length}")
        })?;
        let [low, high] = gas.walls.along(partition.axis);
        let periodic = [low, high].contains(&&crate::Wall::Periodic);
        self.require("gas.partition.axis", !periodic, || {
            "a partition between periodic sides parts nothing; make them walls, or take the partition out".into()
        })?;
        if let Some(time) = partition.lifted_at_s {
            self.at_least("gas.partition.lifted_at_s", time, 0.0)?;
        }
        let Some(hole) = &partition.hole else { return Ok(()) };
        let others: Vec<f64> =
            (0..gas.dimensions()).filter(|&other| other != axis).map(|other| gas.size[other]).collect();
        for (end, corner) in [("from", &hole.from), ("to", &hole.to)] {
            let key = format!("gas.partition.hole.{end}");
            self.require(&key, corner.len() == others.len(), || {
                format!("must have {} numbers, one for each axis but that of the partition", others.len())
            })?;
            let inside = corner.iter().zip(&others).all(|(&position, &length)| (0.0..=length).contains(&position));
            self.require(&key, inside, || format!("must lie inside the box, between 0 and {others:?}"))?;
        }
        self.require("gas.partition.hole.to", hole.from.iter().zip(&hole.to).all(|(from, to)| from < to), || {
            format!("must be larger than from = {:?}", hole.from)
        })
    }

    fn measure(&self, gas: &Gas, measure: &Measure) -> Checked {
        if let Some(time) = measure.from_s {
            self.at_least("gas.measure.from_s", time, 0.0)?;
        }
        if let Some(distance) = measure.pair_distance {
            self.above("gas.measure.pair_distance", distance, 0.0)?;
            let half = 0.5 * gas.size.iter().copied().fold(f64::INFINITY, f64::min);
            self.require("gas.measure.pair_distance", distance <= half, || {
                format!("must be at most {half}, half the shortest side of the box")
            })?;
        }
        self.above("gas.measure.lag_collisions", measure.lag_collisions, 0.0)?;
        self.axis(gas, "gas.measure.profile_axis", measure.profile_axis)?;
        let bins = [
            ("speed_bins", measure.speed_bins),
            ("profile_bins", measure.profile_bins),
            ("pair_bins", measure.pair_bins),
        ];
        for (name, count) in bins {
            self.require(&format!("gas.measure.{name}"), (1..=MOST_BINS).contains(&count), || {
                format!("must be from 1 to {MOST_BINS}")
            })?;
        }
        self.measured_regions(gas, measure)
    }

    /// Regions of measurement lie in the box, and their columns have names of their own.
    fn measured_regions(&self, gas: &Gas, measure: &Measure) -> Checked {
        let walls = ["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"];
        let species = gas.species.iter().map(|species| &species.name).chain(gas.ball.iter().map(|ball| &ball.name));
        let mut taken: Vec<&str> = species.map(String::as_str).chain(walls).chain(["gas"]).collect();
        for (number, region) in measure.region.iter().enumerate() {
            let key = format!("gas.measure.region.{number}");
            let name = region.name.as_str();
            self.require(&format!("{key}.name"), !name.trim().is_empty() && !taken.contains(&name), || {
                format!("`{name}` is empty or taken, by a species, a wall or another region; gauges have this name")
            })?;
            taken.push(name);
            self.corners(gas, &key, &region.from, &region.to)?;
        }
        Ok(())
    }
}
