//! Water that comes in, at points and along lines.

use super::Sampler;
use super::particle::Particle;
use crate::zone::{Source, Zone};
use corpuscle_model::ExactSum;
use corpuscle_sph::kernel::CubicSpline;
use corpuscle_terrain::Bounds;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// Places tried for each new particle; the lowest surface is taken.
pub(super) const TRIES: usize = 12;

/// New particles: what they are like, and whom to ask where they fit.
pub(crate) struct Nursery<'a> {
    pub water: Sampler<'a>,
    pub bounds: Bounds,
    pub volume: f64,
    pub h: f64,
    pub seed: u64,
    pub next_id: u64,
    pub born: Vec<Particle>,
}

impl Nursery<'_> {
    /// Lets in what `source` gives from `time` to `time + step`, in whole particles; `owed` is what is left over, m3.
    pub fn pour(&mut self, source: &Source, owed: &mut ExactSum, time: f64, step: f64) {
        owed.add(source.discharge.integral(time, time + step));
        while owed.value() >= self.volume {
            owed.add(-self.volume);
            self.bear(&source.zone, source.velocity);
        }
    }

    /// One new particle in `zone`, where the surface stands lowest.
    fn bear(&mut self, zone: &Zone, velocity: [f64; 2]) {
        let id = self.next_id;
        self.next_id += 1;
        let [x, y] = self.lowest(zone, id);
        let mut particle = Particle::new(id, x, y, self.volume, self.h);
        [particle.u, particle.v] = velocity;
        self.born.push(particle);
    }

    /// Of some places in `zone`, drawn at random for the particle with that identity, the one where the surface stands lowest.
    fn lowest(&self, zone: &Zone, id: u64) -> [f64; 2] {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        random.set_stream(id);
        let tried: [_; TRIES] = std::array::from_fn(|_| {
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
        let born: f64 = self.born.iter().map(deep).sum();
        self.water.terrain.height(x, y) + there + born
    }
}
