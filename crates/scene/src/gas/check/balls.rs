//! Checks of `[[gas.ball]]` and `[[gas.species]]`.

use super::{CLOSE_PACKING, MOST_BALLS};
use crate::check::{Check, Checked, SIDES};
use crate::{Axis, Ball, Gas, Problem, Region, Species, Wall};
use std::collections::HashMap;
use std::f64::consts::PI;

/// Area, in three dimensions volume, of a ball.
fn volume(radius: f64, dimensions: usize) -> f64 {
    if dimensions == 2 { PI * radius * radius } else { 4.0 / 3.0 * PI * radius.powi(3) }
}

impl Check {
    pub(super) fn balls(&self, gas: &Gas) -> Checked {
        self.require("gas.species", !(gas.species.is_empty() && gas.ball.is_empty() && gas.start_file.is_none()), || {
            "there are no balls; give [[gas.species]] with name, count, radius, mass and temperature, or [[gas.ball]], or gas.start_file"
                .into()
        })?;
        for (index, ball) in gas.ball.iter().enumerate() {
            self.ball(gas, &format!("gas.ball.{index}"), ball)?;
        }
        self.no_overlap(gas)?;
        for (index, species) in gas.species.iter().enumerate() {
            self.species(gas, &format!("gas.species.{index}"), species)?;
        }
        self.species_names(gas)?;
        self.total(gas)
    }

    fn ball(&self, gas: &Gas, key: &str, ball: &Ball) -> Checked {
        self.name(&format!("{key}.name"), &ball.name)?;
        self.as_many(gas, &format!("{key}.position"), Some(&ball.position))?;
        self.as_many(gas, &format!("{key}.velocity"), ball.velocity.as_deref())?;
        self.body(key, ball.radius, ball.mass)?;
        self.colour(key, ball.colour.as_deref())?;
        self.fits(&format!("{key}.radius"), ball.radius, &gas.size, "the box")?;
        for axis in Axis::ALL.into_iter().take(gas.dimensions()) {
            let (position, length) = (ball.position[axis.index()], gas.size[axis.index()]);
            // Half of a ball may stand beyond a periodic side; its centre may not.
            let margin = if *gas.walls.along(axis)[0] == Wall::Periodic { 0.0 } else { ball.radius };
            self.require(&format!("{key}.position"), position >= margin && position <= length - margin, || {
                format!(
                    "the ball must lie inside the box: its centre from {margin} to {} along {axis:?}",
                    length - margin
                )
            })?;
        }
        let Some(partition) = &gas.partition else { return Ok(()) };
        let distance = (ball.position[partition.axis.index()] - partition.at).abs();
        self.require(&format!("{key}.position"), distance >= ball.radius, || {
            format!("the ball stands in the partition at {}; move one of them", partition.at)
        })
    }

    /// No two balls overlap, across periodic sides neither. In order along x, so that few pairs are tested.
    fn no_overlap(&self, gas: &Gas) -> Checked {
        let largest = gas.ball.iter().map(|ball| ball.radius).fold(0.0, f64::max);
        let mut order: Vec<usize> = (0..gas.ball.len()).collect();
        order.sort_by(|&a, &b| gas.ball[a].position[0].total_cmp(&gas.ball[b].position[0]));
        let turns = if *gas.walls.along(Axis::X)[0] == Wall::Periodic { 2 } else { 1 };
        for (rank, &one) in order.iter().enumerate() {
            let others = (rank + 1..turns * order.len()).take(order.len() - 1);
            for index in others {
                let other = order[index % order.len()];
                let turn = if index >= order.len() { gas.size[0] } else { 0.0 };
                if gas.ball[other].position[0] + turn - gas.ball[one].position[0] > gas.ball[one].radius + largest {
                    break;
                }
                self.apart(gas, one.min(other), one.max(other))?;
            }
        }
        Ok(())
    }

    fn apart(&self, gas: &Gas, one: usize, other: usize) -> Checked {
        let (a, b) = (&gas.ball[one], &gas.ball[other]);
        let square = |axis: Axis| {
            let (i, length) = (axis.index(), gas.size[axis.index()]);
            let straight = (a.position[i] - b.position[i]).abs();
            let shortest = match gas.walls.along(axis)[0] {
                Wall::Periodic => straight.min(length - straight),
                _ => straight,
            };
            shortest * shortest
        };
        let distance = Axis::ALL.into_iter().take(gas.dimensions()).map(square).sum::<f64>().sqrt();
        let sum = a.radius + b.radius;
        // Balls that touch may be a rounding error too close.
        self.require(&format!("gas.ball.{other}.position"), distance >= sum * (1.0 - 1e-12), || {
            format!("the ball overlaps gas.ball.{one}: their centres are {distance} apart, their radii sum to {sum}")
        })
    }

    fn species(&self, gas: &Gas, key: &str, species: &Species) -> Checked {
        self.name(&format!("{key}.name"), &species.name)?;
        self.exactly_one(key, &[("count", species.count.is_some()), ("packing", species.packing.is_some())])?;
        self.body(key, species.radius, species.mass)?;
        self.at_least(&format!("{key}.temperature"), species.temperature, 0.0)?;
        self.as_many(gas, &format!("{key}.velocity"), species.velocity.as_deref())?;
        self.colour(key, species.colour.as_deref())?;
        let whole = Region { from: vec![0.0; gas.dimensions()], to: gas.size.clone() };
        let region = species.region.as_ref().unwrap_or(&whole);
        self.region(gas, &format!("{key}.region"), region)?;
        let sides: Vec<f64> = region.from.iter().zip(&region.to).map(|(from, to)| to - from).collect();
        let what = if species.region.is_some() { "its region" } else { "the box" };
        self.fits(&format!("{key}.radius"), species.radius, &sides, what)?;
        let space: f64 = sides.iter().product();
        let ball = volume(species.radius, gas.dimensions());
        let (given, packing) = match (species.packing, species.count) {
            (Some(packing), _) => ("packing", packing),
            (None, count) => ("count", count.unwrap_or(0) as f64 * ball / space),
        };
        let given = format!("{key}.{given}");
        self.require(&given, species.count != Some(0), || "must be at least 1".into())?;
        self.require(&given, packing > 0.0, || "must be larger than 0".into())?;
        let limit = CLOSE_PACKING[gas.dimensions() - 2];
        self.require(&given, packing <= limit, || {
            format!(
                "the balls would fill {packing:.4} of {what}; close packing, the densest that there is, is {limit:.4} in {} \
                 dimensions",
                gas.dimensions()
            )
        })?;
        self.require(&given, packing * space / ball <= MOST_BALLS, || {
            format!("would make {:.1e} balls; at most {MOST_BALLS:.0e} are possible", packing * space / ball)
        })
    }

    fn body(&self, key: &str, radius: f64, mass: f64) -> Checked {
        self.above(&format!("{key}.radius"), radius, 0.0)?;
        self.above(&format!("{key}.mass"), mass, 0.0)
    }

    fn fits(&self, key: &str, radius: f64, sides: &[f64], what: &str) -> Checked {
        let shortest = sides.iter().copied().fold(f64::INFINITY, f64::min);
        self.require(key, 2.0 * radius <= shortest, || {
            format!("a ball must fit into {what}: its radius can be at most {}", 0.5 * shortest)
        })
    }

    fn colour(&self, key: &str, colour: Option<&str>) -> Checked {
        let Some(colour) = colour else { return Ok(()) };
        let digits = colour.strip_prefix('#').unwrap_or_default();
        let fit = digits.len() == 6 && digits.chars().all(|c| c.is_ascii_hexdigit());
        self.require(&format!("{key}.colour"), fit, || "must be red, green and blue, as in \"#0072b2\"".into())
    }

    fn species_names(&self, gas: &Gas) -> Checked {
        let mut seen = HashMap::new();
        let walls: Vec<&str> = SIDES.iter().flatten().copied().collect();
        let is_alone = gas.species.len() + gas.ball.len() == 1;
        for (index, species) in gas.species.iter().enumerate() {
            let key = format!("gas.species.{index}.name");
            if let Some(other) = seen.insert(species.name.replace(' ', "_"), key.clone()) {
                let what = format!(" = {:?}: this name is taken by {other}; give another", species.name);
                return Err(Problem::new(key, what));
            }
            // Of a single species the gauges of the gas are its own.
            let is_free = !walls.contains(&species.name.as_str()) && (is_alone || species.name != "gas");
            self.require(&key, is_free, || {
                "is the name of other gauges: those of the gas or of a wall; give another".into()
            })?;
        }
        for (index, ball) in gas.ball.iter().enumerate() {
            let is_free = ball.name != "gas" && !walls.contains(&ball.name.as_str());
            let key = format!("gas.ball.{index}.name");
            self.require(&key, is_free, || {
                "is the name of other gauges: those of the gas or of a wall; give another".into()
            })?;
            let file = ball.name.replace(' ', "_");
            let other = seen.get(&file).filter(|_| gas.species.iter().all(|species| species.name != ball.name));
            if let Some(other) = other {
                return Err(Problem::new(
                    key,
                    format!(" = {:?}: this name is taken by {other}; give another", ball.name),
                ));
            }
        }
        Ok(())
    }

    /// All balls together fill less than the box, and the ball to be followed is one of them.
    fn total(&self, gas: &Gas) -> Checked {
        let dimensions = gas.dimensions();
        let (mut filled, mut most_balls) = (0.0, gas.ball.len() as f64);
        for ball in &gas.ball {
            filled += volume(ball.radius, dimensions);
        }
        for species in &gas.species {
            let ball = volume(species.radius, dimensions);
            let count = species
                .count
                .map_or_else(|| species.packing.unwrap_or(0.0) * self.space(gas, species) / ball, |n| n as f64);
            filled += count * ball;
            most_balls += count.ceil();
        }
        let space: f64 = gas.size.iter().product();
        self.require("gas.size", filled < space, || {
            format!("the balls of all species together would fill {:.3} of the box", filled / space)
        })?;
        // How many balls a file has is known when it is read.
        let Some(follow) = gas.follow.filter(|_| gas.start_file.is_none()) else { return Ok(()) };
        self.require("gas.follow", (follow as f64) < most_balls, || {
            format!("there is no such ball: ids run from 0 to {}", most_balls - 1.0)
        })
    }

    fn space(&self, gas: &Gas, species: &Species) -> f64 {
        match &species.region {
            Some(region) => region.from.iter().zip(&region.to).map(|(from, to)| to - from).product(),
            None => gas.size.iter().product(),
        }
    }
}
