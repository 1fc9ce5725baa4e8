//! The window: shows a scene while it runs, and changes it live.
//!
//! The physics runs in a thread of its own ([`physics`]) and publishes snapshots; the window draws the newest one on its own
//! device and never waits: pictures that take long are drawn in another thread. [`view`] opens the window of the system; [`Window`] is its content, independent of the system: a test shows
//! it off screen.

mod background_device;
mod dropped;
mod files;
mod gallery;
mod gas_controls;
mod help;
mod icons;
mod instruments;
pub mod link;
mod meshes;
mod meter;
mod offscreen;
mod overlay;
mod parameters;
pub mod physics;
mod pick;
mod picture;
mod plots;
mod screen;
mod snapshot;
mod source;
mod spot;
mod style;
mod transport;
#[cfg(not(target_arch = "wasm32"))]
mod view;
mod view_state;
#[cfg(target_arch = "wasm32")]
pub mod web;
mod window;

pub use meshes::Meshes;
pub use meter::Measurement;
pub use screen::Screen;
pub use snapshot::{Measures, Snapshot, Wake};
pub use source::{Source, Start};
#[cfg(not(target_arch = "wasm32"))]
pub use view::{ViewError, view};
pub use view_state::ViewState;
pub use window::{Embedded, Window};
