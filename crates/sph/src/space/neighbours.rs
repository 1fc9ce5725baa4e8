//! Lists of the particles within one reach of each.

use super::Cells;
use crate::{BLOCK, FAR_AWAY};
use corpuscle_simd::{LANES, Lanes, Level, Simd, SimdBase, SimdMask, dispatch};
use fearless_simd::{mask32x8, mask64x8, u32x8};
use rayon::prelude::*;
use std::ops::Range;

/// For each particle, those within reach. Each list is filled up with the particle itself to a multiple of [`LANES`].
#[derive(Debug, Default)]
pub struct NeighbourLists {
    blocks: Vec<Block>,
}

#[derive(Debug, Default)]
struct Block {
    start: Vec<u32>,
    index: Vec<u32>,
    /// Squared distances of the particle at hand only.
    r_squared: Vec<f64>,
}

/// The neighbours of one particle, filled up with the particle itself to a multiple of [`LANES`].
#[derive(Clone, Copy)]
pub struct Neighbours<'a> {
    /// Their numbers.
    pub index: &'a [u32],
    /// Squares of their distances, m2; [`FAR_AWAY`] squared where the list is filled up.
    pub r_squared: &'a [f64],
}

/// Where particles are, in the order of their cells.
#[derive(Clone, Copy)]
pub struct Places<'a> {
    /// Along x, m.
    pub x: &'a [f64],
    /// Along y, m.
    pub y: &'a [f64],
    /// Along z, m.
    pub z: &'a [f64],
}

/// A sum over the neighbours of a particle.
pub trait PairSum<T>: Sync {
    /// Whether this particle's neighbours are wanted; the list of another stays empty.
    fn wants(&self, particle: usize) -> bool;

    /// Sums over the neighbours found of `particle`.
    fn sum<S: Simd>(&self, simd: S, particle: usize, found: Neighbours) -> T;
}

impl NeighbourLists {
    /// Finds the particles within `reach` of each. `sum` is called once for every particle that it wants, and its result
    /// goes to `out`.
    pub fn search<T: Send>(&mut self, cells: &Cells, places: Places, reach: f64, out: &mut [T], sum: &impl PairSum<T>) {
        self.blocks.resize_with(places.x.len().div_ceil(BLOCK), Block::default);
        self.blocks.par_iter_mut().zip(out.par_chunks_mut(BLOCK)).enumerate().for_each(|(number, (block, out))| {
            let first = number * BLOCK;
            dispatch!(Level::new(), simd => search_block(simd, block, cells, places, reach, first, out, sum));
        });
    }

    /// Numbers of the neighbours of particle `i`, filled up with `i` to a multiple of [`LANES`].
    #[inline(always)]
    pub fn of(&self, i: usize) -> &[u32] {
        let block = &self.blocks[i / BLOCK];
        let k = i % BLOCK;
        &block.index[block.start[k] as usize..block.start[k + 1] as usize]
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.blocks.iter().map(|block| 4 * (block.start.capacity() + block.index.capacity())).sum()
    }
}

#[inline(always)]
fn search_block<S: Simd, T>(
    simd: S,
    block: &mut Block,
    cells: &Cells,
    places: Places,
    reach: f64,
    first: usize,
    out: &mut [T],
    sum: &impl PairSum<T>,
) {
    let Block { start, index, r_squared } = block;
    start.clear();
    start.push(0);
    let mut begin = 0;
    for (k, out) in out.iter_mut().enumerate() {
        let i = first + k;
        if !sum.wants(i) {
            start.push(begin as u32);
            continue;
        }
        let place = [places.x[i], places.y[i], places.z[i]];
        let mut found = 0;
        cells.each_range(place, reach, |range| {
            // Room for every candidate and for the lanes written beyond the last.
            let room = found + range.len() + 2 * LANES;
            if index.len() < begin + room {
                index.resize(begin + room, 0);
            }
            if r_squared.len() < room {
                r_squared.resize(room, 0.0);
            }
            found += keep_near(simd, &mut index[begin + found..], &mut r_squared[found..], places, i, reach, range);
        });
        let filled = found.next_multiple_of(LANES);
        if index.len() < begin + filled {
            index.resize(begin + filled, 0);
            r_squared.resize(r_squared.len().max(filled), 0.0);
        }
        index[begin + found..begin + filled].fill(i as u32);
        r_squared[found..filled].fill(FAR_AWAY * FAR_AWAY);
        let neighbours = Neighbours { index: &index[begin..begin + filled], r_squared: &r_squared[..filled] };
        *out = sum.sum(simd, i, neighbours);
        begin += filled;
        start.push(begin as u32);
    }
}

/// Writes those of `range` that are neighbours of `i`, and their squared distances, and says how many they are. What
/// stands behind them is left undefined.
#[inline(always)]
fn keep_near<S: Simd>(
    simd: S,
    index: &mut [u32],
    r_squared: &mut [f64],
    places: Places,
    i: usize,
    reach: f64,
    range: Range<usize>,
) -> usize {
    let (xi, yi, zi) = (places.x[i], places.y[i], places.z[i]);
    let counting = u32x8::from_fn(simd, |lane| lane as u32);
    let limit = Lanes::splat(simd, reach * reach);
    let mut kept = 0;
    let mut at = range.start;
    while at < range.end {
        let lanes = (range.end - at).min(LANES);
        let load = |values: &[f64]| {
            if at + LANES <= values.len() {
                Lanes::from_slice(simd, &values[at..at + LANES])
            } else {
                Lanes::from_fn(simd, |lane| values[(at + lane).min(values.len() - 1)])
            }
        };
        let (dx, dy, dz) = (load(places.x) - xi, load(places.y) - yi, load(places.z) - zi);
        let squared = dx * dx + dy * dy + dz * dz;
        let mut near = squared.simd_lt(limit).to_bitmask() & ((1 << lanes) - 1);
        if at <= i && i < at + lanes {
            near &= !(1 << (i - at));
        }
        let numbers = counting + at as u32;
        numbers.compress(mask32x8::from_bitmask(simd, near)).store_slice(&mut index[kept..kept + LANES]);
        squared.compress(mask64x8::from_bitmask(simd, near)).store_slice(&mut r_squared[kept..kept + LANES]);
        kept += near.count_ones() as usize;
        at += LANES;
    }
    kept
}

impl Neighbours<'_> {
    /// Squares of the distances, [`LANES`] at a time.
    #[inline(always)]
    pub fn lanes<S: Simd>(self, simd: S) -> impl Iterator<Item = Lanes<S>> {
        self.r_squared.chunks_exact(LANES).map(
            #[inline(always)]
            move |r_squared| Lanes::from_slice(simd, r_squared),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    struct Count;

    impl PairSum<usize> for Count {
        fn wants(&self, particle: usize) -> bool {
            particle % 5 != 3
        }

        fn sum<S: Simd>(&self, simd: S, _: usize, found: Neighbours) -> usize {
            let far = found.lanes(simd).map(|r_squared| r_squared.largest_lanes()).sum::<usize>();
            found.index.len() - far
        }
    }

    trait Filled {
        /// How many of the lanes fill up.
        fn largest_lanes(self) -> usize;
    }

    impl<S: Simd> Filled for Lanes<S> {
        fn largest_lanes(self) -> usize {
            let lanes: [f64; LANES] = self.into();
            lanes.iter().filter(|&&r_squared| r_squared > FAR_AWAY).count()
        }
    }

    proptest! {
        #[test]
        fn finds_what_all_pairs_find(
            places in prop::collection::vec((0.0..6.0f64, 0.0..6.0f64, 0.0..6.0f64), 0..400),
            reach in 0.3..3.0f64,
        ) {
            let unsorted = [0, 1, 2].map(|axis| {
                places.iter().map(|p| [p.0, p.1, p.2][axis]).collect::<Vec<f64>>()
            });
            let mut cells = Cells::default();
            let order = cells.sort([&unsorted[0], &unsorted[1], &unsorted[2]], reach).to_vec();
            let [x, y, z] = unsorted.map(|values| order.iter().map(|&p| values[p as usize]).collect::<Vec<_>>());
            let mut lists = NeighbourLists::default();
            let mut counts = vec![0; x.len()];
            lists.search(&cells, Places { x: &x, y: &y, z: &z }, reach, &mut counts, &Count);
            for i in 0..x.len() {
                let squared = |j: usize| (x[i] - x[j]).powi(2) + (y[i] - y[j]).powi(2) + (z[i] - z[j]).powi(2);
                let mut expected: Vec<u32> = (0..x.len())
                    .filter(|&j| Count.wants(i) && j != i && squared(j) < reach * reach)
                    .map(|j| j as u32)
                    .collect();
                prop_assert_eq!(counts[i], expected.len());
                let list = lists.of(i);
                prop_assert_eq!(list.len() % LANES, 0);
                prop_assert!(list[expected.len()..].iter().all(|&j| j as usize == i));
                let mut found = list[..expected.len()].to_vec();
                found.sort_unstable();
                expected.sort_unstable();
                prop_assert_eq!(found, expected);
            }
        }
    }
}
