//! What the particle models share: kernels, cells, neighbour lists, and lanes for vector arithmetic.
//!
//! Everything here gives the same bits for any number of threads: every particle gathers from its neighbours in one
//! fixed order.

mod cells;
pub mod kernel;
mod lanes;
mod neighbours;

pub use cells::Cells;
pub use lanes::{LANES, Lanes};
pub use neighbours::{BLOCK, NeighbourLists, Searched};
