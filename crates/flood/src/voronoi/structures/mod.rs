//! Outflows by rating, held levels, culverts and weirs in a step.

pub(super) mod hydraulics;
mod kinds;
#[cfg(feature = "gpu")]
pub(super) mod upload;

pub(super) use kinds::{Flows, Structures, warn_of_links};

use super::domain::Domain;
use super::mesh::Mesh;
use super::patch::{Changed, Patch};
use super::solver::Solver;
use crate::zone::Zone;

/// The cells that each structure takes from and gives to.
#[derive(Default)]
pub(crate) struct Patches {
    outflows: Vec<Patch>,
    held: Vec<Patch>,
    links: Vec<[Patch; 2]>,
}

impl Patches {
    /// The tiles over which structures extend.
    pub fn tiles(structures: &Structures, mesh: &Mesh) -> Vec<usize> {
        let zones = structures.outflows.iter().map(|outflow| &outflow.zone);
        let zones = zones.chain(structures.held.iter().map(|held| &held.zone));
        let zones = zones.chain(structures.links.iter().flat_map(|link| &link.ends));
        zones.flat_map(|zone| Patch::tiles(zone, mesh)).collect()
    }

    pub fn of(structures: &Structures, mesh: &Mesh, domain: Option<&Domain>) -> Self {
        let of = |zone: &Zone| Patch::of(zone, mesh, domain);
        Self {
            outflows: structures.outflows.iter().map(|outflow| of(&outflow.zone)).collect(),
            held: structures.held.iter().map(|held| of(&held.zone)).collect(),
            links: structures.links.iter().map(|link| [0, 1].map(|end| of(&link.ends[end]))).collect(),
        }
    }

    /// Lets structures work for `step` s up to `time`: calls `book` with what each took out of the water, or brought.
    pub fn work(
        &self,
        structures: &Structures,
        flows: &mut Flows,
        solver: &mut Solver,
        time: f64,
        step: f64,
        book: &mut impl FnMut(Changed),
    ) {
        let levels = |patch: &Patch, solver: &Solver| patch.level(solver);
        for ((outflow, patch), discharge) in structures.outflows.iter().zip(&self.outflows).zip(&mut flows.outflows) {
            let wanted = levels(patch, solver).map_or(0.0, |level| outflow.rating.at(level).max(0.0));
            let change = patch.take(solver, wanted * step);
            *discharge = -change.volume / step;
            book(change);
        }
        for (held, patch) in structures.held.iter().zip(&self.held) {
            book(patch.hold(solver, held.level.at(time)));
        }
        for ((link, ends), discharge) in structures.links.iter().zip(&self.links).zip(&mut flows.links) {
            let levels = [0, 1].map(|end| levels(&ends[end], solver));
            let wanted = link.discharge(levels, solver.gravity);
            let [from, to] = if wanted >= 0.0 { [0, 1] } else { [1, 0] };
            let taken = ends[from].take(solver, wanted.abs() * step);
            // It comes out at rest.
            let given = ends[to].add(solver, -taken.volume, [0.0; 2]);
            *discharge = (given.volume / step).copysign(wanted);
            book(Changed {
                volume: taken.volume + given.volume,
                momentum: taken.momentum,
                energy: taken.energy + given.energy,
            });
        }
    }
}
