//! Humid air that condenses on cold solids.

pub mod humid_air;
