//! Particles in cell order, together with their ghost particles beyond the edges.

use super::boundaries::{EdgeRules, GhostSide};
use corpuscle_sph::{Cells, FEWEST, NeighbourLists};
use rayon::prelude::*;

/// One entry of the arrangement: a particle itself, or its ghost particle beyond an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Entry {
    /// The particle, as numbered before arranging.
    pub from: u32,
    /// Where its ghost particle stands.
    pub ghost: GhostSide,
}

/// How far from an edge a particle has a ghost particle, in reaches: some of those beyond it reach farther than itself.
pub(super) const GHOST_MARGIN: f64 = 1.5;

/// Stands for no particle: a ghost particle.
pub const GHOST: u32 = u32::MAX;

/// Particles and ghost particles, sorted into cells, with their neighbour lists.
#[derive(Debug, Default)]
pub struct Arrangement {
    /// Cells over particles and ghost particles.
    pub cells: Cells<2>,
    /// Neighbour lists over particles and ghost particles.
    pub lists: NeighbourLists,
    /// What stands at each index of the sorted order.
    pub entries: Vec<Entry>,
    /// The index of each particle, in sorted order.
    pub real: Vec<u32>,
    /// The particle at each index, in sorted order; [`GHOST`] for a ghost particle.
    pub particle: Vec<u32>,
    /// The ghost particles: their index and the index of the particle that they show.
    pub ghosts: Vec<(u32, u32)>,
    /// Positions, sorted.
    pub x: Vec<f64>,
    /// Positions, sorted.
    pub y: Vec<f64>,
    /// Squares of the reaches, sorted.
    pub reach_squared: Vec<f64>,
    reach: Vec<f64>,
    unsorted: Unsorted,
}

#[derive(Debug, Default)]
struct Unsorted {
    /// The ghost particles, which stand behind the particles.
    ghosts: Vec<Entry>,
    x: Vec<f64>,
    y: Vec<f64>,
    reach: Vec<f64>,
    index_of: Vec<u32>,
}

impl Arrangement {
    /// Arranges `particles`, of which `reaching` gives (x, y, reach), and their ghost particles beyond the edges.
    pub fn arrange<T: Sync>(
        &mut self,
        particles: &[T],
        reaching: impl Fn(&T) -> (f64, f64, f64) + Sync,
        edges: &EdgeRules,
        cell_size: f64,
    ) {
        let before = &mut self.unsorted;
        for values in [&mut before.x, &mut before.y, &mut before.reach] {
            values.resize(particles.len(), 0.0);
        }
        let positions = before.x.par_iter_mut().zip(&mut before.y).zip(&mut before.reach).zip(particles);
        positions.with_min_len(FEWEST).for_each(|(((x, y), reach), particle)| (*x, *y, *reach) = reaching(particle));
        before.add_ghosts(edges);
        let order = self.cells.sort([&before.x, &before.y], [cell_size; 2]);
        gather(&mut self.x, order, &before.x);
        gather(&mut self.y, order, &before.y);
        gather(&mut self.reach, order, &before.reach);
        let squared = self.reach.par_iter().with_min_len(FEWEST).map(|reach| reach * reach);
        squared.collect_into_vec(&mut self.reach_squared);
        let count = particles.len();
        let entry = |&from: &u32| match (from as usize).checked_sub(count) {
            None => Entry { from, ghost: GhostSide::NONE },
            Some(ghost) => before.ghosts[ghost],
        };
        order.par_iter().with_min_len(FEWEST).map(entry).collect_into_vec(&mut self.entries);
        self.cells.set_reach(&self.reach);
        self.tell_apart(count);
    }

    /// Finds which indices hold particles and which ghost particles.
    fn tell_apart(&mut self, count: usize) {
        self.ghosts.clear();
        if count == self.entries.len() {
            (0..count as u32).into_par_iter().with_min_len(FEWEST).collect_into_vec(&mut self.real);
            self.particle.clone_from(&self.real);
            return;
        }
        let index_of = &mut self.unsorted.index_of;
        index_of.resize(count, 0);
        self.real.clear();
        self.particle.clear();
        for (index, entry) in self.entries.iter().enumerate() {
            if entry.ghost == GhostSide::NONE {
                index_of[entry.from as usize] = index as u32;
                self.particle.push(self.real.len() as u32);
                self.real.push(index as u32);
            } else {
                self.particle.push(GHOST);
                self.ghosts.push((index as u32, entry.from));
            }
        }
        self.ghosts.iter_mut().for_each(|(_, shown)| *shown = index_of[*shown as usize]);
    }

    /// Brings `particles` into sorted order, by way of `spare`.
    pub fn sort<T: Copy + Send + Sync>(&self, particles: &mut Vec<T>, spare: &mut Vec<T>) {
        let from = |&index: &u32| particles[self.entries[index as usize].from as usize];
        self.real.par_iter().with_min_len(FEWEST).map(from).collect_into_vec(spare);
        std::mem::swap(particles, spare);
    }

    /// Number of entries: particles and ghost particles.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.cells.bytes() + self.lists.bytes() + self.len() * (2 * 8 + 8 * 4 + 8 * 3 + 4)
    }
}

impl Unsorted {
    /// Adds the ghost particles of the particles near the edges.
    fn add_ghosts(&mut self, edges: &EdgeRules) {
        self.ghosts.clear();
        for from in 0..self.x.len() {
            let (x, y, reach) = (self.x[from], self.y[from], self.reach[from]);
            if edges.bounds.holds_disc(x, y, GHOST_MARGIN * reach) {
                continue;
            }
            edges.ghosts(x, y, GHOST_MARGIN * reach, |ghost, x, y| {
                self.ghosts.push(Entry { from: from as u32, ghost });
                self.x.push(x);
                self.y.push(y);
                self.reach.push(reach);
            });
        }
    }
}

fn gather(out: &mut Vec<f64>, order: &[u32], values: &[f64]) {
    order.par_iter().with_min_len(FEWEST).map(|&from| values[from as usize]).collect_into_vec(out);
}
