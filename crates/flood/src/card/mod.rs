//! The flood on the graphics card: twins of scheme balanced's passes, in single precision, that leave the water where it is.
//!
//! The host says until when to go on and reads a few numbers after some steps. The state comes back when something looks at it.

mod air;
mod ground;
mod layout;
mod tasks;
mod walls;
mod weather;
mod works;

use crate::balanced;
use crate::edges::EdgeRule;
use crate::falling::Falling;
use crate::friction::Roughness;
use crate::inflow::Source;
use crate::particle::Particle;
use crate::rain::{Ground, Intensity, Wetness};
use crate::scheme::Surroundings;
use crate::structures::{Flows, Structures};
use air::Air;
use corpuscle_gpu::{Gpu, GpuError, read, wgpu};
use corpuscle_scene::Paper;
use corpuscle_terrain::{Bounds, Terrain};
use layout::{CardBirth, CardParticle, Grid, OnObstacle, Origin, Parameters, Status};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::time::Instant;
use tasks::Tasks;
use walls::Walls;
use weather::Weather;
use works::Works;

/// Size of a cell over the mean reach, as on the CPU in scheme balanced.
const CELL_OVER_REACH: f64 = 0.6;

/// The same in scheme paper.
const CELL_OVER_REACH_PAPER: f64 = 1.4;

/// The cells are laid out anew after so many steps; in between the host reads no more than it must.
const LAID_OUT: u64 = 64;

/// Cells a particle, and at least: what the sort goes through beside the particles.
const CELLS_A_PARTICLE: usize = 4;
const FEWEST_CELLS: usize = 65_536;

/// A batch of steps takes about so long at most, s: then the host looks whether it is to stop.
const BATCH: f64 = 0.2;

/// Water on a card.
#[derive(Debug)]
pub(crate) struct Card {
    gpu: Gpu,
    tasks: Tasks,
    walls: Walls,
    works: Works,
    weather: Option<Weather>,
    air: Option<Air>,
    parameters: Parameters,
    origin: Origin,
    bounds: Bounds,
    status: Status,
    /// Particles and cells that there is room for.
    room: usize,
    most_cells: usize,
    /// Steps in all, to lay the cells out at the same ones however often the host looks.
    steps: u64,
    /// The time that the clock of the device counts from, s, and how long before that it last rained, s.
    clock_began: f64,
    dry_before: f64,
    /// Steps in a batch.
    batch: u32,
    /// Whether the host has not the state that is here.
    ahead: bool,
    /// Time spent on steps, s.
    busy: f64,
    /// As it was when the water was handed over.
    done_before: DoneToObstacles,
}

/// A particle that is to come from a source.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Birth {
    /// Time from now, s.
    pub time: f64,
    pub source: usize,
    pub velocity: [f64; 2],
}

/// What the water moves in, and how.
#[derive(Clone, Copy)]
pub(crate) struct Setting<'a> {
    pub surroundings: &'a Surroundings,
    pub scheme: &'a balanced::Parameters,
    /// Scheme paper in its place, and its smoothing length at the start is `h`.
    pub paper: Option<&'a Paper>,
    /// Particles in the air.
    pub falling: usize,
    /// The longest step while any are, s.
    pub fall_step: f64,
    pub roughness: &'a Roughness,
    pub sources: &'a [Source],
    pub structures: &'a Structures,
    pub ground: Option<&'a Ground>,
    pub seed: u64,
    pub shortest_step: f64,
    /// Volume, m3, smoothing length, m, and distance, m, of new particles.
    pub volume: f64,
    pub h: f64,
    pub spacing: f64,
}

/// Births that the card can be told of at once.
pub(crate) const MOST_BIRTHS: usize = 16_384;

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

/// What a batch of steps did.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Progress {
    pub steps: u64,
    pub particle_steps: u64,
    pub elapsed: f64,
    /// The next step, s.
    pub step: f64,
    /// Volumes, m3, and momentum over density, m4/s.
    pub outflow: f64,
    pub inflow: f64,
    pub momentum_lost: f64,
    pub momentum_gained: f64,
    pub rained: f64,
    pub infiltrated: f64,
    pub from_outside: [f64; 2],
    pub mean_h: f64,
    /// How many of the births have been, and the identity of the next new particle.
    pub born: usize,
    pub next_id: u64,
    /// Whether the next step is too short to go on.
    pub broken: bool,
}

impl Progress {
    /// Nothing yet; `step` is the next one.
    pub fn none(step: f64) -> Self {
        Self {
            steps: 0,
            particle_steps: 0,
            elapsed: 0.0,
            step,
            outflow: 0.0,
            inflow: 0.0,
            momentum_lost: 0.0,
            momentum_gained: 0.0,
            rained: 0.0,
            infiltrated: 0.0,
            from_outside: [0.0; 2],
            mean_h: 0.0,
            born: 0,
            next_id: 0,
            broken: false,
        }
    }

    /// With what was done after it.
    pub fn and(self, later: Self) -> Self {
        Self {
            steps: self.steps + later.steps,
            particle_steps: self.particle_steps + later.particle_steps,
            elapsed: self.elapsed + later.elapsed,
            outflow: self.outflow + later.outflow,
            inflow: self.inflow + later.inflow,
            momentum_lost: self.momentum_lost + later.momentum_lost,
            momentum_gained: self.momentum_gained + later.momentum_gained,
            rained: self.rained + later.rained,
            infiltrated: self.infiltrated + later.infiltrated,
            born: self.born + later.born,
            ..later
        }
    }
}

impl Card {
    /// Room for `count` particles.
    pub fn new(gpu: Gpu, count: usize, setting: &Setting<'_>) -> Result<Self, GpuError> {
        let &Setting { surroundings, scheme, roughness, sources, structures, ground, .. } = setting;
        let bounds = surroundings.edges.bounds;
        let origin = Origin {
            centre: bounds.centre(),
            level: surroundings.terrain.height(bounds.centre()[0], bounds.centre()[1]),
        };
        let (nodes, patches) = ground::texture(&gpu, &surroundings.terrain, origin.level)?;
        let farthest = setting.paper.map_or(2.0 * scheme.largest_h, |paper| paper.largest_smoothing * setting.h);
        let walls = Walls::new(&gpu, &surroundings.obstacles, origin, farthest)?;
        let rain = ground.and_then(|ground| match &ground.intensity {
            Intensity::Table(table) => Some(table),
            Intensity::None | Intensity::Function(_) => None,
        });
        let works = Works::new(&gpu, surroundings, sources, structures, rain, origin, setting.h)?;
        let [west, south] = origin.relative([bounds.x_min, bounds.y_min]);
        let [east, north] = origin.relative([bounds.x_max, bounds.y_max]);
        let mut parameters = Parameters {
            bounds: [west, east, south, north],
            rules: surroundings.edges.rules.each_ref().map(rule),
            key: bytemuck::cast(ChaCha8Rng::seed_from_u64(setting.seed).get_seed()),
            walls: walls.grid,
            outlines: walls.outlines_grid,
            obstacles: walls.count as u32,
            ground_corner: origin.relative(patches.corner),
            ground_per_metre: patches.per_metre.map(|value| value as f32),
            ground_patches: patches.size.map(|nodes| nodes as u32 - 1),
            gravity: scheme.gravity as f32,
            eta: scheme.eta as f32,
            largest_h: scheme.largest_h as f32,
            viscosity: scheme.viscosity as f32,
            cfl: scheme.cfl as f32,
            longest_step: scheme.longest_step as f32,
            shortest_step: setting.shortest_step as f32,
            new_volume: setting.volume as f32,
            new_h: setting.h as f32,
            spacing: setting.spacing as f32,
            smoothing: 1.0,
            before: 0.5,
            reach_over_h: 2.0,
            in_air: setting.falling as u32,
            fall_step: setting.fall_step as f32,
            rain: works.rain,
            ..Parameters::default()
        };
        if let Some(paper) = setting.paper {
            tell_of_paper(&mut parameters, paper, setting.h);
        }
        let rough = ground::roughness(&gpu, roughness, bounds, origin, &mut parameters)?;
        let mut weather = None;
        if let Some(ground) = ground {
            weather = Some(Weather::new(&gpu, ground, count, scheme.eta, &mut parameters)?);
        }
        if setting.paper.is_some() {
            parameters.drop_h = setting.h as f32;
        }
        let air = (setting.falling > 0).then(|| Air::new(&gpu, setting.falling)).transpose()?;
        let most_cells = (CELLS_A_PARTICLE * count).max(FEWEST_CELLS);
        let tasks = Tasks::new(
            &gpu,
            count,
            most_cells,
            MOST_BIRTHS,
            [&nodes, &rough],
            &walls,
            &works,
            weather.as_ref(),
            air.as_ref(),
            setting.paper.is_some(),
        )?;
        let status = Status::default();
        Ok(Self {
            gpu,
            room: count,
            tasks,
            walls,
            works,
            weather,
            air,
            parameters,
            origin,
            bounds,
            status,
            most_cells,
            steps: 0,
            clock_began: 0.0,
            dry_before: 0.0,
            batch: 4,
            ahead: false,
            busy: 0.0,
            done_before: DoneToObstacles::default(),
        })
    }

    /// The device.
    pub fn gpu(&self) -> Gpu {
        self.gpu.clone()
    }

    /// Wall-clock time spent on steps, s.
    pub fn busy(&self) -> f64 {
        self.busy
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        self.tasks.bytes
    }

    /// Particles that there is room for.
    pub fn room(&self) -> usize {
        self.room
    }

    /// Particles in the air that there is room for.
    pub fn room_in_air(&self) -> usize {
        self.air.as_ref().map_or(0, |air| air.room)
    }

    /// Hands the water over.
    pub fn send(&mut self, water: &Water<'_>) {
        let Water { particles, step, from_outside, on_obstacles, impulses, put_back, .. } = *water;
        self.walls.begin(&self.gpu, on_obstacles);
        self.works.begin(&self.gpu, water.flows);
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

    /// Whether the room may not do for `births` more until it is time to ask again; none where it is not time to.
    pub fn lacks_room(&self, births: impl FnOnce(f64) -> usize) -> bool {
        let horizon = LAID_OUT as f64 * f64::from(self.parameters.longest_step);
        self.steps.is_multiple_of(LAID_OUT)
            && (self.status.particles + self.status.falling) as usize + births(horizon) > self.room
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

    /// What was done to obstacles.
    pub fn on_obstacles(&self) -> Result<DoneToObstacles, GpuError> {
        let count = self.walls.count;
        let pushed: Vec<OnObstacle> = read(&self.gpu, &self.walls.on_obstacles, count)?;
        let knocks: Vec<i32> = read(&self.gpu, &self.walls.knocks, 2 * count + 1)?;
        let knock = layout::KNOCK * f64::from(self.parameters.new_volume);
        let impulse = |number: usize, axis: usize| {
            let [sum, lacking] = pushed[number].impulse[axis].map(f64::from);
            self.done_before.impulses[number][axis] + sum - lacking + knock * f64::from(knocks[2 * number + axis])
        };
        let impulses = (0..count).map(|number| [0, 1].map(|axis| impulse(number, axis))).collect();
        let forces = pushed.iter().map(|pushed| pushed.force.map(f64::from)).collect();
        Ok(DoneToObstacles { forces, impulses, put_back: self.done_before.put_back + knocks[2 * count] as u64 })
    }

    /// Takes some steps from the time `now` s, up to `until` s from there or to the first after `look` s, while `births` come, the earliest
    /// first.
    pub fn advance(&mut self, now: f64, until: f64, look: f64, births: &[Birth]) -> Result<Progress, GpuError> {
        if self.steps.is_multiple_of(LAID_OUT) {
            self.lay_out()?;
            let [sum, lacking] = self.status.clock;
            self.status.wetted -= sum - lacking;
            self.status.clock = [0.0; 2];
            (self.clock_began, self.dry_before) = (now, -f64::from(self.status.wetted).min(0.0));
        }
        let births: Vec<_> = births
            .iter()
            .map(|birth| CardBirth {
                velocity: birth.velocity.map(|along| along as f32),
                time: (birth.time + now - self.clock_began) as f32,
                zone: self.works.sources[birth.source],
            })
            .collect();
        let horizon = (LAID_OUT + 1) as f64 * f64::from(self.parameters.longest_step);
        self.works.tell(&self.gpu, self.clock_began, self.dry_before, horizon);
        self.gpu.queue.write_buffer(&self.tasks.births, 0, bytemuck::cast_slice(&births));
        let to_layout = LAID_OUT - self.steps % LAID_OUT;
        let planned = (until.min(look) / f64::from(self.status.step)).ceil().clamp(1.0, LAID_OUT as f64) as u32;
        let count = planned.min(self.batch).min(to_layout as u32);
        self.status = Status {
            halted: layout::SPOKEN,
            steps_before: self.status.steps_before.wrapping_add(self.status.steps),
            steps: 0,
            particle_steps: [0; 2],
            until: until as f32,
            look: look as f32,
            births: births.len() as u32,
            born: 0,
            elapsed: [0.0; 2],
            rained: [0.0; 2],
            infiltrated: [0.0; 2],
            outflow: [0.0; 2],
            inflow: [0.0; 2],
            momentum_lost: [0.0; 2],
            momentum_gained: [0.0; 2],
            ..self.status
        };
        let began = Instant::now();
        self.gpu.queue.write_buffer(&self.tasks.status, 0, bytemuck::bytes_of(&self.status));
        let mut encoder =
            self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("flood") });
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        self.tasks.steps(&mut pass, count);
        drop(pass);
        self.gpu.queue.submit([encoder.finish()]);
        self.status = read(&self.gpu, &self.tasks.status, 1)?[0];
        let took = began.elapsed().as_secs_f64();
        self.busy += took;
        self.batch =
            if took < 0.5 * BATCH { 2 * count.max(self.batch / 2) } else { (count / 2).max(1) }.min(LAID_OUT as u32);
        self.steps += u64::from(self.status.steps);
        self.ahead |= self.status.steps > 0;
        Ok(self.progress())
    }

    fn progress(&self) -> Progress {
        let Status { steps, particle_steps: [low, high], step, halted, mean_h, .. } = self.status;
        let total = |[sum, lacking]: [f32; 2]| f64::from(sum) - f64::from(lacking);
        Progress {
            steps: u64::from(steps),
            particle_steps: (u64::from(high) << 32) + u64::from(low),
            elapsed: total(self.status.elapsed),
            step: f64::from(step),
            outflow: total(self.status.outflow),
            inflow: total(self.status.inflow),
            momentum_lost: total(self.status.momentum_lost),
            momentum_gained: total(self.status.momentum_gained),
            rained: total(self.status.rained),
            infiltrated: total(self.status.infiltrated),
            from_outside: self.status.from_outside.map(f64::from),
            mean_h: f64::from(mean_h),
            born: self.status.born as usize,
            next_id: u64::from(self.status.next_id),
            broken: halted == layout::BROKEN,
        }
    }

    /// Lays the cells over the water as it stands, as [`corpuscle_sph::Cells`] does.
    fn lay_out(&mut self) -> Result<(), GpuError> {
        let Status { low, high, mean_h, particles, .. } = self.status;
        let any = particles > 0;
        let over_reach = if self.parameters.scheme == layout::PAPER { CELL_OVER_REACH_PAPER } else { CELL_OVER_REACH };
        let cell_over_h = over_reach * f64::from(self.parameters.reach_over_h);
        let [mut low, mut high] =
            [low, high].map(|corner| corner.map(|value| if any { f64::from(value) } else { 0.0 }));
        let mut smallest = if any { cell_over_h * f64::from(mean_h) } else { self.bounds.size()[0] };
        if self.weather.is_some() || self.status.falling > 0 {
            // Drops fall anywhere.
            let [west, east, south, north] = self.parameters.bounds.map(f64::from);
            (low, high) = ([low[0].min(west), low[1].min(south)], [high[0].max(east), high[1].max(north)]);
            smallest = if any { smallest } else { cell_over_h * f64::from(self.parameters.new_h) };
        }
        let [width, height] = [0, 1].map(|axis| (high[axis] - low[axis]).max(0.0));
        let most = (self.most_cells - 1) as f64;
        let columns_and_rows = |cell: f64| [width, height].map(|length| (length / cell).floor() + 1.0);
        let mut cell = smallest;
        while columns_and_rows(cell).iter().product::<f64>() > most {
            cell *= 1.1;
        }
        let [columns, rows] = columns_and_rows(cell).map(|number| number as u32);
        self.parameters.grid = Grid {
            corner: low.map(|value| value as f32),
            cell: cell as f32,
            per_cell: (1.0 / cell) as f32,
            columns,
            rows,
            unused: [0.0; 2],
        };
        self.parameters.farthest = (2.0 * f64::from(self.parameters.largest_h) / cell) as u32 + 1;
        // One more cell holds what has left.
        self.status.cells = columns * rows + 1;
        self.gpu.queue.write_buffer(&self.tasks.parameters, 0, bytemuck::bytes_of(&self.parameters));
        self.tasks.arrange(&self.gpu, &Status { step: 0.0, ..self.status });
        let arranged: Status = read(&self.gpu, &self.tasks.status, 1)?[0];
        self.status.particles = arranged.particles;
        Ok(())
    }
}

fn rule(rule: &EdgeRule) -> u32 {
    match rule {
        EdgeRule::Wall => layout::WALL,
        EdgeRule::Periodic => layout::PERIODIC,
        EdgeRule::Open => layout::OPEN,
        EdgeRule::Stage(_) => layout::STAGE,
    }
}

/// What the shaders of scheme paper must know; `h` is the smoothing length at the start, m.
fn tell_of_paper(parameters: &mut Parameters, paper: &Paper, h: f64) {
    let widest = paper.largest_smoothing * h;
    *parameters = Parameters {
        scheme: layout::PAPER,
        before: 0.0,
        reach_over_h: 1.0,
        smoothing: 0.5,
        // A kernel reaches twice that far.
        largest_h: (0.5 * widest) as f32,
        longest_step: paper.time_step_s as f32,
        rest_density: paper.density_kg_per_m3 as f32,
        gas_constant: paper.gas_constant as f32,
        paper_viscosity: paper.viscosity as f32,
        clips_pressure: u32::from(paper.clip_negative_pressure),
        control: u32::from(paper.control_force),
        control_strength: paper.control_strength as f32,
        control_square: paper.control_square as f32,
        first_h: h as f32,
        widest_h: widest as f32,
        ..*parameters
    };
}
