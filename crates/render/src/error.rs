//! Errors of drawing a picture.

/// An error of drawing a picture.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// An error of the GPU.
    #[error(transparent)]
    Gpu(#[from] corpuscle_gpu::GpuError),
    /// Text and bars over the picture cannot be drawn.
    #[error("the text over the picture cannot be drawn: {0}")]
    Overlay(String),
}
