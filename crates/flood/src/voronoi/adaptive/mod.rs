//! Cells that become finer and coarser while the water moves.
//!
//! Every some steps the required resolution is evaluated ([`refinement`]). Where cells must be finer than they are, or many could be coarser, all are remade, and the
//! water and what is known of each cell is carried over ([`carry`]) by what old and new cells have in common ([`overlap`]).

mod borders;
mod carry;
mod overlap;
mod refinement;

use super::friction::Slowing;
use super::local::{HIGHEST, Local};
use super::maps::Record;
use super::mesh::{Blocks, Layout, Mesh};
use super::open::longest_step;
use super::patch::Patch;
use super::solver::Solver;
use super::structures::Patches;
use super::{VoronoiFlood, rain::Weather};
use crate::error::setup;
use borders::Border;
use corpuscle_model::ModelError;
use corpuscle_scene::TimeSteps;

/// Adaptive mesh refinement: its settings and working memory.
pub(super) struct Adaptive {
    settings: corpuscle_scene::Adaptive,
    /// How often the spacing is halved at most.
    finest: u8,
    /// How often it is halved everywhere in each block by `[[flood.finer]]`; empty where there is none.
    of_parts: Vec<u8>,
    /// The levels required by each cell.
    required: Vec<refinement::LevelRange>,
}

/// Cells before a remake, with their water, records and infiltration.
pub(super) struct Old {
    solver: Solver,
    records: Vec<Record>,
    /// Infiltrated depth of each cell, m; empty where there is no infiltration.
    soaked: Vec<f32>,
    borders: Vec<Border>,
}

impl Adaptive {
    /// Adaptive refinement of a layout by a scene's settings.
    pub fn new(settings: corpuscle_scene::Adaptive, layout: &Layout, has_parts: bool) -> Self {
        let finest = layout.level_of(settings.finest_m);
        let of_parts = if has_parts { refinement::levels_of_parts(layout) } else { Vec::new() };
        Self { settings, finest, of_parts, required: Vec::new() }
    }

    /// Whether blocks may have these levels.
    pub fn allows(&self, levels: &[(u32, u8)]) -> bool {
        levels.iter().all(|(_, level)| *level <= self.finest)
    }
}

impl VoronoiFlood {
    /// Remakes the cells, with the spacing halved as often as a function gives at a position in model coordinates, and carries the water
    /// over. As often as `flood.adaptive.finest_m` allows at most, and until the refinement criteria require other cells. A scene without `[flood.adaptive]` keeps
    /// its cells.
    ///
    /// # Errors
    /// [`ModelError::Setup`] where the cells would not fit in memory.
    pub fn remake_cells(&mut self, halvings: impl Fn(f64, f64) -> u8) -> Result<(), ModelError> {
        if self.solver.domain.is_some() {
            return Err(setup("cells are remade on request by one process only"));
        }
        let Some(adaptive) = &self.adaptive else { return Ok(()) };
        let mut blocks = self.solver.mesh.layout.blocks().cleared();
        for block in 0..blocks.levels().len() {
            let [x, y] = blocks.middle(block);
            blocks.levels_mut()[block] = halvings(x, y).min(adaptive.finest);
        }
        self.regrade(blocks)
    }

    /// How often the cells were remade since the start.
    pub fn remakes(&self) -> u64 {
        self.state.remakes
    }

    /// Number of steps between two checks of the resolution; none where cells are not adaptive.
    pub(super) fn steps_between_checks(&self) -> Option<u64> {
        // A step that is counted may have several of the shortest.
        let parts = if self.settings.time_steps == TimeSteps::Local { 1 << HIGHEST } else { 1 };
        self.adaptive.as_ref().map(|adaptive| u64::from((adaptive.settings.every_steps / parts).max(1)))
    }

    /// Refines and coarsens the cells, where a check is due. At the start of a step: what is shown between two steps has the cells
    /// of both.
    pub(super) fn adapt(&mut self) -> Result<(), ModelError> {
        let Some(every) = self.steps_between_checks() else { return Ok(()) };
        // The water at the start was checked before.
        if self.state.steps == 0 || !self.state.steps.is_multiple_of(every) {
            return Ok(());
        }
        self.required_blocks().map_or(Ok(()), |blocks| self.regrade(blocks))
    }

    /// Refines the cells where the water at the start requires it; returns whether there were any.
    pub(super) fn adapt_to_start(&mut self) -> Result<bool, ModelError> {
        let Some(blocks) = self.required_blocks() else { return Ok(false) };
        self.remake(blocks)?;
        Ok(true)
    }

    /// Most checks of the water at the start: finer cells resolve more of the ground.
    pub(super) fn checks_at_start(&self) -> u8 {
        self.adaptive.as_ref().map_or(0, |adaptive| adaptive.finest + 1)
    }

    /// Remakes all cells and carries the state of the old ones over.
    fn regrade(&mut self, blocks: Blocks) -> Result<(), ModelError> {
        // New cells of this process lie on cells of others too, as far away as the coarsest are wide.
        self.update_ghost_tiles()?;
        let old = self.remake(blocks)?;
        let carried = carry::carry(&old, &self.solver, &self.bed, &self.terrain);
        self.solver.columns = carried.columns;
        self.state.records = carried.records;
        if !old.soaked.is_empty() {
            self.state.soaked.depth = carried.soaked;
        }
        borders::carry(&old.borders, &self.borders(), &mut self.state.beyond);
        self.state.remakes += 1;
        self.solver.refresh_water();
        self.connect();
        loop {
            let missing = self.solver.missing_tiles();
            if missing.is_empty() {
                break;
            }
            self.make_tiles(missing)?;
        }
        let columns = self.solver.columns.clone();
        *self.solver.before_mut() = columns;
        self.state.before = self.state.time;
        let step = self.solver.plan();
        self.state.time_step = self.limit_time_step(step);
        Ok(())
    }

    /// Remakes the cells, dry, with the blocks of a state; returns whether they are valid.
    pub(super) fn restore_blocks(&mut self, levels: &[(u32, u8)]) -> Result<bool, ModelError> {
        if self.solver.mesh.layout.blocks().finer() == levels {
            return Ok(true);
        }
        let Some(blocks) = self.allowed_blocks(levels) else { return Ok(false) };
        self.remake(blocks)?;
        Ok(true)
    }

    /// Blocks with levels, if this flood may have them.
    pub(super) fn allowed_blocks(&self, levels: &[(u32, u8)]) -> Option<Blocks> {
        let present = self.solver.mesh.layout.blocks();
        if present.finer() == levels {
            return Some(present.clone());
        }
        let allowed = self.adaptive.as_ref().is_some_and(|adaptive| adaptive.allows(levels));
        present.with(levels).filter(|_| allowed)
    }

    /// Remakes the cells of all tiles, with other blocks, dry; returns the old ones.
    pub(super) fn remake(&mut self, blocks: Blocks) -> Result<Old, ModelError> {
        let tiles: Vec<usize> = self.tiles().iter().map(|tile| *tile as usize).collect();
        self.remake_tiles(blocks, &tiles, None)
    }

    /// Makes the cells of tiles anew, dry, with other blocks and, where several processes share them, tiles of other processes; returns the old ones.
    pub(super) fn remake_tiles(
        &mut self,
        blocks: Blocks,
        tiles: &[usize],
        owners: Option<Vec<u16>>,
    ) -> Result<Old, ModelError> {
        let layout = self.solver.mesh.layout.with(blocks);
        let longest = longest_step(&layout, self.solver.gravity);
        let mut mesh = Mesh::new(layout);
        mesh.cut(&self.bed);
        let slowing = Slowing::of(&self.roughness, self.solver.gravity);
        let mut solver = Solver::new(mesh, self.solver.gravity, slowing, longest, self.boundaries.brings());
        solver.local = (self.settings.time_steps == TimeSteps::Local).then(Local::default);
        solver.domain = self.solver.domain.take();
        if let Some(domain) = &mut solver.domain {
            domain.clear();
            owners.into_iter().for_each(|owners| domain.assign(&solver.mesh.layout, owners));
        }
        let borders = self.borders();
        let old = Old {
            solver: std::mem::replace(&mut self.solver, solver),
            records: std::mem::take(&mut self.state.records),
            soaked: std::mem::take(&mut self.state.soaked.depth),
            borders,
        };
        self.forget_cells();
        // Inflows and structures have the cells of the tiles that were made for them.
        let (first, others) = tiles.split_at(self.zone_tiles.min(tiles.len()));
        self.make_in_order(first)?;
        self.find_patches();
        self.make_in_order(others)?;
        Ok(old)
    }

    /// Clears the values cached for each cell and each border face.
    fn forget_cells(&mut self) {
        self.state.beyond.clear();
        self.obstacle_of.clear();
        self.boundaries.forget_faces();
        self.weather.iter_mut().for_each(Weather::forget_cells);
    }

    /// Finds the cells of inflows and structures.
    pub(super) fn find_patches(&mut self) {
        let (mesh, domain) = (&self.solver.mesh, self.solver.domain.as_ref());
        self.patches = Patches::of(&self.structures, mesh, domain);
        self.inflows.iter_mut().for_each(|inflow| inflow.patch = Patch::of(&inflow.zone, mesh, domain));
    }

    /// The border faces as they are.
    fn borders(&self) -> Vec<Border> {
        let border = |number: usize| Border {
            rule: self.boundaries.rule_of(number),
            takes_highest: self.boundaries.is_open(number),
            ends: borders::ends(&self.solver.mesh, self.solver.borders[number] as usize),
            beyond: self.state.beyond.get(number).copied().unwrap_or(0.0),
        };
        (0..self.solver.borders.len()).map(border).collect()
    }
}
