//! What the particle models share: kernels, cells, neighbour lists, and lanes for vector arithmetic.
//!
//! The modules at the root work in the plane, [`space`] in three dimensions. Everything here gives the same bits for any
//! number of threads: every particle gathers from its neighbours in one fixed order.

mod cells;
mod counting;
pub mod kernel;
mod neighbours;
pub mod space;

pub use cells::{Cells, FEWEST};
pub use corpuscle_simd::{
    LANES, Lanes, LanesExt, Level, Select, Simd, SimdBase, SimdFloat, SimdFrom, dispatch, gather,
};
pub use neighbours::{BLOCK, FAR_AWAY, Near, NeighbourLists, Neighbours, PairSum};
