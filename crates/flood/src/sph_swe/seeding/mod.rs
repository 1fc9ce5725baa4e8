//! Where particles stand at the start: a relaxed glass of equal volumes.
//!
//! Particles on a lattice do not mix when it is stretched along one axis only, and fronts come out wrong by a factor
//! of five; a disordered but even arrangement behaves the same in every direction.

mod density;

use super::boundaries::EdgeRules;
use super::neighbours::Arrangement;
use super::obstacles::Obstacles;
use super::particle::Particle;
use corpuscle_sph::kernel::CubicSpline;
use corpuscle_sph::{EachReach, Lanes, LanesExt, Level, Near, Neighbours, Simd, SimdBase, dispatch};
use corpuscle_terrain::Bounds;
use density::{Densities, Density};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// Rounds of relaxation.
const RELAXATION_ROUNDS: usize = 60;

/// Smoothing length of the kernel by which particles are arranged over their distance, and the largest over that in water of the depth that goes with their
/// volume.
pub const ETA: f64 = 1.25;
const MAX_H_RATIO: f64 = 6.0;

/// Longest way in one round, in particle distances.
const LONGEST_SHIFT: f64 = 0.1;

/// Largest volume of a particle over the required one. In a pocket with too few neighbours the exact depth would take more,
/// and such a particle would stand out wherever it goes.
const LARGEST_VOLUME: f64 = 2.0;

/// A body of water to be filled with particles.
pub struct Body<'a> {
    /// Depth of the water at a position, m; 0 or less where there is none. Goes on beyond `inside` where the ground does,
    /// so that the rim of the body is cut out of a larger glass and stands as close as its middle.
    pub depth: &'a (dyn Fn(f64, f64) -> f64 + Sync),
    /// Whether a position belongs to the body.
    pub inside: &'a (dyn Fn(f64, f64) -> bool + Sync),
    /// A rectangle round the body.
    pub within: Bounds,
    /// Volume of a particle, m3.
    pub volume: f64,
    /// Distance of particles in water of the depth that goes with their volume, m.
    pub spacing: f64,
    /// The shallowest water that is filled, m.
    pub shallowest: f64,
}

impl Body<'_> {
    /// Places particles. Each gets the volume that makes its depth exact where neighbours surround it.
    pub fn fill(&self, edges: &EdgeRules, obstacles: &Obstacles, seed: u64) -> Vec<Particle> {
        let mut particles = self.scatter(edges, seed);
        let mut arrangement = Arrangement::default();
        let mut spare = Vec::new();
        for _ in 0..RELAXATION_ROUNDS {
            self.arrange(&mut arrangement, &mut particles, &mut spare, edges);
            self.relax(&arrangement, &mut particles, edges);
        }
        // Obstacles are cut out of the glass, so that water stands before their walls as close as elsewhere; and what
        // stands on dry ground is no water.
        particles
            .retain(|particle| !obstacles.hold([particle.x, particle.y]) && (self.depth)(particle.x, particle.y) > 0.0);
        self.settle_smoothing(&mut arrangement, &mut particles, &mut spare, edges, obstacles);
        particles.retain(|particle| (self.inside)(particle.x, particle.y) && particle.volume > 0.0);
        particles
    }

    /// Largest smoothing length, m.
    fn largest_h(&self) -> f64 {
        MAX_H_RATIO * ETA * self.spacing
    }

    fn smoothing(&self, depth: f64) -> f64 {
        (ETA * (self.volume / depth).sqrt()).min(self.largest_h())
    }

    /// A first scattering by error diffusion (Floyd & Steinberg 1976): even in every direction, its density following
    /// the depth.
    fn scatter(&self, edges: &EdgeRules, seed: u64) -> Vec<Particle> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let margin = 4.0 * self.largest_spacing();
        let bounds = &edges.bounds;
        let low = [(self.within.x_min - margin).max(bounds.x_min), (self.within.y_min - margin).max(bounds.y_min)];
        let high = [(self.within.x_max + margin).min(bounds.x_max), (self.within.y_max + margin).min(bounds.y_max)];
        let fine = 0.45 * self.smallest_spacing(low, high);
        let cells = [0, 1].map(|axis| ((high[axis] - low[axis]) / fine).ceil().max(1.0) as usize);
        let size = [0, 1].map(|axis| (high[axis] - low[axis]) / cells[axis] as f64);
        let mut particles = Vec::new();
        let mut error = vec![0.0; cells[0] + 2];
        let mut below = vec![0.0; cells[0] + 2];
        for row in 0..cells[1] {
            below.fill(0.0);
            for column in 0..cells[0] {
                let x = low[0] + (column as f64 + 0.5) * size[0];
                let y = low[1] + (row as f64 + 0.5) * size[1];
                let depth = (self.depth)(x, y);
                let wanted = if depth > self.shallowest { depth * size[0] * size[1] / self.volume } else { 0.0 };
                let sum = wanted + error[column + 1];
                let put = sum > 0.5 && wanted > 0.0;
                let left = sum - f64::from(u8::from(put));
                error[column + 2] += left * (7.0 / 16.0);
                below[column] += left * (3.0 / 16.0);
                below[column + 1] += left * (5.0 / 16.0);
                below[column + 2] += left * (1.0 / 16.0);
                if put {
                    let [dx, dy] = [(); 2].map(|()| random.random_range(-0.3..0.3));
                    let h = self.smoothing(depth);
                    particles.push(Particle::new(0, x + dx * size[0], y + dy * size[1], self.volume, h));
                }
            }
            std::mem::swap(&mut error, &mut below);
        }
        particles
    }

    fn largest_spacing(&self) -> f64 {
        self.largest_h() / ETA
    }

    fn smallest_spacing(&self, low: [f64; 2], high: [f64; 2]) -> f64 {
        let parts = 200;
        let at = |axis: usize, part: usize| low[axis] + (high[axis] - low[axis]) * (part as f64 + 0.5) / parts as f64;
        let deepest = (0..parts * parts)
            .map(|k| (self.depth)(at(0, k % parts), at(1, k / parts)))
            .fold(self.shallowest, f64::max);
        (self.volume / deepest).sqrt()
    }

    fn arrange(
        &self,
        arrangement: &mut Arrangement,
        particles: &mut Vec<Particle>,
        spare: &mut Vec<Particle>,
        edges: &EdgeRules,
    ) {
        let mean_h = particles.iter().map(|p| p.h).sum::<f64>() / particles.len().max(1) as f64;
        arrangement.arrange(particles, |p| (p.x, p.y, 2.0 * p.h), edges, 1.2 * mean_h.max(1e-12));
        arrangement.sort(particles, spare);
        let Arrangement { cells, lists, x, y, reach_squared, .. } = arrangement;
        let reach = EachReach { squared: reach_squared, near: Near::Either };
        lists.search(cells, [x, y], &reach, &mut vec![(); x.len()], &());
    }

    /// Moves each particle away from where its neighbours crowd, along -sum V grad W, but not to where the required depth is 0.
    fn relax(&self, arrangement: &Arrangement, particles: &mut [Particle], edges: &EdgeRules) {
        let Arrangement { x, y, reach_squared, real, lists, .. } = arrangement;
        // The area of each entry, by the depth wanted there: equal in an even arrangement.
        let area: Vec<f64> = reach_squared.iter().map(|square| square / (4.0 * ETA * ETA)).collect();
        particles.par_iter_mut().zip(real).for_each(|(particle, &index)| {
            let i = index as usize;
            let h = particle.h;
            let list = lists.of(i);
            let [push_x, push_y] = dispatch!(Level::new(), simd => crowding(simd, x, y, &area, list, i, h));
            let longest = LONGEST_SHIFT * h / ETA;
            let shift = [push_x, push_y].map(|push| -0.2 * h * h * push);
            let clip = (longest / shift[0].hypot(shift[1]).max(1e-300)).min(1.0);
            let mut position = [particle.x + clip * shift[0], particle.y + clip * shift[1]];
            if edges.keep(&mut position, &mut [0.0; 2]).is_some() {
                return;
            }
            let depth = (self.depth)(position[0], position[1]);
            if depth > self.shallowest {
                [particle.x, particle.y] = position;
                particle.h = self.smoothing(depth);
            }
        });
    }

    /// Finds the smoothing lengths that go with the arrangement, and gives each particle the volume d / n that makes the
    /// surface exact.
    fn settle_smoothing(
        &self,
        arrangement: &mut Arrangement,
        particles: &mut Vec<Particle>,
        spare: &mut Vec<Particle>,
        edges: &EdgeRules,
        obstacles: &Obstacles,
    ) {
        let mut densities = Vec::new();
        for _ in 0..12 {
            self.arrange(arrangement, particles, spare, edges);
            let Arrangement { cells, lists, x, y, reach_squared, real, .. } = arrangement;
            densities.resize(x.len(), Density::default());
            let reach = EachReach { squared: reach_squared, near: Near::Either };
            lists.search(cells, [x, y], &reach, &mut densities, &Densities { reach_squared });
            for (particle, &index) in particles.iter_mut().zip(real.iter()) {
                let covered = obstacles.coverage([particle.x, particle.y], particle.h);
                let density = densities[index as usize].beside(covered);
                particle.h = density.next_h(particle.h, ETA).min(self.largest_h());
                particle.next_h = particle.h;
                particle.depth = (self.depth)(particle.x, particle.y);
                particle.volume = (particle.depth / density.number).min(LARGEST_VOLUME * self.volume);
            }
        }
    }
}

/// How the neighbours in `list` crowd particle `i`: sum of V grad W over them, 1/m.
#[inline(always)]
fn crowding<S: Simd>(simd: S, x: &[f64], y: &[f64], area: &[f64], list: Neighbours, i: usize, h: f64) -> [f64; 2] {
    let [mut push_x, mut push_y] = [Lanes::splat(simd, 0.0); 2];
    let spline = CubicSpline::<2>::new(h);
    for (index, r) in list.lanes(simd) {
        let of = |values: &[f64]| Lanes::from_fn(simd, |lane| values[index[lane] as usize]);
        let (ex, ey) = (of(x) - x[i], of(y) - y[i]);
        let weight = spline.slopes_at(r) / r * of(area);
        push_x += weight * ex;
        push_y += weight * ey;
    }
    [push_x.sum(), push_y.sum()]
}
