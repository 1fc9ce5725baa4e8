//! Water that comes in: at points, along lines, and at edges held at a level.

use crate::edges::{EdgeRule, EdgeRules};
use crate::particle::Particle;
use crate::sampling::Sampler;
use crate::zone::Zone;
use corpuscle_model::ExactSum;
use corpuscle_scene::Table;
use corpuscle_sph::kernel::cubic_spline;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// Places tried for each new particle; the lowest surface is taken.
const TRIES: usize = 12;

/// A discharge into the water.
#[derive(Debug, Clone)]
pub(crate) struct Source {
    pub zone: Zone,
    /// Discharge over time, m3/s.
    pub discharge: Table,
    pub velocity: [f64; 2],
}

impl Source {
    /// The times from `from` to `until` at which another `volume` m3 has come, with `owed` m3 at the start.
    #[cfg(feature = "gpu")]
    pub fn times(&self, owed: f64, volume: f64, from: f64, until: f64) -> Vec<f64> {
        let come = |time: f64| owed + self.discharge.integral(from, time);
        let count = (come(until) / volume).floor().max(0.0) as usize;
        let mut earliest = from;
        let time = |number: usize| {
            let (mut low, mut high) = (earliest, until);
            // To a billionth of the span.
            for _ in 0..30 {
                let middle = 0.5 * (low + high);
                *if come(middle) >= number as f64 * volume { &mut high } else { &mut low } = middle;
            }
            earliest = low;
            high
        };
        (1..=count).map(time).collect()
    }
}

/// New particles: what they are like, and whom to ask where they fit.
pub(crate) struct Nursery<'a> {
    pub water: Sampler<'a>,
    pub edges: &'a EdgeRules,
    pub volume: f64,
    pub spacing: f64,
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
            self.bear(&source.zone, source.velocity, None);
        }
    }

    /// Tops up the water at the edges that are held at a level.
    pub fn hold_levels(&mut self, time: f64) {
        for side in 0..4 {
            if let EdgeRule::Stage(stage) = &self.edges.rules[side] {
                self.hold_level(side, stage.at(time));
            }
        }
    }

    /// Sees to it that a strip beyond the edge, as wide as water before the edge looks, holds water up to `level`, m.
    fn hold_level(&mut self, side: usize, level: f64) {
        let bounds = self.edges.bounds;
        let along_y = side < 2;
        let (from, to) = if along_y { (bounds.y_min, bounds.y_max) } else { (bounds.x_min, bounds.x_max) };
        let width = 3.0 * self.h;
        let pieces = ((to - from) / width).ceil().max(1.0) as usize;
        let length = (to - from) / pieces as f64;
        for piece in 0..pieces {
            let low = from + piece as f64 * length;
            let at = |outwards: f64, along: f64| match side {
                0 => [bounds.x_min - outwards, along],
                1 => [bounds.x_max + outwards, along],
                2 => [along, bounds.y_min - outwards],
                _ => [along, bounds.y_max + outwards],
            };
            let parts = 5;
            let depth = |part: i32| {
                let [x, y] = at(0.0, low + (f64::from(part) + 0.5) / f64::from(parts) * length);
                (level - self.water.terrain.height(x, y)).max(0.0)
            };
            let wanted = (0..parts).map(depth).sum::<f64>() / f64::from(parts) * length * width;
            let size = if along_y { [width, length] } else { [length, width] };
            let here = self.volume_in(at(0.5 * width, low + 0.5 * length), size);
            let missing = ((wanted - here) / self.volume + 0.25).floor().max(0.0) as usize;
            let line = vec![at(0.5 * width, low), at(0.5 * width, low + length)];
            let strip = Zone::Band { line, half_width: 0.5 * width };
            for _ in 0..missing {
                self.bear(&strip, [0.0; 2], Some(side as u8));
            }
        }
    }

    /// Volume of the water in a rectangle, m3.
    fn volume_in(&self, centre: [f64; 2], size: [f64; 2]) -> f64 {
        let inside = |particle: &&Particle| {
            (particle.x - centre[0]).abs() <= 0.5 * size[0] && (particle.y - centre[1]).abs() <= 0.5 * size[1]
        };
        let near = self.water.near(centre[0], centre[1], 0.5 * size[0].max(size[1]) + self.spacing);
        near.chain(&self.born).filter(inside).map(|particle| particle.volume).sum()
    }

    /// One new particle in `zone`, where the surface stands lowest.
    fn bear(&mut self, zone: &Zone, velocity: [f64; 2], outside: Option<u8>) {
        let id = self.next_id;
        self.next_id += 1;
        let [x, y] = self.lowest(zone, id, outside.is_some());
        let mut particle = Particle::new(id, x, y, self.volume, self.h);
        [particle.u, particle.v] = velocity;
        particle.outside = outside;
        self.born.push(particle);
    }

    /// One new particle in `zone`, where the surface stands lowest, as fast as the water there.
    pub fn bear_in_flow(&mut self, zone: &Zone) {
        self.bear(zone, [0.0; 2], None);
        if let Some(particle) = self.born.last_mut() {
            [particle.u, particle.v] = self.water.at(particle.x, particle.y).velocity;
        }
    }

    /// A place in `zone` for a particle that comes from elsewhere, drawn for what has the number `stream`.
    pub fn place(&self, zone: &Zone, stream: u64) -> [f64; 2] {
        self.lowest(zone, stream, false)
    }

    /// Of some places in `zone` the one where the surface stands lowest.
    fn lowest(&self, zone: &Zone, stream: u64, may_be_outside: bool) -> [f64; 2] {
        let tried = self.places(zone, stream, may_be_outside).map(|[x, y]| (self.surface(x, y), [x, y]));
        tried.into_iter().fold((f64::INFINITY, [0.0; 2]), |best, tried| if tried.0 < best.0 { tried } else { best }).1
    }

    /// Places in `zone`, drawn at random for what has the number `stream`.
    fn places(&self, zone: &Zone, stream: u64, may_be_outside: bool) -> [[f64; 2]; TRIES] {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        random.set_stream(stream);
        let bounds = self.edges.bounds;
        std::array::from_fn(|_| {
            let [x, y] = zone.any(&mut random);
            if may_be_outside {
                return [x, y];
            }
            [x.clamp(bounds.x_min, bounds.x_max), y.clamp(bounds.y_min, bounds.y_max)]
        })
    }

    /// Height of the water's surface by the plain kernel sum: low where particles leave a gap.
    fn surface(&self, x: f64, y: f64) -> f64 {
        let deep = |particle: &Particle| {
            particle.volume * cubic_spline::value_of_one((x - particle.x).hypot(y - particle.y), self.h)
        };
        let there: f64 = self.water.near(x, y, 2.0 * self.h).map(deep).sum();
        let born: f64 = self.born.iter().map(deep).sum();
        self.water.terrain.height(x, y) + there + born
    }
}
