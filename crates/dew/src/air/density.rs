//! How dense the air is, and how regularly its particles stand.

use super::{Arrangement, Entry, Scale};
use corpuscle_sph::space::{Neighbours, PairSum};
use corpuscle_sph::{Lanes, LanesExt, Simd, SimdBase, SimdFloat};

/// Sums over the neighbours of a place.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Sums {
    /// sum V W, itself included: 1 on the lattice.
    pub filling: f64,
    /// sum V r^2 lap W / 6, over its value on the lattice.
    pub moment: f64,
}

struct Filling<'a> {
    entries: &'a [Entry],
    scale: Scale,
}

impl Arrangement {
    /// Finds the neighbours of all particles and sums over them; the sums of images stay as they are.
    pub fn search(&mut self, scale: &Scale, sums: &mut Vec<Sums>) {
        sums.resize(self.entries.len(), Sums::default());
        let Self { cells, lists, entries, x, y, z, .. } = self;
        let places = corpuscle_sph::space::Places { x, y, z };
        lists.search(cells, places, scale.h(), sums, &Filling { entries, scale: *scale });
    }
}

impl PairSum<Sums> for Filling<'_> {
    fn wants(&self, particle: usize) -> bool {
        !self.entries[particle].image
    }

    #[inline(always)]
    fn sum<S: Simd>(&self, simd: S, _: usize, found: Neighbours) -> Sums {
        let Scale { volume, kernels, to_density, moment: of_lattice, .. } = self.scale;
        let mut filling = Lanes::splat(simd, 0.0);
        let mut moment = Lanes::splat(simd, 0.0);
        for r_squared in found.lanes(simd) {
            filling += kernels.poly6_shape(r_squared);
            moment += r_squared * kernels.inside(r_squared.sqrt());
        }
        Sums {
            filling: to_density * volume * (filling.sum() * kernels.poly6_factor() + kernels.poly6(0.0)),
            moment: volume * moment.sum() * kernels.spiky_factor() / (6.0 * of_lattice),
        }
    }
}
