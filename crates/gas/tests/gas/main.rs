//! The crate's public behaviour. One program, because each would compile the engine anew.

mod agreement;
mod common;
mod exactness;
mod measured;
mod refused;
mod sides;
mod start;
