//! How dense the air is, and how its particles stand about each other.

use super::{Arrangement, Entry, Scale};
use crate::normalisation::{self, Moments, Tensor};
use corpuscle_sph::kernel::SmoothingKernel;
use corpuscle_sph::{
    BLOCK, LANES, Lanes, LanesExt, Level, Neighbours, OneReach, PairSum, Simd, SimdBase, SimdFloat, dispatch,
};
use rayon::prelude::*;

/// Sums over the neighbours of a particle.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Sums {
    /// sum V W, itself included: 1 on the lattice.
    pub filling: f64,
    /// Fourth moments of the Laplacian's weights, over the mean second moment on the lattice.
    pub moments: Moments,
}

struct Filling<'a> {
    entries: &'a [Entry],
    positions: [&'a [f64]; 3],
    scale: Scale,
}

impl Arrangement {
    /// Finds the neighbours of all particles and sums over them; the sums of ghost particles stay as they are.
    pub fn search(&mut self, scale: &Scale, sums: &mut Vec<Sums>) {
        sums.resize(self.entries.len(), Sums::default());
        let Self { cells, lists, entries, x, y, z, .. } = self;
        let positions: [&[f64]; 3] = [x, y, z];
        lists.search(cells, positions, &OneReach(scale.h()), sums, &Filling { entries, positions, scale: *scale });
    }

    /// Finds the tensor by which each particle's diffusion is normalised.
    pub fn normalise(&self, sums: &[Sums], tensors: &mut Vec<Tensor>) {
        tensors.resize(self.index_of.len(), Tensor::default());
        tensors.par_chunks_mut(BLOCK).zip(self.index_of.par_chunks(BLOCK)).for_each(|(tensors, indices)| {
            dispatch!(Level::new(), simd => normalise_block(simd, sums, indices, tensors));
        });
    }
}

#[inline(always)]
fn normalise_block<S: Simd>(simd: S, sums: &[Sums], indices: &[u32], tensors: &mut [Tensor]) {
    for (tensors, indices) in tensors.chunks_mut(LANES).zip(indices.chunks(LANES)) {
        // The last one fills up what is missing.
        let at = |lane: usize| indices[lane.min(indices.len() - 1)] as usize;
        let moments: [&Moments; LANES] = std::array::from_fn(|lane| &sums[at(lane)].moments);
        let found = normalisation::tensors(simd, moments);
        tensors.copy_from_slice(&found[..tensors.len()]);
    }
}

impl PairSum<Sums> for Filling<'_> {
    fn requires(&self, particle: usize) -> bool {
        !self.entries[particle].is_ghost_particle
    }

    #[inline(always)]
    fn sum<S: Simd>(&self, simd: S, own: usize, found: Neighbours) -> Sums {
        let Scale { volume, kernel, to_density, moment: of_lattice, .. } = self.scale;
        let [x, y, z] = self.positions;
        let mut filling = Lanes::splat(simd, 0.0);
        let mut moments = [Lanes::splat(simd, 0.0); 15];
        for (index, r_squared) in found.lanes(simd) {
            filling += kernel.value_shape(r_squared);
            let offset = [
                gathered(simd, x, index) - x[own],
                gathered(simd, y, index) - y[own],
                gathered(simd, z, index) - z[own],
            ];
            let weight = kernel.laplacian_shape(r_squared.sqrt()) / r_squared;
            let products = normalisation::products(offset);
            // Closures over lanes would not be inlined here.
            for (sum, product) in moments.iter_mut().zip(products) {
                *sum += weight * product;
            }
        }
        let of_moments = 0.5 * volume * kernel.laplacian_factor() / of_lattice;
        let mut sums = Sums {
            filling: to_density * volume * (filling.sum() * kernel.value_factor() + kernel.value(0.0)),
            moments: Moments::default(),
        };
        for (moment, lanes) in sums.moments.iter_mut().zip(moments) {
            *moment = of_moments * lanes.sum();
        }
        sums
    }
}

/// Numbers by their index, one a lane.
#[inline(always)]
fn gathered<S: Simd>(simd: S, numbers: &[f64], index: &[u32; LANES]) -> Lanes<S> {
    let mut lanes = [0.0; LANES];
    for (lane, &index) in lanes.iter_mut().zip(index) {
        *lane = numbers[index as usize];
    }
    Lanes::from_slice(simd, &lanes)
}
