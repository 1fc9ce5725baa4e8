//! What the particle models share: smoothing kernels, cells, neighbour lists, and lanes for vector arithmetic.
//!
//! All of it is for two and three dimensions. It gives the same bits for any number of threads: every particle gathers from its neighbours in one
//! fixed order.

mod cells;
mod counting;
pub mod kernel;
mod neighbours;
mod reach;

pub use cells::{Cells, FEWEST};
pub use corpuscle_simd::{
    LANES, Lanes, LanesExt, Level, Select, Simd, SimdBase, SimdFloat, SimdFrom, dispatch, gather,
};
pub use neighbours::{BLOCK, EachReach, FAR_AWAY, Near, NeighbourLists, Neighbours, OneReach, PairSum, Reach};
