//! Drawable things: the interface between the renderer and each kind of thing.

use crate::{Camera, Stage};
use corpuscle_gpu::{Gpu, wgpu};

/// A thing in a picture. It takes part in the passes that concern it, in this order:
///
/// 1. [`Drawable::cast`], once for all things: things that cast shadows draw their depth as seen from the sun.
/// 2. [`Drawable::draw_before`], one thing after another, in lit pictures: passes into textures of its own that it needs to be drawn.
/// 3. [`Drawable::draw`], once for all things: opaque things draw into colour and depth, over the backdrop.
/// 4. [`Drawable::draw_through`], one thing after another: transparent things (water, glass) draw over a copy of
///    all that is behind it.
///
/// Shaders begin with `#import view` (camera, positions, lines of sight), `#import sky` (what is mirrored) or `#import light` (light
/// on surfaces, shadows); group 0 is bound already, a thing's own groups start at 1. Coordinates are those of the stage; depth is
/// 1 near and 0 far, so nearer is *greater*; colours are linear light.
pub trait Drawable {
    /// Called before the passes of each picture: prepares what depends on the camera and the size (samples).
    fn prepare(&mut self, _gpu: &Gpu, _stage: &Stage, _camera: &Camera, _size: [u32; 2]) {}

    /// Draws the parts that cast shadows, with a pipeline of [`crate::DEPTH_FORMAT`] alone. Group 0 is the view from the sun (without
    /// perspective).
    fn cast(&self, _pass: &mut wgpu::RenderPass<'_>) {}

    /// False for things that cast no shadow: where only they move, shadows can be kept.
    fn throws_shadow(&self) -> bool {
        true
    }

    /// Draws into textures of the thing's own that its later passes need.
    fn draw_before(&mut self, _frame: &mut Before<'_>) {}

    /// Draws the opaque parts, with a pipeline of [`crate::COLOUR_FORMAT`] and [`crate::DEPTH_FORMAT`].
    fn draw(&self, _pass: &mut wgpu::RenderPass<'_>) {}

    /// For a static thing, a number that no other thing has, and that changes when the thing is drawn otherwise although
    /// camera, light and size are the same. Its picture is kept while these rest, in light that casts shadows only where nothing
    /// moves that casts one. None for a moving thing.
    fn static_state(&self) -> Option<u64> {
        None
    }

    /// True for transparent things. They cast no shadows and draw nothing opaque.
    fn lets_light_through(&self) -> bool {
        false
    }

    /// Draws the transparent parts, in passes of its own.
    fn draw_through(&mut self, _frame: &mut Through<'_>) {}
}

/// Device, encoder and bindings for the passes before the picture.
pub struct Before<'a> {
    /// The device.
    pub gpu: &'a Gpu,
    /// Where its passes go.
    pub encoder: &'a mut wgpu::CommandEncoder,
    /// Group 0: to be set in each pass that uses a shader with `#import view`.
    pub view: &'a wgpu::BindGroup,
    /// Width and height of the picture, samples.
    pub size: [u32; 2],
}

/// Targets of a transparent thing, and the picture behind it.
pub struct Through<'a> {
    /// The device.
    pub gpu: &'a Gpu,
    /// Where its passes go: render and compute passes, as many as it likes.
    pub encoder: &'a mut wgpu::CommandEncoder,
    /// Group 0: to be set in each pass that uses a shader with `#import view`.
    pub view: &'a wgpu::BindGroup,
    /// Width and height of all four textures, pixels.
    pub size: [u32; 2],
    /// Colour to draw into ([`crate::COLOUR_FORMAT`]); holds all that is behind: load, do not clear.
    pub colour: &'a wgpu::TextureView,
    /// Depth to draw into and to test against ([`crate::DEPTH_FORMAT`]); load, do not clear. What comes later is drawn over what
    /// writes here.
    pub depth: &'a wgpu::TextureView,
    /// A copy of the colour as it was before, to sample what is refracted or mirrored.
    pub behind_colour: &'a wgpu::TextureView,
    /// A copy of the depth as it was before, as a depth texture; 0 where nothing is but the backdrop.
    pub behind_depth: &'a wgpu::TextureView,
}

impl Through<'_> {
    /// Begins a pass that draws into colour and depth over what is there, with group 0 set.
    pub fn begin(&mut self, label: &str) -> wgpu::RenderPass<'_> {
        let mut pass = self.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(label),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: self.colour,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: self.depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_bind_group(0, self.view, &[]);
        pass
    }
}
