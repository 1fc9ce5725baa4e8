//! The physics in a worker of the browser, so that the page never waits for it.

mod handle;
mod serve;

pub(crate) use handle::FileHolder;
pub use handle::Physics;
pub use serve::serve;
