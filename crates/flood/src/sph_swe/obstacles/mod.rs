//! Rigid obstacles: buildings and walls that water goes round.
//!
//! Boundary particles fill them, have mass and push (Akinci et al. 2012). Beyond that no particle stays inside: one that a step takes in is put back to the wall.

mod impulses;
mod push;
mod sites;
#[cfg(feature = "gpu")]
pub(super) mod upload;

pub(crate) use sites::{Site, Sites};

use super::particle::Particle;
#[cfg(feature = "gpu")]
use crate::obstacles::Outline;
#[cfg(feature = "gpu")]
use crate::obstacles::OutlineCells;
use crate::obstacles::Outlines;
use corpuscle_scene::Flood;
use corpuscle_sph::kernel::{CubicSpline, Kernel, SmoothingKernel};
use corpuscle_terrain::Terrain;
use rayon::prelude::*;

/// The obstacles of a flood.
#[derive(Debug, Default)]
pub(crate) struct Obstacles {
    /// Names, by number.
    pub names: Vec<String>,
    outlines: Outlines,
    sites: Sites,
}

/// What walls cover of a particle's kernel.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Coverage {
    /// Integral of W over the obstacles.
    pub part: f64,
    /// How it changes with the smoothing length, 1/m.
    pub slope_in_h: f64,
}

/// Largest part of a kernel that walls are taken to cover: in a nook little is left from which to estimate the depth.
pub(super) const MOST_COVERED: f64 = 0.8;

/// A particle that has come into an obstacle is put this far before its wall, over the particles' distance.
pub(super) const BEFORE_WALL: f64 = 1e-3;

/// Boundary particles stand this close, over the particles' distance.
const PITCH: f64 = 0.5;

impl Obstacles {
    /// The obstacles of a scene with these outlines for particles `spacing` m apart where they are closest whose `kernel` has the support of the
    /// start; they reach at most `reach` m.
    pub fn new(
        flood: &Flood,
        terrain: &Terrain,
        outlines: Outlines,
        spacing: f64,
        reach: f64,
        kernel: &Kernel<2>,
    ) -> Self {
        let tops = flood.obstacle.iter().map(|obstacle| obstacle.height_m);
        let mut sites = Sites::new(&outlines, PITCH * spacing, reach, kernel);
        sites.set_tops(&tops.collect::<Vec<_>>(), |x, y| terrain.height(x, y));
        Self { names: flood.obstacle.iter().map(|obstacle| obstacle.name.clone()).collect(), outlines, sites }
    }

    /// The boundary particles.
    #[cfg(feature = "gpu")]
    pub fn sites(&self) -> &[Site] {
        self.sites.all()
    }

    /// The outlines.
    #[cfg(feature = "gpu")]
    pub fn outlines(&self) -> &[Outline] {
        &self.outlines.all
    }

    /// The cells by which outlines are found, where there are any.
    #[cfg(feature = "gpu")]
    pub fn outlines_by_cell(&self) -> Option<OutlineCells<'_>> {
        self.outlines.by_cell()
    }

    /// Whether there are any.
    pub fn any(&self) -> bool {
        !self.outlines.all.is_empty()
    }

    /// Whether a particle at a position may reach one.
    pub fn may_reach(&self, position: [f64; 2]) -> bool {
        !self.outlines.near(position).is_empty()
    }

    /// Whether a position is inside one.
    pub fn hold(&self, position: [f64; 2]) -> bool {
        self.outlines.hold(position)
    }

    /// Calls `found` with each boundary particle nearer than `reach` to a position, its distance, and the way to it, m.
    #[inline]
    pub fn each(&self, position: [f64; 2], reach: f64, found: impl FnMut(&Site, f64, [f64; 2])) {
        if self.may_reach(position) {
            self.sites.each(position, reach, found);
        }
    }

    /// What obstacles cover at a position of the cubic spline, by which particles are arranged at the start and the water is sampled.
    pub fn coverage(&self, position: [f64; 2], h: f64) -> Coverage {
        let spline = CubicSpline::<2>::new(h);
        let [mut part, mut r_slope] = [0.0; 2];
        self.each(position, 2.0 * h, |site, r, _| {
            part += site.area * spline.value_at(r);
            r_slope += site.area * r * spline.slope(r);
        });
        if part > MOST_COVERED {
            return Coverage { part: MOST_COVERED, slope_in_h: 0.0 };
        }
        Coverage { part, slope_in_h: (r_slope - 2.0 * part) / h }
    }

    /// Puts particles that have come inside back to the wall; what of their velocity led in is taken off. Gives what that adds to
    /// each obstacle's impulse, m4/s, in `impulses`, and returns their number.
    pub fn resolve_penetration(&self, particles: &mut [Particle], spacing: f64, impulses: &mut [[f64; 2]]) -> usize {
        let put_back = |particle: &mut Particle| {
            let position = [particle.x, particle.y];
            if particle.outside.is_some() || !self.may_reach(position) {
                return None;
            }
            let nearest = self.outlines.around(position)?;
            let way = BEFORE_WALL * spacing - nearest.distance;
            particle.x += way * nearest.normal[0];
            particle.y += way * nearest.normal[1];
            let inward = -(particle.u * nearest.normal[0] + particle.v * nearest.normal[1]).min(0.0);
            particle.u += inward * nearest.normal[0];
            particle.v += inward * nearest.normal[1];
            let taken = nearest.normal.map(|along| -particle.volume * inward * along);
            Some((self.outlines.all[nearest.outline].obstacle, taken))
        };
        let taken: Vec<_> = particles.par_iter_mut().filter_map(put_back).collect();
        for &(obstacle, taken) in &taken {
            (0..2).for_each(|axis| impulses[obstacle][axis] += taken[axis]);
        }
        taken.len()
    }

    /// Calls `found` with the number of each obstacle that water before it stands higher than.
    pub fn each_overtopped(&self, particles: &[Particle], mut found: impl FnMut(usize)) {
        for particle in particles {
            self.each([particle.x, particle.y], particle.h, |site, _, _| {
                if particle.surface() > site.top {
                    found(site.obstacle);
                }
            });
        }
    }
}
