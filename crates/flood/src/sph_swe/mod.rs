//! Scheme `sph-swe`: the published stable SPH-SWE model.
//!
//! Source: "Real-time simulation of realistic fluid animation based on a stable SPH-SWE numerical model", Acta Physica Sinica (2021). Particles are columns of
//! water of a fixed volume that move with it; depth, smoothing length and forces are formula by formula those of the paper. It has what the paper has, and what a
//! film or a comparison needs beside it: inflows, friction, open, closed and periodic sides, gauges and maps.
//!
//! | folder | what |
//! |---|---|
//! | `neighbours` | cells, ghost particles, neighbour lists |
//! | `density` | density sums, depths, smoothing lengths |
//! | `forces` | pressure, viscosity, slope of the ground, control force |
//! | `motion`, `friction` | positions and velocities |
//! | `boundaries` | the sides of the terrain, and outflow over them |
//! | `inflow`, `falling` | sources of water, and water in the air |
//! | `obstacles` | boundary particles, their push, and that on obstacles |
//! | `ground` | the ground under the particles |
//! | `sampling`, `gauges`, `maps` | the water at a position, and what is recorded of it |
//! | `seeding` | the particles at the start |
//! | `gpu` | the same steps on a GPU; each pass's WGSL stands in the folder of the pass, with what is uploaded for it (`upload.rs`) |
//!
//! `solver.rs` evaluates densities and forces, `step.rs` takes a step.

mod boundaries;
mod breakdown;
mod change;
mod density;
mod falling;
mod forces;
mod friction;
mod gauges;
#[cfg(feature = "gpu")]
mod gpu;
mod ground;
mod inflow;
mod maps;
mod model;
mod motion;
mod neighbours;
mod obstacles;
mod open;
mod particle;
mod sampling;
mod seeding;
mod solver;
mod step;
mod surroundings;
mod to_come;

pub use particle::Particle;

use self::maps::Maps;
use crate::friction::Roughness;
use crate::gauges::{LineGauge, PointGauge};
use crate::sampling::Sample;
use crate::zone::Source;
use boundaries::outflow::BEYOND;
use change::Overrides;
use corpuscle_model::{Account, CompensatedSum};
use corpuscle_scene::{Flood, Table};
use falling::Falling;
use sampling::Sampler;
use serde::{Deserialize, Serialize};
use solver::SphSweSolver;
use step::BlockUpdate;
use surroundings::Surroundings;

/// Density of water, kg/m3.
const DENSITY: f64 = 1000.0;

/// Support of the sampling kernel over that of the scheme's: the paper's h is the whole support, not half of it.
const SAMPLED: f64 = 0.5;

/// Shallow water as particles of a fixed volume over terrain (scheme `sph-swe`).
pub struct SphSweFlood {
    settings: Flood,
    seed: u64,
    surroundings: Surroundings,
    solver: SphSweSolver,
    roughness: Roughness,
    sources: Vec<Source>,
    points: Vec<PointGauge>,
    lines: Vec<LineGauge>,
    /// Distance of particles in water of depth `spacing_depth_m`, m, and what goes with it.
    spacing: f64,
    volume: f64,
    h: f64,
    map_period: f64,
    state: State,
    /// What the scene says of the discharges that were changed live, by inflow.
    written: Vec<(usize, Table)>,
    /// Working memory.
    of_blocks: Vec<f64>,
    block_updates: Vec<BlockUpdate>,
    /// The time shown, s; up to one step after the state's.
    shown: f64,
    /// The GPU that takes the steps, where one does.
    #[cfg(feature = "gpu")]
    on_gpu: Option<gpu::OnGpu>,
}

/// Everything that changes.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct State {
    time: f64,
    steps: u64,
    particle_steps: u64,
    particles: Vec<Particle>,
    falling: Vec<Falling>,
    /// Inflow of each source that is not yet a whole particle, m3.
    residual_volume: Vec<CompensatedSum>,
    next_id: u64,
    water: Account,
    momentum: Account,
    maps: Maps,
    /// Number of the next sample of the maps.
    next_sample: u64,
    /// Next time step, s.
    time_step: f64,
    /// Size of a cell, m.
    cell: f64,
    /// Force of ground, edges and obstacles at the last evaluation, m4/s2.
    external: [f64; 2],
    /// Force on each obstacle at the last evaluation, m4/s2, and its sum over time, m4/s.
    on_obstacles: Vec<[f64; 2]>,
    impulses: Vec<[f64; 2]>,
    /// How often a particle was put back to the wall of an obstacle.
    put_back: u64,
    /// When water was first seen to stand higher than each obstacle, s.
    overtopped: Vec<Option<f64>>,
    /// Warnings about the water at the start.
    warnings: Vec<String>,
    /// What was changed live.
    overrides: Overrides,
}

/// Particles of a state lie at most so many times the terrain's size beyond it, or as far as what has left goes.
const MOST_BEYOND: f64 = 1.0;

/// Cells of a state are at least this part of the spacing wide.
const SMALLEST_CELL: f64 = 1e-3;

impl SphSweFlood {
    /// Whether a state that was read can be one of this flood: sorting particles that lie anywhere, into cells of any size, might never end.
    fn can_be(&self, state: &State) -> bool {
        let bounds = self.surroundings.terrain.bounds();
        let [length, width] = [bounds.x_max - bounds.x_min, bounds.y_max - bounds.y_min];
        let smoothing = self.settings.sph_swe.smoothing_length_m.unwrap_or(self.spacing);
        // What has left goes on for a while.
        let reach = BEYOND * self.settings.sph_swe.largest_smoothing * smoothing;
        let is_near = |x: f64, low: f64, high: f64, size: f64| {
            let margin = reach.max(MOST_BEYOND * size);
            (low - margin..=high + margin).contains(&x)
        };
        let largest = length.max(width).max(100.0 * self.spacing.max(smoothing));
        let particle_can_be = |particle: &Particle| {
            let Particle { x, y, u, v, ax, ay, volume, h, next_h, depth, ground, ground_slope, outside, id: _ } =
                particle;
            is_near(*x, bounds.x_min, bounds.x_max, length)
                && is_near(*y, bounds.y_min, bounds.y_max, width)
                && *h > 0.0
                && [h, next_h].iter().all(|h| (0.0..=largest).contains(*h))
                && [u, v, ax, ay, volume, depth, ground].iter().all(|value| value.is_finite())
                && ground_slope.iter().all(|slope| slope.is_finite())
                && outside.is_none_or(|side| side < 4)
        };
        let cells = SMALLEST_CELL * self.spacing.min(smoothing)..=largest;
        state.time.is_finite() && cells.contains(&state.cell) && state.particles.iter().all(particle_can_be)
    }

    /// Distance of particles as they are shown, m: they stand for no area.
    fn spacing_shown(&self) -> f64 {
        self.settings.sph_swe.radius_m.map_or(self.spacing, |radius| 2.0 * radius)
    }

    fn sampler(&self, since: f64) -> Sampler<'_> {
        Sampler {
            particles: &self.state.particles,
            arrangement: self.solver.arrangement(),
            terrain: &self.surroundings.terrain,
            obstacles: &self.surroundings.obstacles,
            since,
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
        self.inside().map(|particle| particle.volume).chain(airborne).collect::<CompensatedSum>().value()
    }

    /// Momentum of the water, sum of its two components, kg m/s.
    fn momentum(&self) -> f64 {
        let along = |particle: &Particle| DENSITY * particle.volume * (particle.u + particle.v);
        self.inside().map(along).sum::<f64>() + self.state.falling.iter().map(|drop| along(&drop.particle)).sum::<f64>()
    }

    /// The `[flood]` of the scene with every default that depends on ground and water filled in.
    pub fn settings(&self) -> &Flood {
        &self.settings
    }

    /// The water at a position in model coordinates, at the time shown.
    pub fn sample(&self, x: f64, y: f64) -> Sample {
        self.sampler(self.since()).at(x, y)
    }

    /// The particles as they stand at the end of the last step.
    pub fn particles(&self) -> &[Particle] {
        &self.state.particles
    }

    /// How often so far a particle came into an obstacle in a step and was put back to its wall.
    pub fn put_back(&self) -> u64 {
        self.state.put_back
    }

    /// Bytes held for the particles and the work on them.
    pub fn bytes(&self) -> usize {
        self.solver.bytes() + self.state.particles.capacity() * size_of::<Particle>()
    }

    /// The time step from here, s.
    pub fn time_step(&self) -> f64 {
        self.state.time_step
    }
}
