//! Particles in space: kernels, cells and neighbour lists in three dimensions, for one smoothing length of all.
//!
//! The plane's [`Cells`](crate::Cells) and [`NeighbourLists`](crate::NeighbourLists) serve a reach that differs from
//! particle to particle; here one reach holds for all, so that runs of cells can be cut to the ball that is looked at.

mod cells;
mod kernel;
mod neighbours;

pub use cells::Cells;
pub use kernel::Kernels;
pub use neighbours::{NeighbourLists, Neighbours, PairSum, Places};
