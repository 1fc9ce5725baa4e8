//! The sides of the box, and a wall across it.

use crate::Series;
use serde::{Deserialize, Serialize};

/// The sides of the box, each at the smallest or largest coordinate along an axis.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Walls {
    /// At x = 0.
    pub x_min: Wall,
    /// At the first number of `size`.
    pub x_max: Wall,
    /// At y = 0.
    pub y_min: Wall,
    /// At the second number of `size`.
    pub y_max: Wall,
    /// At z = 0; only in three dimensions. Left out: `"fixed"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z_min: Option<Wall>,
    /// At the third number of `size`; only in three dimensions. Left out: `"fixed"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z_max: Option<Wall>,
}

impl Walls {
    /// The walls at the smallest and the largest coordinate along an axis.
    pub fn along(&self, axis: Axis) -> [&Wall; 2] {
        match axis {
            Axis::X => [&self.x_min, &self.x_max],
            Axis::Y => [&self.y_min, &self.y_max],
            Axis::Z => [&self.z_min, &self.z_max].map(|wall| wall.as_ref().unwrap_or(&Wall::Fixed)),
        }
    }
}

/// What one side of the box is. Balls are reflected without friction by all but periodic and thermal sides.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Wall {
    /// It stays where it is.
    #[default]
    Fixed,
    /// What leaves here comes in at the opposite side (which must be periodic too).
    Periodic,
    /// A ball that hits it leaves with the speeds of a gas at this temperature behind a hole in its place.
    Thermal {
        /// Temperature.
        temperature: f64,
    },
    /// It moves at this velocity, positive towards larger coordinates, whatever hits it.
    Moving {
        /// Velocity.
        velocity: f64,
        /// It stops at this time, s. Left out: never.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        until_s: Option<f64>,
    },
    /// It is displaced by this much over time from where it starts, towards larger coordinates, whatever hits it.
    Motion(Motion),
    /// It slides freely, between the gas and an outside pressure.
    Piston {
        /// Mass.
        mass: f64,
        /// Pressure from outside.
        pressure: f64,
        /// Velocity at the start, positive towards larger coordinates.
        #[serde(default)]
        velocity: f64,
    },
}

/// Displacement over time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Motion {
    /// Rows of `[time_s, displacement]`, or a CSV file with them: straight from row to row.
    Displacement(Series),
    /// amplitude sin(2 pi t / period_s).
    Sinusoid {
        /// Largest displacement.
        amplitude: f64,
        /// Time of one swing, s.
        period_s: f64,
    },
}

/// A thin wall across the box. Balls are on one side of it or the other at the start.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Partition {
    /// The axis that it stands across.
    pub axis: Axis,
    /// Its position along that axis.
    pub at: f64,
    /// Time from which it is removed, s. Left out: it stays.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lifted_at_s: Option<f64>,
    /// A hole in it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hole: Option<Hole>,
}

/// A slit (in three dimensions a rectangle) in a partition: its coordinates along the other axes, in their order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hole {
    /// Where it begins.
    pub from: Vec<f64>,
    /// Where it ends.
    pub to: Vec<f64>,
}

/// A direction of the box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Axis {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}

impl Axis {
    /// All three.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// Its number in positions and velocities: 0, 1 or 2.
    pub fn index(self) -> usize {
        self as usize
    }
}
