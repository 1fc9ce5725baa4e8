//! Humid air that condenses on cold solids.

// Loops over axes read several arrays at once.
#![allow(clippy::needless_range_loop)]

pub mod bodies;
pub mod drops;
pub mod humid_air;
