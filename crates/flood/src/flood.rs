//! The flood model: water that comes, moves and goes.

use crate::balanced::{self, Balanced};
use crate::edges::OUTWARD;
use crate::falling::Falling;
use crate::friction::Roughness;
use crate::gauges::{LineGauge, PointGauge};
use crate::inflow::{Nursery, Source};
use crate::limits;
use crate::maps::Maps;
use crate::paper::Paper;
use crate::particle::Particle;
use crate::sampling::{Sample, Sampler};
use crate::scheme::{Scheme, Surroundings};
use crate::seeding::Body;
use crate::setup::{self, InitialWater};
use corpuscle_model::{
    Account, Column, ExactSum, Frame, GaugeColumn, Ledger, Map, Model, ModelError, ParticleSet, Values,
};
use corpuscle_scene::{Flood as Settings, Scheme as SchemeName};
use corpuscle_sph::BLOCK;
use corpuscle_terrain::Terrain;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Density of water, kg/m3.
const DENSITY: f64 = 1000.0;

/// The depth over `spacing_depth_m` whose wave speed sets the time step where there is no water.
const DRY_DEPTH: f64 = 0.05;

/// Shallow water as particles over terrain.
pub struct Flood {
    settings: Settings,
    seed: u64,
    surroundings: Surroundings,
    scheme: Box<dyn Scheme>,
    roughness: Roughness,
    sources: Vec<Source>,
    points: Vec<PointGauge>,
    lines: Vec<LineGauge>,
    /// Distance of particles in water of depth `spacing_depth_m`, m, and what goes with it.
    spacing: f64,
    volume: f64,
    h: f64,
    map_period: f64,
    warnings: Vec<String>,
    state: State,
    /// Working memory.
    of_blocks: Vec<f64>,
    renewals: Vec<(f64, bool)>,
    /// The time shown, s; up to one step after the state's.
    shown: f64,
}

/// Everything that changes.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct State {
    time: f64,
    steps: u64,
    particle_steps: u64,
    particles: Vec<Particle>,
    falling: Vec<Falling>,
    /// Water that each source owes, less than a particle, m3.
    owed: Vec<ExactSum>,
    next_id: u64,
    water: Account,
    momentum: Account,
    maps: Maps,
    /// Number of the next look at the maps.
    next_look: u64,
    /// Next time step, s.
    time_step: f64,
    cell_size: f64,
    /// Force of ground and edges at the last evaluation, m4/s2.
    external: [f64; 2],
}

impl Flood {
    /// Sets a flood up as the `[flood]` of a scene says, its defaults resolved, with the scene's seed. `folder` is what
    /// relative paths refer to.
    ///
    /// # Errors
    /// [`ModelError::Setup`] where something cannot be opened or lies outside the terrain.
    pub fn new(settings: &Settings, seed: u64, folder: &Path, terrain: Arc<Terrain>) -> Result<Self, ModelError> {
        let ground = Arc::clone(&terrain);
        let bodies = setup::initial_water(settings, &ground, folder)?;
        Self::with_water(settings, seed, folder, terrain, &bodies)
    }

    /// As [`Flood::new`], with the water at the start given as functions instead of by the scene.
    ///
    /// # Errors
    /// As [`Flood::new`].
    pub fn with_water(
        settings: &Settings,
        seed: u64,
        folder: &Path,
        terrain: Arc<Terrain>,
        bodies: &[InitialWater],
    ) -> Result<Self, ModelError> {
        let mut settings = settings.clone();
        let flood = &mut settings;
        let map_period = flood
            .map_every_s
            .ok_or_else(|| ModelError::Setup("flood.map_every_s is open; resolve the scene's defaults first".into()))?;
        let spacing = flood.spacing_m;
        let depth = *flood.spacing_depth_m.get_or_insert_with(|| setup::mean_depth(bodies, &terrain).unwrap_or(1.0));
        let volume = spacing * spacing * depth;
        let (scheme, h): (Box<dyn Scheme>, f64) = match flood.scheme {
            SchemeName::Balanced => {
                let h = flood.balanced.smoothing * spacing;
                let shallow = (flood.gravity_m_per_s2 * DRY_DEPTH * depth).sqrt();
                let parameters = balanced::Parameters {
                    gravity: flood.gravity_m_per_s2,
                    eta: flood.balanced.smoothing,
                    largest_h: flood.balanced.largest_smoothing * h,
                    viscosity: flood.balanced.viscosity,
                    cfl: flood.balanced.cfl,
                    longest_step: flood.balanced.cfl * h / shallow,
                };
                (Box::new(Balanced::new(parameters)), h)
            }
            SchemeName::Paper => {
                // Neighbours in the reach: pi h0^2 rho0 / m, whatever the depth. Table 1 has particles of 1 m3.
                let h = *flood.paper.smoothing_length_m.get_or_insert(TABLE_1_SMOOTHING * volume.sqrt());
                flood.paper.radius_m.get_or_insert(0.5 * spacing);
                (Box::new(Paper::new(flood.paper.clone(), h, flood.gravity_m_per_s2)), h)
            }
        };
        limits::check_blocks(flood, &terrain)?;
        limits::check_count(flood, bodies, &terrain, spacing, volume)?;
        let edges = setup::edge_rules(flood, &terrain, folder)?;
        let sources = setup::sources(flood, &terrain, folder, spacing)?;
        let state = State {
            time: 0.0,
            steps: 0,
            particle_steps: 0,
            particles: Vec::new(),
            falling: Vec::new(),
            owed: vec![ExactSum::default(); sources.len()],
            next_id: 0,
            water: Account::default(),
            momentum: Account::default(),
            maps: Maps::new(&terrain, flood.wet_depth_m),
            next_look: 0,
            time_step: 0.0,
            cell_size: h,
            external: [0.0; 2],
        };
        let mut model = Self {
            roughness: Roughness::open(&flood.manning, &terrain, folder)?,
            points: setup::point_gauges(flood, &terrain)?,
            lines: setup::line_gauges(flood, &terrain, spacing)?,
            map_period,
            warnings: terrain.warnings().to_vec(),
            surroundings: Surroundings { terrain, edges, time: 0.0 },
            settings,
            seed,
            scheme,
            sources,
            spacing,
            volume,
            h,
            state,
            of_blocks: Vec::new(),
            renewals: Vec::new(),
            shown: 0.0,
        };
        model.fill(bodies);
        model.begin();
        Ok(model)
    }

    /// Fills in the water at the start.
    fn fill(&mut self, bodies: &[InitialWater]) {
        let flood = &self.settings;
        let eta = flood.balanced.smoothing;
        for (number, body) in bodies.iter().enumerate() {
            let seed = self.seed.wrapping_add(number as u64);
            let mut particles = Body {
                depth: &*body.depth,
                inside: &*body.inside,
                within: body.within,
                volume: self.volume,
                eta,
                largest_h: flood.balanced.largest_smoothing * eta * self.spacing,
                shallowest: flood.wet_depth_m,
            }
            .fill(&self.surroundings.edges, seed);
            if particles.is_empty() {
                self.warnings.push(format!(
                    "Body {number} of the water at the start (from 0, without blocks) holds no water: its level lies below \
                     the ground, or its depth below wet_depth_m."
                ));
            }
            for particle in &mut particles {
                [particle.u, particle.v] = (body.velocity)(particle.x, particle.y);
                if flood.scheme == SchemeName::Paper {
                    (particle.h, particle.next_h) = (self.h, self.h);
                }
            }
            self.state.particles.append(&mut particles);
        }
        let mut random = setup::random(self.seed, u64::MAX);
        for water in &flood.water {
            if let Some(block) = &water.block {
                let terrain = &self.surroundings.terrain;
                let velocity = water.velocity_m_per_s;
                let falling = setup::block(block, velocity, terrain, self.spacing, self.volume, self.h, &mut random);
                self.state.falling.extend(falling);
            }
        }
        let State { particles, falling, .. } = &mut self.state;
        let all = particles.iter_mut().chain(falling.iter_mut().map(|drop| &mut drop.particle));
        self.state.next_id = all.enumerate().map(|(number, particle)| particle.id = number as u64).count() as u64;
        if self.state.next_id == 0 && self.sources.is_empty() && !self.surroundings.edges.holds_level() {
            let what = "There is no water: give [[flood.water]], [[flood.inflow]], or an edge with a stage.";
            self.warnings.push(what.into());
        }
    }

    fn begin(&mut self) {
        self.state.water.initial = self.stored();
        self.state.momentum.initial = self.momentum();
        self.renew();
        self.arrange();
        if self.surroundings.edges.holds_level() {
            self.gain(0.0);
            self.renew();
            self.arrange();
        }
        let evaluation = self.scheme.evaluate(&mut self.state.particles, &self.surroundings, 0.0);
        self.state.time_step = self.limited(evaluation.time_step);
        self.state.external = evaluation.external;
        self.look();
    }

    /// A time step short enough for what is in the air, too: it falls its own size in some ten steps.
    fn limited(&self, step: f64) -> f64 {
        let fall = 0.1 * (self.spacing / self.settings.gravity_m_per_s2).sqrt();
        if self.state.falling.is_empty() { step } else { step.min(fall) }
    }

    /// Gives the particles the smoothing lengths that they have come to need, and the cells their size; whether all the
    /// particles are still inside.
    fn renew(&mut self) -> bool {
        let edges = &self.surroundings.edges;
        let State { particles, cell_size, .. } = &mut self.state;
        let renew_block = |particles: &mut [Particle]| {
            let (mut sum, mut all_inside) = (0.0, true);
            for particle in particles {
                particle.h = particle.next_h;
                sum += particle.h;
                all_inside &= particle.outside.is_none() && edges.bounds.contains(particle.x, particle.y);
            }
            (sum, all_inside)
        };
        particles.par_chunks_mut(BLOCK).map(renew_block).collect_into_vec(&mut self.renewals);
        if !particles.is_empty() {
            let cell_over_h = match self.settings.scheme {
                SchemeName::Balanced => CELL_OVER_H_BALANCED,
                SchemeName::Paper => CELL_OVER_H_PAPER,
            };
            *cell_size = cell_over_h * self.renewals.iter().map(|(sum, _)| sum).sum::<f64>() / particles.len() as f64;
        }
        self.renewals.iter().all(|(_, all_inside)| *all_inside)
    }

    /// Sorts the particles into cells.
    fn arrange(&mut self) {
        self.scheme.arrange(&mut self.state.particles, &self.surroundings, self.state.cell_size);
    }

    fn step(&mut self) -> Result<(), ModelError> {
        let step = self.state.time_step;
        self.carry_beyond();
        self.scheme.drift(&mut self.state.particles, step);
        self.gain(step);
        if !self.renew() {
            self.lose();
        }
        self.state.time += step;
        self.surroundings.time = self.state.time;
        self.arrange();
        let evaluation = self.scheme.evaluate(&mut self.state.particles, &self.surroundings, step);
        self.scheme.kick(&mut self.state.particles, step);
        let impulse = match self.settings.scheme {
            SchemeName::Balanced => [0, 1].map(|k| 0.5 * step * (self.state.external[k] + evaluation.external[k])),
            SchemeName::Paper => evaluation.external.map(|force| step * force),
        };
        impulse.into_iter().for_each(|along| self.state.momentum.book(DENSITY * along));
        let gravity = self.settings.gravity_m_per_s2;
        let slowed = self.roughness.slow(&mut self.state.particles, gravity, step, &mut self.of_blocks);
        self.state.momentum.book(DENSITY * slowed);
        self.state.external = evaluation.external;
        self.state.time_step = self.limited(evaluation.time_step);
        self.state.steps += 1;
        self.state.particle_steps += self.state.particles.len() as u64;
        self.look();
        self.check(step)
    }

    /// Books what crosses the edges, and takes out what is well beyond them.
    fn lose(&mut self) {
        let edges = &self.surroundings.edges;
        let gravity = self.settings.gravity_m_per_s2;
        let State { particles, water, momentum, .. } = &mut self.state;
        particles.retain_mut(|particle| {
            let before = [particle.u, particle.v];
            let mut place = [particle.x, particle.y];
            let mut velocity = before;
            let side = edges.keep(&mut place, &mut velocity);
            [particle.x, particle.y] = place;
            [particle.u, particle.v] = velocity;
            let carried = |velocity: [f64; 2]| DENSITY * particle.volume * (velocity[0] + velocity[1]);
            match (particle.outside, side) {
                (None, None) => momentum.book(carried(velocity) - carried(before)),
                (None, Some(side)) => {
                    water.outflow.add(particle.volume);
                    momentum.book(-carried(before));
                    leave(particle, side, gravity);
                }
                (Some(_), None) => {
                    water.inflow.add(particle.volume);
                    momentum.book(carried(velocity));
                }
                (Some(_), Some(_)) => {}
            }
            particle.outside = side;
            side.is_none_or(|side| edges.beyond(side, particle.x, particle.y) < BEYOND * particle.h)
        });
    }

    /// Beyond an edge held at a level, water moves with that before the edge: in where it sinks away, out where it comes.
    fn carry_beyond(&mut self) {
        let edges = &self.surroundings.edges;
        if !edges.holds_level() {
            return;
        }
        let gravity = self.settings.gravity_m_per_s2;
        let water = self.sampler(0.0);
        let carried: Vec<(usize, [f64; 2])> = (self.state.particles.iter().enumerate())
            .filter_map(|(number, particle)| {
                self.surroundings.stage(particle.outside)?;
                let [x, y] = edges.before(particle.x, particle.y, particle.h);
                let inside = water.at(x, y);
                let outward = OUTWARD[usize::from(particle.outside?)];
                // The outgoing invariant u + 2c is the same on both sides of the edge (Riemann).
                let faster = 2.0 * ((gravity * inside.depth).sqrt() - (gravity * particle.depth).sqrt());
                Some((number, [0, 1].map(|axis| inside.velocity[axis] + faster * outward[axis])))
            })
            .collect();
        for (number, velocity) in carried {
            [self.state.particles[number].u, self.state.particles[number].v] = velocity;
        }
    }

    /// Lets in what comes during the coming step.
    fn gain(&mut self, step: f64) {
        let holds_level = self.surroundings.edges.holds_level();
        if self.sources.is_empty() && self.state.falling.is_empty() && !holds_level {
            return;
        }
        let mut owed = std::mem::take(&mut self.state.owed);
        let mut falling = std::mem::take(&mut self.state.falling);
        let mut nursery = Nursery {
            // Particles have drifted since they were arranged, which matters little to where there is a gap.
            water: self.sampler(0.0),
            edges: &self.surroundings.edges,
            volume: self.volume,
            spacing: self.spacing,
            h: self.h,
            seed: self.seed,
            next_id: self.state.next_id,
            born: Vec::new(),
        };
        for (source, owed) in self.sources.iter().zip(&mut owed) {
            nursery.pour(source, owed, self.state.time, step);
        }
        if holds_level {
            nursery.hold_levels(self.state.time);
        }
        let Nursery { next_id, mut born, .. } = nursery;
        let landed = {
            let water = self.sampler(0.0);
            falling.iter_mut().for_each(|drop| drop.fall(self.settings.gravity_m_per_s2, step));
            falling.extract_if(.., |drop| drop.has_landed(&water)).map(|drop| drop.particle).collect::<Vec<_>>()
        };
        let state = &mut self.state;
        (state.owed, state.falling, state.next_id) = (owed, falling, next_id);
        for particle in born.iter().filter(|particle| particle.outside.is_none()) {
            state.water.inflow.add(particle.volume);
            state.momentum.book(DENSITY * particle.volume * (particle.u + particle.v));
        }
        state.particles.append(&mut born);
        state.particles.extend(landed);
    }

    /// Looks at the maps when it is time to.
    fn look(&mut self) {
        if self.state.time < self.state.next_look as f64 * self.map_period {
            return;
        }
        self.state.next_look = (self.state.time / self.map_period).floor() as u64 + 1;
        let smoothing = self.smoothing();
        let State { particles, maps, time, .. } = &mut self.state;
        let water = Sampler {
            particles,
            arrangement: self.scheme.arrangement(),
            terrain: &self.surroundings.terrain,
            since: 0.0,
            smoothing,
        };
        maps.look(&water, *time);
    }

    fn check(&self, step: f64) -> Result<(), ModelError> {
        let next = self.state.time_step;
        if next.is_finite() && next > 1e-9 * self.spacing {
            return Ok(());
        }
        Err(ModelError::Breakdown {
            time: self.state.time,
            step: self.state.steps,
            what: format!(
                "the time step fell from {step:.3e} s to {next:.3e} s. Try a smaller flood.balanced.cfl (scheme balanced) \
                 or flood.paper.time_step_s (scheme paper), or look in the last frame for the place where the water is fast"
            ),
        })
    }

    /// Support of the sampling kernel over the scheme's own: the paper's h is the whole support, not half of it.
    fn smoothing(&self) -> f64 {
        match self.settings.scheme {
            SchemeName::Balanced => 1.0,
            SchemeName::Paper => 0.5,
        }
    }

    fn sampler(&self, since: f64) -> Sampler<'_> {
        Sampler {
            particles: &self.state.particles,
            arrangement: self.scheme.arrangement(),
            terrain: &self.surroundings.terrain,
            since,
            smoothing: self.smoothing(),
        }
    }

    /// Time from the state to the time shown, s.
    fn since(&self) -> f64 {
        self.shown - self.state.time
    }

    /// The particles that have not left.
    fn inside(&self) -> impl Iterator<Item = &Particle> {
        self.state.particles.iter().filter(|particle| particle.outside.is_none())
    }

    /// Water in the model, m3.
    fn stored(&self) -> f64 {
        let airborne = self.state.falling.iter().map(|drop| drop.particle.volume);
        self.inside().map(|particle| particle.volume).chain(airborne).collect::<ExactSum>().value()
    }

    /// Momentum of the water, sum of its two components, kg m/s.
    fn momentum(&self) -> f64 {
        let along = |particle: &Particle| DENSITY * particle.volume * (particle.u + particle.v);
        self.inside().map(along).sum::<f64>() + self.state.falling.iter().map(|drop| along(&drop.particle)).sum::<f64>()
    }

    /// The `[flood]` of the scene with every default that depends on ground and water filled in.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The water at a place in model coordinates, at the time shown.
    pub fn sample(&self, x: f64, y: f64) -> Sample {
        self.sampler(self.since()).at(x, y)
    }

    /// The particles as they stand at the end of the last step.
    pub fn particles(&self) -> &[Particle] {
        &self.state.particles
    }

    /// Bytes held for the particles and the work on them.
    pub fn bytes(&self) -> usize {
        self.scheme.bytes() + self.state.particles.capacity() * size_of::<Particle>()
    }

    /// Largest sound time step from here, s.
    pub fn time_step(&self) -> f64 {
        self.state.time_step
    }
}

/// Smoothing length in Table 1 of scheme paper, over the root of the volume of its particles, m^(-1/2).
const TABLE_1_SMOOTHING: f64 = 2.66;

/// Size of a cell over the mean smoothing length: small cells fit the search closer, large ones are fewer and gone through in
/// longer pieces. Scheme balanced, whose particles must find all that reach them, gains from a close fit.
const CELL_OVER_H_BALANCED: f64 = 1.2;

/// The same for scheme paper, whose particles look as far as they reach themselves.
const CELL_OVER_H_PAPER: f64 = 1.4;

/// How far beyond an edge particles go on, in smoothing lengths: those before the edge and their neighbours see them.
const BEYOND: f64 = 4.0;

/// A particle that has left goes on at its speed, but not so slowly that it would stand in the way: at this Froude number
/// at least.
const SLOWEST_LEAVING: f64 = 0.1;

fn leave(particle: &mut Particle, side: u8, gravity: f64) {
    let outward = OUTWARD[usize::from(side)];
    let speed = particle.u * outward[0] + particle.v * outward[1];
    let missing = (SLOWEST_LEAVING * (gravity * particle.depth).sqrt() - speed).max(0.0);
    particle.u += missing * outward[0];
    particle.v += missing * outward[1];
}

impl Model for Flood {
    fn name(&self) -> &'static str {
        "flood"
    }

    fn time(&self) -> f64 {
        self.shown
    }

    fn steps(&self) -> u64 {
        self.state.steps
    }

    fn particle_steps(&self) -> u64 {
        self.state.particle_steps
    }

    fn particles(&self) -> usize {
        self.inside().count() + self.state.falling.len()
    }

    fn advance_to(&mut self, time: f64, stop: &AtomicBool) -> Result<(), ModelError> {
        while self.state.time + self.state.time_step <= time {
            if stop.load(Ordering::Relaxed) {
                self.shown = self.shown.max(self.state.time);
                return Ok(());
            }
            self.step()?;
        }
        self.shown = time;
        Ok(())
    }

    fn frame(&self) -> Frame {
        let since = self.since();
        let mut order: Vec<&Particle> = self.inside().collect();
        order.sort_unstable_by_key(|particle| particle.id);
        let count = order.len() + self.state.falling.len();
        let mut set = ParticleSet { name: "water".into(), ..ParticleSet::default() };
        let [mut depth, mut ground, mut speed] = [(); 3].map(|()| Vec::with_capacity(count));
        let radius = |particle: &Particle| match self.settings.scheme {
            SchemeName::Balanced => 0.5 * particle.area().sqrt(),
            SchemeName::Paper => self.settings.paper.radius_m.unwrap_or(0.5 * self.spacing),
        };
        let terrain = &self.surroundings.terrain;
        let on_ground = order.into_iter().map(|particle| {
            let (x, y) = (particle.x + since * particle.u, particle.y + since * particle.v);
            let height = terrain.height(x, y);
            (particle, [x, y, height + particle.depth], 0.0, height, particle.depth, radius(particle))
        });
        let in_air = self.state.falling.iter().map(|drop| {
            let particle = &drop.particle;
            let height = terrain.height(particle.x, particle.y);
            (particle, [particle.x, particle.y, drop.z], drop.w, height, 0.0, 0.5 * self.spacing)
        });
        for (particle, position, w, height, deep, radius) in on_ground.chain(in_air) {
            set.id.push(particle.id);
            set.position.push(position);
            set.velocity.push([particle.u, particle.v, w]);
            set.radius.push(radius);
            set.mass.push(DENSITY * particle.volume);
            depth.push(deep);
            ground.push(height);
            speed.push(particle.speed());
        }
        set.columns = vec![
            Column { name: "depth", unit: "m", values: Values::Scalar(depth) },
            Column { name: "ground", unit: "m", values: Values::Scalar(ground) },
            Column { name: "speed", unit: "m/s", values: Values::Scalar(speed) },
        ];
        Frame { time: self.shown, sets: vec![set] }
    }

    fn gauge_columns(&self) -> Vec<GaugeColumn> {
        let total = |quantity| GaugeColumn { gauge: "water".into(), quantity, unit: "m3" };
        let points = self.points.iter().flat_map(PointGauge::columns);
        let lines = self.lines.iter().map(LineGauge::column);
        points.chain(lines).chain(["stored", "total_inflow", "total_outflow"].map(total)).collect()
    }

    fn gauge_row(&self) -> Vec<f64> {
        let water = self.sampler(self.since());
        let points = self.points.iter().flat_map(|point| point.row(&water));
        let lines = self.lines.iter().map(|line| line.discharge(&water));
        let account = &self.state.water;
        let totals = [self.stored(), account.inflow.value(), account.outflow.value()];
        points.chain(lines).chain(totals).collect()
    }

    fn maps(&self) -> Vec<Map> {
        self.state.maps.maps(&self.sampler(self.since()))
    }

    fn ledger(&self) -> Ledger {
        let water = self.state.water.balance("water_m3", self.stored());
        let momentum = self.state.momentum.balance("momentum", self.momentum());
        Ledger { balances: vec![water, momentum] }
    }

    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    fn save(&self) -> Vec<u8> {
        postcard::to_stdvec(&(self.shown, &self.state)).unwrap_or_default()
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ModelError> {
        let refused = |what: String| ModelError::Checkpoint(what);
        let (shown, state): (f64, State) =
            postcard::from_bytes(state).map_err(|error| refused(format!("its bytes are damaged ({error})")))?;
        if state.owed.len() != self.sources.len() || !state.maps.fit(&self.state.maps) {
            return Err(refused("it belongs to another scene".into()));
        }
        (self.shown, self.state) = (shown, state);
        self.surroundings.time = self.state.time;
        self.scheme.arrange(&mut self.state.particles, &self.surroundings, self.state.cell_size);
        Ok(())
    }
}
