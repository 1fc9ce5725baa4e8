//! The flood model: water that comes, moves and goes.

mod breakdown;
mod by_hand;
mod exchange;
mod measured;
#[cfg(feature = "gpu")]
mod measured_on_card;
mod model;
#[cfg(feature = "gpu")]
mod on_card;
#[cfg(feature = "gpu")]
mod on_device;
mod open;
mod placed;
mod regulate;
mod step;
mod to_come;
mod weather;

pub use by_hand::ByHand;

use crate::falling::Falling;
use crate::friction::Roughness;
use crate::gauges::{LineGauge, PointGauge};
use crate::inflow::Source;
use crate::maps::Maps;
use crate::particle::Particle;
use crate::rain::{Ground, Wetness};
use crate::refinement::Refinement;
use crate::sampling::{Sample, Sampler};
use crate::scheme::{Scheme, Sizes, Surroundings};
use crate::structures::{Flows, Structures};
use by_hand::{Hand, Over};
use corpuscle_model::{Account, ExactSum};
use corpuscle_scene::{Flood as Settings, Scheme as SchemeName, Table};
use serde::{Deserialize, Serialize};
use step::Renewal;

/// Density of water, kg/m3.
const DENSITY: f64 = 1000.0;

/// Shallow water as particles over terrain.
pub struct Flood {
    settings: Settings,
    seed: u64,
    surroundings: Surroundings,
    scheme: Box<dyn Scheme>,
    roughness: Roughness,
    /// The ground, where it rains or water soaks in.
    ground: Option<Ground>,
    refinement: Option<Refinement>,
    sources: Vec<Source>,
    structures: Structures,
    points: Vec<PointGauge>,
    lines: Vec<LineGauge>,
    /// Distance of particles in water of depth `spacing_depth_m`, m, and what goes with it.
    spacing: f64,
    volume: f64,
    h: f64,
    map_period: f64,
    state: State,
    /// What the scene says of the values over time that a hand has changed.
    before_hand: Vec<(Over, Table)>,
    /// Working memory.
    of_blocks: Vec<f64>,
    renewals: Vec<Renewal>,
    /// The time shown, s; up to one step after the state's.
    shown: f64,
    /// The card that takes the steps, where one does.
    #[cfg(feature = "gpu")]
    card: Option<crate::card::Card>,
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
    wetness: Wetness,
    flows: Flows,
    water: Account,
    momentum: Account,
    maps: Maps,
    /// Number of the next look at the maps.
    next_look: u64,
    /// Next time step, s.
    time_step: f64,
    sizes: Sizes,
    /// Force of ground, edges and obstacles at the last evaluation, m4/s2.
    external: [f64; 2],
    /// Force on each obstacle at the last evaluation, m4/s2, and its sum over time, m4/s.
    on_obstacles: Vec<[f64; 2]>,
    impulses: Vec<[f64; 2]>,
    /// How often a particle was put back to the wall of an obstacle.
    put_back: u64,
    /// When water was first seen to stand higher than each obstacle, s.
    overtopped: Vec<Option<f64>>,
    /// What a user should know of the water at the start.
    warnings: Vec<String>,
    /// What a hand has changed.
    hand: Hand,
}

impl Flood {
    /// Support of the sampling kernel over the scheme's own: the paper's h is the whole support, not half of it.
    fn smoothing(&self) -> f64 {
        match self.settings.scheme {
            SchemeName::Balanced | SchemeName::Voronoi => 1.0,
            SchemeName::SphSwe => 0.5,
        }
    }

    /// Distance of particles as they are shown where all are shown with the same, m: scheme sph-swe's stand for no area.
    fn spacing_shown(&self) -> Option<f64> {
        match self.settings.scheme {
            SchemeName::Balanced | SchemeName::Voronoi => None,
            SchemeName::SphSwe => Some(self.settings.sph_swe.radius_m.map_or(self.spacing, |radius| 2.0 * radius)),
        }
    }

    fn sampler(&self, since: f64) -> Sampler<'_> {
        Sampler {
            particles: &self.state.particles,
            arrangement: self.scheme.arrangement(),
            terrain: &self.surroundings.terrain,
            obstacles: &self.surroundings.obstacles,
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
        let particles = self.inside().map(|particle| particle.volume).chain(airborne);
        particles.chain([self.state.wetness.on_the_ground()]).collect::<ExactSum>().value()
    }

    /// The account of the water, rain and infiltration included, m3.
    fn water(&self) -> Account {
        let mut water = self.state.water;
        water.inflow.add(self.state.wetness.rained.value());
        water.outflow.add(self.state.wetness.infiltrated.value());
        water
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

    /// How often so far a particle came into an obstacle in a step and was put back to its wall.
    pub fn put_back(&self) -> u64 {
        self.state.put_back
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
