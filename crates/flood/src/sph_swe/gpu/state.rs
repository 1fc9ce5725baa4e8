//! Upload of the state to the GPU, and its download on demand.

use super::super::maps::Maps;
use super::OnGpu;
use super::shared::{Drop, FALLS, GONE, KNOCK, OnObstacle, Packed, Status};
use crate::sph_swe::falling::Falling;
use crate::sph_swe::ground::upload::complete;
use crate::sph_swe::particle::Particle;
use corpuscle_gpu::{GpuError, from_pair, read};
use corpuscle_terrain::Terrain;

/// Water to be uploaded.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Water<'a> {
    pub particles: &'a [Particle],
    /// The next step, s.
    pub step: f64,
    /// Forces at the last evaluation: of ground, edges and obstacles, and on each obstacle, m4/s2.
    pub external: [f64; 2],
    pub on_obstacles: &'a [[f64; 2]],
    /// Forces on obstacles summed over time so far, m4/s, and how often a particle was put back.
    pub impulses: &'a [[f64; 2]],
    pub put_back: u64,
    /// Time, s.
    pub time: f64,
    pub next_id: u64,
    pub maps: &'a Maps,
    pub falling: &'a [Falling],
}

/// What the water has done to obstacles.
#[derive(Debug, Clone, Default)]
pub(crate) struct ObstacleTotals {
    /// Force on each now, over the density of water, m4/s2.
    pub forces: Vec<[f64; 2]>,
    /// Its sum over time, m4/s.
    pub impulses: Vec<[f64; 2]>,
    /// How often a particle was put back to a wall.
    pub put_back: u64,
}

impl OnGpu {
    /// Hands the water over.
    pub fn upload(&mut self, water: &Water<'_>) {
        let Water { particles, step, external, on_obstacles, impulses, put_back, falling, .. } = *water;
        let memory = &self.tasks.memory;
        let gpu = self.gpu().clone();
        let write = |buffer, bytes: &[u8]| gpu.queue.write_buffer(buffer, 0, bytes);
        write(&memory.obstacles, bytemuck::cast_slice(&self.obstacles.packed(on_obstacles)));
        write(&memory.knocks, bytemuck::cast_slice(&vec![0_i32; 2 * self.obstacles.count + 1]));
        let mut drops: Vec<Drop> = falling.iter().map(|drop| self.origin.drop(drop)).collect();
        drops.resize(self.room_in_air, Drop { state: GONE, ..Drop::default() });
        write(&memory.drops, bytemuck::cast_slice(&drops));
        let sent: Vec<Packed> = particles.iter().map(|particle| self.origin.packed(particle)).collect();
        write(&memory.particles, bytemuck::cast_slice(&sent));
        self.upload_maps(water.maps);
        self.totals_before = ObstacleTotals { forces: Vec::new(), impulses: impulses.to_vec(), put_back };
        let corners = |pick: fn(f32, f32) -> f32, none: f32| {
            [0, 1].map(|axis| sent.iter().map(|particle| particle.position_and_velocity[axis]).fold(none, pick))
        };
        let sum_of_h: f64 = particles.iter().map(|particle| particle.next_h).sum();
        self.status = Status {
            particles: sent.len() as u32,
            step: step as f32,
            outer_force: external.map(|value| value as f32),
            mean_h: (sum_of_h / particles.len().max(1) as f64) as f32,
            low: corners(f32::min, f32::MAX),
            high: corners(f32::max, -f32::MAX),
            next_id: water.next_id as u32,
            falling: falling.len() as u32,
            ..Status::default()
        };
        (self.steps, self.ahead, self.clock_began) = (0, false, water.time);
        // Steps begin with this anyway: what is seen before them reads it too.
        write(&memory.status, bytemuck::bytes_of(&self.status));
    }

    /// Brings the particles back, where there is any news of them.
    pub async fn download(&mut self, particles: &mut Vec<Particle>, terrain: &Terrain) -> Result<(), GpuError> {
        if !self.ahead {
            return Ok(());
        }
        let sent: Vec<Packed> = read(self.gpu(), &self.tasks.memory.particles, self.status.particles as usize).await?;
        particles.clear();
        particles.extend(sent.iter().map(|particle| self.origin.unpacked(particle)));
        complete(particles, terrain);
        self.ahead = false;
        Ok(())
    }

    /// Brings back what still falls.
    pub async fn falling(&self) -> Result<Vec<Falling>, GpuError> {
        if self.room_in_air == 0 {
            return Ok(Vec::new());
        }
        let drops: Vec<Drop> = read(self.gpu(), &self.tasks.memory.drops, self.room_in_air).await?;
        Ok(drops.iter().filter(|drop| drop.state == FALLS).map(|drop| self.origin.falling(drop)).collect())
    }

    /// The sum over time of the force on an obstacle along an axis, of which the GPU has counted `sum` and `knocks` since the upload of the water, m4/s.
    pub(in crate::sph_swe) fn impulse(&self, number: usize, axis: usize, sum: f64, knocks: i32) -> f64 {
        let knock = f64::from(KNOCK) * f64::from(self.parameters.new_volume);
        self.totals_before.impulses[number][axis] + sum + knock * f64::from(knocks)
    }

    /// What was done to obstacles.
    pub async fn on_obstacles(&self) -> Result<ObstacleTotals, GpuError> {
        let (count, memory) = (self.obstacles.count, &self.tasks.memory);
        let pushed: Vec<OnObstacle> = read(self.gpu(), &memory.obstacles, count).await?;
        let knocks: Vec<i32> = read(self.gpu(), &memory.knocks, 2 * count + 1).await?;
        let impulses = pushed.iter().enumerate().map(|(number, pushed)| {
            let sums = [pushed.impulse_east, pushed.impulse_north].map(from_pair);
            [0, 1].map(|axis| self.impulse(number, axis, sums[axis], knocks[2 * number + axis]))
        });
        let forces = pushed.iter().map(|pushed| pushed.force.map(f64::from)).collect();
        let put_back = self.totals_before.put_back + knocks[2 * count] as u64;
        Ok(ObstacleTotals { forces, impulses: impulses.collect(), put_back })
    }
}
