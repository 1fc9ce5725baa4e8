//! Densities and smoothing lengths of scheme `sph-swe`, at each particle's own smoothing length.

mod smoothing;

use super::boundaries::EdgeRule;
use super::ground::GROUND_BLOCK;
use super::neighbours::{Arrangement, GHOST};
use super::obstacles::Obstacles;
use super::particle::Particle;
use super::solver::{Column, SphSweSolver};
use super::surroundings::Surroundings;
use corpuscle_scene::{KernelName, SmoothingForm, SphSwe};
use corpuscle_sph::kernel::{Kernel, SmoothingKernel};
use corpuscle_sph::{EachReach, Lanes, LanesExt, Near, Neighbours, PairSum, Simd, SimdBase};
use rayon::prelude::*;

/// sum_j W(r_ij, h_i), the particle itself included, 1/m2: times the volume that all particles have, the depth.
pub(super) struct NumberDensities<'a> {
    /// The kernel.
    pub kernel: KernelName,
    /// Squares of the smoothing lengths, m2.
    pub reach_squared: &'a [f64],
}

/// sum_j V_j W(r_ij, h_i), the particle itself included, m: the depth, for particles of unequal volumes.
pub(super) struct Depths<'a> {
    /// The kernel.
    pub kernel: KernelName,
    /// Squares of the smoothing lengths, m2.
    pub reach_squared: &'a [f64],
    /// Volumes, m3.
    pub volumes: &'a [f64],
}

impl PairSum<f64> for NumberDensities<'_> {
    #[inline(always)]
    fn sum<S: Simd>(&self, simd: S, particle: usize, found: Neighbours) -> f64 {
        let kernel = Kernel::<2>::new(self.kernel, self.reach_squared[particle].sqrt());
        let mut sum = Lanes::splat(simd, 0.0);
        for (_, r) in found.lanes(simd) {
            sum += kernel.value_shape(r * r);
        }
        kernel.value_factor() * (at_centre(&kernel) + sum.sum())
    }
}

impl PairSum<f64> for Depths<'_> {
    #[inline(always)]
    fn sum<S: Simd>(&self, simd: S, particle: usize, found: Neighbours) -> f64 {
        let kernel = Kernel::<2>::new(self.kernel, self.reach_squared[particle].sqrt());
        let mut sum = Lanes::splat(simd, 0.0);
        for (index, r) in found.lanes(simd) {
            sum += kernel.value_shape(r * r) * Lanes::from_fn(simd, |lane| self.volumes[index[lane] as usize]);
        }
        kernel.value_factor() * (self.volumes[particle] * at_centre(&kernel) + sum.sum())
    }
}

/// The kernel's shape at its centre.
#[inline(always)]
fn at_centre(kernel: &Kernel<2>) -> f64 {
    kernel.value(0.0) / kernel.value_factor()
}

impl SphSweSolver {
    /// Gives every entry of the arrangement the volume of its particle, where they are not all the same.
    fn fill_volumes(&mut self, particles: &[Particle]) {
        self.volumes.clear();
        let is_first = |particle: &Particle| particle.volume == particles[0].volume;
        if particles.par_iter().all(is_first) {
            return;
        }
        let Arrangement { particle, ghosts, .. } = &self.arrangement;
        let volume = |&k: &u32| if k == GHOST { 0.0 } else { particles[k as usize].volume };
        particle.par_iter().map(volume).collect_into_vec(&mut self.volumes);
        for &(index, shown) in ghosts {
            self.volumes[index as usize] = self.volumes[shown as usize];
        }
    }

    /// rho_i = sum_j m_j W(r_ij, h_i), the particle itself included; and, where it follows from the density, the smoothing
    /// length for the next step.
    pub(super) fn find_densities(&mut self, particles: &mut [Particle], surroundings: &Surroundings, step: f64) {
        self.fill_volumes(particles);
        let Arrangement { cells, lists, x, y, reach_squared, .. } = &mut self.arrangement;
        self.densities.resize(x.len(), 0.0);
        // Kernels at h_i: what a particle does not reach itself adds nothing.
        let (kernel, out, volumes) = (self.parameters.kernel, &mut self.densities, &self.volumes);
        let (positions, reach): ([&[f64]; 2], _) = ([x, y], EachReach { squared: reach_squared, near: Near::Reached });
        if volumes.is_empty() {
            lists.search(cells, positions, &reach, out, &NumberDensities { kernel, reach_squared });
        } else {
            lists.search(cells, positions, &reach, out, &Depths { kernel, reach_squared, volumes });
        }
        let (this, rho0) = (&*self, self.parameters.density_kg_per_m3);
        let groups = particles.par_chunks_mut(GROUND_BLOCK).zip(this.arrangement.real.par_chunks(GROUND_BLOCK));
        groups.for_each(|(particles, indices)| {
            surroundings.find_ground(particles);
            for (particle, &index) in particles.iter_mut().zip(indices) {
                let sum = this.densities[index as usize];
                let water = if this.volumes.is_empty() { particle.volume * sum } else { sum };
                // Whose density was never found has no smoothing length by forms (8) and (9) yet.
                let is_new = step == 0.0 || particle.depth == 0.0;
                let density = rho0 * (water + covered(&this.parameters, &surroundings.obstacles, particle));
                particle.depth = density / rho0;
                particle.next_h = match this.parameters.smoothing {
                    SmoothingForm::Density => h_of_density(&this.parameters, this.h0, density),
                    SmoothingForm::Rate if is_new => 0.0,
                    SmoothingForm::Rate => particle.h,
                };
            }
        });
    }

    /// Fills the columns of particles and ghost particles from the densities.
    pub(super) fn fill_columns(&mut self, particles: &[Particle], surroundings: &Surroundings) {
        let SphSwe { density_kg_per_m3: rho0, gas_constant, clip_negative_pressure, .. } = self.parameters;
        self.columns.resize(self.arrangement.len(), Column::default());
        self.columns.par_iter_mut().zip(&self.arrangement.particle).for_each(|(column, &particle)| {
            if particle == GHOST {
                return;
            }
            let particle = &particles[particle as usize];
            let density = rho0 * particle.depth;
            let pressure = gas_constant * (density - rho0);
            *column = Column {
                x: particle.x,
                y: particle.y,
                u: particle.u,
                v: particle.v,
                area: particle.area(),
                density,
                pressure: if clip_negative_pressure { pressure.max(0.0) } else { pressure },
                h: particle.h,
            };
        });
        for &(index, source) in &self.arrangement.ghosts {
            let index = index as usize;
            let mut column = self.columns[source as usize];
            (column.x, column.y) = (self.arrangement.x[index], self.arrangement.y[index]);
            let ghost = self.arrangement.entries[index].ghost;
            if surroundings.edges.along_x(ghost) == Some(&EdgeRule::Wall) {
                column.u = -column.u;
            }
            if surroundings.edges.along_y(ghost) == Some(&EdgeRule::Wall) {
                column.v = -column.v;
            }
            self.columns[index] = column;
        }
    }
}

/// h = h0 (rho0 / rho)^(1/2), at most `largest_smoothing` times h0, m.
pub(in crate::sph_swe) fn h_of_density(parameters: &SphSwe, h0: f64, density: f64) -> f64 {
    (h0 * (parameters.density_kg_per_m3 / density).sqrt()).min(parameters.largest_smoothing * h0)
}

/// What boundary particles add to the density of a particle, over rho0: sum_k V_k W_ik (Akinci et al. 2012, equation 6).
fn covered(parameters: &SphSwe, obstacles: &Obstacles, particle: &Particle) -> f64 {
    let kernel = Kernel::<2>::new(parameters.kernel, particle.h);
    let mut sum = 0.0;
    obstacles.each([particle.x, particle.y], particle.h, |site, r, _| sum += site.volume * kernel.value(r * r));
    sum
}
