//! The ground under the water, and the water's faces at its borders.

use super::shared::NO_HEIGHT;
use crate::shared::Vertex;
use crate::{HeightField, Stage};
use corpuscle_gpu::{Gpu, GpuError, storage, wgpu};
use glam::DVec2;

/// The ground's nodes on the device.
#[derive(Debug)]
pub(super) struct Ground {
    /// From the middle of the stage, m.
    pub heights: wgpu::Buffer,
    /// South-west node from there, m; nodes per metre; nodes `[eastwards, northwards]`.
    pub corner: DVec2,
    pub per_metre: DVec2,
    pub nodes: [u32; 2],
    /// The water's level at the nodes of the borders, stage units, and the faces there.
    pub levels: wgpu::Buffer,
    pub faces: wgpu::Buffer,
}

impl Ground {
    pub fn new(gpu: &Gpu, stage: &Stage, field: &HeightField) -> Result<Self, GpuError> {
        let middle = stage.centre();
        let known = |height: &f32| match f64::from(*height) - middle.z {
            height if height.is_finite() => height as f32,
            _ => NO_HEIGHT,
        };
        let known: Vec<f32> = field.heights.iter().map(known).collect();
        let heights = storage::<f32>(gpu, "heights of the ground", known.len())?;
        gpu.queue.write_buffer(&heights, 0, bytemuck::cast_slice(&known));
        let at_borders = 2 * (field.nodes[0] + field.nodes[1]);
        Ok(Self {
            heights,
            corner: DVec2::from(field.origin) - middle.truncate(),
            per_metre: 1.0 / DVec2::from(field.cell),
            nodes: field.nodes.map(|count| count as u32),
            levels: storage::<f32>(gpu, "levels of water", at_borders)?,
            faces: storage::<[Vertex; 6]>(gpu, "sides of water", at_borders)?,
        })
    }

    /// Nodes of the four borders.
    pub fn border_nodes(&self) -> u32 {
        2 * (self.nodes[0] + self.nodes[1])
    }
}
