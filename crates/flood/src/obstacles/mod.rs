//! Rigid obstacles: buildings and walls that water goes round.
//!
//! Boundary particles fill them (Akinci et al. 2012). In scheme sph-swe they have mass and push as published; in scheme balanced
//! they make up for what a particle's kernel does not see, and push back with the particle's own pressure, as a mirror of the
//! water before them would. Beyond that no particle stays inside: one that a step takes in is put back to the wall.

mod open;
mod outline;
mod shapes;
mod sites;

pub(crate) use open::{check_overlap, open, polygons};
#[cfg(feature = "gpu")]
pub(crate) use outline::OutlineCells;
pub(crate) use outline::{Outline, Outlines};
pub use shapes::{LineWall, line_walls, obstacle_shapes};
pub(crate) use sites::{Site, Sites};

use crate::particle::Particle;
use corpuscle_model::GaugeColumn;
use corpuscle_sph::kernel::cubic_spline;
use rayon::prelude::*;

/// Gauge columns of an obstacle: the force on it, and its sum over time.
pub(crate) fn force_columns(name: &str) -> [GaugeColumn; 4] {
    let column = |quantity, unit| GaugeColumn { gauge: name.into(), quantity, unit };
    [
        column("force_east", "N"),
        column("force_north", "N"),
        column("impulse_east", "N_s"),
        column("impulse_north", "N_s"),
    ]
}

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

/// Most of a kernel that walls are taken to cover: in a nook little is left to tell the depth by.
const MOST_COVERED: f64 = 0.8;

/// A particle that has come into an obstacle is put this far before its wall, over the particles' distance.
const BEFORE_WALL: f64 = 1e-3;

/// Boundary particles stand this close, over the particles' distance.
const PITCH: f64 = 0.5;

impl Obstacles {
    /// Obstacles for particles `spacing` m apart that reach at most `reach` m; `h0` is the kernel's reach in scheme sph-swe, m.
    pub fn new(names: Vec<String>, outlines: Vec<Outline>, spacing: f64, reach: f64, h0: f64) -> Self {
        let outlines = Outlines::new(outlines, reach);
        let sites = Sites::new(&outlines, PITCH * spacing, reach, h0);
        Self { names, outlines, sites }
    }

    /// The boundary particles.
    #[cfg(feature = "gpu")]
    pub fn sites(&self) -> &[Site] {
        self.sites.all()
    }

    /// The outlines.
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

    /// Whether a particle at a place may reach one.
    pub fn may_reach(&self, place: [f64; 2]) -> bool {
        !self.outlines.near(place).is_empty()
    }

    /// Whether a place is inside one.
    pub fn hold(&self, place: [f64; 2]) -> bool {
        self.outlines.around(place).is_some()
    }

    /// Calls `found` with each boundary particle nearer than `reach` to a place, its distance, and the way to it, m.
    #[inline]
    pub fn each(&self, place: [f64; 2], reach: f64, found: impl FnMut(&Site, f64, [f64; 2])) {
        if self.may_reach(place) {
            self.sites.each(place, reach, found);
        }
    }

    /// What obstacles cover of the kernel of scheme balanced at a place.
    pub fn coverage(&self, place: [f64; 2], h: f64) -> Coverage {
        let [mut part, mut r_slope] = [0.0; 2];
        self.each(place, 2.0 * h, |site, r, _| {
            part += site.area * cubic_spline::value_of_one(r, h);
            r_slope += site.area * r * cubic_spline::slope_of_one(r, h);
        });
        if part > MOST_COVERED {
            return Coverage { part: MOST_COVERED, slope_in_h: 0.0 };
        }
        Coverage { part, slope_in_h: (r_slope - 2.0 * part) / h }
    }

    /// Puts particles that have come inside back to the wall; what of their velocity led in is taken off. Gives what that adds to
    /// each obstacle's impulse, m4/s, in `impulses`, and tells how many.
    pub fn keep_out(&self, particles: &mut [Particle], spacing: f64, impulses: &mut [[f64; 2]]) -> usize {
        let put_back = |particle: &mut Particle| {
            let place = [particle.x, particle.y];
            if particle.outside.is_some() || !self.may_reach(place) {
                return None;
            }
            let nearest = self.outlines.around(place)?;
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

    /// Gives the obstacles tops: their heights, m, above the ground below them; none where they are high enough.
    pub fn set_tops(&mut self, heights: &[Option<f64>], ground: impl Fn(f64, f64) -> f64) {
        for site in self.sites.all_mut() {
            if let Some(height) = heights[site.obstacle] {
                site.top = ground(site.x, site.y) + height;
            }
        }
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
