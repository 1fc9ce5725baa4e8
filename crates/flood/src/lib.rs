//! Shallow water as particles over terrain.
//!
//! [`Flood`] is the model. Two formulations move the water, chosen in the scene: `balanced` (the default: right as well
//! as stable) and `paper` (the published one). Both move [`Particle`]s, columns of water of constant volume.

#![warn(missing_docs)]

mod arrangement;
mod balanced;
mod density;
mod edges;
mod falling;
mod flood;
mod friction;
mod gauges;
mod inflow;
mod limits;
mod maps;
mod paper;
mod particle;
mod sampling;
mod scheme;
mod seeding;
mod setup;

pub use flood::Flood;
pub use particle::Particle;
pub use sampling::Sample;
pub use setup::InitialWater;
