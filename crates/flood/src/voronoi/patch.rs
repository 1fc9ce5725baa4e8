//! The cells of a part of the plane, in which water is added, taken, or held.

use super::domain::{Domain, any, total, total_of};
use super::mesh::Mesh;
use super::solver::Solver;
use super::water::Column;
use crate::zone::Zone;
use corpuscle_model::ExactSum;
use corpuscle_terrain::Bounds;

/// A group of cells that exchange water together.
#[derive(Debug, Clone, Default)]
pub(crate) struct Patch {
    /// Those of this process.
    pub(super) cells: Vec<u32>,
    /// Sum of the areas of all, m2.
    pub(super) area: f64,
}

/// What adding or taking water changed: volume, m3, momentum over density, m4/s, and energy over density above the level 0, m5/s2.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Change {
    volume: ExactSum,
    momentum: [ExactSum; 2],
    energy: ExactSum,
}

/// What a change in all processes was.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Changed {
    /// m3.
    pub volume: f64,
    /// Over density, m4/s.
    pub momentum: [f64; 2],
    /// Over density above the level 0, m5/s2.
    pub energy: f64,
}

impl Patch {
    /// The tiles over which a zone extends.
    pub fn tiles(zone: &Zone, mesh: &Mesh) -> Vec<usize> {
        let ([x, y], reach) = zone.round();
        let layout = &mesh.layout;
        let Bounds { x_min, x_max, y_min, y_max } = layout.bounds;
        let corner = |dx: f64, dy: f64| {
            layout.tile_at([(x + dx * reach).clamp(x_min, x_max), (y + dy * reach).clamp(y_min, y_max)])
        };
        let (low, high) = (corner(-1.0, -1.0), corner(1.0, 1.0));
        let columns = layout.tiles[0];
        let rows = low / columns..=high / columns;
        rows.flat_map(|row| (low % columns..=high % columns).map(move |column| row * columns + column)).collect()
    }

    /// The cells whose centroids lie in a zone, or the one at its middle where there is none.
    pub fn of(zone: &Zone, mesh: &Mesh, domain: Option<&Domain>) -> Self {
        let owns = |cell: &usize| domain.is_none_or(|domain| domain.owns(*cell));
        let inside = |cell: &usize| owns(cell) && zone.contains(mesh.centroid[*cell][0], mesh.centroid[*cell][1]);
        let mut cells: Vec<usize> = (0..mesh.len()).filter(inside).collect();
        if !any(domain, !cells.is_empty()) {
            cells.extend(mesh.cell_at(zone.round().0).filter(owns));
        }
        // In the order of their points, whatever the order in which tiles were made.
        cells.sort_unstable_by_key(|cell| mesh.point[*cell]);
        let area = total_of(domain, cells.iter().map(|cell| mesh.area[*cell]).collect());
        Self { cells: cells.into_iter().map(|cell| cell as u32).collect(), area }
    }

    /// Whether there is no cell, in any process.
    pub fn is_empty(&self) -> bool {
        self.area <= 0.0
    }

    /// Mean level of its water by volume, m: films on higher ground count as little as they are deep. None where all is dry.
    pub fn level(&self, solver: &Solver) -> Option<f64> {
        let (mut sum, mut volume) = (ExactSum::default(), ExactSum::default());
        for cell in self.cells.iter().map(|cell| *cell as usize) {
            let water = &solver.water[cell];
            let own = solver.mesh.area[cell] * water.depth;
            if own > 0.0 {
                sum.add(own * water.level);
                volume.add(own);
            }
        }
        total(solver.domain.as_ref(), &mut [], &mut [&mut sum, &mut volume]);
        (volume.value() > 0.0).then(|| sum.value() / volume.value())
    }

    /// Raises the surface evenly by a volume, m3, that comes with a velocity, m/s.
    pub fn add(&self, solver: &mut Solver, volume: f64, velocity: [f64; 2]) -> Changed {
        let mut change = Change::default();
        if volume == 0.0 || self.area <= 0.0 {
            return Changed::default();
        }
        for cell in self.cells.iter().map(|cell| *cell as usize) {
            let part = volume * solver.mesh.area[cell] / self.area;
            let momentum = velocity.map(|velocity| part * velocity);
            change.apply(solver, cell, Column { volume: part, momentum });
        }
        change.in_all(solver.domain.as_ref())
    }

    /// Takes a volume, m3, from the cells in proportion to what they hold, and all they hold at most, with its velocity; the change is negative.
    pub fn take(&self, solver: &mut Solver, volume: f64) -> Changed {
        let mut change = Change::default();
        let held = self.cells.iter().map(|cell| solver.columns[*cell as usize].volume).collect();
        let held = total_of(solver.domain.as_ref(), held);
        if held <= 0.0 || volume <= 0.0 {
            return Changed::default();
        }
        let share = (volume / held).min(1.0);
        for cell in self.cells.iter().map(|cell| *cell as usize) {
            let Column { volume, momentum } = solver.columns[cell];
            let taken = Column { volume: -share * volume, momentum: momentum.map(|momentum| -share * momentum) };
            change.apply(solver, cell, taken);
        }
        change.in_all(solver.domain.as_ref())
    }

    /// Brings each cell to a level, m; what is added has the velocity of the water there.
    pub fn hold(&self, solver: &mut Solver, level: f64) -> Changed {
        let mut change = Change::default();
        for cell in self.cells.iter().map(|cell| *cell as usize) {
            let wanted = solver.mesh.area[cell] * solver.mesh.depth_below(cell, level);
            let volume = wanted - solver.columns[cell].volume;
            let momentum = solver.water[cell].velocity.map(|velocity| volume * velocity);
            change.apply(solver, cell, Column { volume, momentum });
        }
        change.in_all(solver.domain.as_ref())
    }
}

impl Change {
    /// Adds water to a cell. The momentum that a thin film cannot carry counts as taken.
    pub fn apply(&mut self, solver: &mut Solver, cell: usize, added: Column) {
        let (mesh, gravity) = (&solver.mesh, solver.gravity);
        let column = &mut solver.columns[cell];
        let energy = |column: &Column| column.kinetic() + gravity * mesh.potential(cell, column.volume);
        let before = *column;
        let energy_before = energy(column);
        column.volume = (before.volume + added.volume).max(0.0);
        self.volume.add(column.volume - before.volume);
        (0..2).for_each(|axis| column.momentum[axis] += added.momentum[axis]);
        self.energy.add(energy(column) - energy_before);
        solver.touch(cell);
        let now = solver.columns[cell].momentum;
        for (sum, change) in self.momentum.iter_mut().zip([0, 1].map(|axis| now[axis] - before.momentum[axis])) {
            if change != 0.0 {
                sum.add(change);
            }
        }
    }

    /// The change in all processes together.
    pub fn in_all(mut self, domain: Option<&Domain>) -> Changed {
        let [p, q] = &mut self.momentum;
        total(domain, &mut [], &mut [&mut self.volume, p, q, &mut self.energy]);
        let momentum = self.momentum.map(|sum| sum.value());
        Changed { volume: self.volume.value(), momentum, energy: self.energy.value() }
    }
}
