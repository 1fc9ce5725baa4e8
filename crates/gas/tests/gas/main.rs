//! The crate's public behaviour. One program, because each would compile the engine anew.

// Loops over axes read several arrays at once.
#![allow(clippy::needless_range_loop)]

mod agreement;
mod common;
mod exactness;
mod live_change;
mod measured;
mod refused;
mod regions;
mod shear;
mod sides;
mod start;
mod wells;
