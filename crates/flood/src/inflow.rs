//! Water that comes in: at points, along lines, and at edges held at a level.

use crate::edges::{EdgeRule, EdgeRules};
use crate::particle::Particle;
use crate::sampling::Sampler;
use corpuscle_model::ExactSum;
use corpuscle_scene::Table;
use corpuscle_sph::kernel::cubic_spline;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Inflowing water raises the surface where it comes in no faster than this, m/s: the area it is spread over follows.
const FASTEST_RISE: f64 = 0.5;

/// Places tried for each new particle; the lowest surface is taken.
const TRIES: usize = 12;

/// Where new particles may stand.
#[derive(Debug, Clone)]
pub(crate) enum Zone {
    /// A disc.
    Disc { centre: [f64; 2], radius: f64 },
    /// A band on both sides of a line.
    Band { line: Vec<[f64; 2]>, half_width: f64 },
}

impl Zone {
    /// A disc wide enough for `discharge` m3/s.
    pub fn at(centre: [f64; 2], discharge: f64, spacing: f64) -> Self {
        let needed = (discharge / FASTEST_RISE / std::f64::consts::PI).sqrt();
        Self::Disc { centre, radius: needed.max(2.0 * spacing) }
    }

    /// A band wide enough for `discharge` m3/s.
    pub fn along(line: Vec<[f64; 2]>, discharge: f64, spacing: f64) -> Self {
        let length: f64 = line.windows(2).map(|pair| distance(pair[0], pair[1])).sum();
        let needed = 0.5 * discharge / FASTEST_RISE / length;
        Self::Band { line, half_width: needed.max(spacing) }
    }

    fn any(&self, random: &mut ChaCha8Rng) -> [f64; 2] {
        match self {
            Self::Disc { centre, radius } => {
                let r = radius * random.random_range(0.0..1.0_f64).sqrt();
                let (sin, cos) = random.random_range(0.0..std::f64::consts::TAU).sin_cos();
                [centre[0] + r * cos, centre[1] + r * sin]
            }
            Self::Band { line, half_width } => {
                let length: f64 = line.windows(2).map(|pair| distance(pair[0], pair[1])).sum();
                let mut along = random.random_range(0.0..length);
                let beside = random.random_range(-half_width..*half_width);
                let pair = line
                    .windows(2)
                    .find(|pair| {
                        let here = along <= distance(pair[0], pair[1]);
                        along -= if here { 0.0 } else { distance(pair[0], pair[1]) };
                        here
                    })
                    .unwrap_or(&line[line.len() - 2..]);
                let part = along / distance(pair[0], pair[1]);
                let direction = [0, 1].map(|axis| (pair[1][axis] - pair[0][axis]) / distance(pair[0], pair[1]));
                [
                    pair[0][0] + part * (pair[1][0] - pair[0][0]) - beside * direction[1],
                    pair[0][1] + part * (pair[1][1] - pair[0][1]) + beside * direction[0],
                ]
            }
        }
    }
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// A discharge into the water.
#[derive(Debug, Clone)]
pub(crate) struct Source {
    pub zone: Zone,
    /// Discharge over time, m3/s.
    pub discharge: Table,
    pub velocity: [f64; 2],
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
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        random.set_stream(id);
        let bounds = self.edges.bounds;
        let places = (0..TRIES).map(|_| {
            let [x, y] = zone.any(&mut random);
            if outside.is_some() {
                return [x, y];
            }
            [x.clamp(bounds.x_min, bounds.x_max), y.clamp(bounds.y_min, bounds.y_max)]
        });
        let (_, [x, y]) = places
            .map(|[x, y]| (self.surface(x, y), [x, y]))
            .fold((f64::INFINITY, [0.0; 2]), |best, tried| if tried.0 < best.0 { tried } else { best });
        let mut particle = Particle::new(id, x, y, self.volume, self.h);
        [particle.u, particle.v] = velocity;
        particle.outside = outside;
        self.born.push(particle);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_lie_in_their_zone() {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let disc = Zone::at([3.0, 4.0], 2.0, 0.1);
        let band = Zone::along(vec![[0.0, 0.0], [10.0, 0.0], [10.0, 20.0]], 3.0, 0.5);
        let (mut first, mut second) = (0, 0);
        for _ in 0..2000 {
            let p = disc.any(&mut random);
            assert!(distance(p, [3.0, 4.0]) <= (4.0 / std::f64::consts::PI).sqrt());
            let [x, y] = band.any(&mut random);
            assert!((-0.5..=10.5).contains(&x) && (-0.5..=20.0).contains(&y), "{x} {y}");
            if y.abs() <= 0.5 && x < 9.5 { first += 1 } else { second += 1 }
        }
        // A third of the line is its first part.
        assert!((550..750).contains(&first), "{first} {second}");
    }
}
