//! The size of particles, and the kernel made exact for them.

use corpuscle_scene::KernelName;
use corpuscle_sph::kernel::{Kernel, SmoothingKernel};

/// Smoothing length over the distance of particles: 26 neighbours on a cubic lattice.
pub const H_OVER_SPACING: f64 = 2.0;

/// Particles a `spacing` apart, and factors that make kernel sums exact on the cubic lattice of that spacing.
#[derive(Debug, Clone, Copy)]
pub struct Scale {
    /// Distance of particles, m.
    pub spacing: f64,
    /// Volume of a particle, m3.
    pub volume: f64,
    /// The kernel.
    pub kernel: Kernel<3>,
    /// Inverse of sum V W on the lattice: 1 in the continuum limit.
    pub to_density: f64,
    /// Over sum V r |W'| / 3.
    pub to_gradient: f64,
    /// Sum V r^2 lap W / 6 on the lattice: 1 in the continuum limit.
    pub moment: f64,
}

impl Scale {
    /// Particles a `spacing` apart, m, with the kernel of that name.
    pub fn new(spacing: f64, kernel: KernelName) -> Self {
        let kernel = Kernel::new(kernel, H_OVER_SPACING * spacing);
        let volume = spacing.powi(3);
        let around = -3..=3_i32;
        let squares = around.clone().flat_map(|x| {
            let around = around.clone();
            around.clone().flat_map(move |y| around.clone().map(move |z| f64::from(x * x + y * y + z * z)))
        });
        let [mut density, mut gradient, mut moment] = [0.0; 3];
        for r_squared in squares.map(|square| square * spacing * spacing) {
            let r = r_squared.sqrt();
            density += volume * kernel.value(r_squared);
            gradient += volume * r * kernel.slope(r) / 3.0;
            moment += volume * r_squared * kernel.laplacian(r) / 6.0;
        }
        Self { spacing, volume, kernel, to_density: 1.0 / density, to_gradient: 1.0 / gradient, moment }
    }

    /// Smoothing length, the kernel's support, m.
    pub fn h(&self) -> f64 {
        self.kernel.support()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lattice_is_not_far_from_a_continuum() {
        for kernel in KernelName::ALL {
            let scale = Scale::new(0.002, kernel);
            for factor in [scale.to_density, scale.to_gradient, scale.moment] {
                assert!((factor - 1.0).abs() < 0.15, "{scale:?}");
            }
        }
    }
}
