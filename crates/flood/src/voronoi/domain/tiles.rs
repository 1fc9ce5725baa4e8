//! The state by tiles: from process to process where work is shared out anew, to the first where it is saved, and from there where it is restored.

use super::super::change::Overrides;
use super::super::maps::{DRY, Record};
use super::super::mesh::Blocks;
use super::super::rain::Soaked;
use super::super::water::Column;
use super::super::{State, VoronoiFlood};
use super::{Domain, agreed, curve, kept_by};
use corpuscle_model::{Account, ModelError};
use corpuscle_processes::{MAX_IMBALANCE, STEPS_BETWEEN_BALANCING, imbalance};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::ops::Range;

/// Number of cells and of border faces of a tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(in super::super) struct Counts {
    pub cells: u32,
    pub borders: u32,
}

/// Values of a state beyond this are refused.
const LARGEST: f64 = 1e100;

impl State {
    /// Whether its tiles are different ones of `tiles`, and its lists as long as these tiles and so many obstacles need.
    pub(in super::super) fn is_consistent(&self, tiles: usize, obstacles: usize) -> bool {
        let cells: u64 = self.counts.iter().map(|counts| u64::from(counts.cells)).sum();
        let borders: u64 = self.counts.iter().map(|counts| u64::from(counts.borders)).sum();
        let lengths = [self.columns[0].len(), self.columns[1].len(), self.records.len()];
        let soaked = self.soaked.depth.len();
        let mut is_listed = vec![false; tiles];
        let mut is_new =
            |tile: &u32| is_listed.get_mut(*tile as usize).is_some_and(|listed| !std::mem::replace(listed, true));
        self.counts.len() == self.tiles.len()
            && lengths.iter().all(|length| *length as u64 == cells)
            && self.beyond.len() as u64 == borders
            && (soaked == 0 || soaked as u64 == cells)
            && [&self.impulses, &self.forces].iter().all(|of| of.len() == obstacles)
            && self.tiles.iter().all(&mut is_new)
    }

    /// Whether all that steps begin with are numbers whose squares are numbers too.
    pub(in super::super) fn is_finite(&self) -> bool {
        let is_number = |value: f64| value.abs() < LARGEST;
        let columns = self.columns.iter().flatten();
        // A cell that was never wet has no arrival.
        let record = |of: &Record| [of.max_depth, of.fastest[0], of.fastest[1], of.hazard, of.duration];
        let falling = self.falling.iter();
        [self.time, self.before, self.time_step].into_iter().all(is_number)
            && columns.flat_map(|column| [column.volume, column.momentum[0], column.momentum[1]]).all(is_number)
            && self.records.iter().flat_map(record).all(f32::is_finite)
            && self.beyond.iter().all(|beyond| !beyond.is_nan() && *beyond < LARGEST)
            && self.soaked.depth.iter().copied().map(f64::from).all(is_number)
            && falling
                .flat_map(|drop| drop.position.into_iter().chain(drop.velocity).chain([drop.volume]))
                .all(is_number)
    }
}

/// The state of the cells of a tile and of their border faces.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct TileState {
    tile: u32,
    columns: Vec<Column>,
    before: Vec<Column>,
    records: Vec<Record>,
    soaked: Vec<f32>,
    beyond: Vec<f64>,
}

/// The state of a ghost cell that its process sends.
#[derive(Serialize, Deserialize)]
struct CellState {
    column: Column,
    before: Column,
    record: Record,
    soaked: Option<f32>,
    beyond: Vec<f64>,
}

impl VoronoiFlood {
    /// The tiles that are made, by all processes, in the order in which they were.
    pub(in super::super) fn tiles(&self) -> &[u32] {
        self.solver.domain.as_ref().map_or(&self.solver.mesh.made, |domain| &domain.made)
    }

    /// The cells of each tile here, in the order in which tiles were made.
    fn cells_of_tiles(&self) -> Vec<(u32, Range<usize>)> {
        let mesh = &self.solver.mesh;
        let mut next = 0;
        let cells = |tile: &u32| {
            let first = next;
            while next < mesh.len() && mesh.layout.tile_and_index(mesh.point[next]).0 == *tile as usize {
                next += 1;
            }
            (*tile, first..next)
        };
        mesh.made.iter().map(cells).collect()
    }

    /// The border faces of cells, by their numbers among all: they stand in the order of the cells.
    fn borders_of(&self, cells: &Range<usize>) -> Range<usize> {
        let (mesh, borders) = (&self.solver.mesh, &self.solver.borders);
        let before =
            |cell: usize| borders.partition_point(|face| (mesh.faces[*face as usize].cells[0] as usize) < cell);
        before(cells.start)..before(cells.end)
    }

    /// Number of cells and of border faces of each tile.
    pub(in super::super) fn counts(&self) -> Vec<Counts> {
        let of = |(_, cells): &(u32, Range<usize>)| Counts {
            cells: cells.len() as u32,
            borders: self.borders_of(cells).len() as u32,
        };
        self.cells_of_tiles().iter().map(of).collect()
    }

    fn tile_state(&self, tile: u32, cells: &Range<usize>) -> TileState {
        let soaked = &self.state.soaked.depth;
        TileState {
            tile,
            columns: self.solver.columns[cells.clone()].to_vec(),
            before: self.solver.before()[cells.clone()].to_vec(),
            records: self.state.records[cells.clone()].to_vec(),
            soaked: if soaked.is_empty() { Vec::new() } else { soaked[cells.clone()].to_vec() },
            beyond: self.state.beyond[self.borders_of(cells)].to_vec(),
        }
    }

    /// The state of the tiles of this process.
    fn own_tile_states(&self, domain: &Domain) -> Vec<TileState> {
        let own = self.cells_of_tiles().into_iter().filter(|(tile, _)| domain.owns_tile(*tile as usize));
        own.map(|(tile, cells)| self.tile_state(tile, &cells)).collect()
    }

    /// Takes over the state of tiles.
    ///
    /// # Errors
    /// [`ModelError::Checkpoint`] where they have other cells.
    fn install(&mut self, states: &[TileState]) -> Result<(), ModelError> {
        let other = || ModelError::Checkpoint("it belongs to another scene".into());
        let of_tile: HashMap<u32, &TileState> = states.iter().map(|state| (state.tile, state)).collect();
        for (tile, cells) in self.cells_of_tiles() {
            let Some(state) = of_tile.get(&tile) else { return Err(other()) };
            let borders = self.borders_of(&cells);
            let soaks = !self.state.soaked.depth.is_empty();
            let lengths = [state.columns.len(), state.before.len(), state.records.len()];
            let fits = lengths == [cells.len(); 3]
                && state.beyond.len() == borders.len()
                && state.soaked.len() == if soaks { cells.len() } else { 0 };
            if !fits {
                return Err(other());
            }
            self.solver.columns[cells.clone()].copy_from_slice(&state.columns);
            self.solver.before_mut()[cells.clone()].copy_from_slice(&state.before);
            self.state.records[cells.clone()].copy_from_slice(&state.records);
            self.state.beyond[borders].copy_from_slice(&state.beyond);
            if soaks {
                self.state.soaked.depth[cells].copy_from_slice(&state.soaked);
            }
        }
        Ok(())
    }

    /// Finds the cells that processes need of each other, and brings those of others up to date.
    pub(in super::super) fn connect(&mut self) {
        let Some(mut domain) = self.solver.domain.take() else { return };
        domain.connect(&self.solver);
        let [sent, received] = domain.shared();
        let states = |cells: &[u32]| cells.iter().map(|cell| self.cell_state(*cell as usize)).collect::<Vec<_>>();
        let outgoing = sent.iter().map(|(process, cells)| (*process, states(cells))).collect();
        let incoming: Vec<(usize, Vec<CellState>)> = domain.processes.swap(outgoing);
        let ghosts: Vec<usize> = received.iter().flat_map(|(_, cells)| cells).map(|cell| *cell as usize).collect();
        self.solver.domain = Some(domain);
        for (cell, state) in ghosts.into_iter().zip(incoming.into_iter().flat_map(|(_, states)| states)) {
            self.take_ghost(cell, state);
        }
        self.solver.empty_far_ghosts();
    }

    fn cell_state(&self, cell: usize) -> CellState {
        CellState {
            column: self.solver.columns[cell],
            before: self.solver.before()[cell],
            record: self.state.records.get(cell).copied().unwrap_or(DRY),
            soaked: self.state.soaked.depth.get(cell).copied(),
            beyond: self.state.beyond[self.borders_of(&(cell..cell + 1))].to_vec(),
        }
    }

    fn take_ghost(&mut self, cell: usize, state: CellState) {
        self.solver.set_ghost(cell, state.column, state.before);
        if let Some(record) = self.state.records.get_mut(cell) {
            *record = state.record;
        }
        if let (Some(depth), Some(soaked)) = (self.state.soaked.depth.get_mut(cell), state.soaked) {
            *depth = soaked;
        }
        let borders = self.borders_of(&(cell..cell + 1));
        for (beyond, theirs) in self.state.beyond[borders].iter_mut().zip(state.beyond) {
            *beyond = theirs;
        }
    }

    /// Distributes the tiles anew where a check of the load is due and finds it uneven.
    pub(in super::super) fn balance_load_when_due(&mut self) -> Result<(), ModelError> {
        if self.solver.domain.is_some() && self.state.steps.is_multiple_of(STEPS_BETWEEN_BALANCING) {
            return self.balance_load(MAX_IMBALANCE);
        }
        Ok(())
    }

    /// Distributes the tiles anew where the imbalance is above a limit, and that makes it less.
    pub(in super::super) fn balance_load(&mut self, limit: f64) -> Result<(), ModelError> {
        let Some(domain) = &self.solver.domain else { return Ok(()) };
        let wet =
            |cells: &Range<usize>| self.solver.water[cells.clone()].iter().filter(|water| water.depth > 0.0).count();
        let own = self.cells_of_tiles().into_iter().filter(|(tile, _)| domain.owns_tile(*tile as usize));
        let own: Vec<(u32, f64)> = own.map(|(tile, cells)| (tile, wet(&cells) as f64)).collect();
        let mut work = vec![0.0; domain.owners.len()];
        for (tile, of_tile) in domain.processes.gather_all(own).into_iter().flatten() {
            work[tile as usize] = of_tile;
        }
        let owners = curve::owners(self.solver.mesh.layout.tiles, &work, domain.count());
        let [present, better] = [&domain.owners, &owners].map(|owners| imbalance(owners, &work, domain.count()));
        if present <= limit || better >= present {
            return Ok(());
        }
        self.redistribute(owners)
    }

    /// Gives tiles to other processes.
    fn redistribute(&mut self, owners: Vec<u16>) -> Result<(), ModelError> {
        let Some(domain) = &self.solver.domain else { return Ok(()) };
        let states = self.exchange_tiles(domain, &owners);
        let tiles: Vec<usize> = domain.made.iter().map(|tile| *tile as usize).collect();
        let blocks = self.solver.mesh.layout.blocks().clone();
        self.remake_part(owners, blocks, &tiles, &states)
    }

    /// The state of the tiles that this process keeps where tiles belong to `owners`, from the processes that they belong to now.
    fn exchange_tiles(&self, domain: &Domain, owners: &[u16]) -> Vec<TileState> {
        let states = self.own_tile_states(domain);
        let of_process = |process: usize| {
            let keeps = kept_by(process, owners, &self.solver.mesh.layout, domain.rings());
            (process, states.iter().filter(|state| keeps[state.tile as usize]).collect::<Vec<_>>())
        };
        let outgoing = (0..domain.count()).map(of_process).filter(|(_, states)| !states.is_empty()).collect();
        let incoming: Vec<(usize, Vec<TileState>)> = domain.processes.swap(outgoing);
        incoming.into_iter().flat_map(|(_, states)| states).collect()
    }

    /// Brings all ghost cells up to date, those too far away to be kept so included.
    pub(in super::super) fn update_ghost_tiles(&mut self) -> Result<(), ModelError> {
        let Some(domain) = &self.solver.domain else { return Ok(()) };
        let states = self.exchange_tiles(domain, &domain.owners);
        let installed = self.install(&states);
        agreed(self.solver.domain.as_ref(), installed)?;
        self.solver.refresh_water();
        Ok(())
    }

    /// Remakes the cells for other tiles of this process, with the state of those that are kept here.
    fn remake_part(
        &mut self,
        owners: Vec<u16>,
        blocks: Blocks,
        tiles: &[usize],
        states: &[TileState],
    ) -> Result<(), ModelError> {
        let time_step = self.state.time_step;
        self.remake_tiles(blocks, tiles, Some(owners))?;
        let installed = self.install(states);
        agreed(self.solver.domain.as_ref(), installed)?;
        self.solver.refresh_water();
        self.connect();
        if self.state.steps > 0 {
            self.solver.plan();
        }
        self.solver.count();
        self.state.time_step = time_step;
        Ok(())
    }

    /// The whole state, at the first process: as one process alone would save it.
    pub(in super::super) fn gathered_state(&self) -> State {
        let domain = self.solver.domain.as_ref();
        let ([water, momentum, energy], [rained, infiltrated]) = self.booked();
        let mut state = self.state.clone();
        state.booked_before = self.in_all(state.booked_before);
        (state.water, state.momentum, state.energy) = (water, momentum, energy);
        (state.soaked.rained, state.soaked.infiltrated) = (rained, infiltrated);
        state.tiles = self.tiles().to_vec();
        state.blocks = self.solver.mesh.layout.blocks().finer();
        let Some(domain) = domain else {
            state.counts = self.counts();
            state.columns = [self.solver.columns.clone(), self.solver.before().to_vec()];
            return state;
        };
        let mut order = vec![0; domain.is_made.len()];
        domain.made.iter().enumerate().for_each(|(k, tile)| order[*tile as usize] = k);
        let mut all: Vec<TileState> =
            domain.processes.gather(self.own_tile_states(domain)).into_iter().flatten().collect();
        all.sort_unstable_by_key(|of_tile| order[of_tile.tile as usize]);
        let count =
            |of_tile: &TileState| Counts { cells: of_tile.columns.len() as u32, borders: of_tile.beyond.len() as u32 };
        state.counts = all.iter().map(count).collect();
        state.columns = [
            all.iter().flat_map(|of| &of.columns).copied().collect(),
            all.iter().flat_map(|of| &of.before).copied().collect(),
        ];
        state.records = all.iter().flat_map(|of| &of.records).copied().collect();
        state.beyond = all.iter().flat_map(|of| &of.beyond).copied().collect();
        state.soaked.depth = all.iter().flat_map(|of| &of.soaked).copied().collect();
        state
    }

    /// Takes the part of this process of a whole state that all processes have.
    ///
    /// # Errors
    /// [`ModelError::Checkpoint`] where it is of another scene.
    pub(in super::super) fn restore_part(&mut self, mut state: State) -> Result<(), ModelError> {
        let other = || ModelError::Checkpoint("it belongs to another scene".into());
        let Some(domain) = &self.solver.domain else { return Err(other()) };
        let soaked = std::mem::take(&mut state.soaked.depth);
        if state.overrides != Overrides::default() {
            let changed = "the flood was changed while it ran: resume it without `mpirun`";
            return Err(ModelError::Checkpoint(changed.into()));
        }
        let mut states = Vec::with_capacity(state.tiles.len());
        let (mut cell, mut border) = (0, 0);
        for (tile, counts) in state.tiles.iter().zip(&state.counts) {
            let cells = cell..cell + counts.cells as usize;
            let borders = border..border + counts.borders as usize;
            (cell, border) = (cells.end, borders.end);
            states.push(TileState {
                tile: *tile,
                columns: state.columns[0][cells.clone()].to_vec(),
                before: state.columns[1][cells.clone()].to_vec(),
                records: state.records[cells.clone()].to_vec(),
                soaked: if soaked.is_empty() { Vec::new() } else { soaked[cells].to_vec() },
                beyond: state.beyond[borders].to_vec(),
            });
        }
        let mut work = vec![0.0; domain.owners.len()];
        for of_tile in &states {
            work[of_tile.tile as usize] = of_tile.columns.iter().filter(|column| column.volume > 0.0).count() as f64;
        }
        let owners = curve::owners(self.solver.mesh.layout.tiles, &work, domain.count());
        let is_first = domain.is_first();
        let tiles: Vec<usize> = state.tiles.iter().map(|tile| *tile as usize).collect();
        // What was booked stands at the first process.
        let ours = |account: &Account| {
            if is_first { *account } else { Account { initial: account.initial, ..Account::default() } }
        };
        (state.water, state.momentum, state.energy) = (ours(&state.water), ours(&state.momentum), ours(&state.energy));
        if !is_first {
            state.soaked = Soaked { until: state.soaked.until, ..Soaked::default() };
            state.booked_before = Default::default();
        }
        state.columns = [Vec::new(), Vec::new()];
        (state.beyond, state.records, state.tiles, state.counts) = Default::default();
        let blocks = self.allowed_blocks(&state.blocks).ok_or_else(other)?;
        state.blocks.clear();
        self.state = state;
        self.remake_part(owners, blocks, &tiles, &states)
    }
}
