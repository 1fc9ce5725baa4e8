//! Pictures laid into a pass of others, such as that of a window.
//!
//! A toolkit's own shader for images filters in two ways and takes one; software in place of a GPU computes both, and took ten
//! times as long. A picture that was drawn quickly comes from its linear light without a finished picture in between.

use crate::shaders::Shader;
use crate::{Target, shaders};
use corpuscle_gpu::{Gpu, GpuError, GroupLayout, Image, texture_2d, wgpu};

/// Lays pictures into passes that draw into one format; holds the pipelines of all.
#[derive(Debug)]
pub struct InlayPainter {
    finished: wgpu::RenderPipeline,
    light: wgpu::RenderPipeline,
    pressed: wgpu::RenderPipeline,
    layout: GroupLayout,
}

/// A picture on the device, ready to be laid into a pass.
#[derive(Debug, Clone)]
pub struct Inlay {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
}

impl InlayPainter {
    /// A painter for passes of a format.
    pub fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Self {
        let shader = ("inlay", include_str!("inlay.wgsl"));
        let layout = shaders::layout(gpu, "inlay", 0, &[shader]);
        let whole = Shader::new(shader.0, shader.1);
        let build = |entry, pressed| pipeline(gpu, &whole, &layout, format, entry, pressed);
        Self {
            finished: build("fragment_finished", false),
            light: build("fragment_light", false),
            pressed: build("fragment_light", true),
            layout,
        }
    }

    /// The finished picture of a target ([`Renderer::draw`](crate::Renderer::draw)), as it is in files.
    pub fn finished(&self, gpu: &Gpu, target: &Target) -> Inlay {
        self.inlay(gpu, &self.finished, &target.picture)
    }

    /// The light in a target with one sample a pixel ([`Renderer::draw_light`](crate::Renderer::draw_light)): highlights pressed, or
    /// colours as they are; edges stay hard.
    pub fn light(&self, gpu: &Gpu, target: &Target, pressed: bool) -> Inlay {
        self.inlay(gpu, if pressed { &self.pressed } else { &self.light }, &target.colour)
    }

    /// A picture in main memory, such as one that another device drew.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`].
    pub fn image(&self, gpu: &Gpu, image: &Image) -> Result<Inlay, GpuError> {
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let size = [image.width, image.height];
        let texture = texture_2d(gpu, "picture", size, wgpu::TextureFormat::Rgba8Unorm, usage)?;
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * image.width), rows_per_image: None };
        gpu.queue.write_texture(texture.as_image_copy(), &image.rgba, layout, texture.size());
        Ok(self.inlay(gpu, &self.finished, &texture))
    }

    fn inlay(&self, gpu: &Gpu, pipeline: &wgpu::RenderPipeline, texture: &wgpu::Texture) -> Inlay {
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let group = self.layout.bind(&gpu.device, &[("picture", wgpu::BindingResource::TextureView(&view))]);
        Inlay { pipeline: pipeline.clone(), group }
    }
}

impl Inlay {
    /// Fills the pass's viewport with the picture.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// A device compiles the same one once.
fn pipeline(
    gpu: &Gpu,
    shader: &Shader<'_>,
    layout: &GroupLayout,
    format: wgpu::TextureFormat,
    entry: &str,
    pressed: bool,
) -> wgpu::RenderPipeline {
    gpu.drawing(format!("{entry} {format:?} {pressed} {}", shader.text), |_| {
        let constants = [("pressed", f64::from(u8::from(pressed))), ("linear", f64::from(u8::from(format.is_srgb())))];
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("inlay"),
            bind_group_layouts: &[Some(layout.layout())],
            immediate_size: 0,
        });
        let module = shader.module(gpu);
        gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("inlay"),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
                targets: &[Some(format.into())],
            }),
            multiview_mask: None,
            cache: None,
        })
    })
}
