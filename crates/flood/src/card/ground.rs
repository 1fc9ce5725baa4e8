//! The ground as textures: nodes of its height, and its roughness.

use crate::friction::{Coefficient, Roughness};
use crate::particle::Particle;
use corpuscle_gpu::{Gpu, GpuError, texture_2d, wgpu};
use corpuscle_scene::Friction;
use corpuscle_terrain::{Bounds, GroundPatches, Terrain};
use rayon::prelude::*;

use super::layout::{CHEZY, LINEAR, MANNING, MAPPED, Origin, Parameters, SMOOTH};

/// Roughness whose raster does not lie along the model's coordinates is met in so many cells along the longer side.
const CELLS: f64 = 2048.0;

/// The nodes of the ground's patches, heights above `level`, and where they lie.
pub(super) fn texture(
    gpu: &Gpu,
    terrain: &Terrain,
    level: f64,
) -> Result<(wgpu::TextureView, GroundPatches), GpuError> {
    let patches = terrain.patches_above(level);
    let size = patches.size.map(|nodes| nodes as u32);
    let bytes: &[u8] = bytemuck::cast_slice(&patches.nodes);
    Ok((filled(gpu, "ground", size, wgpu::TextureFormat::Rgba32Float, bytes)?, patches))
}

fn filled(
    gpu: &Gpu,
    label: &str,
    [width, height]: [u32; 2],
    format: wgpu::TextureFormat,
    bytes: &[u8],
) -> Result<wgpu::TextureView, GpuError> {
    let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
    let texture = texture_2d(gpu, label, [width, height], format, usage)?;
    let bytes_per_row = Some(bytes.len() as u32 / height);
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row, rows_per_image: Some(height) };
    gpu.queue.write_texture(texture.as_image_copy(), bytes, layout, texture.size());
    Ok(texture.create_view(&wgpu::TextureViewDescriptor::default()))
}

/// How the ground slows the water: told in `parameters`, with Manning's n over the ground as a texture where it is not one number.
pub(super) fn roughness(
    gpu: &Gpu,
    roughness: &Roughness,
    bounds: Bounds,
    origin: Origin,
    parameters: &mut Parameters,
) -> Result<wgpu::TextureView, GpuError> {
    let (law, number) = match roughness {
        Roughness::Manning(Coefficient::Even(0.0)) => (SMOOTH, 0.0),
        Roughness::Manning(Coefficient::Even(n)) => (MANNING, *n),
        Roughness::Other(Friction::Chezy(c)) => (CHEZY, *c),
        Roughness::Other(Friction::Linear(slope)) => (LINEAR, *slope),
        Roughness::Manning(coefficient) => {
            parameters.friction = MAPPED;
            return mapped(gpu, coefficient, bounds, origin, parameters);
        }
    };
    (parameters.friction, parameters.roughness) = (law, number as f32);
    filled(gpu, "roughness", [1, 1], wgpu::TextureFormat::R32Float, &[0; 4])
}

/// Cells of the raster itself, over all the ground.
fn mapped(
    gpu: &Gpu,
    coefficient: &Coefficient,
    bounds: Bounds,
    origin: Origin,
    parameters: &mut Parameters,
) -> Result<wgpu::TextureView, GpuError> {
    let low = [bounds.x_min, bounds.y_min];
    let size = bounds.size();
    let even = size[0].max(size[1]) / CELLS;
    let lattice = coefficient.raster().and_then(corpuscle_terrain::RasterField::cells_in_model);
    let (corner, cell) = lattice.unwrap_or((low, [even; 2]));
    let first = [0, 1].map(|axis| ((low[axis] - corner[axis]) / cell[axis]).floor());
    let count = [0, 1].map(|axis| ((low[axis] + size[axis] - corner[axis]) / cell[axis]).ceil().max(first[axis] + 1.0));
    let [columns, rows] = [0, 1].map(|axis| (count[axis] - first[axis]) as u32);
    let most = gpu.most_pixels();
    if columns.max(rows) > most {
        return Err(GpuError::TooLarge { width: columns, height: rows, most });
    }
    let south_west = [0, 1].map(|axis| corner[axis] + first[axis] * cell[axis]);
    let value = |number: u32| {
        let at = [number % columns, number / columns];
        let [x, y] = [0, 1].map(|axis| south_west[axis] + (f64::from(at[axis]) + 0.5) * cell[axis]);
        coefficient.at(x, y) as f32
    };
    let values: Vec<f32> = (0..columns * rows).into_par_iter().map(value).collect();
    parameters.rough_corner = origin.relative(south_west);
    parameters.rough_per_metre = cell.map(|size| (1.0 / size) as f32);
    parameters.rough_cells = [columns, rows];
    filled(gpu, "roughness", [columns, rows], wgpu::TextureFormat::R32Float, bytemuck::cast_slice(&values))
}

/// What has come back from the card, on which the slope of the ground is not kept.
pub(super) fn complete(particles: &mut [Particle], terrain: &Terrain) {
    particles.par_iter_mut().with_min_len(1024).for_each(|particle| {
        particle.ground_slope = terrain.height_and_slope(particle.x, particle.y).1;
    });
}
