//! Humid air that condenses on cold solids.
//!
//! [`Dew`] is the model: air as particles in three dimensions (SPH, weakly compressible) round solids sampled into particles
//! too. Heat goes through both; vapour diffuses through the air and becomes water where a surface is cold enough.
//! Published as Chinese patent CN106650064B, whose ways can be chosen beside the defaults.

// Loops over axes read several arrays at once.
#![allow(clippy::needless_range_loop)]

pub mod air;
mod constants;
mod dew;
mod domain;
pub mod drops;
mod exchange;
mod faces;
mod fan;
mod fogging;
#[cfg(feature = "gpu")]
mod gpu;
pub mod humid_air;
mod inventory;
mod layer;
mod measures;
mod model;
mod normalisation;
mod open;
#[cfg(feature = "gpu")]
mod origin;
mod room;
mod settings;
#[cfg(feature = "gpu")]
mod shared;
pub mod solids;
mod state;
#[cfg(test)]
mod testing;
mod utility;
mod walls;
mod wetting;

pub use dew::{Dew, LiveChange, Scatter, Setup, SourceChange};
pub use fan::Fan;
pub use open::{open, open_on};
pub use room::{Face, GhostParticle, Inflow, Room};
pub use settings::{Condensation, Conductor, Humidity, LowUtility, Mean, Settings, WallTreatment};
pub use solids::bodies;
