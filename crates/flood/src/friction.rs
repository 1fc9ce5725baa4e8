//! Bed friction after Manning.

use crate::particle::Particle;
use corpuscle_model::ModelError;
use corpuscle_scene::Manning;
use corpuscle_sph::BLOCK;
use corpuscle_terrain::{RasterField, Terrain};
use rayon::prelude::*;
use std::path::Path;

/// Manning's roughness n over the ground, s/m^(1/3).
pub(crate) enum Roughness {
    Even(f64),
    Raster(Box<RasterField>),
}

impl Roughness {
    pub fn open(scene: &Manning, terrain: &Terrain, folder: &Path) -> Result<Self, ModelError> {
        Ok(match scene {
            Manning::Number(n) => Self::Even(*n),
            Manning::Raster { raster } => Self::Raster(Box::new(
                RasterField::open(folder.join(raster), terrain)
                    .map_err(|error| ModelError::Setup(error.to_string()))?,
            )),
        })
    }

    fn at(&self, x: f64, y: f64) -> f64 {
        match self {
            Self::Even(n) => *n,
            Self::Raster(raster) => raster.nearest(x, y).unwrap_or(0.0),
        }
    }

    /// Slows the water for `step` s: dv/dt = -g n^2 |v| v / d^(4/3) (Manning 1891), solved exactly over the step for
    /// the depth as it is: v / (1 + g n^2 |v| d^(-4/3) step). It stops water but never turns it round. Gives the change
    /// of momentum over density, sum of both components, m4/s; `impulses` is working memory.
    pub fn slow(&self, particles: &mut [Particle], gravity: f64, step: f64, impulses: &mut Vec<f64>) -> f64 {
        if matches!(self, Self::Even(0.0)) {
            return 0.0;
        }
        let slow_block = |particles: &mut [Particle]| {
            let inside = particles.iter_mut().filter(|particle| particle.outside.is_none());
            inside.map(|particle| self.slow_one(particle, gravity, step)).sum::<f64>()
        };
        particles.par_chunks_mut(BLOCK).map(slow_block).collect_into_vec(impulses);
        impulses.iter().sum()
    }

    fn slow_one(&self, particle: &mut Particle, gravity: f64, step: f64) -> f64 {
        let n = self.at(particle.x, particle.y);
        let depth = particle.depth;
        let factor = 1.0 / (1.0 + step * gravity * n * n * particle.speed() / (depth * depth.cbrt()));
        let before = particle.u + particle.v;
        particle.u *= factor;
        particle.v *= factor;
        particle.volume * (particle.u + particle.v - before)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn friction_follows_the_exact_solution_for_any_step() {
        let mut particle = Particle::new(0, 0.0, 0.0, 1.0, 1.0);
        (particle.u, particle.v, particle.depth) = (3.0, 4.0, 0.5);
        let (mut once, mut often) = ([particle], [particle]);
        let rough = Roughness::Even(0.03);
        let impulse = rough.slow(&mut once, 9.81, 2.0, &mut Vec::new());
        assert_eq!(impulse, once[0].u + once[0].v - 7.0);
        for _ in 0..1000 {
            rough.slow(&mut often, 9.81, 0.002, &mut Vec::new());
        }
        let exact = 5.0 / (1.0 + 2.0 * 9.81 * 0.03 * 0.03 * 5.0 / 0.5_f64.powf(4.0 / 3.0));
        assert!((once[0].speed() - exact).abs() < 1e-12);
        assert!((often[0].speed() - exact).abs() < 1e-10);
        assert!((once[0].u / once[0].v - 0.75).abs() < 1e-12);
    }
}
