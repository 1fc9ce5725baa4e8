//! Lists of neighbours: pairs of particles of which at least one reaches the other.

use crate::{Cells, LANES, Lanes};
use multiversion::multiversion;
use rayon::prelude::*;

/// Particles of one block of lists; work is shared out by blocks, so results never depend on the number of threads.
pub const BLOCK: usize = 256;

/// For each particle, the particles that it reaches or that reach it. Each list is filled up with the particle itself
/// to a multiple of [`LANES`].
#[derive(Debug, Default)]
pub struct NeighbourLists {
    blocks: Vec<Block>,
}

#[derive(Debug, Default)]
struct Block {
    start: Vec<u32>,
    index: Vec<u32>,
}

/// What a search over one particle's candidates found, in the lists' order.
pub struct Searched<'a> {
    /// The particle.
    pub particle: usize,
    /// Squared distances of the neighbours, m2; filled up to a multiple of [`LANES`] with `f64::INFINITY`.
    pub r_squared: &'a [f64],
}

impl NeighbourLists {
    /// Finds the neighbours of all particles. `x`, `y` and `reach` are in the order of `cells`, whose reach is set. Two
    /// particles are neighbours where their distance is below the larger of their reaches. `each` is called once for
    /// every particle with what was found, and its result goes to `out`.
    pub fn search<T: Send>(
        &mut self,
        cells: &Cells,
        x: &[f64],
        y: &[f64],
        reach_squared: &[f64],
        out: &mut [T],
        each: impl Fn(Searched) -> T + Sync,
    ) {
        self.blocks.resize_with(x.len().div_ceil(BLOCK), Block::default);
        self.blocks.par_iter_mut().zip(out.par_chunks_mut(BLOCK)).enumerate().for_each(|(number, (block, out))| {
            let first = number * BLOCK;
            search_block(block, cells, x, y, reach_squared, first, out, &each);
        });
    }

    /// The neighbours of particle `i`, filled up with `i` itself to a multiple of [`LANES`].
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

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw", "x86_64+avx2"))]
fn search_block<T>(
    block: &mut Block,
    cells: &Cells,
    x: &[f64],
    y: &[f64],
    reach_squared: &[f64],
    first: usize,
    out: &mut [T],
    each: &impl Fn(Searched) -> T,
) {
    block.start.clear();
    block.index.clear();
    block.start.push(0);
    let mut r_squared = Vec::new();
    for (k, out) in out.iter_mut().enumerate() {
        let i = first + k;
        let begin = block.index.len();
        r_squared.clear();
        let (xi, yi) = (x[i], y[i]);
        for range in cells.ranges(xi, yi, cells.reach_at(xi, yi)) {
            append_within(block, &mut r_squared, x, y, reach_squared, i, range);
        }
        let found = block.index.len() - begin;
        let full = found.next_multiple_of(LANES);
        block.index.resize(begin + full, i as u32);
        r_squared.resize(full, f64::INFINITY);
        block.start.push(block.index.len() as u32);
        *out = each(Searched { particle: i, r_squared: &r_squared });
    }
}

/// Appends those of `range` that are neighbours of `i`. Every candidate is written and only the neighbours are kept, so
/// that there is no branch to mispredict.
#[inline(always)]
fn append_within(
    block: &mut Block,
    r_squared: &mut Vec<f64>,
    x: &[f64],
    y: &[f64],
    reach_squared: &[f64],
    i: usize,
    range: std::ops::Range<usize>,
) {
    let (xi, yi, reach) = (x[i], y[i], reach_squared[i]);
    let begin = block.index.len();
    block.index.resize(begin + range.len(), 0);
    let distances = r_squared.len();
    r_squared.resize(distances + range.len(), 0.0);
    let index = &mut block.index[begin..];
    let kept_distance = &mut r_squared[distances..];
    let mut kept = 0;
    let (xs, ys, reaches) = (&x[range.clone()], &y[range.clone()], &reach_squared[range.clone()]);
    for (k, ((&xj, &yj), &reach_j)) in xs.iter().zip(ys).zip(reaches).enumerate() {
        let (dx, dy) = (xj - xi, yj - yi);
        let distance = dx * dx + dy * dy;
        let j = range.start + k;
        index[kept] = j as u32;
        kept_distance[kept] = distance;
        let near = (distance < if reach > reach_j { reach } else { reach_j }) & (j != i);
        kept += usize::from(near);
    }
    block.index.truncate(begin + kept);
    r_squared.truncate(distances + kept);
}

/// Reads lanes from squared distances.
impl Searched<'_> {
    /// The squared distances, [`LANES`] at a time.
    #[inline(always)]
    pub fn lanes(&self) -> impl Iterator<Item = Lanes> + '_ {
        self.r_squared.chunks_exact(LANES).map(|chunk| Lanes::from_fn(|lane| chunk[lane]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn finds_what_all_pairs_find(
            places in prop::collection::vec((0.0..30.0f64, 0.0..30.0f64, 0.5..6.0f64), 0..150),
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
            lists.search(&cells, &x, &y, &squared, &mut counts, |found| {
                found.r_squared.iter().filter(|r| r.is_finite()).count()
            });
            for i in 0..x.len() {
                let mut expected: Vec<u32> = (0..x.len())
                    .filter(|&j| j != i && (x[i] - x[j]).powi(2) + (y[i] - y[j]).powi(2) < squared[i].max(squared[j]))
                    .map(|j| j as u32)
                    .collect();
                prop_assert_eq!(counts[i], expected.len());
                prop_assert_eq!(lists.of(i).len() % LANES, 0);
                let mut found = lists.of(i)[..expected.len()].to_vec();
                prop_assert!(lists.of(i)[expected.len()..].iter().all(|&j| j as usize == i));
                found.sort_unstable();
                expected.sort_unstable();
                prop_assert_eq!(found, expected);
            }
        }
    }
}
