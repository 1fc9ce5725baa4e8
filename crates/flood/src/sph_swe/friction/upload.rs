//! The roughness of the ground as the shaders have it.

use crate::friction::{Coefficient, Law, Roughness};
use crate::sph_swe::gpu::shared::Parameters;
use crate::sph_swe::gpu::upload::Origin;
use corpuscle_terrain::Bounds;
use rayon::prelude::*;

/// Cells along the longer side into which a roughness raster is resampled that does not lie along the model's coordinates.
const ROUGHNESS_CELLS: f64 = 2048.0;

/// Friction of the ground, whose law is in `parameters`; the law's coefficient over gravity in cells where it is not one number.
pub(in crate::sph_swe) fn roughness(
    roughness: &Roughness,
    bounds: Bounds,
    origin: Origin,
    parameters: &mut Parameters,
) -> Vec<f32> {
    let Roughness { law, number } = roughness;
    parameters.friction_exponent = law.exponent();
    match number.even() {
        Some(number) => {
            parameters.roughness = law.coefficient(1.0, number) as f32;
            Vec::new()
        }
        None => mapped(*law, number, bounds, origin, parameters),
    }
}

/// Cells of the raster itself, over all the ground.
fn mapped(law: Law, number: &Coefficient, bounds: Bounds, origin: Origin, parameters: &mut Parameters) -> Vec<f32> {
    let low = [bounds.x_min, bounds.y_min];
    let size = bounds.size();
    let even = size[0].max(size[1]) / ROUGHNESS_CELLS;
    let lattice = number.raster().and_then(corpuscle_terrain::RasterField::cells_in_model);
    let (corner, cell) = lattice.unwrap_or((low, [even; 2]));
    let first = [0, 1].map(|axis| ((low[axis] - corner[axis]) / cell[axis]).floor());
    let count = [0, 1].map(|axis| ((low[axis] + size[axis] - corner[axis]) / cell[axis]).ceil().max(first[axis] + 1.0));
    let [columns, rows] = [0, 1].map(|axis| (count[axis] - first[axis]) as u32);
    let south_west = [0, 1].map(|axis| corner[axis] + first[axis] * cell[axis]);
    let value = |k: u32| {
        let at = [k % columns, k / columns];
        let [x, y] = [0, 1].map(|axis| south_west[axis] + (f64::from(at[axis]) + 0.5) * cell[axis]);
        law.coefficient(1.0, number.at(x, y)) as f32
    };
    parameters.rough_corner = origin.relative(south_west);
    parameters.rough_per_metre = cell.map(|size| (1.0 / size) as f32);
    parameters.rough_cells = [columns, rows];
    (0..columns * rows).into_par_iter().map(value).collect()
}
