//! Terrain from public servers: the Copernicus digital elevation model GLO-30.
//!
//! Only the blocks of its files that a box needs are read, by HTTP range requests, and kept in a cache with their
//! checksums, so that a second download needs no network. This is the only crate that uses a network.

mod attribution;
mod cache;
mod checksum;
mod client;
mod error;
mod fetch;
mod glo30;
mod observer;
mod piece;
mod remote;
mod source;
mod tile;

pub use attribution::ATTRIBUTION;
pub use error::FetchError;
pub use fetch::{Fetched, fetch};
pub use observer::{FetchObserver, Progress};
pub use source::{BASE, BASE_VARIABLE, CACHE_VARIABLE, Source};
