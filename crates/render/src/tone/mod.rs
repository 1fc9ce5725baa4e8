//! From linear light to the bytes of a picture.

use crate::buffer::uniform;
use crate::formats::PICTURE_FORMAT;
use crate::pipeline::PipelineDescriptor;
use crate::shaders::Shader;
use crate::shared::Tone as Settings;
use crate::{Target, shaders};
use corpuscle_gpu::{Gpu, GroupLayout, Image, texture_2d, wgpu};

/// Averages samples, compresses highlights, and lays the overlay over.
#[derive(Debug)]
pub(crate) struct Tone {
    pipeline: wgpu::RenderPipeline,
    layout: GroupLayout,
}

impl Tone {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let shader = ("tone", include_str!("tone.wgsl"));
        let layout = shaders::layout(gpu, "tone", 0, &[shader]);
        let descriptor = PipelineDescriptor {
            label: "tone",
            shader: &Shader::new(shader.0, shader.1),
            groups: &[&layout],
            buffers: &[],
            topology: wgpu::PrimitiveTopology::TriangleList,
        };
        Self { pipeline: descriptor.flat(gpu, PICTURE_FORMAT), layout }
    }

    /// Draws the finished picture. `pressed` is false where colours are to stay as they are. The overlay has the picture's size and its
    /// opacity multiplied in.
    pub(crate) fn draw(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        target: &Target,
        pressed: bool,
        overlay: Option<&Image>,
    ) {
        let overlay = overlay.filter(|image| [image.width, image.height] == target.size);
        let group = self.group(gpu, target, pressed, overlay);
        let view = target.picture.create_view(&wgpu::TextureViewDescriptor::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("tone"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations::default(),
            })],
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }

    fn group(&self, gpu: &Gpu, target: &Target, pressed: bool, overlay: Option<&Image>) -> wgpu::BindGroup {
        let settings = Settings {
            samples: target.samples,
            pressed: u32::from(pressed),
            overlay: u32::from(overlay.is_some()),
            transparent: u32::from(target.transparent),
        };
        let buffer = uniform(gpu, "tone", &settings);
        let nothing = Image { width: 1, height: 1, rgba: vec![0; 4] };
        let colour = target.colour.create_view(&wgpu::TextureViewDescriptor::default());
        let overlay = upload(gpu, overlay.unwrap_or(&nothing));
        let resources = [
            ("tone", buffer.as_entire_binding()),
            ("light", wgpu::BindingResource::TextureView(&colour)),
            ("overlay", wgpu::BindingResource::TextureView(&overlay)),
        ];
        self.layout.bind(&gpu.device, &resources)
    }
}

/// An image of at most a target's size on the device.
fn upload(gpu: &Gpu, image: &Image) -> wgpu::TextureView {
    let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
    let size = [image.width, image.height];
    let texture = texture_2d(gpu, "overlay", size, wgpu::TextureFormat::Rgba8Unorm, usage);
    let texture = texture.expect("no larger than the target, which is there");
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * image.width), rows_per_image: None };
    gpu.queue.write_texture(texture.as_image_copy(), &image.rgba, layout, texture.size());
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
