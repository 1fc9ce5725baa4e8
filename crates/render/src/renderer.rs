//! The renderer: draws pictures pass by pass.

use crate::pipeline::PipelineDescriptor;
use crate::shaders::Shader;
use crate::static_layer::{StaticLayer, StaticUse};
use crate::tone::Tone;
use crate::{Before, Camera, Drawable, Light, RenderError, Stage, Target, Through, View};
use corpuscle_gpu::{Gpu, GroupLayout, Image, read_rgba8, read_rgba8_later, wgpu};
use std::sync::PoisonError;

/// The renderer of pictures; holds pipelines and layouts.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    view_layout: GroupLayout,
    backdrop: wgpu::RenderPipeline,
    tone: Tone,
}

impl Renderer {
    /// A renderer on a device.
    pub fn new(gpu: &Gpu) -> Self {
        let view_layout = View::layout(gpu);
        let backdrop = PipelineDescriptor {
            label: "backdrop",
            shader: &Shader::new("backdrop", include_str!("sky/backdrop.wgsl")),
            groups: &[&view_layout],
            buffers: &[],
            topology: wgpu::PrimitiveTopology::TriangleList,
        }
        .opaque(gpu);
        Self { gpu: gpu.clone(), tone: Tone::new(gpu), view_layout, backdrop }
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The layout of group 0 of every pipeline of a [`Drawable`].
    pub fn view_layout(&self) -> &GroupLayout {
        &self.view_layout
    }

    /// Draws things into a target, and lays the overlay over (as large as the picture, opacity multiplied in). Returns before
    /// the device is done.
    pub fn draw(
        &self,
        target: &Target,
        stage: &Stage,
        camera: &Camera,
        light: &Light,
        things: &mut [&mut dyn Drawable],
        overlay: Option<&Image>,
    ) {
        let mut encoder = self.encoder();
        self.record(&mut encoder, target, stage, camera, light, things);
        self.tone.draw(&self.gpu, &mut encoder, target, light.is_lit(), overlay);
        self.gpu.queue.submit([encoder.finish()]);
    }

    /// Draws things into a target and leaves linear light there, for an [`Inlay`](crate::Inlay) to make a picture of. Returns before
    /// the device is done.
    pub fn draw_light(
        &self,
        target: &Target,
        stage: &Stage,
        camera: &Camera,
        light: &Light,
        things: &mut [&mut dyn Drawable],
    ) {
        let mut encoder = self.encoder();
        self.record(&mut encoder, target, stage, camera, light, things);
        self.gpu.queue.submit([encoder.finish()]);
    }

    fn encoder(&self) -> wgpu::CommandEncoder {
        self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("picture") })
    }

    /// The passes before colours are those of a picture.
    fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &Target,
        stage: &Stage,
        camera: &Camera,
        light: &Light,
        things: &mut [&mut dyn Drawable],
    ) {
        let gpu = &self.gpu;
        let mut static_layer = target.static_layer.lock().unwrap_or_else(PoisonError::into_inner);
        let shadows = static_layer.shadows(gpu, light);
        let view = View::new(gpu, &self.view_layout, stage, camera, light, target.drawn_size(), shadows);
        things.iter_mut().for_each(|thing| thing.prepare(gpu, stage, camera, target.drawn_size()));
        let static_use = static_layer.decide(view.bytes(), light, things);
        if light.throws_shadows() && static_use != StaticUse::Kept {
            draw_shadows(encoder, &view, things);
        }
        if light.is_lit() {
            for thing in things.iter_mut() {
                let (view, size) = (&view.group, target.drawn_size());
                thing.draw_before(&mut Before { gpu, encoder, view, size });
            }
        }
        self.draw_opaque(encoder, target, &view, light, things, (&mut static_layer, static_use));
        for thing in things.iter_mut().filter(|thing| thing.lets_light_through()) {
            draw_through(gpu, encoder, target, &view, *thing);
        }
    }

    /// The picture in a target. Waits for the device.
    ///
    /// # Errors
    /// [`RenderError::Gpu`] where the device was lost.
    pub fn read(&self, target: &Target) -> Result<Image, RenderError> {
        Ok(read_rgba8(&self.gpu, &target.picture)?)
    }

    /// [`Renderer::read`] where one may not wait, as in a browser.
    pub fn read_later(&self, target: &Target) -> impl Future<Output = Result<Image, RenderError>> + use<> {
        let reading = read_rgba8_later(&self.gpu, &target.picture);
        async move { Ok(reading.await?) }
    }

    fn draw_opaque(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &Target,
        view: &View,
        light: &Light,
        things: &[&mut dyn Drawable],
        (static_layer, static_use): (&mut StaticLayer, StaticUse),
    ) {
        match static_use {
            StaticUse::Changed => return self.draw_some(encoder, target, view, light, things, Which::All),
            StaticUse::Rests => {
                self.draw_some(encoder, target, view, light, things, Which::Static);
                static_layer.keep(&self.gpu, encoder, [&target.colour, &target.depth]);
            }
            StaticUse::Kept => static_layer.lay(encoder, [&target.colour, &target.depth]),
        }
        self.draw_some(encoder, target, view, light, things, Which::Moving);
    }

    /// Draws some of the things: what moves over what is there, all others over nothing.
    fn draw_some(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &Target,
        view: &View,
        light: &Light,
        things: &[&mut dyn Drawable],
        which: Which,
    ) {
        let cleared = which != Which::Moving;
        let [colour, depth] = [&target.colour, &target.depth].map(whole);
        let load = if cleared { wgpu::LoadOp::Clear(behind(light, target.transparent)) } else { wgpu::LoadOp::Load };
        let load_depth = if cleared { wgpu::LoadOp::Clear(0.0) } else { wgpu::LoadOp::Load };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("opaque"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &colour,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(depth_of(&depth, load_depth)),
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_bind_group(0, &view.group, &[]);
        if cleared && light.draws_backdrop() && !target.transparent {
            pass.set_pipeline(&self.backdrop);
            pass.draw(0..3, 0..1);
        }
        things.iter().filter(|thing| which.has(&***thing)).for_each(|thing| thing.draw(&mut pass));
    }
}

/// Which things are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Which {
    All,
    Static,
    Moving,
}

impl Which {
    fn has(self, thing: &dyn Drawable) -> bool {
        match self {
            Self::All => true,
            Self::Static => thing.static_state().is_some(),
            Self::Moving => thing.static_state().is_none(),
        }
    }
}

/// The one colour behind everything, where the backdrop is not drawn: transparent things show it also where it is left out.
fn behind(light: &Light, left_out: bool) -> wgpu::Color {
    let [r, g, b] = light.plain_backdrop().map(f64::from);
    wgpu::Color { r, g, b, a: if left_out { 0.0 } else { 1.0 } }
}

/// The sun's depth map.
fn draw_shadows(encoder: &mut wgpu::CommandEncoder, view: &View, things: &[&mut dyn Drawable]) {
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("shadows"),
        color_attachments: &[],
        depth_stencil_attachment: Some(depth_of(&view.shadow, wgpu::LoadOp::Clear(0.0))),
        ..wgpu::RenderPassDescriptor::default()
    });
    pass.set_bind_group(0, &view.sun_group, &[]);
    things.iter().for_each(|thing| thing.cast(&mut pass));
}

fn draw_through(gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, target: &Target, view: &View, thing: &mut dyn Drawable) {
    for (from, to) in [(&target.colour, &target.behind_colour), (&target.depth, &target.behind_depth)] {
        encoder.copy_texture_to_texture(from.as_image_copy(), to.as_image_copy(), from.size());
    }
    let textures = [&target.colour, &target.depth, &target.behind_colour, &target.behind_depth];
    let [colour, depth, behind_colour, behind_depth] = &textures.map(whole);
    let size = target.drawn_size();
    let view = &view.group;
    thing.draw_through(&mut Through { gpu, encoder, view, size, colour, depth, behind_colour, behind_depth });
}

fn whole(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// Depth that is there, or begins at 0: far.
fn depth_of(view: &wgpu::TextureView, load: wgpu::LoadOp<f32>) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load, store: wgpu::StoreOp::Store }),
        stencil_ops: None,
    }
}
