//! The window: a scene that is looked at and touched while it runs.
//!
//! The physics goes on in a thread of its own ([`physics`]) and publishes what it shows; the window draws the newest picture on its own
//! device and never waits: what takes long is drawn elsewhere. [`view`] opens the window of the system; [`Window`] is what is in it, and knows no system: a test shows
//! it off screen.

mod background_device;
mod dropped;
mod files;
mod gallery;
mod gas_controls;
mod help;
mod icons;
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
mod spot;
mod style;
mod transport;
mod view;
mod view_state;
mod window;

pub use meshes::Meshes;
pub use meter::Measurement;
pub use screen::Screen;
pub use snapshot::{Measures, Snapshot, Wake};
pub use view::{ViewError, view};
pub use view_state::ViewState;
pub use window::{Source, Start, Window};
