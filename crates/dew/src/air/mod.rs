//! The air: particles of equal mass that move, warm and carry vapour.

mod arrangement;
mod density;
mod pairs;
mod particle;
mod properties;
mod scale;
pub mod transport;

pub(crate) use arrangement::order_of;
pub use arrangement::{Arrangement, Entry, Part};
pub use density::Sums;
#[cfg(feature = "gpu")]
pub(crate) use pairs::DAMPING;
pub use pairs::{Column, Rates, sum as sum_pairs};
pub use particle::{HaloParticle, Particle, Role};
pub(crate) use properties::{LEAST_SOUND, SOUND_OVER_MOTION};
pub use properties::{Properties, TemperatureCoefficients};
pub use scale::Scale;
