//! Bed friction after Manning, Chezy, or in proportion to the velocity.

use crate::particle::Particle;
use crate::setup::setup;
use corpuscle_model::ModelError;
use corpuscle_scene::{Flood as Settings, Friction, LandUse, Manning};
use corpuscle_sph::BLOCK;
use corpuscle_terrain::{RasterField, Terrain};
use rayon::prelude::*;
use std::path::Path;

/// How the ground slows the water.
pub(crate) enum Roughness {
    /// Manning's n over the ground, s/m^(1/3).
    Manning(Coefficient),
    Other(Friction),
}

/// A number over the ground.
pub(crate) enum Coefficient {
    Even(f64),
    Raster(Box<RasterField>),
    /// By kinds of ground: their numbers in the raster, with theirs; and that of the rest.
    Classes(Box<RasterField>, Vec<(f64, f64)>, Box<Coefficient>),
}

impl Roughness {
    pub fn open(scene: &Settings, terrain: &Terrain, folder: &Path) -> Result<Self, ModelError> {
        if let Some(friction) = scene.friction {
            return Ok(Self::Other(friction));
        }
        let open = |path: &Path| RasterField::open(folder.join(path), terrain).map(Box::new).map_err(setup);
        let rest = match &scene.manning {
            Manning::Number(n) => Coefficient::Even(*n),
            Manning::Raster { raster } => Coefficient::Raster(open(raster)?),
        };
        let Some(LandUse { raster, class }) = &scene.land_use else { return Ok(Self::Manning(rest)) };
        let classes: Vec<_> = class.iter().filter_map(|class| Some((class.code as f64, class.manning?))).collect();
        if classes.is_empty() {
            return Ok(Self::Manning(rest));
        }
        Ok(Self::Manning(Coefficient::Classes(open(raster)?, classes, Box::new(rest))))
    }

    /// Slows the water for `step` s, for the depth as it is; it stops water but never turns it round. Water that runs down a slope
    /// evenly gets the right speed whatever the step.
    ///
    /// - Manning 1891: dv/dt = -g n^2 |v| v / d^(4/3), so v / (1 + g n^2 |v| d^(-4/3) step): exact.
    /// - Chezy 1775: dv/dt = -g |v| v / (C^2 d), likewise.
    /// - In proportion to the velocity: dv/dt = -g S v, by v / (1 + g S step), of first order (Euler, backwards).
    ///
    /// Gives the change of momentum over density, sum of both components, m4/s; `impulses` is working memory.
    pub fn slow(&self, particles: &mut [Particle], gravity: f64, step: f64, impulses: &mut Vec<f64>) -> f64 {
        if matches!(self, Self::Manning(Coefficient::Even(0.0))) {
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
        let (depth, speed) = (particle.depth, particle.speed());
        let factor = match self {
            Self::Manning(coefficient) => {
                let n = coefficient.at(particle.x, particle.y);
                1.0 / (1.0 + step * gravity * n * n * speed / (depth * depth.cbrt()))
            }
            Self::Other(Friction::Chezy(c)) => 1.0 / (1.0 + step * gravity * speed / (c * c * depth)),
            Self::Other(Friction::Linear(slope)) => 1.0 / (1.0 + step * gravity * slope),
        };
        let before = particle.u + particle.v;
        particle.u *= factor;
        particle.v *= factor;
        particle.volume * (particle.u + particle.v - before)
    }
}

impl Coefficient {
    fn at(&self, x: f64, y: f64) -> f64 {
        match self {
            Self::Even(value) => *value,
            Self::Raster(raster) => raster.nearest(x, y).unwrap_or(0.0),
            Self::Classes(raster, classes, rest) => {
                let code = raster.nearest(x, y);
                let class = classes.iter().find(|(class, _)| Some(*class) == code);
                class.map_or_else(|| rest.at(x, y), |(_, value)| *value)
            }
        }
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
        let rough = Roughness::Manning(Coefficient::Even(0.03));
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

    #[test]
    fn other_laws_follow_their_exact_solutions() {
        let slowed = |friction: Friction| {
            let mut particle = Particle::new(0, 0.0, 0.0, 1.0, 1.0);
            (particle.u, particle.v, particle.depth) = (3.0, 4.0, 0.5);
            let mut water = [particle];
            Roughness::Other(friction).slow(&mut water, 9.81, 2.0, &mut Vec::new());
            water[0].speed()
        };
        let chezy = 5.0 / (1.0 + 2.0 * 9.81 * 5.0 / (40.0 * 40.0 * 0.5));
        assert!((slowed(Friction::Chezy(40.0)) - chezy).abs() < 1e-12);
        assert!((slowed(Friction::Linear(0.01)) - 5.0 / (1.0 + 2.0 * 9.81 * 0.01)).abs() < 1e-12);
    }
}
