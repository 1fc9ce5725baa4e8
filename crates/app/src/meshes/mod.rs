//! Draws the toolkit's meshes, where software stands in for a GPU.
//!
//! The toolkit's own shader filters images in two ways and takes one; software computes both, one of them with whole-number division,
//! and half of the time of a picture went there (`docs/src/benchmarks.md`, "The window"). Here the same triangles go through a
//! shader that does what is wanted alone. On a GPU nothing of this is used.

mod pipelines;
mod shared;

use corpuscle::gpu::{Gpu, GpuKind, wgpu};
use egui::epaint::{ClippedShape, ImageData, ImageDelta, Primitive};
use egui::{Context, FullOutput, PaintCallbackInfo, Rect, Shape, TextureId};
use egui_wgpu::{Callback, CallbackResources, CallbackTrait};
use pipelines::{Image, Pipelines};
use shared::MeshVertex;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// Images that hold letters and the white of plain grounds.
const LETTERS: TextureId = TextureId::Managed(0);

/// A plugin that takes the toolkit's shapes before it draws them, and draws them itself.
pub struct Meshes {
    gpu: Gpu,
    pipelines: Arc<Pipelines>,
    images: HashMap<TextureId, Image>,
    /// Images to be freed after the next picture.
    gone: Vec<TextureId>,
    vertices: Room,
    indices: Room,
}

/// Memory on the device that grows.
struct Room {
    usage: wgpu::BufferUsages,
    buffer: Option<wgpu::Buffer>,
}

/// Triangles between two things that others draw.
struct Drawn {
    pipelines: Arc<Pipelines>,
    window: wgpu::BindGroup,
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    meshes: Vec<Part>,
}

/// Triangles with one image, within a part of the window (pixels: left, top, width, height).
struct Part {
    within: [u32; 4],
    image: Arc<wgpu::BindGroup>,
    letters: bool,
    indices: Range<u32>,
    first_vertex: i32,
}

/// Buffers of a picture's triangles: vertices, indices, and the parts.
#[derive(Default)]
struct Gathered {
    vertices: Vec<MeshVertex>,
    indices: Vec<u32>,
    /// Parts in a row, and what others draw after them.
    runs: Vec<(Vec<Part>, Option<ClippedShape>)>,
}

impl Meshes {
    /// For a window that is drawn in a format of sRGB bytes; none where the window takes linear light, or a GPU draws it.
    pub fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Option<Self> {
        let software = gpu.kind == GpuKind::Software;
        (software && !format.is_srgb()).then(|| Self {
            gpu: gpu.clone(),
            pipelines: Arc::new(Pipelines::new(&gpu.device, format)),
            images: HashMap::new(),
            gone: Vec::new(),
            vertices: Room { usage: wgpu::BufferUsages::VERTEX, buffer: None },
            indices: Room { usage: wgpu::BufferUsages::INDEX, buffer: None },
        })
    }

    fn take_images(&mut self, output: &FullOutput) {
        for id in self.gone.drain(..) {
            self.images.remove(&id);
        }
        for (id, changes) in &output.textures_delta.set {
            for change in changes {
                self.change_image(*id, change);
            }
        }
        self.gone.extend(&output.textures_delta.free);
    }

    fn change_image(&mut self, id: TextureId, change: &ImageDelta) {
        let ImageData::Color(pixels) = &change.image;
        let [width, height] = pixels.size.map(|length| length as u32);
        let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        if change.pos.is_none() {
            let image = self.pipelines.image(&self.gpu.device, size, change.options.magnification);
            self.images.insert(id, image);
        }
        let Some(image) = self.images.get(&id) else { return };
        let [x, y] = change.pos.unwrap_or_default().map(|along| along as u32);
        let part =
            wgpu::TexelCopyTextureInfo { origin: wgpu::Origin3d { x, y, z: 0 }, ..image.texture.as_image_copy() };
        let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None };
        self.gpu.queue.write_texture(part, bytemuck::cast_slice(&pixels.pixels), rows, size);
    }

    /// The triangles of shapes, and between them what others draw.
    fn gather(&self, context: &Context, shapes: Vec<ClippedShape>, scale: f32, size: [u32; 2]) -> Gathered {
        let mut gathered = Gathered::default();
        let mut parts = Vec::new();
        let mut waiting: Vec<ClippedShape> = Vec::new();
        for shape in shapes {
            if matches!(shape.shape, Shape::Callback(_)) {
                self.add(context, std::mem::take(&mut waiting), scale, size, &mut gathered, &mut parts);
                gathered.runs.push((std::mem::take(&mut parts), Some(shape)));
            } else {
                waiting.push(shape);
            }
        }
        self.add(context, waiting, scale, size, &mut gathered, &mut parts);
        gathered.runs.push((parts, None));
        gathered
    }

    fn add(
        &self,
        context: &Context,
        shapes: Vec<ClippedShape>,
        scale: f32,
        size: [u32; 2],
        gathered: &mut Gathered,
        parts: &mut Vec<Part>,
    ) {
        for clipped in context.tessellate(shapes, scale) {
            let Primitive::Mesh(mesh) = clipped.primitive else { continue };
            let Some(image) = self.images.get(&mesh.texture_id) else { continue };
            let Some(within) = pixels_within(clipped.clip_rect, scale, size) else { continue };
            let first_index = gathered.indices.len() as u32;
            parts.push(Part {
                within,
                image: image.group.clone(),
                letters: mesh.texture_id == LETTERS,
                indices: first_index..first_index + mesh.indices.len() as u32,
                first_vertex: gathered.vertices.len() as i32,
            });
            gathered.indices.extend(&mesh.indices);
            gathered.vertices.extend(mesh.vertices.iter().map(MeshVertex::from));
        }
    }
}

impl egui::Plugin for Meshes {
    fn debug_name(&self) -> &'static str {
        "meshes"
    }

    fn output_hook(&mut self, context: &Context, output: &mut FullOutput) {
        self.take_images(output);
        let scale = output.pixels_per_point;
        let whole = context.viewport_rect();
        let size = [whole.width(), whole.height()].map(|length| (length * scale).round() as u32);
        let gathered = self.gather(context, std::mem::take(&mut output.shapes), scale, size);
        let gpu = &self.gpu;
        let vertices = self.vertices.filled(gpu, bytemuck::cast_slice(&gathered.vertices));
        let indices = self.indices.filled(gpu, bytemuck::cast_slice(&gathered.indices));
        let window = self.pipelines.window(gpu, [whole.width(), whole.height()]);
        for (meshes, other) in gathered.runs {
            let pipelines = self.pipelines.clone();
            let drawn = Drawn {
                pipelines,
                window: window.clone(),
                vertices: vertices.clone(),
                indices: indices.clone(),
                meshes,
            };
            if !drawn.meshes.is_empty() {
                let shape = Shape::Callback(Callback::new_paint_callback(whole, drawn));
                output.shapes.push(ClippedShape::new(whole, shape));
            }
            output.shapes.extend(other);
        }
    }
}

/// A part of the window in pixels; none where nothing of it is seen.
fn pixels_within(clip: Rect, scale: f32, [width, height]: [u32; 2]) -> Option<[u32; 4]> {
    let pixel = |along: f32, most: u32| (along * scale).round().clamp(0.0, most as f32) as u32;
    let [left, right] = [clip.min.x, clip.max.x].map(|x| pixel(x, width));
    let [top, bottom] = [clip.min.y, clip.max.y].map(|y| pixel(y, height));
    (left < right && top < bottom).then(|| [left, top, right - left, bottom - top])
}

impl Room {
    /// The memory with bytes in it.
    fn filled(&mut self, gpu: &Gpu, bytes: &[u8]) -> wgpu::Buffer {
        let enough = |buffer: &wgpu::Buffer| buffer.size() >= bytes.len() as u64;
        let buffer = self.buffer.take().filter(enough).unwrap_or_else(|| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("meshes"),
                size: (bytes.len() as u64).next_power_of_two().max(1 << 16),
                usage: self.usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        });
        gpu.queue.write_buffer(&buffer, 0, bytes);
        self.buffer.insert(buffer).clone()
    }
}

impl CallbackTrait for Drawn {
    fn paint(&self, info: PaintCallbackInfo, pass: &mut wgpu::RenderPass<'static>, _resources: &CallbackResources) {
        let [width, height] = info.screen_size_px;
        pass.set_bind_group(0, &self.window, &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        let mut letters = None;
        for part in &self.meshes {
            let [left, top, wide, tall] = part.within;
            // The window may have shrunk since.
            if left + wide > width || top + tall > height {
                continue;
            }
            if letters != Some(part.letters) {
                let Pipelines { letters, images, .. } = &*self.pipelines;
                pass.set_pipeline(if part.letters { letters } else { images });
            }
            letters = Some(part.letters);
            pass.set_scissor_rect(left, top, wide, tall);
            pass.set_bind_group(1, &*part.image, &[]);
            pass.draw_indexed(part.indices.clone(), part.first_vertex, 0..1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    #[test]
    fn what_lies_outside_of_the_window_is_not_drawn() {
        let clip = |x: [f32; 2], y: [f32; 2]| Rect::from_min_max(pos2(x[0], y[0]), pos2(x[1], y[1]));
        assert_eq!(pixels_within(clip([-5.0, 10.4], [2.0, 900.0]), 1.0, [100, 80]), Some([0, 2, 10, 78]));
        assert_eq!(pixels_within(clip([1.0, 2.0], [1.0, 3.0]), 1.5, [100, 80]), Some([2, 2, 1, 3]));
        assert_eq!(pixels_within(clip([120.0, 130.0], [1.0, 3.0]), 1.0, [100, 80]), None);
        assert_eq!(pixels_within(Rect::NOTHING, 1.0, [100, 80]), None);
    }
}
