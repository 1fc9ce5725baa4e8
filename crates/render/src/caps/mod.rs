//! Drops on solids: caps of spheres that flow together where they come near, and fog of those too small to be seen.

mod fog;
mod neighbours;

use crate::buffer::{storage, uniform};
use crate::pipeline::PipelineDescriptor;
use crate::shaders::Shader;
use crate::shared::{CapInstance, CapUniforms};
use crate::solids::{Behind, FarSide};
use crate::{Drawable, Renderer, Stage, Through, shaders};
use corpuscle_gpu::{Gpu, GroupLayout, wgpu};
use fog::Fog;
use glam::Vec3;
use std::sync::Arc;

/// How far drops reach for each other, part of their mean radius; and the gap over which they still do, in these lengths.
const NECK: f32 = 0.12;
const GAP: f32 = 4.0;
/// Drops of smaller radius are fog, samples.
const FINEST: f32 = 1.5;

/// A drop: a cap on a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cap {
    /// Middle of the disc that it covers, m.
    pub position: [f64; 3],
    /// Radius of that disc, m.
    pub radius: f64,
    /// Outward unit normal of the surface.
    pub normal: [f64; 3],
    /// Height above the surface, m.
    pub height: f64,
}

/// A part of a surface with drops too small to be drawn one by one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FogPatch {
    /// Its middle, m.
    pub position: [f64; 3],
    /// Half its width, m.
    pub half_width: f64,
    /// Outward unit normal of the surface.
    pub normal: [f64; 3],
    /// The part of it that the drops cover.
    pub covered: f64,
}

/// Draws drops; holds the pipelines of all.
#[derive(Debug)]
pub struct CapPainter {
    tools: Arc<Tools>,
}

#[derive(Debug)]
struct Tools {
    pipeline: wgpu::RenderPipeline,
    layout: GroupLayout,
    behind: Behind,
    fog: Fog,
}

/// Drops on the device.
#[derive(Debug)]
pub struct Caps {
    tools: Arc<Tools>,
    group: wgpu::BindGroup,
    count: u32,
}

/// Fog on the far sides of glass: to be drawn before the glass, through which it is seen.
#[derive(Debug)]
pub struct FarFog {
    fog: Caps,
    sides: Vec<FarSide>,
}

/// Shaders that share the drops' group: of drops, and of the fog of the fine ones.
const SHADERS: [(&str, &str); 2] = [("caps", include_str!("caps.wgsl")), ("fog", include_str!("fog.wgsl"))];

impl CapPainter {
    /// A painter for a renderer.
    pub fn new(renderer: &Renderer) -> Self {
        let gpu = renderer.gpu();
        let [drops, _] = SHADERS;
        let (behind, layout) = (Behind::new(gpu, drops), shaders::layout(gpu, "caps", 1, &SHADERS));
        let pipeline = PipelineDescriptor {
            label: "caps",
            shader: &Shader::new(drops.0, drops.1),
            groups: &[renderer.view_layout(), &layout, &behind.layout],
            buffers: &[],
            topology: wgpu::PrimitiveTopology::TriangleStrip,
        }
        .opaque(gpu);
        let fog = Fog::new(renderer, &layout);
        Self { tools: Arc::new(Tools { pipeline, layout, behind, fog }) }
    }

    /// Drops and fog; drops without height and fog that covers nothing are left out.
    pub fn caps(
        &self,
        gpu: &Gpu,
        stage: &Stage,
        caps: impl IntoIterator<Item = Cap>,
        fog: impl IntoIterator<Item = FogPatch>,
    ) -> Caps {
        let drawn = |cap: Cap| CapInstance {
            position: stage.position(cap.position).into(),
            radius: stage.length(cap.radius),
            out: cap.normal.map(|part| part as f32),
            height: stage.length(cap.height),
            ..CapInstance::default()
        };
        let is_finite = |cap: &CapInstance| {
            let CapInstance { position, radius, out, height, .. } = cap;
            position.iter().chain(out).chain([radius, height]).all(|number| number.is_finite()) && *height > 0.0
        };
        let mut all: Vec<CapInstance> = caps.into_iter().map(drawn).filter(is_finite).collect();
        let neck = NECK * all.iter().map(|cap| cap.radius).sum::<f32>() / all.len().max(1) as f32;
        let discs: Vec<_> = all.iter().map(|cap| (Vec3::from(cap.position), cap.radius)).collect();
        let (spans, list) = neighbours::neighbours(&discs, GAP * neck);
        all.iter_mut().zip(spans).for_each(|(cap, span)| cap.neighbours = span);
        let patch = |fog: FogPatch| CapInstance {
            position: stage.position(fog.position).into(),
            // A disc of the patch's area.
            radius: stage.length(2.0 * fog.half_width / std::f64::consts::PI.sqrt()),
            out: fog.normal.map(|part| part as f32),
            height: f32::MIN_POSITIVE,
            covered: fog.covered as f32,
            ..CapInstance::default()
        };
        all.extend(fog.into_iter().map(patch).filter(is_finite).filter(|patch| patch.covered > 0.0));
        let (drops, list) = (storage(gpu, "caps", &all), storage(gpu, "caps' neighbours", &list));
        let settings = CapUniforms { neck: neck.max(1e-9), finest: FINEST, ..CapUniforms::default() };
        let settings = uniform(gpu, "caps", &settings);
        let resources = [
            ("caps", drops.as_entire_binding()),
            ("neighbours", list.as_entire_binding()),
            ("settings", settings.as_entire_binding()),
        ];
        let group = self.tools.layout.bind(&gpu.device, &resources);
        Caps { tools: self.tools.clone(), group, count: all.len() as u32 }
    }
}

impl Caps {
    /// The fog of these on the far sides of glass.
    pub fn on_far_sides(self, sides: impl IntoIterator<Item = FarSide>) -> FarFog {
        FarFog { fog: self, sides: sides.into_iter().collect() }
    }
}

impl Drawable for FarFog {
    fn lets_light_through(&self) -> bool {
        self.fog.count > 0 && !self.sides.is_empty()
    }

    fn draw_through(&mut self, frame: &mut Through<'_>) {
        let Caps { tools, group, count } = &self.fog;
        tools.fog.draw_on_far_sides(frame, &self.sides, group, *count);
    }
}

impl Drawable for Caps {
    fn lets_light_through(&self) -> bool {
        self.count > 0
    }

    fn draw_through(&mut self, frame: &mut Through<'_>) {
        self.tools.fog.draw(frame, &self.group, self.count);
        let behind = self.tools.behind.group(frame);
        let mut pass = frame.begin("caps");
        pass.set_pipeline(&self.tools.pipeline);
        pass.set_bind_group(1, &self.group, &[]);
        pass.set_bind_group(2, &behind, &[]);
        pass.draw(0..4, 0..self.count);
    }
}
