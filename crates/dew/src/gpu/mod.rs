//! Humid air on the GPU: twins of the passes of a step, in single precision, that leave the air where it is.
//!
//! The host says until when to go on and reads a few numbers after some steps. The state is downloaded on demand. Drops
//! stay with the host: they are few, each sticks, merges or runs by itself, and they only need
//! water the solids have gained once in some steps.
//!
//! What single precision is spent on: see `shared.rs`.

mod inputs;
mod measure;
mod numbers;
mod seen;
mod tasks;

pub(crate) use inputs::GpuInputs;
#[cfg(test)]
pub(crate) use numbers::FINE_CELLS_MIN_PARTICLES;
#[cfg(test)]
pub(crate) use tasks::pieces;

use crate::faces::OpenSide;
use crate::origin::Origin;
use crate::room::InflowsOverTime;
use crate::shared::{self, OutsideColumn, Parameters, Status, TURN};
use crate::solids::sources::upload::{GpuSources, append};
use crate::solids::upload::GpuSolids;
use crate::state::State;
use crate::utility::upload::distance_field;
use bytemuck::Zeroable;
use corpuscle_gpu::{
    BATCH_START, Batches, Gpu, GpuError, Halt, SeenParticles, from_halves, from_pair, read, to_pair, wgpu,
};
use corpuscle_sph::kernel::Kernel;
use tasks::Tasks;

/// Humid air on a GPU.
#[derive(Debug)]
pub(crate) struct GpuSolver {
    pub batches: Batches,
    tasks: Tasks,
    /// Where solids have any.
    sources: Option<GpuSources>,
    origin: Origin,
    bodies: Vec<shared::Body>,
    /// Times, s, and values: temperatures from the ambient air's, K, and powers.
    rows: Vec<[f64; 2]>,
    status: Status,
    /// The time of the state that was sent, s.
    uploaded_at: f64,
    /// Particles that there is room for.
    room: usize,
    /// Water on the particles of the solids when it was last uploaded, kg.
    water_uploaded: Vec<f64>,
    /// Heat that came from each solid until the last batch, J.
    held_before: Vec<f64>,
    /// Whether the host has not the air that is here.
    ahead: bool,
    /// Once the air is drawn.
    seen: SeenParticles,
    /// Batches of steps until the device is lost.
    #[cfg(test)]
    pub lost_after: Option<u32>,
}

/// Particles that came or went: sums of their temperature above 0 °C, K, vapour and fog, parts of the mass.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Crossed {
    pub temperature: f64,
    pub vapour: f64,
    pub fog: f64,
}

/// What a batch of steps did.
#[derive(Debug, Clone)]
pub(crate) struct BatchResult {
    pub steps: u64,
    /// Time at the end of the last step, s.
    pub time: f64,
    /// Length of the last step, s.
    pub last_step: f64,
    pub particle_steps: u64,
    /// The next step, s.
    pub step: f64,
    pub next_id: u64,
    pub came: Crossed,
    pub went: Crossed,
    /// Water that diffused in and out, part of a particle's mass, and energy, J for a kilogram of it.
    pub diffused: [f64; 4],
    /// Vapour that became fog, part of a particle's mass.
    pub fogged: f64,
    /// Heat that came from each solid held at a temperature, J.
    pub held_heat: Vec<f64>,
    /// Heat that each solid got from its heater, from outside and by radiation, J; none where no solid has any.
    pub supplied: Vec<[f64; 3]>,
    pub inlet_phase: [[f64; 2]; 3],
    /// By how much the air beyond each outlet is denser than at rest, over its density at rest.
    pub density_excess_beyond: [[f64; 2]; 3],
    /// Running mean of the velocity along its axis of the air before each outlet, m/s.
    pub running_mean_before: [[f64; 2]; 3],
    /// Time of the last search for air of low utility, s.
    pub utility_seen: f64,
    /// What all air of a closed room gains in the next step: temperature, K, and vapour, part of the mass.
    pub drift: [f64; 2],
    /// m/s.
    pub fastest: f64,
    /// Whether the next step is too short to go on, or the air faster than sound where that is refused.
    pub broken: bool,
    /// Whether the next step may bring more air than there is room for.
    pub full: bool,
}

fn outside_column(&is_free: &bool) -> OutsideColumn {
    OutsideColumn { is_free: u32::from(is_free), ..OutsideColumn::default() }
}

/// Appends what comes in over time to the values, from the ambient air's, and tells the inlets where it is.
fn append_inflows(inflows: &InflowsOverTime, origin: Origin, parameters: &mut Parameters, rows: &mut Vec<[f64; 2]>) {
    for (inlet, inflow) in parameters.inlets.iter_mut().zip(inflows.as_flattened()) {
        let Some(inflow) = inflow else { continue };
        [inlet.temperature_first, inlet.temperature_end] = append(&inflow.temperature, origin.temperature, rows);
        [inlet.vapour_first, inlet.vapour_end] = append(&inflow.vapour, origin.vapour, rows);
    }
}

impl GpuSolver {
    /// Room for `room` particles of air.
    pub fn new(gpu: Gpu, room: usize, inputs: &GpuInputs) -> Result<Self, GpuError> {
        let origin = Origin {
            room: *inputs.room,
            temperature: inputs.settings.ambient_temperature,
            vapour: inputs.settings.ambient_vapour,
        };
        let mut parameters = Parameters::of(inputs, origin, room);
        let field =
            distance_field(&mut parameters, inputs.settings, inputs.room, inputs.scale, inputs.surfaces, origin);
        let mut rows = Vec::new();
        let solids = GpuSolids::new(&gpu, &inputs.solids, origin, &parameters, &mut rows)?;
        let outside: Vec<OutsideColumn> =
            inputs.open_sides.iter().flat_map(OpenSide::free).map(outside_column).collect();
        let sources = GpuSources::new(inputs.sources, origin, &mut rows);
        append_inflows(inputs.inflows, origin, &mut parameters, &mut rows);
        let fans = numbers::gpu_fans(inputs, origin);
        let (bodies, of_solids) = (solids.bodies.clone(), solids.count);
        let kernel = Kernel::<3>::device_piece(inputs.settings.kernel);
        let tasks = Tasks::new(
            &gpu,
            &kernel,
            room,
            &parameters,
            &fans,
            solids,
            sources.as_ref(),
            rows.len(),
            &outside,
            &field,
        )?;
        let cells = parameters.cells.iter().product::<u32>() + 1;
        let held_before = vec![0.0; bodies.len()];
        Ok(Self {
            batches: Batches::new(gpu, "dew"),
            tasks,
            sources,
            origin,
            bodies,
            rows,
            // One more cell holds what has gone.
            status: Status { cells, ..Status::zeroed() },
            uploaded_at: 0.0,
            room,
            water_uploaded: vec![0.0; of_solids],
            held_before,
            ahead: false,
            seen: SeenParticles::default(),
            #[cfg(test)]
            lost_after: None,
        })
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        self.tasks.bytes()
    }

    /// Particles that there are, and that there is room for.
    pub fn filling(&self) -> [usize; 2] {
        [self.status.particles as usize, self.room]
    }

    /// Cells that there are.
    #[cfg(test)]
    pub fn cells(&self) -> u32 {
        self.status.cells
    }

    /// Hands the state over, with what part of the evaporation of a wet surface the water on each particle of the solids lets go.
    pub fn upload(&mut self, state: &State, evaporation: &[f64]) {
        let air: Vec<shared::Particle> = state.air.iter().map(|particle| self.origin.to_gpu(particle)).collect();
        let temperature = |temperature: &f64| shared::Solid {
            temperature: to_pair(temperature - self.origin.temperature),
            ..shared::Solid::default()
        };
        let solids: Vec<shared::Solid> = state.temperatures.iter().map(temperature).collect();
        let write = |buffer: &wgpu::Buffer, bytes: &[u8]| self.batches.gpu().queue.write_buffer(buffer, 0, bytes);
        write(&self.tasks.memory.particles, bytemuck::cast_slice(&air));
        write(&self.tasks.memory.solids, bytemuck::cast_slice(&solids));
        // A row of the gauges may be due before the first step.
        let flow = |(body, &flow): (&shared::Body, &f64)| shared::Body { flow: flow as f32, ..*body };
        let bodies: Vec<shared::Body> = self.bodies.iter().zip(&state.heat_flow).map(flow).collect();
        write(&self.tasks.memory.bodies, bytemuck::cast_slice(&bodies));
        let row = |&row: &[f64; 2]| shared::Row::new(row, state.time);
        let rows: Vec<shared::Row> = self.rows.iter().map(row).collect();
        write(&self.tasks.memory.rows, bytemuck::cast_slice(&rows));
        if let Some(sources) = &mut self.sources {
            sources.reset(self.batches.gpu(), &self.tasks.memory);
        }
        self.upload_water(&state.water_on, evaporation);
        self.held_before.fill(0.0);
        let phases = state.inlet_phase.as_flattened();
        let narrow = |by_face: [[f64; 2]; 3]| std::array::from_fn(|number| by_face.as_flattened()[number] as f32);
        self.status = Status {
            cells: self.status.cells,
            particles: air.len() as u32,
            step: state.time_step as f32,
            next_id: state.next_id as u32,
            seen: to_pair(state.utility_seen - state.time),
            turn: (state.steps % u64::from(TURN)) as u32,
            drift: state.drift.map(|gain| gain as f32),
            phase: std::array::from_fn(|number| to_pair(phases[number])),
            density_excess_beyond: narrow(state.density_excess_beyond),
            running_mean_before: narrow(state.running_mean_before),
            ..Status::zeroed()
        };
        // Drawing before the first step reads it too.
        self.batches.gpu().queue.write_buffer(&self.tasks.memory.status, 0, bytemuck::bytes_of(&self.status));
        self.uploaded_at = state.time;
        self.ahead = false;
    }

    /// Uploads the water on the particles of the solids, kg, where drops have moved, and what part of the evaporation of a wet surface it lets go.
    pub fn upload_water(&mut self, water: &[f64], evaporation: &[f64]) {
        let packed = |(&water, &evaporation): (&f64, &f64)| shared::Water {
            uploaded: water as f32,
            evaporation: evaporation as f32,
            ..shared::Water::default()
        };
        let uploaded: Vec<shared::Water> = water.iter().zip(evaporation).map(packed).collect();
        self.batches.gpu().queue.write_buffer(&self.tasks.memory.waters, 0, bytemuck::cast_slice(&uploaded));
        self.water_uploaded.clear();
        self.water_uploaded.extend_from_slice(water);
    }

    /// Brings the water on the particles of the solids, kg.
    pub async fn download_water(&self, water: &mut Vec<f64>) -> Result<(), GpuError> {
        let waters: Vec<shared::Water> =
            read(self.batches.gpu(), &self.tasks.memory.waters, self.water_uploaded.len()).await?;
        water.clear();
        // What rounding leaves of the last of the water is nothing.
        let now = |(uploaded, water): (&f64, &shared::Water)| (uploaded + from_pair(water.gained)).max(0.0);
        water.extend(self.water_uploaded.iter().zip(&waters).map(now));
        Ok(())
    }

    /// Brings the air and the solids back, where there is any news of them.
    pub async fn download(&mut self, state: &mut State) -> Result<(), GpuError> {
        if !self.ahead {
            return Ok(());
        }
        let air: Vec<shared::Particle> =
            read(self.batches.gpu(), &self.tasks.memory.particles, self.status.particles as usize).await?;
        self.download_solids(state).await?;
        state.air.clear();
        state.air.extend(air.iter().map(|particle| self.origin.to_host(particle)));
        self.ahead = false;
        Ok(())
    }

    /// Brings back what changes of the solids.
    async fn download_solids(&self, state: &mut State) -> Result<(), GpuError> {
        let solids: Vec<shared::Solid> =
            read(self.batches.gpu(), &self.tasks.memory.solids, state.temperatures.len()).await?;
        let bodies: Vec<shared::Body> = read(self.batches.gpu(), &self.tasks.memory.bodies, self.bodies.len()).await?;
        self.download_water(&mut state.water_on).await?;
        let temperature = |solid: &shared::Solid| from_pair(solid.temperature) + self.origin.temperature;
        state.temperatures.clear();
        state.temperatures.extend(solids.iter().map(temperature));
        state.heat_flow.clear();
        state.heat_flow.extend(bodies.iter().map(|body| f64::from(body.flow)));
        Ok(())
    }

    /// Takes steps up to a time, s, or as many as a batch has, `most` at most.
    pub async fn advance(&mut self, until: f64, most: u64) -> Result<BatchResult, GpuError> {
        #[cfg(test)]
        self.lose();
        let left = until - self.time();
        let count = self.batches.steps(left, f64::from(self.status.step), most);
        self.status = Status {
            halted: BATCH_START,
            particles: self.status.particles,
            cells: self.status.cells,
            step: self.status.step,
            until: to_pair(until - self.uploaded_at),
            next_id: self.status.next_id,
            phase: self.status.phase,
            density_excess_beyond: self.status.density_excess_beyond,
            running_mean_before: self.status.running_mean_before,
            time: self.status.time,
            seen: self.status.seen,
            turn: (self.status.turn + self.status.steps) % TURN,
            drift: self.status.drift,
            ..Status::zeroed()
        };
        let Self { tasks, batches, status, bodies, sources, .. } = self;
        let download = async |gpu: &Gpu| {
            let done = read(gpu, &tasks.memory.status, 1).await?[0];
            let bodies: Vec<shared::Body> = read(gpu, &tasks.memory.bodies, bodies.len()).await?;
            let supplied = match sources {
                Some(sources) => sources.download_supplied(gpu, &tasks.memory).await?,
                None => Vec::new(),
            };
            Ok((done, bodies, supplied))
        };
        let status = (&tasks.memory.status, &*status);
        let (done, bodies, supplied) = batches.run(count, status, |pass| tasks.steps(pass, count), download).await?;
        self.status = done;
        self.ahead |= self.status.steps > 0;
        Ok(self.progress(&bodies, supplied))
    }

    /// Time at the end of the last step, s.
    fn time(&self) -> f64 {
        self.uploaded_at + from_pair(self.status.time)
    }

    /// Loses the device where it is time.
    #[cfg(test)]
    fn lose(&mut self) {
        match &mut self.lost_after {
            Some(0) => self.batches.gpu().device.destroy(),
            Some(batches) => *batches -= 1,
            None => {}
        }
    }

    fn progress(&mut self, bodies: &[shared::Body], supplied: Vec<[f64; 3]>) -> BatchResult {
        let Status { steps, particle_steps, step, last_step, halted, fastest, .. } = self.status;
        let held: Vec<f64> = bodies.iter().map(|body| from_pair(body.held)).collect();
        let held_heat = held.iter().zip(&self.held_before).map(|(now, before)| now - before).collect();
        self.held_before = held;
        let phase = |axis: usize, side: usize| from_pair(self.status.phase[2 * axis + side]);
        let wide = |by_face: [f32; 6]| [0, 1, 2].map(|axis| [0, 1].map(|side| f64::from(by_face[2 * axis + side])));
        BatchResult {
            steps: u64::from(steps),
            time: self.time(),
            last_step: f64::from(last_step),
            particle_steps: from_halves(particle_steps),
            step: f64::from(step),
            next_id: u64::from(self.status.next_id),
            came: self.crossed(self.status.came.values()),
            went: self.crossed(self.status.went.values()),
            diffused: self.status.diffused.values(),
            fogged: from_pair(self.status.fogged),
            held_heat,
            supplied,
            drift: self.status.drift.map(f64::from),
            utility_seen: self.uploaded_at + from_pair(self.status.seen),
            inlet_phase: [0, 1, 2].map(|axis| [phase(axis, 0), phase(axis, 1)]),
            density_excess_beyond: wide(self.status.density_excess_beyond),
            running_mean_before: wide(self.status.running_mean_before),
            fastest: f64::from(fastest).sqrt(),
            broken: Halt::of(halted) == Halt::Broken,
            full: Halt::of(halted) == Halt::NeedsHost,
        }
    }

    fn crossed(&self, [number, temperature, vapour, fog]: [f64; 4]) -> Crossed {
        let Origin { temperature: ambient, vapour: ambient_vapour, .. } = self.origin;
        Crossed {
            temperature: number * (ambient - crate::humid_air::ZERO_CELSIUS) + temperature,
            vapour: number * ambient_vapour + vapour,
            fog,
        }
    }
}
