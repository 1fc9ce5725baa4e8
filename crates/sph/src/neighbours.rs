//! Lists of neighbours: for each particle those within reach.

use crate::Cells;
use corpuscle_simd::{LANES, Lanes, Level, Simd, SimdBase, SimdFloat, SimdMask, dispatch};
use fearless_simd::{mask32x8, mask64x8, u32x8};
use rayon::prelude::*;
use std::ops::Range;

/// Particles of one block of lists; work is shared out by blocks, so results never depend on the number of threads.
pub const BLOCK: usize = 256;

/// Distance at which nothing is felt, m; its square is still a number.
pub const FAR_AWAY: f64 = 1e150;

/// For each particle, its neighbours. Each list is filled up with the particle itself to a multiple of [`LANES`].
#[derive(Debug, Default)]
pub struct NeighbourLists {
    blocks: Vec<Block>,
}

#[derive(Debug, Default)]
struct Block {
    start: Vec<u32>,
    index: Vec<u32>,
    /// Of the whole block, or of the particle at hand only: see [`Reach::DISTANCES`].
    distance: Vec<f64>,
}

/// The neighbours of one particle, filled up with the particle itself to a multiple of [`LANES`].
#[derive(Clone, Copy)]
pub struct Neighbours<'a> {
    /// Their numbers.
    pub index: &'a [u32],
    /// Their distances, m, never 0, or the squares of them, m2: see [`Reach::DISTANCES`]. Where the list is filled up, [`FAR_AWAY`], or its square.
    pub distance: &'a [f64],
}

/// Which particles are neighbours.
pub trait Reach<const D: usize>: Sync {
    /// Whether lists keep distances, for later passes. Otherwise sums are given squares, which are not kept.
    const DISTANCES: bool;

    /// Search radius of particle `i` at `position`, m.
    fn farthest(&self, cells: &Cells<D>, i: usize, position: [f64; D]) -> f64;

    /// Squares of the distances within which the particles from `at` on are neighbours of particle `i`, m2.
    fn squared<S: Simd>(&self, simd: S, i: usize, at: usize) -> Lanes<S>;

    /// Square of the smallest distance recorded, m2: closer particles are recorded at that. Only where distances are kept.
    fn nearest_squared(&self, i: usize) -> f64;
}

/// One reach for all particles, m.
#[derive(Debug, Clone, Copy)]
pub struct OneReach(pub f64);

impl<const D: usize> Reach<D> for OneReach {
    const DISTANCES: bool = false;

    #[inline(always)]
    fn farthest(&self, _: &Cells<D>, _: usize, _: [f64; D]) -> f64 {
        self.0
    }

    #[inline(always)]
    fn squared<S: Simd>(&self, simd: S, _: usize, _: usize) -> Lanes<S> {
        Lanes::splat(simd, self.0 * self.0)
    }

    fn nearest_squared(&self, _: usize) -> f64 {
        0.0
    }
}

/// A reach for each particle, in the order of the cells, whose reach is set ([`Cells::set_reach`]).
#[derive(Debug, Clone, Copy)]
pub struct EachReach<'a> {
    /// Their squares, m2.
    pub squared: &'a [f64],
    /// Which pairs are neighbours.
    pub near: Near,
}

/// Which particles are neighbours of a particle, where they reach differently far.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Near {
    /// Those that it reaches.
    Reached,
    /// Those that it reaches or that reach it.
    Either,
}

impl Reach<2> for EachReach<'_> {
    const DISTANCES: bool = true;

    #[inline(always)]
    fn farthest(&self, cells: &Cells<2>, i: usize, position: [f64; 2]) -> f64 {
        match self.near {
            Near::Reached => self.squared[i].sqrt(),
            Near::Either => cells.reach_at(position),
        }
    }

    #[inline(always)]
    fn squared<S: Simd>(&self, simd: S, i: usize, at: usize) -> Lanes<S> {
        match self.near {
            Near::Reached => Lanes::splat(simd, self.squared[i]),
            Near::Either => load(simd, self.squared, at).max(self.squared[i]),
        }
    }

    #[inline(always)]
    fn nearest_squared(&self, i: usize) -> f64 {
        1e-24 * self.squared[i]
    }
}

/// A sum over the neighbours of a particle.
pub trait PairSum<T>: Sync {
    /// Whether this particle's neighbours are required; the list of another stays empty.
    #[inline(always)]
    fn requires(&self, _particle: usize) -> bool {
        true
    }

    /// Sums over the neighbours found of `particle`.
    fn sum<S: Simd>(&self, simd: S, particle: usize, found: Neighbours) -> T;
}

/// No sum: only the lists are required.
impl PairSum<()> for () {
    fn sum<S: Simd>(&self, _: S, _: usize, _: Neighbours) {}
}

impl NeighbourLists {
    /// Finds the neighbours of all particles, whose `positions` are in the order of `cells`. `sum` is called once for every particle that it requires, and
    /// its result goes to `out`.
    pub fn search<const D: usize, T: Send>(
        &mut self,
        cells: &Cells<D>,
        positions: [&[f64]; D],
        reach: &impl Reach<D>,
        out: &mut [T],
        sum: &impl PairSum<T>,
    ) {
        self.blocks.resize_with(positions[0].len().div_ceil(BLOCK), Block::default);
        self.blocks.par_iter_mut().zip(out.par_chunks_mut(BLOCK)).enumerate().for_each(|(number, (block, out))| {
            let first = number * BLOCK;
            dispatch!(Level::new(), simd => search_block(simd, block, cells, positions, reach, first, out, sum));
        });
    }

    /// The neighbours of particle `i`, after a search that keeps distances ([`Reach::DISTANCES`]).
    #[inline(always)]
    pub fn of(&self, i: usize) -> Neighbours<'_> {
        let block = &self.blocks[i / BLOCK];
        let k = i % BLOCK;
        let list = block.start[k] as usize..block.start[k + 1] as usize;
        Neighbours { index: &block.index[list.clone()], distance: &block.distance[list] }
    }

    /// Numbers of the neighbours of particle `i`, filled up with `i` to a multiple of [`LANES`].
    #[inline(always)]
    pub fn numbers_of(&self, i: usize) -> &[u32] {
        let block = &self.blocks[i / BLOCK];
        let k = i % BLOCK;
        &block.index[block.start[k] as usize..block.start[k + 1] as usize]
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let of = |block: &Block| 4 * (block.start.capacity() + block.index.capacity()) + 8 * block.distance.capacity();
        self.blocks.iter().map(of).sum()
    }
}

#[inline(always)]
fn search_block<S: Simd, const D: usize, T, R: Reach<D>>(
    simd: S,
    block: &mut Block,
    cells: &Cells<D>,
    positions: [&[f64]; D],
    reach: &R,
    first: usize,
    out: &mut [T],
    sum: &impl PairSum<T>,
) {
    let Block { start, index, distance } = block;
    start.clear();
    start.push(0);
    let mut begin = 0;
    for (k, out) in out.iter_mut().enumerate() {
        let i = first + k;
        if !sum.requires(i) {
            start.push(begin as u32);
            continue;
        }
        let position: [f64; D] = std::array::from_fn(|axis| positions[axis][i]);
        // Where the distances of this particle begin.
        let apart = if R::DISTANCES { begin } else { 0 };
        let mut found = 0;
        for range in cells.ranges_within(position, reach.farthest(cells, i, position)) {
            // Room for every candidate and for the lanes written beyond the last.
            let room = found + range.len() + 2 * LANES;
            make_room(index, begin + room);
            make_room(distance, apart + room);
            let (index, distance) = (&mut index[begin + found..], &mut distance[apart + found..]);
            found += keep_near(simd, index, distance, positions, reach, i, range);
        }
        let filled = found.next_multiple_of(LANES);
        make_room(index, begin + filled);
        make_room(distance, apart + filled);
        let (index, distance) = (&mut index[begin..begin + filled], &mut distance[apart..apart + filled]);
        index[found..].fill(i as u32);
        distance[found..].fill(FAR_AWAY * FAR_AWAY);
        if R::DISTANCES {
            let nearest_squared = reach.nearest_squared(i);
            for lanes in distance.chunks_exact_mut(LANES) {
                Lanes::from_slice(simd, lanes).max(nearest_squared).sqrt().store_slice(lanes);
            }
        }
        *out = sum.sum(simd, i, Neighbours { index, distance });
        begin += filled;
        start.push(begin as u32);
    }
}

#[inline(always)]
fn make_room<T: Copy + Default>(values: &mut Vec<T>, count: usize) {
    if values.len() < count {
        values.resize(count, T::default());
    }
}

/// Writes those of `range` that are neighbours of `i`, and their squared distances, and says how many they are. What
/// stands behind them is left undefined.
#[inline(always)]
fn keep_near<S: Simd, const D: usize>(
    simd: S,
    index: &mut [u32],
    distance: &mut [f64],
    positions: [&[f64]; D],
    reach: &impl Reach<D>,
    i: usize,
    range: Range<usize>,
) -> usize {
    let position: [f64; D] = std::array::from_fn(|axis| positions[axis][i]);
    let counting = u32x8::from_fn(simd, |lane| lane as u32);
    let mut kept = 0;
    let mut at = range.start;
    while at < range.end {
        let lanes = (range.end - at).min(LANES);
        let mut squared = Lanes::splat(simd, 0.0);
        for axis in 0..D {
            let apart = load(simd, positions[axis], at) - position[axis];
            squared = if axis == 0 { apart * apart } else { squared + apart * apart };
        }
        let mut near = squared.simd_lt(reach.squared(simd, i, at)).to_bitmask() & ((1 << lanes) - 1);
        if at <= i && i < at + lanes {
            near &= !(1 << (i - at));
        }
        let numbers = counting + at as u32;
        numbers.compress(mask32x8::from_bitmask(simd, near)).store_slice(&mut index[kept..kept + LANES]);
        squared.compress(mask64x8::from_bitmask(simd, near)).store_slice(&mut distance[kept..kept + LANES]);
        kept += near.count_ones() as usize;
        at += LANES;
    }
    kept
}

/// [`LANES`] numbers from `at` on; beyond the end the last one.
#[inline(always)]
fn load<S: Simd>(simd: S, values: &[f64], at: usize) -> Lanes<S> {
    if at + LANES <= values.len() {
        Lanes::from_slice(simd, &values[at..at + LANES])
    } else {
        Lanes::from_fn(simd, |lane| values[(at + lane).min(values.len() - 1)])
    }
}

impl<'a> Neighbours<'a> {
    /// [`LANES`] neighbours at a time: their numbers, and their distances or the squares of them.
    #[inline(always)]
    pub fn lanes<S: Simd>(self, simd: S) -> impl Iterator<Item = (&'a [u32; LANES], Lanes<S>)> {
        self.index.as_chunks().0.iter().zip(self.distance.chunks_exact(LANES)).map(
            #[inline(always)]
            move |(index, distance)| (index, Lanes::from_slice(simd, distance)),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Counts those found; of a fifth of the particles the neighbours are not required.
    struct Count;

    impl PairSum<usize> for Count {
        fn requires(&self, particle: usize) -> bool {
            particle % 5 != 3
        }

        fn sum<S: Simd>(&self, _: S, _: usize, found: Neighbours) -> usize {
            found.distance.iter().filter(|&&r| r < FAR_AWAY).count()
        }
    }

    /// Points in sorted order, with the reach of each.
    fn sorted<const D: usize>(cells: &mut Cells<D>, points: &[[f64; 4]], size: f64) -> ([Vec<f64>; D], Vec<f64>) {
        let column = |axis: usize| points.iter().map(|point| point[axis]).collect::<Vec<f64>>();
        let columns: [Vec<f64>; D] = std::array::from_fn(column);
        let order = cells.sort(columns.each_ref().map(|column| &column[..]), [size; D]).to_vec();
        let pick = |values: &[f64]| order.iter().map(|&p| values[p as usize]).collect::<Vec<_>>();
        (columns.each_ref().map(|column| pick(column)), pick(&column(3)))
    }

    /// Compares with what all pairs find: those nearer than `within(i, j)`.
    fn finds_what_all_pairs_find<const D: usize>(
        cells: &Cells<D>,
        columns: &[Vec<f64>; D],
        reach: &impl Reach<D>,
        within: impl Fn(usize, usize) -> f64,
    ) {
        let count = columns[0].len();
        let (mut lists, mut counts) = (NeighbourLists::default(), vec![0; count]);
        lists.search(cells, columns.each_ref().map(|column| &column[..]), reach, &mut counts, &Count);
        let squared = |i: usize, j: usize| columns.iter().map(|column| (column[i] - column[j]).powi(2)).sum::<f64>();
        for (i, counted) in counts.into_iter().enumerate() {
            let is_near = |&j: &usize| Count.requires(i) && j != i && squared(i, j) < within(i, j);
            let mut expected: Vec<u32> = (0..count).filter(is_near).map(|j| j as u32).collect();
            assert_eq!(counted, expected.len());
            let list = lists.numbers_of(i);
            assert_eq!(list.len() % LANES, 0);
            assert!(list[expected.len()..].iter().all(|&j| j as usize == i));
            let mut found = list[..expected.len()].to_vec();
            found.sort_unstable();
            expected.sort_unstable();
            assert_eq!(found, expected);
        }
    }

    proptest! {
        #[test]
        fn finds_what_all_pairs_find_where_each_has_its_reach(
            points in prop::collection::vec((0.0..30.0f64, 0.0..30.0f64, 0.5..6.0f64), 0..150),
            near in prop::sample::select(vec![Near::Reached, Near::Either]),
        ) {
            let points: Vec<_> = points.into_iter().map(|(x, y, reach)| [x, y, 0.0, reach]).collect();
            let mut cells = Cells::<2>::default();
            let (columns, reach) = sorted(&mut cells, &points, 3.0);
            cells.set_reach(&reach);
            let squared: Vec<f64> = reach.iter().map(|r| r * r).collect();
            let within = |i: usize, j: usize| if near == Near::Either { squared[i].max(squared[j]) } else { squared[i] };
            finds_what_all_pairs_find(&cells, &columns, &EachReach { squared: &squared, near }, within);
        }

        #[test]
        fn finds_what_all_pairs_find_where_all_have_one_reach(
            points in prop::collection::vec(prop::array::uniform3(0.0..6.0f64), 0..400),
            reach in 0.3..3.0f64,
        ) {
            let points: Vec<_> = points.into_iter().map(|[x, y, z]| [x, y, z, 0.0]).collect();
            let mut plane = Cells::<2>::default();
            let (columns, _) = sorted(&mut plane, &points, reach);
            finds_what_all_pairs_find(&plane, &columns, &OneReach(reach), |_, _| reach * reach);
            let mut space = Cells::<3>::default();
            let (columns, _) = sorted(&mut space, &points, reach);
            finds_what_all_pairs_find(&space, &columns, &OneReach(reach), |_, _| reach * reach);
        }
    }
}
