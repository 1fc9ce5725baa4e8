//! The ground as the shaders have it: nodes of its height.

use crate::sph_swe::gpu::shared::Parameters;
use crate::sph_swe::gpu::upload::Origin;
use crate::sph_swe::particle::Particle;
use corpuscle_terrain::Terrain;
use rayon::prelude::*;

/// The nodes of the ground's patches, heights above the origin's; their grid is in `parameters`.
pub(in crate::sph_swe) fn nodes(terrain: &Terrain, origin: Origin, parameters: &mut Parameters) -> Vec<[f32; 4]> {
    let patches = terrain.patches_above(origin.level);
    parameters.ground_corner = origin.relative(patches.corner);
    parameters.ground_per_metre = patches.per_metre.map(|value| value as f32);
    parameters.ground_patches = patches.size.map(|nodes| nodes as u32 - 1);
    patches.nodes
}

/// Completes what has come back from the GPU, on which the slope of the ground is not kept.
pub(in crate::sph_swe) fn complete(particles: &mut [Particle], terrain: &Terrain) {
    particles.par_iter_mut().with_min_len(1024).for_each(|particle| {
        particle.ground_slope = terrain.height_and_slope(particle.x, particle.y).1;
    });
}
