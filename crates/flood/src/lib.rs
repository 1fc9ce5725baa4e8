//! Shallow water as particles over terrain.
//!
//! Three schemes move the water, chosen in the scene ([`open`]): `voronoi` (the default, [`VoronoiFlood`]: finite volumes over Voronoi cells, right on any
//! ground), and two of smoothed-particle hydrodynamics, [`Flood`]: `balanced` and `sph-swe` (the published one), which move
//! [`Particle`]s, columns of water.

#![warn(missing_docs)]

mod arrangement;
mod balanced;
#[cfg(feature = "gpu")]
mod card;
mod density;
mod edges;
mod falling;
mod fields;
mod flood;
mod friction;
mod gauges;
mod hydraulics;
mod infiltration;
mod inflow;
mod limits;
mod maps;
mod obstacles;
mod particle;
mod rain;
mod refinement;
mod sampling;
mod scheme;
mod schemes;
mod seeding;
mod setup;
mod spacing;
mod sph_swe;
mod structures;
mod voronoi;
mod zone;

pub use flood::{ByHand, Flood};
pub use obstacles::{LineWall, line_walls, obstacle_shapes};
pub use particle::Particle;
pub use rain::RainFunction;
pub use sampling::Sample;
pub use schemes::{FloodModel, as_flood, as_flood_mut, open, open_to_restore};
pub use setup::InitialWater;
pub use spacing::{DefaultSpacing, default_spacing, usual_depth};
pub use voronoi::{Filling, OfPosition, StartWater, VoronoiFlood, WetCell};
