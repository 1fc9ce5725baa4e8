//! Hard balls from collision to collision.
//!
//! A [`Setup`] says what is in the box; [`Setup::build`] makes a [`Gas`] of it, in two or three dimensions. [`open`] does
//! both for a scene. The gas is moved on exactly, by the collisions that it has: see `engine`.

#![warn(missing_docs)]
// Loops over axes read several arrays at once.
#![allow(clippy::needless_range_loop)]

mod engine;
mod error;
mod functions;
mod gas;
mod hash;
mod measure;
mod memory;
mod method;
mod pause;
mod random;
mod scene;
mod setup;
pub mod theory;
mod world;

pub use error::SetupError;
pub use gas::{Gas, LiveChange};
pub use measure::Estimate;
pub use method::{Nearest, With};
pub use scene::open;
pub use setup::{
    Amount, Ball, Measure, Method, Partition, Region, Setup, Shear, Side, Species, Speeds, SquareWell, Start,
    ball_volume,
};
