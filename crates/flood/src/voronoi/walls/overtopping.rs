//! Water that flows over the crests of walls.

use super::super::structures::hydraulics::over_weir;
use crate::voronoi::mesh::Mesh;
use crate::voronoi::patch::{Change, Changed};
use crate::voronoi::solver::Solver;
use crate::voronoi::water::Column;
use corpuscle_scene::Weir;
use std::collections::HashMap;

/// Largest part of the volume between the levels on both sides that flows over in a step.
pub(crate) const MAX_CREST_SHARE: f64 = 0.5;

/// A wall between two cells that water may flow over.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OverCrest {
    pub cells: [u32; 2],
    /// Mean level of the crest, or of the ground beside it where that is higher, m.
    pub level: f64,
    /// m.
    pub length: f64,
    /// The part of each cell's water that may flow over here: one over the number of its crests.
    pub parts: [f64; 2],
    /// What flows over in the step, and from which of the cells.
    flow: (usize, Column),
}

/// The crests between cells of a mesh.
pub(crate) fn crests(mesh: &Mesh) -> Vec<OverCrest> {
    let mut counts = HashMap::new();
    mesh.crests().flat_map(|(cells, _)| cells).for_each(|cell| *counts.entry(cell).or_insert(0.0) += 1.0);
    let crest = |(cells, crest): ([u32; 2], &crate::voronoi::mesh::Crest)| OverCrest {
        cells,
        // Where the ground of a cell stands higher, water flows over that.
        level: cells.iter().map(|cell| mesh.level(*cell as usize, 0.0)).fold(crest.level, f64::max),
        length: crest.length,
        parts: cells.map(|cell| 1.0 / counts[&cell]),
        flow: (0, Column::default()),
    };
    mesh.crests().map(crest).collect()
}

/// The coefficient of critical depth on a broad crest, C = (2/3)^(3/2) g^(1/2).
pub(crate) fn coefficient(gravity: f64) -> f64 {
    (2.0_f64 / 3.0).powf(1.5) * gravity.sqrt()
}

/// Lets water flow over crests for `step` s: Poleni's formula for a broad crest, and what the water behind it holds back (Villemonte 1947). All that flows is
/// found from the water before, so that the order of the crests does not count. It takes its velocity along. The change of all the water: of its momentum only
/// what thin films cannot carry.
pub(crate) fn overtop(solver: &mut Solver, step: f64) -> Changed {
    let mut crests = std::mem::take(&mut solver.crests);
    crests.iter_mut().for_each(|crest| crest.flow = crest.flow(solver, step));
    let mut change = Change::default();
    for OverCrest { cells, flow: (from, given), .. } in crests.iter().filter(|crest| crest.flow.1.volume > 0.0) {
        let taken = Column { volume: -given.volume, momentum: given.momentum.map(|momentum| -momentum) };
        for (side, added) in [(*from, taken), (1 - from, *given)] {
            let cell = cells[side] as usize;
            if solver.owns(cell) {
                change.apply(solver, cell, added);
            }
        }
    }
    solver.crests = crests;
    // Walls that water flows over may lie in other processes.
    if solver.crests.is_empty() && solver.domain.is_none() {
        Changed::default()
    } else {
        change.in_all(solver.domain.as_ref())
    }
}

impl OverCrest {
    /// What flows over in a step, and from which of the cells.
    fn flow(&self, solver: &Solver, step: f64) -> (usize, Column) {
        let cells = self.cells.map(|cell| cell as usize);
        let level = |cell: usize| Some(solver.water[cell]).filter(|water| water.depth > 0.0).map(|water| water.level);
        let levels = cells.map(level);
        let [from, to] = if levels[0] >= levels[1] { [0, 1] } else { [1, 0] };
        let none = (from, Column::default());
        let Some(upper) = levels[from].filter(|upper| *upper > self.level) else { return none };
        let weir = Weir { crest_m: self.level, width_m: self.length, coefficient: coefficient(solver.gravity) };
        let wanted = step * over_weir(&weir, upper, levels[to]);
        let [own, other] = [from, to].map(|side| solver.mesh.area[cells[side]]);
        let behind = levels[to].unwrap_or(f64::NEG_INFINITY);
        let most = if behind > self.level {
            (upper - behind) * own * other / (own + other)
        } else {
            (upper - self.level) * own
        };
        let Column { volume: held, momentum } = solver.columns[cells[from]];
        let volume = wanted.min(self.parts[from] * (MAX_CREST_SHARE * most).min(held));
        if volume <= 0.0 {
            return none;
        }
        (from, Column { volume, momentum: momentum.map(|momentum| volume / held * momentum) })
    }
}
