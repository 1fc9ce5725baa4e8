//! Pictures that take long to draw without a GPU, drawn while the window stays live: by a thread of their own, in a browser by the device as it comes
//! to them.

mod drawing;
#[cfg(target_arch = "wasm32")]
mod page;
#[cfg(not(target_arch = "wasm32"))]
mod thread;

use crate::snapshot::Snapshot;
use crate::view_state::ViewState;
use corpuscle::gpu::Image;
use corpuscle::pictures::{Quality, Scenery, Shown};
#[cfg(target_arch = "wasm32")]
pub use page::OffscreenRenderer;
use std::path::PathBuf;
use std::sync::Arc;
#[cfg(not(target_arch = "wasm32"))]
pub use thread::OffscreenRenderer;

/// A scene at one time, as it is to be drawn.
#[derive(Clone)]
pub struct RenderJob {
    /// What pictures need of the scene.
    pub scenery: Arc<Scenery>,
    /// The scene at one time.
    pub snapshot: Arc<Snapshot>,
    /// The camera and the partition.
    pub view_state: ViewState,
}

/// How the window's picture of a paused scene is drawn.
#[derive(Debug, Clone, Copy)]
pub struct PausedSettings {
    /// The quality.
    pub quality: Quality,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Samples each way in a pixel.
    pub samples: u32,
    /// Background of a drawing, linear light.
    pub paper: [f32; 3],
}

/// A picture that was drawn.
pub enum RenderResult {
    /// A still was saved, or could not be.
    Still(Result<PathBuf, String>),
    /// The window's picture of a paused scene, by the number of its request.
    Paused(u64, Result<Box<(Shown, Image)>, String>),
}
