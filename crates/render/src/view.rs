//! Bindings of camera, light and the sun's depth map. Group 0 of every pipeline; in WGSL `#import view`.

use crate::shared::CameraAndLight;
use crate::{Backdrop, Camera, Lens, Light, Stage, shaders};
use corpuscle_gpu::{Gpu, GroupLayout, wgpu};
use glam::camera::rh::{proj::directx, view};
use glam::{Mat4, Vec3};

/// Pixels of the sun's depth map, each way.
pub(crate) const SHADOW_PIXELS: u32 = 4096;

/// Camera and light of one picture on the device.
#[derive(Debug)]
pub struct View {
    /// Group 0 of the pipelines that draw the picture.
    pub group: wgpu::BindGroup,
    /// Group 0 of the pipelines that draw the sun's depth map: the same from the sun.
    pub(crate) sun_group: wgpu::BindGroup,
    /// The sun's depth map.
    pub(crate) shadow: wgpu::TextureView,
    uniform: CameraAndLight,
}

impl View {
    /// Camera and light for a target of `size`, pixels. `layout` is [`crate::Renderer::view_layout`], `shadow` the sun's depth map.
    pub fn new(
        gpu: &Gpu,
        layout: &GroupLayout,
        stage: &Stage,
        camera: &Camera,
        light: &Light,
        size: [u32; 2],
        shadow: wgpu::TextureView,
    ) -> Self {
        let sun_from_world = sun_from_world(light);
        let seen = uniform(stage, camera, light, size, sun_from_world);
        let from_sun = CameraAndLight {
            clip_from_world: columns(sun_from_world),
            world_from_clip: columns(sun_from_world.inverse()),
            eye: (light.towards_sun() * 4.0).extend(0.0).into(),
            forward: (-light.towards_sun()).extend(2.0 / SHADOW_PIXELS as f32).into(),
            frame: [SHADOW_PIXELS as f32, SHADOW_PIXELS as f32, seen.frame[2], seen.frame[3]],
            ..seen
        };
        let nothing = depth_map(gpu, 1);
        let [group, sun_group] =
            [(&seen, &shadow), (&from_sun, &nothing)].map(|(uniform, shadow)| group(gpu, layout, uniform, shadow));
        Self { group, sun_group, shadow, uniform: seen }
    }

    /// The uniforms of camera, light and size.
    pub(crate) fn bytes(&self) -> &[u8] {
        bytemuck::bytes_of(&self.uniform)
    }

    /// The layout of group 0: camera and light, the sun's depth map, its comparing sampler.
    pub(crate) fn layout(gpu: &Gpu) -> GroupLayout {
        shaders::layout(gpu, "view", 0, &[("view", include_str!("view.wgsl"))])
    }
}

fn columns(matrix: Mat4) -> [[f32; 4]; 4] {
    matrix.to_cols_array_2d()
}

fn uniform(
    stage: &Stage,
    camera: &Camera,
    light: &Light,
    [width, height]: [u32; 2],
    sun_from_world: Mat4,
) -> CameraAndLight {
    let view_from_world = camera.view_from_world(stage);
    let clip_from_view = camera.clip_from_view(stage, width as f32 / height as f32);
    let (perspective, tall) = match camera.lens {
        Lens::Perspective { field_of_view } => (1.0, 2.0 * (0.5 * field_of_view as f32).tan()),
        Lens::Orthographic { height } => (0.0, stage.length(height)),
    };
    let ([above, horizon, below], kind) = match light.backdrop {
        Backdrop::Sky { above, horizon, below } => ([above, horizon, below], 0.0),
        Backdrop::Studio { above, horizon, below } => ([above, horizon, below], 1.0),
        Backdrop::Room { above, horizon, below } => ([above, horizon, below], 1.25),
        Backdrop::Paper(colour) => ([colour; 3], 2.0),
    };
    let clip_from_world = clip_from_view * view_from_world;
    CameraAndLight {
        clip_from_world: columns(clip_from_world),
        world_from_clip: columns(clip_from_world.inverse()),
        view_from_world: columns(view_from_world),
        world_from_view: columns(view_from_world.inverse()),
        clip_from_view: columns(clip_from_view),
        view_from_clip: columns(clip_from_view.inverse()),
        sun_from_world: columns(sun_from_world),
        eye: stage.position(camera.eye.into()).extend(perspective).into(),
        forward: camera.forward().extend(tall / height as f32).into(),
        sun: light.towards_sun().extend(light.softness.tan()).into(),
        sunlight: Vec3::from(light.sunlight).extend(light.ambient).into(),
        above: Vec3::from(above).extend(0.0).into(),
        horizon: Vec3::from(horizon).extend(0.0).into(),
        below: Vec3::from(below).extend(0.0).into(),
        frame: [width as f32, height as f32, stage.unit() as f32, kind],
    }
}

/// From the stage to the clip space of a picture taken from the sun that holds all of it.
fn sun_from_world(light: &Light) -> Mat4 {
    let towards = light.towards_sun();
    let up = if towards.z.abs() > 0.99 { Vec3::Y } else { Vec3::Z };
    let reach = 1.02;
    // Reversed depth: 1 is near the sun.
    directx::orthographic(-reach, reach, -reach, reach, 4.0 + reach, 4.0 - reach)
        * view::look_at_mat4(towards * 4.0, Vec3::ZERO, up)
}

/// A depth map of so many pixels each way.
pub(crate) fn depth_map(gpu: &Gpu, pixels: u32) -> wgpu::TextureView {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("sun's depth map"),
        size: wgpu::Extent3d { width: pixels, height: pixels, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: crate::DEPTH_FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn group(gpu: &Gpu, layout: &GroupLayout, uniform: &CameraAndLight, shadow: &wgpu::TextureView) -> wgpu::BindGroup {
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("view"),
        size: size_of::<CameraAndLight>() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    gpu.queue.write_buffer(&buffer, 0, bytemuck::bytes_of(uniform));
    let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("shadow"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        compare: Some(wgpu::CompareFunction::GreaterEqual),
        ..wgpu::SamplerDescriptor::default()
    });
    layout.bind(
        &gpu.device,
        &[
            ("view", buffer.as_entire_binding()),
            ("sun_depth", wgpu::BindingResource::TextureView(shadow)),
            ("sun_compare", wgpu::BindingResource::Sampler(&sampler)),
        ],
    )
}
