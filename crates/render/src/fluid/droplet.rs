//! Particles of a fluid, as they are drawn.

use crate::Stage;
use crate::buffer::{filled, storage};
use crate::shared::{DropletInstance, SPLAT_COUNT, SPLAT_GROUP};
use corpuscle_gpu::{Gpu, wgpu};
use glam::{DVec2, DVec3};

/// Drawn particles have their ids modulo it, by which tests tell them apart.
pub(super) const DRAWN_NUMBERS: u32 = 4096;

/// A particle of a fluid, as it is drawn: a ball, or flattened along a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Droplet {
    /// Its middle, m.
    pub position: [f64; 3],
    /// Radius, across `normal` where it is flattened, m.
    pub radius: f64,
    /// The direction along which it is flattened, of length 1.
    pub normal: [f64; 3],
    /// Thickness over width: 1 for a ball.
    pub flatness: f64,
    /// Water in it where it stands for a column: its volume, m3, spread over `reach` as its kernel has it. 0 for a ball, whose
    /// own thickness counts.
    pub volume: f64,
    /// How far the volume is spread, m.
    pub reach: f64,
    /// Foam on it: 0 none, 1 white.
    pub foam: f64,
    /// Velocity eastwards and northwards, m/s.
    pub flow: [f64; 2],
    /// Its number.
    pub id: u64,
}

impl Droplet {
    /// A ball.
    pub fn ball(position: [f64; 3], radius: f64) -> Self {
        let (normal, flow) = ([0.0, 0.0, 1.0], [0.0; 2]);
        Self { position, radius, normal, flatness: 1.0, volume: 0.0, reach: radius, foam: 0.0, flow, id: 0 }
    }

    /// Height of its upper side beside its middle by this much `[eastwards, northwards]`, m, as if it went on flat.
    pub(super) fn level(&self, away: DVec2) -> f64 {
        let normal = DVec3::from(self.normal);
        let top = normal * self.flatness * self.radius;
        self.position[2] + top.z - normal.truncate().dot(away - top.truncate()) / normal.z.max(1e-3)
    }

    /// As the device has it; none where a number is not finite.
    pub(super) fn drawn(&self, stage: &Stage) -> Option<DropletInstance> {
        // Poly6 in the plane is 4 / (pi h^2) in its middle (Mueller, Charypar and Gross 2003).
        let depth = 4.0 * self.volume / (std::f64::consts::PI * self.reach * self.reach);
        let drawn = DropletInstance {
            position: stage.position(self.position).into(),
            radius: stage.length(self.radius),
            normal: DVec3::from(self.normal).normalize_or(DVec3::Z).as_vec3().into(),
            flatness: self.flatness as f32,
            matter: [
                depth as f32,
                self.foam as f32,
                stage.length(self.reach),
                (self.id % u64::from(DRAWN_NUMBERS)) as f32,
            ],
            flow: self.flow.map(|along| along as f32),
            unused: [0.0; 2],
        };
        let all: &[f32] = bytemuck::cast_slice(std::slice::from_ref(&drawn));
        all.iter().all(|number| number.is_finite()).then_some(drawn)
    }
}

/// Particles on the device that are drawn in one go.
#[derive(Debug, Clone)]
pub(super) enum Batch {
    /// A known number, which is in `draw_args` too, at [`COUNT`].
    Counted { instances: wgpu::Buffer, draw_args: wgpu::Buffer, count: u32 },
    /// A number known on the GPU: from byte `at` of `draw_args` the arguments of an indirect draw, from byte `splats` those of an
    /// indirect dispatch that splats them, and their number at [`COUNT`].
    Indirect { instances: wgpu::Buffer, draw_args: wgpu::Buffer, at: u64, splats: u64 },
}

/// See [`SPLAT_COUNT`].
const COUNT: usize = SPLAT_COUNT as usize;

impl Batch {
    /// These.
    pub fn counted(gpu: &Gpu, all: &[DropletInstance]) -> Self {
        let count = all.len() as u32;
        let usage = wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::STORAGE;
        let instances = filled(gpu, "droplets", bytemuck::cast_slice(all), usage);
        let mut draw_args = [0; COUNT + 1];
        draw_args[COUNT] = count;
        Self::Counted { instances, draw_args: storage(gpu, "how many droplets", &draw_args), count }
    }

    /// The particles, and the buffer with their number at [`COUNT`].
    pub fn buffers(&self) -> [&wgpu::Buffer; 2] {
        match self {
            Self::Counted { instances, draw_args, .. } | Self::Indirect { instances, draw_args, .. } => {
                [instances, draw_args]
            }
        }
    }

    /// Runs a kernel with a thread for each.
    pub fn splat(&self, pass: &mut wgpu::ComputePass<'_>) {
        match self {
            Self::Counted { count, .. } => pass.dispatch_workgroups(count.div_ceil(SPLAT_GROUP), 1, 1),
            Self::Indirect { draw_args, splats, .. } => pass.dispatch_workgroups_indirect(draw_args, *splats),
        }
    }

    /// Draws a quad for each.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        match self {
            Self::Counted { instances, count, .. } => {
                pass.set_vertex_buffer(0, instances.slice(..));
                pass.draw(0..4, 0..*count);
            }
            Self::Indirect { instances, draw_args, at, .. } => {
                pass.set_vertex_buffer(0, instances.slice(..));
                pass.draw_indirect(draw_args, *at);
            }
        }
    }
}
