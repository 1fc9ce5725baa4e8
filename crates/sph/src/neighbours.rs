//! Lists of neighbours: pairs of particles of which one reaches the other.

use crate::Cells;
use corpuscle_simd::{LANES, Lanes, Level, Simd, SimdBase, SimdFloat, SimdMask, dispatch};
use fearless_simd::{mask32x8, u32x8};
use rayon::prelude::*;

/// Particles of one block of lists; work is shared out by blocks, so results never depend on the number of threads.
pub const BLOCK: usize = 256;

/// For each particle, its neighbours. Each list is filled up with the particle itself to a multiple of [`LANES`].
#[derive(Debug, Default)]
pub struct NeighbourLists {
    blocks: Vec<Block>,
}

#[derive(Debug, Default)]
struct Block {
    start: Vec<u32>,
    index: Vec<u32>,
    distance: Vec<f64>,
}

/// The neighbours of one particle, filled up with the particle itself to a multiple of [`LANES`].
#[derive(Clone, Copy)]
pub struct Neighbours<'a> {
    /// Their numbers.
    pub index: &'a [u32],
    /// Their distances, m: never 0; where the list is filled up, [`FAR_AWAY`].
    pub distance: &'a [f64],
}

/// Distance at which nothing is felt, m; its square is still a number.
pub const FAR_AWAY: f64 = 1e150;

/// Which particles are neighbours of a particle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Near {
    /// Those that it reaches.
    Reached,
    /// Those that it reaches or that reach it.
    Either,
}

/// A sum over the neighbours of a particle.
pub trait PairSum<T>: Sync {
    /// Sums over the neighbours found of `particle`.
    fn sum<S: Simd>(&self, simd: S, particle: usize, found: Neighbours) -> T;
}

/// No sum: for who wants the lists only.
impl PairSum<()> for () {
    fn sum<S: Simd>(&self, _: S, _: usize, _: Neighbours) {}
}

impl NeighbourLists {
    /// Finds the neighbours of all particles. `x`, `y` and `reach_squared` are in the order of `cells`, whose reach is set.
    /// `sum` is called once for every particle with what was found, and its result goes to `out`.
    pub fn search<T: Send>(
        &mut self,
        near: Near,
        cells: &Cells,
        x: &[f64],
        y: &[f64],
        reach_squared: &[f64],
        out: &mut [T],
        sum: &impl PairSum<T>,
    ) {
        self.blocks.resize_with(x.len().div_ceil(BLOCK), Block::default);
        let places = Places { x, y, reach_squared, near };
        self.blocks.par_iter_mut().zip(out.par_chunks_mut(BLOCK)).enumerate().for_each(|(number, (block, out))| {
            let first = number * BLOCK;
            dispatch!(Level::new(), simd => search_block(simd, block, cells, places, first, out, sum));
        });
    }

    /// The neighbours of particle `i`.
    #[inline(always)]
    pub fn of(&self, i: usize) -> Neighbours<'_> {
        let block = &self.blocks[i / BLOCK];
        let k = i % BLOCK;
        let list = block.start[k] as usize..block.start[k + 1] as usize;
        Neighbours { index: &block.index[list.clone()], distance: &block.distance[list] }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.blocks.iter().map(|block| 4 * block.start.capacity() + 12 * block.index.capacity()).sum()
    }
}

/// Where the particles are and the squares of how far they reach, in the order of the cells.
#[derive(Clone, Copy)]
struct Places<'a> {
    x: &'a [f64],
    y: &'a [f64],
    reach_squared: &'a [f64],
    near: Near,
}

#[inline(always)]
fn search_block<S: Simd, T>(
    simd: S,
    block: &mut Block,
    cells: &Cells,
    places: Places,
    first: usize,
    out: &mut [T],
    sum: &impl PairSum<T>,
) {
    let Block { start, index, distance } = block;
    start.clear();
    start.push(0);
    let mut end = 0;
    for (k, out) in out.iter_mut().enumerate() {
        let i = first + k;
        let begin = end;
        let (xi, yi) = (places.x[i], places.y[i]);
        let mut found = 0;
        let reach = match places.near {
            Near::Reached => places.reach_squared[i].sqrt(),
            Near::Either => cells.reach_at(xi, yi),
        };
        for range in cells.ranges(xi, yi, reach) {
            // Room for every candidate and for the lanes written beyond the last.
            let room = begin + found + range.len() + 2 * LANES;
            if index.len() < room {
                index.resize(room, 0);
                distance.resize(room, 0.0);
            }
            let rest = begin + found;
            found += keep_near(simd, &mut index[rest..], &mut distance[rest..], places, i, range);
        }
        end = begin + found.next_multiple_of(LANES);
        index[begin + found..end].fill(i as u32);
        distance[begin + found..end].fill(FAR_AWAY * FAR_AWAY);
        start.push(end as u32);
        let nearest_squared = 1e-24 * places.reach_squared[i];
        for lanes in distance[begin..end].chunks_exact_mut(LANES) {
            Lanes::from_slice(simd, lanes).max(nearest_squared).sqrt().store_slice(lanes);
        }
        let found = Neighbours { index: &index[begin..end], distance: &distance[begin..end] };
        *out = sum.sum(simd, i, found);
    }
}

/// Writes those of `range` that are neighbours of `i`, and their squared distances, and says how many they are. What
/// stands behind them is left undefined.
#[inline(always)]
fn keep_near<S: Simd>(
    simd: S,
    index: &mut [u32],
    distance: &mut [f64],
    places: Places,
    i: usize,
    range: std::ops::Range<usize>,
) -> usize {
    let (xi, yi, reach) = (places.x[i], places.y[i], places.reach_squared[i]);
    let counting = u32x8::from_fn(simd, |lane| lane as u32);
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
        let (dx, dy) = (load(places.x) - xi, load(places.y) - yi);
        let r_squared = dx * dx + dy * dy;
        let within = match places.near {
            Near::Reached => Lanes::splat(simd, reach),
            Near::Either => load(places.reach_squared).max(reach),
        };
        let mut near = r_squared.simd_lt(within).to_bitmask() & ((1 << lanes) - 1);
        if at <= i && i < at + lanes {
            near &= !(1 << (i - at));
        }
        let numbers = counting + at as u32;
        let mask = mask32x8::from_bitmask(simd, near);
        numbers.compress(mask).store_slice(&mut index[kept..kept + LANES]);
        r_squared
            .compress(fearless_simd::mask64x8::from_bitmask(simd, near))
            .store_slice(&mut distance[kept..kept + LANES]);
        kept += near.count_ones() as usize;
        at += LANES;
    }
    kept
}

impl Neighbours<'_> {
    /// [`LANES`] neighbours at a time: their numbers and distances.
    #[inline(always)]
    pub fn lanes<S: Simd>(self, simd: S) -> impl Iterator<Item = ([usize; LANES], Lanes<S>)> {
        self.index.chunks_exact(LANES).zip(self.distance.chunks_exact(LANES)).map(
            #[inline(always)]
            move |(index, distance)| {
                (std::array::from_fn(|lane| index[lane] as usize), Lanes::from_slice(simd, distance))
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    struct Count;

    impl PairSum<usize> for Count {
        fn sum<S: Simd>(&self, _: S, _: usize, found: Neighbours) -> usize {
            found.distance.iter().filter(|&&r| r < FAR_AWAY).count()
        }
    }

    proptest! {
        #[test]
        fn finds_what_all_pairs_find(
            places in prop::collection::vec((0.0..30.0f64, 0.0..30.0f64, 0.5..6.0f64), 0..150),
            near in prop::sample::select(vec![Near::Reached, Near::Either]),
        ) {
            let x: Vec<f64> = places.iter().map(|p| p.0).collect();
            let y: Vec<f64> = places.iter().map(|p| p.1).collect();
            let mut cells = Cells::default();
            let order = cells.sort(&x, &y, 3.0).to_vec();
            let pick = |values: &[f64]| order.iter().map(|&p| values[p as usize]).collect::<Vec<_>>();
            let reach = pick(&places.iter().map(|p| p.2).collect::<Vec<_>>());
            let (x, y) = (pick(&x), pick(&y));
            cells.set_reach(&reach);
            let squared: Vec<f64> = reach.iter().map(|r| r * r).collect();
            let mut lists = NeighbourLists::default();
            let mut counts = vec![0; x.len()];
            lists.search(near, &cells, &x, &y, &squared, &mut counts, &Count);
            for i in 0..x.len() {
                let within = |j: usize| if near == Near::Either { squared[i].max(squared[j]) } else { squared[i] };
                let mut expected: Vec<u32> = (0..x.len())
                    .filter(|&j| j != i && (x[i] - x[j]).powi(2) + (y[i] - y[j]).powi(2) < within(j))
                    .map(|j| j as u32)
                    .collect();
                prop_assert_eq!(counts[i], expected.len());
                prop_assert_eq!(lists.of(i).index.len() % LANES, 0);
                let mut found = lists.of(i).index[..expected.len()].to_vec();
                prop_assert!(lists.of(i).index[expected.len()..].iter().all(|&j| j as usize == i));
                found.sort_unstable();
                expected.sort_unstable();
                prop_assert_eq!(found, expected);
            }
        }
    }
}
