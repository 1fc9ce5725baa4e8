//! Samples of the water at any position, from the particles near it.

use super::SAMPLED;
use super::neighbours::{Arrangement, GHOST};
use super::obstacles::Obstacles;
use super::particle::Particle;
use crate::sampling::Sample;
use corpuscle_sph::kernel::CubicSpline;
use corpuscle_terrain::Terrain;

/// Share of a position's surroundings that water must cover for the position to be wet.
pub(super) const COVERED: f64 = 0.5;

/// Radius of a search for the water at a position over the reach of the particles there: that of those around may be larger.
pub(super) const SEARCH_MARGIN: f64 = 1.1;

/// Largest depth at a position over that of the deepest particle near it.
pub(super) const DEEPER: f64 = 1.2;

/// Samples the water at a position from the particles, a little after they were arranged.
pub(crate) struct Sampler<'a> {
    pub particles: &'a [Particle],
    pub arrangement: &'a Arrangement,
    pub terrain: &'a Terrain,
    pub obstacles: &'a Obstacles,
    /// Time since the particles were arranged, s; they are taken where they are by then.
    pub since: f64,
}

impl Sampler<'_> {
    /// False where no particle can reach (x, y): quick to say.
    pub fn may_be_wet(&self, x: f64, y: f64) -> bool {
        !self.particles.is_empty() && self.arrangement.cells.reach_at([x, y]) > 0.0
    }

    /// The particles whose cells come within `reach` of (x, y), and some more.
    pub fn near(&self, x: f64, y: f64, reach: f64) -> impl Iterator<Item = &Particle> {
        let ranges = (!self.particles.is_empty()).then(|| self.arrangement.cells.ranges([x, y], reach));
        let indices = ranges.into_iter().flatten().flat_map(|range| &self.arrangement.particle[range]);
        indices.filter(|&&k| k != GHOST).map(|&k| &self.particles[k as usize])
    }

    /// The share of the surroundings of (x, y) that ghost particles beyond walls and periodic sides cover.
    fn covered_by_ghosts(&self, x: f64, y: f64) -> f64 {
        let Arrangement { cells, particle, ghosts, x: at_x, y: at_y, .. } = self.arrangement;
        let indices = cells.ranges([x, y], SEARCH_MARGIN * cells.reach_at([x, y])).flatten();
        let weight = |index: usize| {
            let ghost = ghosts.binary_search_by_key(&(index as u32), |(ghost, _)| *ghost).ok()?;
            let shown = &self.particles[particle[ghosts[ghost].1 as usize] as usize];
            let h = SAMPLED * shown.h;
            let distance = (x - at_x[index]).hypot(y - at_y[index]);
            (distance < 2.0 * h).then(|| shown.area() * CubicSpline::<2>::new(h).value_at(distance))
        };
        indices.filter(|index| particle[*index] == GHOST).filter_map(weight).sum()
    }

    /// The position, when the particles were arranged, of the water that is at (x, y) now: in a fast step it moves farther than their support.
    fn origin(&self, x: f64, y: f64) -> [f64; 2] {
        if self.since == 0.0 {
            return [x, y];
        }
        let (mut total, mut u, mut v) = (0.0, 0.0, 0.0);
        for particle in self.near(x, y, self.arrangement.cells.reach_at([x, y])) {
            let weight = CubicSpline::<2>::new(particle.h).value_at((x - particle.x).hypot(y - particle.y));
            total += weight;
            u += weight * particle.u;
            v += weight * particle.v;
        }
        let since = self.since / total.max(f64::MIN_POSITIVE);
        [x - since * u, y - since * v]
    }

    /// The share that obstacles cover, seen with the mean smoothing length h of the particles that cover the rest.
    fn covered_by_obstacles(&self, x: f64, y: f64, h: f64) -> f64 {
        self.obstacles.coverage([x, y], SAMPLED * h).part
    }

    /// The water at (x, y): a Shepard mean over the particles (weights V W), of the surface's height where the surface
    /// is the smoother field, as in a lake, and of the depth where that is, as in a sheet running down a slope.
    pub fn at(&self, x: f64, y: f64) -> Sample {
        if !self.may_be_wet(x, y) || self.obstacles.hold([x, y]) {
            return Sample::default();
        }
        let [from_x, from_y] = self.origin(x, y);
        if !self.may_be_wet(from_x, from_y) {
            return Sample::default();
        }
        let near = |each: &mut dyn FnMut(&Particle, f64)| {
            for particle in self.near(from_x, from_y, SEARCH_MARGIN * self.arrangement.cells.reach_at([from_x, from_y]))
            {
                let dx = x - (particle.x + self.since * particle.u);
                let dy = y - (particle.y + self.since * particle.v);
                let h = SAMPLED * particle.h;
                let r_squared = dx * dx + dy * dy;
                if r_squared < 4.0 * h * h {
                    let weight = particle.area() * CubicSpline::<2>::new(h).value_at(r_squared.sqrt());
                    each(particle, weight);
                }
            }
        };
        let (mut total, mut lengths) = (0.0, 0.0);
        let [mut surface, mut depth, mut u, mut v] = [0.0; 4];
        near(&mut |particle, weight| {
            total += weight;
            lengths += weight * particle.h;
            surface += weight * particle.surface();
            depth += weight * particle.depth;
            u += weight * particle.u;
            v += weight * particle.v;
        });
        let covers = |total: f64| {
            let beside = || self.covered_by_ghosts(x, y) + self.covered_by_obstacles(x, y, lengths / total);
            total >= COVERED || total > 0.0 && total + beside() >= COVERED
        };
        if !covers(total) {
            return Sample::default();
        }
        [surface, depth, u, v] = [surface, depth, u, v].map(|sum| sum / total);
        let [mut surface_spread, mut depth_spread, mut deepest] = [0.0, 0.0, 0.0_f64];
        near(&mut |particle, weight| {
            surface_spread += weight * (particle.surface() - surface).powi(2);
            depth_spread += weight * (particle.depth - depth).powi(2);
            deepest = deepest.max(particle.depth);
        });
        let from_surface = (surface - self.terrain.height(x, y)).min(DEEPER * deepest);
        // Variances squared, so that the smoother field decides alone unless the two are similar.
        let [surface_spread, depth_spread] = [surface_spread, depth_spread].map(|spread| spread * spread);
        let spread = surface_spread + depth_spread;
        let share = if spread > 0.0 { depth_spread / spread } else { 1.0 };
        Sample { depth: (share * from_surface + (1.0 - share) * depth).max(0.0), velocity: [u, v] }
    }
}
