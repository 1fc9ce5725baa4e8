//! Shallow water as particles over terrain.
//!
//! Two schemes move the water, chosen in the scene ([`open`]): `voronoi` (the default, [`VoronoiFlood`]: finite volumes over Voronoi cells, right on any
//! ground), and `sph-swe` ([`SphSweFlood`]: the published one, which moves [`Particle`]s, columns of water of a fixed volume).

#![warn(missing_docs)]

mod error;
mod extent;
mod fields;
mod friction;
mod gauges;
mod initial_water;
mod limits;
mod live_change;
mod obstacles;
mod polygon;
mod sampling;
mod schemes;
mod series;
mod setup;
mod spacing;
mod sph_swe;
mod voronoi;
mod zone;

pub use fields::OfPosition;
pub use initial_water::{Filling, InitialWater, StartWater};
pub use live_change::LiveChange;
pub use obstacles::{LineWall, line_walls, obstacle_shapes};
pub use sampling::Sample;
pub use schemes::{FloodModel, as_flood, as_flood_mut, open, open_to_restore};
pub use spacing::{DefaultSpacing, default_spacing, usual_depth};
pub use sph_swe::{Particle, SphSweFlood};
pub use voronoi::{RainFunction, VoronoiFlood, WetCell};
