//! What is handed to the card, and what comes back when something looks.

use super::layout::{self, CardParticle, OnObstacle, Status};
use super::{Card, ground};
use crate::falling::Falling;
use crate::maps::Maps;
use crate::particle::Particle;
use crate::rain::Wetness;
use crate::structures::Flows;
use corpuscle_gpu::{GpuError, read};
use corpuscle_terrain::Terrain;

/// Water to be handed over.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Water<'a> {
    pub particles: &'a [Particle],
    /// The next step, s.
    pub step: f64,
    /// Forces at the last evaluation: from outside, and on each obstacle, m4/s2.
    pub from_outside: [f64; 2],
    pub on_obstacles: &'a [[f64; 2]],
    /// Forces on obstacles summed over time so far, m4/s, and how often a particle was put back.
    pub impulses: &'a [[f64; 2]],
    pub put_back: u64,
    /// Time, s, and steps so far.
    pub time: f64,
    pub steps: u64,
    pub next_id: u64,
    pub flows: &'a Flows,
    pub wetness: &'a Wetness,
    pub maps: &'a Maps,
    pub falling: &'a [Falling],
}

/// What the water has done to obstacles.
#[derive(Debug, Clone, Default)]
pub(crate) struct DoneToObstacles {
    /// Force on each now, over the density of water, m4/s2.
    pub forces: Vec<[f64; 2]>,
    /// Its sum over time, m4/s.
    pub impulses: Vec<[f64; 2]>,
    /// How often a particle was put back to a wall.
    pub put_back: u64,
}

impl Card {
    /// Hands the water over.
    pub fn send(&mut self, water: &Water<'_>) {
        let Water { particles, step, from_outside, on_obstacles, impulses, put_back, .. } = *water;
        self.walls.begin(&self.gpu, on_obstacles);
        self.works.begin(&self.gpu, water.flows);
        self.begin_maps(water.maps);
        if let Some(weather) = &self.weather {
            weather.begin(&self.gpu, water.wetness);
        }
        if let Some(air) = &self.air {
            air.begin(&self.gpu, water.falling, self.origin);
        }
        self.done_before = DoneToObstacles { forces: Vec::new(), impulses: impulses.to_vec(), put_back };
        let sent: Vec<CardParticle> = particles.iter().map(|particle| self.origin.to_card(particle)).collect();
        self.gpu.queue.write_buffer(&self.tasks.particles, 0, bytemuck::cast_slice(&sent));
        let corners = |pick: fn(f32, f32) -> f32, none: f32| {
            [0, 1].map(|axis| sent.iter().map(|particle| particle.place[axis]).fold(none, pick))
        };
        let sum_of_h: f64 = particles.iter().map(|particle| particle.next_h).sum();
        self.status = Status {
            particles: sent.len() as u32,
            step: step as f32,
            from_outside: from_outside.map(|value| value as f32),
            mean_h: (sum_of_h / particles.len().max(1) as f64) as f32,
            low: corners(f32::min, f32::MAX),
            high: corners(f32::max, -f32::MAX),
            next_id: water.next_id as u32,
            steps_before: water.steps as u32,
            falling: water.falling.len() as u32,
            wetted: (water.wetness.until - water.time) as f32,
            ..Status::default()
        };
        (self.steps, self.ahead, self.clock_began) = (0, false, water.time);
        // Steps begin with these anyway: what is seen before them reads them too.
        self.gpu.queue.write_buffer(&self.tasks.parameters, 0, bytemuck::bytes_of(&self.parameters));
        self.gpu.queue.write_buffer(&self.tasks.status, 0, bytemuck::bytes_of(&self.status));
    }

    /// Brings the water back, where there is any news of it.
    pub fn fetch(&mut self, particles: &mut Vec<Particle>, terrain: &Terrain) -> Result<(), GpuError> {
        if !self.ahead {
            return Ok(());
        }
        let count = self.status.particles as usize;
        let sent: Vec<CardParticle> = read(&self.gpu, &self.tasks.particles, count)?;
        particles.clear();
        particles.extend(sent.iter().map(|particle| self.origin.to_host(particle)));
        ground::complete(particles, terrain);
        self.ahead = false;
        Ok(())
    }

    /// What outflows and links owe and lead.
    pub fn flows(&self, flows: &mut Flows) -> Result<(), GpuError> {
        self.works.flows(&self.gpu, flows)
    }

    /// Water in the air.
    pub fn falling(&self, falling: &mut Vec<Falling>) -> Result<(), GpuError> {
        self.air.as_ref().map_or(Ok(()), |air| air.fetch(&self.gpu, falling, self.origin))
    }

    /// What stands on the ground and in it.
    pub fn wetness(&self, wetness: &mut Wetness) -> Result<(), GpuError> {
        let Some(weather) = &self.weather else { return Ok(()) };
        wetness.until = self.clock_began + f64::from(self.status.wetted);
        weather.fetch(&self.gpu, wetness)
    }

    /// The sum over time of the force on an obstacle along an axis, of which the card has counted `sum` and `knocks` since the water was handed
    /// over, m4/s.
    pub(super) fn impulse(&self, number: usize, axis: usize, sum: f64, knocks: i32) -> f64 {
        let knock = layout::KNOCK * f64::from(self.parameters.new_volume);
        self.done_before.impulses[number][axis] + sum + knock * f64::from(knocks)
    }

    /// What was done to obstacles.
    pub fn on_obstacles(&self) -> Result<DoneToObstacles, GpuError> {
        let count = self.walls.count;
        let pushed: Vec<OnObstacle> = read(&self.gpu, &self.walls.on_obstacles, count)?;
        let knocks: Vec<i32> = read(&self.gpu, &self.walls.knocks, 2 * count + 1)?;
        let impulse = |number: usize, axis: usize| {
            let [sum, lacking] = pushed[number].impulse[axis].map(f64::from);
            self.impulse(number, axis, sum - lacking, knocks[2 * number + axis])
        };
        let impulses = (0..count).map(|number| [0, 1].map(|axis| impulse(number, axis))).collect();
        let forces = pushed.iter().map(|pushed| pushed.force.map(f64::from)).collect();
        Ok(DoneToObstacles { forces, impulses, put_back: self.done_before.put_back + knocks[2 * count] as u64 })
    }
}
