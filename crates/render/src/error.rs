//! What can go wrong while a picture is drawn.

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The graphics device cannot.
    #[error(transparent)]
    Gpu(#[from] corpuscle_gpu::GpuError),
    /// Text and bars over the picture cannot be drawn.
    #[error("the text over the picture cannot be drawn: {0}")]
    Overlay(String),
}
