//! Humid air that condenses on cold solids.

pub mod bodies;
pub mod humid_air;
