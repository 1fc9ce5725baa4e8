//! Particles of inflows, at points and along lines.

#[cfg(feature = "gpu")]
pub(super) mod upload;

use super::particle::Particle;
use super::sampling::Sampler;
use super::{DENSITY, SphSweFlood};
use crate::zone::{Source, Zone};
use corpuscle_model::CompensatedSum;
use corpuscle_sph::kernel::CubicSpline;
use corpuscle_terrain::Bounds;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// Random positions for each new particle; that with the lowest surface is taken.
pub(super) const SPAWN_CANDIDATES: usize = 12;

/// Creates the particles of inflows: their properties, and the water in which a position is searched.
pub(crate) struct ParticleSpawner<'a> {
    pub water: Sampler<'a>,
    pub bounds: Bounds,
    pub volume: f64,
    pub h: f64,
    pub seed: u64,
    pub next_id: u64,
    pub spawned: Vec<Particle>,
}

impl ParticleSpawner<'_> {
    /// Adds the inflow of `source` from `time` to `time + step` in whole particles; `residual_volume` is the remainder, m3.
    pub fn inject(&mut self, source: &Source, residual_volume: &mut CompensatedSum, time: f64, step: f64) {
        residual_volume.add(source.discharge.integral(time, time + step));
        while residual_volume.value() >= self.volume {
            residual_volume.add(-self.volume);
            self.spawn(&source.zone, source.velocity);
        }
    }

    /// Adds one particle in `zone` at the lowest surface.
    fn spawn(&mut self, zone: &Zone, velocity: [f64; 2]) {
        let id = self.next_id;
        self.next_id += 1;
        let [x, y] = self.lowest(zone, id);
        let mut particle = Particle::new(id, x, y, self.volume, self.h);
        [particle.u, particle.v] = velocity;
        self.spawned.push(particle);
    }

    /// The position with the lowest surface of some in `zone`, drawn at random for the particle with that identity.
    fn lowest(&self, zone: &Zone, id: u64) -> [f64; 2] {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        random.set_stream(id);
        let tried: [_; SPAWN_CANDIDATES] = std::array::from_fn(|_| {
            let [x, y] = zone.any(&mut random);
            [x.clamp(self.bounds.x_min, self.bounds.x_max), y.clamp(self.bounds.y_min, self.bounds.y_max)]
        });
        let tried = tried.map(|[x, y]| (self.surface(x, y), [x, y]));
        tried.into_iter().fold((f64::INFINITY, [0.0; 2]), |best, tried| if tried.0 < best.0 { tried } else { best }).1
    }

    /// Height of the water's surface by the plain kernel sum: low where particles leave a gap.
    fn surface(&self, x: f64, y: f64) -> f64 {
        let spline = CubicSpline::<2>::new(self.h);
        let deep = |particle: &Particle| particle.volume * spline.value_at((x - particle.x).hypot(y - particle.y));
        let there: f64 = self.water.near(x, y, 2.0 * self.h).map(deep).sum();
        let spawned: f64 = self.spawned.iter().map(deep).sum();
        self.water.terrain.height(x, y) + there + spawned
    }
}

impl SphSweFlood {
    /// Adds particles of inflows, and drops that land, during the next step.
    pub(super) fn add_inflow(&mut self, step: f64) {
        if self.sources.is_empty() && self.state.falling.is_empty() {
            return;
        }
        let mut residual_volume = std::mem::take(&mut self.state.residual_volume);
        let mut falling = std::mem::take(&mut self.state.falling);
        let mut spawner = ParticleSpawner {
            water: self.sampler(0.0),
            bounds: self.surroundings.edges.bounds,
            volume: self.volume,
            h: self.h,
            seed: self.seed,
            next_id: self.state.next_id,
            spawned: Vec::new(),
        };
        for (source, residual_volume) in self.sources.iter().zip(&mut residual_volume) {
            spawner.inject(source, residual_volume, self.state.time, step);
        }
        let ParticleSpawner { next_id, mut spawned, .. } = spawner;
        let landed = {
            let water = self.sampler(0.0);
            falling.iter_mut().for_each(|drop| drop.fall(self.settings.gravity_m_per_s2, step));
            falling.extract_if(.., |drop| drop.has_landed(&water)).map(|drop| drop.particle).collect::<Vec<_>>()
        };
        let state = &mut self.state;
        (state.residual_volume, state.falling, state.next_id) = (residual_volume, falling, next_id);
        for particle in &spawned {
            state.water.inflow.add(particle.volume);
            state.momentum.book(DENSITY * particle.volume * (particle.u + particle.v));
        }
        state.particles.append(&mut spawned);
        state.particles.extend(landed);
    }
}
