//! Forces on the water: pressure, viscosity, the slope of the ground, and the control force (`control.rs`).

mod control;

use super::neighbours::Arrangement;
use super::particle::Particle;
use super::solver::{Column, SphSweSolver};
use super::surroundings::Surroundings;
use control::{CONTROLLED, control};
use corpuscle_scene::SphSwe;
use corpuscle_sph::kernel::{Kernel, SmoothingKernel};
use corpuscle_sph::{BLOCK, LANES, Lanes, LanesExt, Level, Simd, SimdBase, dispatch, gather};
use rayon::prelude::*;

impl SphSweSolver {
    /// Finds the accelerations by pressure and viscosity.
    pub(super) fn add_pair_forces(&mut self) {
        self.accelerations.resize(self.arrangement.len(), [0.0; 2]);
        self.accelerations.par_chunks_mut(BLOCK).enumerate().for_each(|(block, out)| {
            let (parameters, first) = (&self.parameters, block * BLOCK);
            dispatch!(Level::new(), simd => pair_forces(simd, parameters, &self.arrangement, &self.columns, first, out));
        });
    }

    /// Adds slope of the ground and control force to the pair forces; returns the sum of both over all the water.
    pub(super) fn add_external_forces(
        &mut self,
        particles: &mut [Particle],
        surroundings: &Surroundings,
        step: f64,
    ) -> [f64; 2] {
        let controlled = self.parameters.control_force && step > 0.0;
        let Self { parameters, h0, gravity, accelerations, of_groups, .. } = self;
        let groups = particles.par_chunks_mut(CONTROLLED).zip(self.arrangement.real.par_chunks(CONTROLLED));
        let of_group = |(particles, indices): (&mut [Particle], &[u32])| {
            let controls = if controlled {
                control(parameters, *h0, particles, &surroundings.terrain, step)
            } else {
                [[0.0; 2]; CONTROLLED]
            };
            let mut sum = [0.0; 2];
            for ((particle, &index), control) in particles.iter_mut().zip(indices).zip(controls) {
                let pairs = accelerations[index as usize];
                let slope = particle.ground_slope;
                let acceleration = [0, 1].map(|k| match particle.outside {
                    None => pairs[k] - *gravity * slope[k] + control[k],
                    Some(_) => 0.0,
                });
                [particle.ax, particle.ay] = acceleration;
                sum = [0, 1].map(|k| sum[k] + particle.volume * acceleration[k]);
            }
            sum
        };
        groups.map(of_group).collect_into_vec(of_groups);
        of_groups.iter().fold([0.0; 2], |all, group| [0, 1].map(|k| all[k] + group[k]))
    }
}

/// Pressure and viscosity on the particles of one block: accelerations, m/s2.
#[inline(always)]
fn pair_forces<S: Simd>(
    simd: S,
    parameters: &SphSwe,
    arrangement: &Arrangement,
    columns: &[Column],
    first: usize,
    out: &mut [[f64; 2]],
) {
    let rows: &[[f64; LANES]] = bytemuck::must_cast_slice(columns);
    for (k, out) in out.iter_mut().enumerate() {
        let i = first + k;
        let own = columns[i];
        // The kernel at h_i: its factors once, its shapes in each pair.
        let kernel = Kernel::<2>::new(parameters.kernel, own.h);
        let (of_slope, of_laplacian) = (0.5 * kernel.slope_factor(), parameters.viscosity * kernel.laplacian_factor());
        let [mut fx, mut fy] = [Lanes::splat(simd, 0.0); 2];
        for (index, r) in arrangement.lists.of(i).lanes(simd) {
            let [x, y, u, v, area, _, pressure, _] = gather(simd, rows, index.map(|index| index as usize));
            let (ex, ey) = (x - own.x, y - own.y);
            // f = -sum m_j (p_i + p_j)/(2 rho_j) grad W + mu sum m_j (v_j - v_i)/rho_j lap W
            let push = kernel.times_slope_shape(area * (pressure + own.pressure), r) * of_slope / r;
            let drag = area * kernel.laplacian_shape(r) * of_laplacian;
            fx += drag * (u - own.u) - push * ex;
            fy += drag * (v - own.v) - push * ey;
        }
        *out = [fx.sum() / own.density, fy.sum() / own.density];
    }
}
