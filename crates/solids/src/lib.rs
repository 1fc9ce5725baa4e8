//! Solids: where they are, how far a point is from their surface, and particles that stand for them.
//!
//! A [`Solid`] is a [`Shape`] or a [`Mesh`] at a [`Pose`]. [`Solid::nearest`] gives the signed distance to its surface and
//! the direction away from it, [`Solid::sample`] fills it with particles. Lengths are in metres. [`MATERIALS`] has the heat
//! properties of common materials.

#![warn(missing_docs)]
// Loops over axes read several arrays at once.
#![allow(clippy::needless_range_loop)]

mod error;
mod glass;
mod material;
mod mesh;
mod nearest;
mod pose;
mod profile;
mod sample;
mod shape;
mod solid;

pub use error::SolidError;
pub use glass::WineGlass;
pub use material::{MATERIALS, Material, material};
pub use mesh::{MOST_BYTES, MOST_TRIANGLES, Mesh};
pub use nearest::Nearest;
pub use pose::Pose;
pub use profile::Profile;
pub use sample::{Depth, Samples};
pub use shape::Shape;
pub use solid::Solid;
