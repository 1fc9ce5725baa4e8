//! The terrain as a shaded mesh, finer near the camera.

mod field;
mod natural;
mod tiles;
mod walls;

pub use field::HeightField;
pub use natural::natural_colours;

use crate::buffer::{indices, instances, uniform};
use crate::pipeline::PipelineDescriptor;
use crate::shaders::Shader;
use crate::shared::{Ground, TileInstance, buffer_layout};
use crate::{Camera, Drawable, RenderError, Renderer, Stage, shaders, static_layer};
use corpuscle_gpu::{Gpu, GroupLayout, Image, SharedStruct, texture_2d, wgpu};
use half::f16;
use rayon::prelude::*;
use walls::Walls;

/// How much the brightness of the ground differs within a cell.
const GRAIN: f32 = 0.35;

/// The ground on the device.
#[derive(Debug)]
pub struct Terrain {
    opaque: wgpu::RenderPipeline,
    plain: wgpu::RenderPipeline,
    /// True where it is drawn without shadows and grain.
    quick: bool,
    /// Number of its appearance: a new one after each change, and for each terrain.
    state: u64,
    cast: wgpu::RenderPipeline,
    layout: GroupLayout,
    settings: Ground,
    /// Heights and slopes.
    shape: [wgpu::TextureView; 2],
    group: wgpu::BindGroup,
    index: wgpu::Buffer,
    field: HeightField,
    /// The tiles of the picture that is drawn now, and how many.
    tiles: Option<(wgpu::Buffer, u32)>,
    walls: Walls,
}

impl Terrain {
    /// Ground of a height field with a picture draped over it (of its own size or any other, rows from the north, opacity 0
    /// where there is no ground), cut off upright at its borders down to `base`, m.
    ///
    /// # Errors
    /// [`RenderError::Gpu`] for more nodes a side than a texture has pixels.
    pub fn new(
        renderer: &Renderer,
        stage: &Stage,
        field: HeightField,
        colours: &Image,
        base: f64,
    ) -> Result<Self, RenderError> {
        let gpu = renderer.gpu();
        let shader = ("terrain", include_str!("terrain.wgsl"));
        let layout = shaders::layout(gpu, "terrain", 1, &[shader]);
        let tile = TileInstance::layout();
        let attributes = tile.vertex_attributes();
        let descriptor = PipelineDescriptor {
            label: "terrain",
            shader: &Shader::new(shader.0, shader.1),
            groups: &[renderer.view_layout(), &layout],
            buffers: &[buffer_layout(&tile, wgpu::VertexStepMode::Instance, &attributes)],
            topology: wgpu::PrimitiveTopology::TriangleList,
        };
        let [x, y, _] = stage.position([field.origin[0], field.origin[1], 0.0]).into();
        let cell = field.cell.map(|length| stage.length(length));
        let settings = Ground {
            origin: [x, y, 0.0, 0.0],
            cell: [cell[0], cell[1], 0.0, GRAIN],
            nodes: [field.nodes[0] as u32, field.nodes[1] as u32, 0, 0],
        };
        let shape = [upload_heights(gpu, stage, &field)?, upload_slopes(gpu, &field)?];
        let colours = upload_colours(gpu, colours)?;
        Ok(Self {
            opaque: descriptor.opaque(gpu),
            plain: descriptor.opaque_by(gpu, "fragment_plain"),
            quick: false,
            state: static_layer::new_state(),
            cast: descriptor.cast(gpu, "throw_shadow"),
            group: group(gpu, &layout, &settings, &shape, &colours),
            layout,
            settings,
            shape,
            index: indices(gpu, "terrain", &tiles::indices()),
            walls: Walls::new(renderer, stage, &field, base),
            field,
            tiles: None,
        })
    }

    /// Drapes another picture over the ground, shown as it is: without the grain that natural ground has.
    ///
    /// # Errors
    /// [`RenderError::Gpu`] for more pixels a side than a texture has.
    pub fn drape(&mut self, gpu: &Gpu, colours: &Image) -> Result<(), RenderError> {
        self.settings.cell[3] = 0.0;
        self.state = static_layer::new_state();
        let colours = upload_colours(gpu, colours)?;
        self.group = group(gpu, &self.layout, &self.settings, &self.shape, &colours);
        Ok(())
    }

    /// Sets whether it is drawn without shadows and grain: much less work.
    pub fn draw_quickly(&mut self, quick: bool) {
        if quick != self.quick {
            self.state = static_layer::new_state();
        }
        self.quick = quick;
    }

    fn paint(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline) {
        let Some((tiles, count)) = &self.tiles else { return };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(1, &self.group, &[]);
        pass.set_vertex_buffer(0, tiles.slice(..));
        pass.set_index_buffer(self.index.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..tiles::INDICES, 0, 0..*count);
    }
}

impl Drawable for Terrain {
    fn prepare(&mut self, gpu: &Gpu, stage: &Stage, camera: &Camera, size: [u32; 2]) {
        let chosen = tiles::choose(&self.field, stage, camera, size);
        self.tiles = Some((instances(gpu, "tiles", &chosen), chosen.len() as u32));
    }

    fn static_state(&self) -> Option<u64> {
        Some(self.state)
    }

    fn cast(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.paint(pass, &self.cast);
        self.walls.cast(pass);
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.paint(pass, if self.quick { &self.plain } else { &self.opaque });
        self.walls.draw(pass);
    }
}

fn group(
    gpu: &Gpu,
    layout: &GroupLayout,
    settings: &Ground,
    [heights, slopes]: &[wgpu::TextureView; 2],
    colours: &wgpu::TextureView,
) -> wgpu::BindGroup {
    let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("terrain"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..wgpu::SamplerDescriptor::default()
    });
    let settings = uniform(gpu, "terrain", settings);
    layout.bind(
        &gpu.device,
        &[
            ("ground", settings.as_entire_binding()),
            ("heights", wgpu::BindingResource::TextureView(heights)),
            ("slopes", wgpu::BindingResource::TextureView(slopes)),
            ("colours", wgpu::BindingResource::TextureView(colours)),
            ("smooth_sampler", wgpu::BindingResource::Sampler(&sampler)),
        ],
    )
}

fn upload(
    gpu: &Gpu,
    label: &str,
    size: [u32; 2],
    format: wgpu::TextureFormat,
    bytes: &[u8],
) -> Result<wgpu::TextureView, RenderError> {
    let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
    let texture = texture_2d(gpu, label, size, format, usage)?;
    let row = bytes.len() as u32 / size[1];
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
    gpu.queue.write_texture(texture.as_image_copy(), bytes, layout, texture.size());
    Ok(texture.create_view(&wgpu::TextureViewDescriptor::default()))
}

/// Heights in stage coordinates; where there are none those nearby.
fn upload_heights(gpu: &Gpu, stage: &Stage, field: &HeightField) -> Result<wgpu::TextureView, RenderError> {
    let [x, y, _] = stage.centre().into();
    let on_stage = |height: f32| stage.position([x, y, f64::from(height)]).z;
    let heights: Vec<f32> = field.filled().into_iter().map(on_stage).collect();
    upload(gpu, "heights", field.size(), wgpu::TextureFormat::R32Float, bytemuck::cast_slice(&heights))
}

/// Slopes; beyond all bounds at nodes without height, so that all quads that meet there can be recognised.
fn upload_slopes(gpu: &Gpu, field: &HeightField) -> Result<wgpu::TextureView, RenderError> {
    let slope =
        |index: usize| if field.heights[index].is_finite() { field.slope(index) } else { [f16::MAX.to_f32(), 0.0] };
    let slopes: Vec<[u8; 4]> = (0..field.heights.len())
        .into_par_iter()
        .map(|index| {
            let [east, north] = slope(index).map(|slope| f16::from_f32(slope).to_le_bytes());
            [east[0], east[1], north[0], north[1]]
        })
        .collect();
    upload(gpu, "slopes", field.size(), wgpu::TextureFormat::Rg16Float, slopes.as_flattened())
}

/// The drape, its rows turned to begin in the south as those of heights do.
fn upload_colours(gpu: &Gpu, colours: &Image) -> Result<wgpu::TextureView, RenderError> {
    let mut rows = Vec::with_capacity(colours.rgba.len());
    colours.rgba.chunks_exact(4 * colours.width as usize).rev().for_each(|row| rows.extend_from_slice(row));
    upload(gpu, "drape", [colours.width, colours.height], wgpu::TextureFormat::Rgba8UnormSrgb, &rows)
}
