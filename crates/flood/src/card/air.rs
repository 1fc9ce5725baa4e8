//! Water in the air, as the shaders have it.

use super::layout::{CardDrop, Origin};
use crate::falling::Falling;
use crate::particle::Particle;
use corpuscle_gpu::{Gpu, GpuError, read, storage, wgpu};

/// Bytes before the drops.
const HEADER: usize = 8;

/// Bytes where there can be none: a binding has room for one drop.
pub(super) const NO_AIR: usize = HEADER + size_of::<CardDrop>();

/// Water in the air on the device.
#[derive(Debug)]
pub(super) struct Air {
    pub buffer: wgpu::Buffer,
    pub room: usize,
}

impl Air {
    /// For `room` particles at most.
    pub fn new(gpu: &Gpu, room: usize) -> Result<Self, GpuError> {
        let bytes = HEADER + room * size_of::<CardDrop>();
        Ok(Self { buffer: storage::<u8>(gpu, "water in the air", bytes)?, room })
    }

    /// Hands over what falls.
    pub fn begin(&self, gpu: &Gpu, falling: &[Falling], origin: Origin) {
        let mut sent: Vec<CardDrop> = falling.iter().map(|drop| to_card(drop, origin)).collect();
        sent.resize(self.room, CardDrop { is_up: 0, ..bytemuck::Zeroable::zeroed() });
        gpu.queue.write_buffer(&self.buffer, HEADER as u64, bytemuck::cast_slice(&sent));
    }

    /// Brings back what still falls.
    pub fn fetch(&self, gpu: &Gpu, falling: &mut Vec<Falling>, origin: Origin) -> Result<(), GpuError> {
        let bytes: Vec<u8> = read(gpu, &self.buffer, HEADER + self.room * size_of::<CardDrop>())?;
        let drops: Vec<CardDrop> = bytemuck::pod_collect_to_vec(&bytes[HEADER..]);
        falling.clear();
        falling.extend(drops.iter().filter(|drop| drop.is_up == 1).map(|drop| to_host(drop, origin)));
        Ok(())
    }
}

fn to_card(drop: &Falling, origin: Origin) -> CardDrop {
    let Particle { x, y, u, v, volume, h, id, .. } = drop.particle;
    CardDrop {
        place: origin.relative([x, y]),
        velocity: [u as f32, v as f32],
        z: (drop.z - origin.level) as f32,
        w: drop.w as f32,
        volume: volume as f32,
        h: h as f32,
        id: id as u32,
        is_up: 1,
    }
}

fn to_host(drop: &CardDrop, origin: Origin) -> Falling {
    let [x, y] = [0, 1].map(|axis| f64::from(drop.place[axis]) + origin.centre[axis]);
    let mut particle = Particle::new(u64::from(drop.id), x, y, f64::from(drop.volume), f64::from(drop.h));
    [particle.u, particle.v] = drop.velocity.map(f64::from);
    Falling { particle, z: f64::from(drop.z) + origin.level, w: f64::from(drop.w) }
}
