//! What air and solids exchange, found by the processes in whose tiles the solids' sites are, and sent to all.

use super::{Domain, from_bytes};
use crate::exchange::ToSolid;
use crate::solids::Site;
use std::ops::Range;

/// Numbers of what a site gets.
const NUMBERS: usize = 4;

impl Domain {
    /// The solids' particles and cells of walls, by their numbers, whose conducted heat a process finds.
    fn nodes_of(&self, process: usize, nodes: usize) -> Range<usize> {
        let at = |process: usize| nodes * process / self.link.count();
        at(process)..at(process + 1)
    }

    /// The same of this process.
    pub fn own_nodes(&self, nodes: usize) -> Range<usize> {
        self.nodes_of(self.link.rank(), nodes)
    }

    /// Completes what sites get from the air, and the heat that is conducted to the particles of solids, W, by what other processes have found.
    pub fn complete(&self, sites: &[Site], given: &mut [ToSolid], heat: &mut [f64]) {
        let mut own = heat[self.own_nodes(heat.len())].to_vec();
        let of_own = given.iter().zip(sites).filter(|(_, site)| !site.is_ghost_particle && self.owns(site.position));
        own.extend(of_own.flat_map(|(given, _)| [given.heat, given.water, given.share, given.conductance]));
        let all = self.link.all_gather(bytemuck::cast_slice(&own));
        let all: Vec<Vec<f64>> = all.iter().map(|bytes| from_bytes(bytes)).collect();
        for (process, theirs) in all.iter().enumerate() {
            let nodes = self.nodes_of(process, heat.len());
            heat[nodes.clone()].copy_from_slice(&theirs[..nodes.len()]);
        }
        let mut rest: Vec<_> = all
            .iter()
            .enumerate()
            .map(|(process, theirs)| theirs[self.nodes_of(process, heat.len()).len()..].as_chunks::<NUMBERS>().0.iter())
            .collect();
        for (given, site) in given.iter_mut().zip(sites).filter(|(_, site)| !site.is_ghost_particle) {
            if let Some([heat, water, share, conductance]) = rest[self.owner(site.position)].next().copied() {
                *given = ToSolid { heat, water, share, conductance };
            }
        }
    }
}
