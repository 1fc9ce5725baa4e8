//! Shallow water as particles over terrain.
//!
//! [`Flood`] is the model. Two formulations move the water, chosen in the scene: `balanced` (the default: right as well
//! as stable) and `paper` (the published one). Both move [`Particle`]s, columns of water.

#![warn(missing_docs)]

mod arrangement;
mod balanced;
#[cfg(feature = "gpu")]
mod card;
mod density;
mod edges;
mod falling;
mod flood;
mod friction;
mod gauges;
mod hydraulics;
mod infiltration;
mod inflow;
mod limits;
mod maps;
mod obstacles;
mod paper;
mod particle;
mod rain;
mod refinement;
mod sampling;
mod scheme;
mod seeding;
mod setup;
mod structures;
mod zone;

pub use flood::{ByHand, Flood};
pub use obstacles::obstacle_shapes;
pub use particle::Particle;
pub use rain::RainFunction;
pub use sampling::Sample;
pub use setup::InitialWater;
