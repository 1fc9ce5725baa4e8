//! Render targets.

use crate::RenderError;
use crate::formats::{COLOUR_FORMAT, DEPTH_FORMAT, PICTURE_FORMAT};
use crate::static_layer::StaticLayer;
use corpuscle_gpu::{Gpu, texture_2d, wgpu};
use std::sync::Mutex;

/// A render target: colour and depth with several samples a pixel, the opaque scene behind transparent
/// things, and the finished picture. Reused from picture to picture of a film.
#[derive(Debug)]
pub struct Target {
    /// Width and height of the picture, pixels.
    pub size: [u32; 2],
    /// Samples each way in a pixel.
    pub samples: u32,
    /// True where the background is left out, so that it is transparent in the picture.
    pub transparent: bool,
    pub(crate) colour: wgpu::Texture,
    pub(crate) depth: wgpu::Texture,
    pub(crate) behind_colour: wgpu::Texture,
    pub(crate) behind_depth: wgpu::Texture,
    pub(crate) picture: wgpu::Texture,
    pub(crate) static_layer: Mutex<StaticLayer>,
}

impl Target {
    /// A target for pictures of `size` `[width, height]` pixels with `samples` x `samples` samples a pixel (2 for stills; 1
    /// is fast).
    ///
    /// # Errors
    /// [`RenderError::Gpu`] where that is more than a device can hold.
    pub fn new(gpu: &Gpu, size: [u32; 2], samples: u32) -> Result<Self, RenderError> {
        use wgpu::TextureUsages as Usage;
        let size = size.map(|length| length.max(1));
        let samples = samples.max(1);
        let drawn = size.map(|length| length.saturating_mul(samples));
        let texture = |label, format, usage| texture_2d(gpu, label, drawn, format, usage);
        let into = Usage::RENDER_ATTACHMENT | Usage::TEXTURE_BINDING | Usage::COPY_SRC | Usage::COPY_DST;
        let behind = Usage::TEXTURE_BINDING | Usage::COPY_DST;
        Ok(Self {
            size,
            samples,
            transparent: false,
            colour: texture("colour", COLOUR_FORMAT, into)?,
            depth: texture("depth", DEPTH_FORMAT, into)?,
            behind_colour: texture("colour behind", COLOUR_FORMAT, behind)?,
            behind_depth: texture("depth behind", DEPTH_FORMAT, behind)?,
            picture: texture_2d(gpu, "picture", size, PICTURE_FORMAT, into)?,
            static_layer: Mutex::default(),
        })
    }

    /// The same for pictures without background.
    pub fn without_background(self, transparent: bool) -> Self {
        Self { transparent, ..self }
    }

    /// Width and height in samples: of everything but the finished picture.
    pub fn drawn_size(&self) -> [u32; 2] {
        self.size.map(|length| length * self.samples)
    }
}
