//! The part of a flood that one of several processes computes, and what it exchanges with the others.
//!
//! Each tile belongs to a process ([`curve`]). A process has the cells of its own tiles and of the tiles round them, the ghost cells. It
//! computes the columns of its own cells; those of ghost cells near them come from their processes after each stage of a step
//! ([`Domain::exchange`]). Cells stand in the order in which all processes together made the tiles, so that faces have the same direction
//! everywhere, and all sums over cells are exact: results have the same bits for any number of processes.
//!
//! `tiles.rs` gathers and distributes the state by tiles.

mod curve;
mod tiles;

pub(super) use tiles::Counts;

use super::local;
use super::mesh::{Layout, Mesh};
use super::solver::Solver;
use super::water::{Column, Water};
use corpuscle_model::{ExactSum, ModelError};
use corpuscle_processes::{Lead, Processes};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// How many cells away from its own a process needs the water: the flux between an own cell and its neighbour depends on whether the neighbour can
/// give as much through all of its faces, these on the slopes of the neighbours' neighbours, and these on the water beside them.
const LAYERS: usize = 3;

/// The same where cells take steps of their own, which follow from the water as far away: see [`Local::plan`].
const LAYERS_OF_LOCAL_STEPS: usize = LAYERS + local::REACH;

/// Neighbours that surely lie in the same tile or the next: where there are several tiles they are 24 cells wide or more, and neighbours less than two
/// spacings apart.
const LAYERS_IN_A_TILE: usize = 12;

/// Numbers that are exchanged for a cell.
const NUMBERS: usize = 3;

/// Cells, by the process that they are sent to or come from.
type CellsByProcess = Vec<(usize, Vec<u32>)>;

/// The part of a process, and its connections to the others.
pub(crate) struct Domain {
    pub processes: Processes,
    /// How many cells away from its own the water is needed.
    layers: usize,
    /// The process of each tile.
    owners: Vec<u16>,
    /// Whether each tile is kept here: own ones, and those round them.
    keeps: Vec<bool>,
    /// All tiles that are made, in the order in which they were.
    pub made: Vec<u32>,
    is_made: Vec<bool>,
    /// Whether each cell here is its own.
    own: Vec<bool>,
    /// Own cells that other processes need, and ghost cells that are needed here, for each such process.
    sent: CellsByProcess,
    received: CellsByProcess,
    outgoing: Vec<(usize, Vec<f64>)>,
    incoming: Vec<(usize, Vec<f64>)>,
    /// Number of wet cells of all processes after the last step.
    pub wet: usize,
    /// Set where the flood is set up, so that the other processes wait for commands.
    lead: Option<Lead>,
}

impl Domain {
    /// The part of a process in a layout without cells; none where it is alone.
    pub fn new(processes: &Processes, layout: &Layout, has_local_steps: bool) -> Option<Self> {
        let count = processes.link()?.count();
        let tiles = layout.tiles[0] * layout.tiles[1];
        let mut domain = Self {
            processes: processes.clone(),
            layers: if has_local_steps { LAYERS_OF_LOCAL_STEPS } else { LAYERS },
            owners: Vec::new(),
            keeps: Vec::new(),
            made: Vec::new(),
            is_made: vec![false; tiles],
            own: Vec::new(),
            sent: Vec::new(),
            received: Vec::new(),
            outgoing: Vec::new(),
            incoming: Vec::new(),
            wet: 0,
            lead: None,
        };
        domain.assign(layout, curve::owners(layout.tiles, &vec![1.0; tiles], count));
        Some(domain)
    }

    /// Gives tiles to processes. There must be no cells yet.
    pub fn assign(&mut self, layout: &Layout, owners: Vec<u16>) {
        self.owners = owners;
        self.keeps = kept_by(self.processes.rank(), &self.owners, layout, self.rings());
    }

    /// How many tiles round its own a process keeps.
    fn rings(&self) -> usize {
        self.layers.div_ceil(LAYERS_IN_A_TILE)
    }

    /// Forgets all cells and tiles.
    pub fn clear(&mut self) {
        self.made.clear();
        self.is_made.fill(false);
        self.own.clear();
        [&mut self.sent, &mut self.received].into_iter().for_each(Vec::clear);
        [&mut self.outgoing, &mut self.incoming].into_iter().for_each(Vec::clear);
    }

    /// From here on the other processes wait for commands.
    pub fn open(&mut self) {
        self.lead = Some(self.processes.lead());
    }

    pub fn is_first(&self) -> bool {
        self.processes.is_first()
    }

    /// The number of processes.
    pub fn count(&self) -> usize {
        self.processes.count()
    }

    /// Whether a cell is its own. Cells that were added just now are not.
    #[inline]
    pub fn owns(&self, cell: usize) -> bool {
        self.own.get(cell).copied().unwrap_or(false)
    }

    pub fn owns_tile(&self, tile: usize) -> bool {
        usize::from(self.owners[tile]) == self.processes.rank()
    }

    /// Whether any process has made a tile.
    pub fn is_made(&self, tile: usize) -> bool {
        self.is_made[tile]
    }

    /// Takes tiles for made; returns those that are kept here.
    pub fn add_tiles(&mut self, tiles: &[usize]) -> Vec<usize> {
        for tile in tiles {
            self.made.push(*tile as u32);
            self.is_made[*tile] = true;
        }
        tiles.iter().copied().filter(|tile| self.keeps[*tile]).collect()
    }

    /// Takes cells that were added to the mesh for its own or others'.
    pub fn add_cells(&mut self, mesh: &Mesh) {
        for cell in self.own.len()..mesh.len() {
            self.own.push(self.owns_tile(mesh.layout.tile_and_index(mesh.point[cell]).0));
        }
    }

    /// The elements of all processes' lists, in order, each once.
    pub fn union(&self, own: Vec<usize>) -> Vec<usize> {
        let mut all: Vec<usize> = self.processes.gather_all(own).into_iter().flatten().collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// What all processes have found, at the first; none at others.
    pub fn gathered<T: Serialize + DeserializeOwned>(domain: Option<&Self>, found: Vec<T>) -> Option<Vec<T>> {
        let Some(domain) = domain else { return Some(found) };
        let all = domain.processes.gather_list(found);
        domain.is_first().then_some(all)
    }

    /// Finds which cells of others are needed here, and which of here elsewhere.
    pub fn connect(&mut self, solver: &Solver) {
        let mesh = &solver.mesh;
        let mut wanted: CellsByProcess = Vec::new();
        for cell in self.ghosts(solver) {
            let owner = usize::from(self.owners[mesh.layout.tile_and_index(mesh.point[cell as usize]).0]);
            match wanted.iter_mut().find(|(process, _)| *process == owner) {
                Some((_, cells)) => cells.push(cell),
                None => wanted.push((owner, vec![cell])),
            }
        }
        wanted.sort_unstable_by_key(|(process, _)| *process);
        let points = |cells: &[u32]| cells.iter().map(|cell| mesh.point[*cell as usize]).collect::<Vec<u64>>();
        let asked = self.processes.swap(wanted.iter().map(|(process, cells)| (*process, points(cells))).collect());
        let cells =
            |points: Vec<u64>| points.into_iter().filter_map(|point| mesh.cell_of(point)).map(|cell| cell as u32);
        self.sent =
            asked.into_iter().map(|(process, points): (usize, Vec<u64>)| (process, cells(points).collect())).collect();
        self.received = wanted;
        let room = |of: &[(usize, Vec<u32>)]| {
            of.iter().map(|(process, cells)| (*process, vec![0.0; NUMBERS * cells.len()])).collect()
        };
        self.outgoing = room(&self.sent);
        self.incoming = room(&self.received);
    }

    /// Ghost cells whose water is needed, in order.
    fn ghosts(&self, solver: &Solver) -> Vec<u32> {
        let mesh = &solver.mesh;
        let mut found: Vec<u32> = Vec::new();
        let mut is_found = vec![false; mesh.len()];
        let mut add = |cell: usize, found: &mut Vec<u32>| {
            if !self.owns(cell) && !std::mem::replace(&mut is_found[cell], true) {
                found.push(cell as u32);
            }
        };
        for cell in (0..mesh.len()).filter(|cell| self.owns(*cell)) {
            mesh.links_of(cell).iter().filter_map(|link| link.cell()).for_each(|other| add(other, &mut found));
        }
        let mut first = 0;
        for _ in 1..self.layers {
            let last = found.len();
            for number in first..last {
                let cell = found[number] as usize;
                mesh.links_of(cell).iter().filter_map(|link| link.cell()).for_each(|other| add(other, &mut found));
            }
            first = last;
        }
        for crest in &solver.crests {
            if crest.cells.iter().any(|cell| self.owns(*cell as usize)) {
                crest.cells.iter().for_each(|cell| add(*cell as usize, &mut found));
            }
        }
        found.sort_unstable();
        found
    }

    /// The own cells that others need, and the ghost cells that are needed here, with their processes.
    pub fn shared(&self) -> [&CellsByProcess; 2] {
        [&self.sent, &self.received]
    }

    /// Sends the columns of own cells to the processes that need them; calls `changed` with those of ghost cells.
    pub fn exchange(&mut self, columns: &mut [Column], mut changed: impl FnMut(usize, &mut Column, Column)) {
        for ((_, numbers), (_, cells)) in self.outgoing.iter_mut().zip(&self.sent) {
            for (numbers, cell) in numbers.chunks_exact_mut(NUMBERS).zip(cells) {
                let Column { volume, momentum: [p, q] } = columns[*cell as usize];
                numbers.copy_from_slice(&[volume, p, q]);
            }
        }
        if let Some(link) = self.processes.link() {
            link.exchange(&self.outgoing, &mut self.incoming);
        }
        for ((_, numbers), (_, cells)) in self.incoming.iter().zip(&self.received) {
            for (numbers, cell) in numbers.chunks_exact(NUMBERS).zip(cells) {
                let cell = *cell as usize;
                changed(cell, &mut columns[cell], Column { volume: numbers[0], momentum: [numbers[1], numbers[2]] });
            }
        }
    }

    /// Replaces each level by the highest of all processes.
    pub fn most(&self, levels: &mut [u8]) {
        let mut least: Vec<f64> = levels.iter().map(|level| -f64::from(*level)).collect();
        if let Some(link) = self.processes.link() {
            link.min(&mut least);
        }
        levels.iter_mut().zip(least).for_each(|(level, least)| *level = -least as u8);
    }
}

/// The tiles that a process keeps: its own, and so many rings round them.
fn kept_by(process: usize, owners: &[u16], layout: &Layout, rings: usize) -> Vec<bool> {
    let mut keeps: Vec<bool> = owners.iter().map(|owner| usize::from(*owner) == process).collect();
    for _ in 0..rings {
        let inner = keeps.clone();
        for tile in (0..inner.len()).filter(|tile| inner[*tile]) {
            let beside = super::mesh::AROUND.iter().filter_map(|away| layout.beside(tile, *away));
            beside.for_each(|tile| keeps[tile] = true);
        }
    }
    keeps
}

/// Replaces counts and sums by those over all processes, if there are several.
pub(crate) fn total(domain: Option<&Domain>, counts: &mut [i64], sums: &mut [&mut ExactSum]) {
    if let Some(domain) = domain {
        domain.processes.total(counts, sums);
    }
}

/// The sum of all processes' sums.
pub(crate) fn total_of(domain: Option<&Domain>, mut sum: ExactSum) -> f64 {
    total(domain, &mut [], &mut [&mut sum]);
    sum.value()
}

/// Whether something holds for any process.
pub(crate) fn any(domain: Option<&Domain>, holds: bool) -> bool {
    let mut count = [i64::from(holds)];
    total(domain, &mut count, &mut []);
    count[0] > 0
}

/// An error of any process, at all of them.
pub(crate) fn agreed<T>(domain: Option<&Domain>, result: Result<T, ModelError>) -> Result<T, ModelError> {
    match domain {
        Some(domain) => domain.processes.agree(result, ModelError::Setup),
        None => result,
    }
}

impl Solver {
    /// Whether a cell is computed by this process.
    #[inline]
    pub fn owns(&self, cell: usize) -> bool {
        self.domain.as_ref().is_none_or(|domain| domain.owns(cell))
    }

    /// Takes the columns of ghost cells from their processes, those that a stage has changed: where cells take steps of their own, others may show the water of
    /// another time.
    pub fn exchange(&mut self, is_changed: impl Fn(usize) -> bool) {
        let Some(mut domain) = self.domain.take() else { return };
        let Self { mesh, columns, water, .. } = self;
        let mut wet = Vec::new();
        domain.exchange(columns, |cell, column, theirs| {
            if !is_changed(cell) {
                return;
            }
            *column = theirs;
            water[cell] = mesh.water_as_it_is(cell, column);
            if water[cell].depth > 0.0 {
                wet.push(cell);
            }
        });
        wet.into_iter().for_each(|cell| self.mark_wet_ghost(cell));
        self.domain = Some(domain);
    }

    /// Empties the ghost cells that are too far away to be kept up to date.
    pub fn empty_far_ghosts(&mut self) {
        let Some(domain) = &self.domain else { return };
        let mut is_kept: Vec<bool> = (0..self.mesh.len()).map(|cell| domain.owns(cell)).collect();
        for cell in domain.received.iter().flat_map(|(_, cells)| cells) {
            is_kept[*cell as usize] = true;
        }
        for cell in (0..is_kept.len()).filter(|cell| !is_kept[*cell]) {
            self.columns[cell] = Column::default();
            self.water[cell] = Water { level: self.mesh.level(cell, 0.0), ..Water::default() };
        }
    }
}
