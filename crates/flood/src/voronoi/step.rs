//! A step of the model: what falls from the air, the water's motion, and what comes and goes.

use super::domain::{self, Domain};
use super::patch::{Change, Changed};
use super::solver::{BorderFlux, Solver};
use super::water::Column;
use super::{DENSITY, State, VoronoiFlood, maps, walls};
use crate::fields::block_velocity;
use crate::setup::{lattice, random};
use corpuscle_model::{ExactSum, ModelError};
use corpuscle_scene::Flood;
use corpuscle_terrain::{Bounds, Terrain};
use rand::RngExt;
use serde::{Deserialize, Serialize};

/// Water in the air.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct Drop {
    pub id: u64,
    pub position: [f64; 3],
    pub velocity: [f64; 3],
    /// m3.
    pub volume: f64,
}

/// Drops are numbered from here on, cells by their points.
pub(super) const FIRST_DROP: u64 = 1 << 48;

/// The drops of the blocks of a scene: layers of a lattice, each shifted a little at random so that no two stand one above the other.
pub(super) fn drops(scene: &Flood, spacing: f64, terrain: &Terrain, seed: u64) -> Vec<Drop> {
    let mut random = random(seed, u64::MAX);
    let volume = spacing * spacing * scene.spacing_depth_m.unwrap_or(1.0);
    let mut drops = Vec::new();
    for (block, water) in scene.water.iter().filter_map(|water| Some((water.block.as_ref()?, water))) {
        let [from, to] = [block.from, block.to].map(|corner| terrain.to_model(corner));
        let centre = [0, 1].map(|axis| 0.5 * (from[axis] + to[axis]));
        let bottom = terrain.height(centre[0], centre[1]) + block.height_m;
        let velocity = block_velocity(&water.velocity_m_per_s, terrain);
        let [columns, rows] = lattice(block, terrain, spacing).map(|count| count as usize);
        for number in 0..block.layers * columns * rows {
            let index = [number % columns, number / columns % rows];
            let mut at =
                |axis: usize| from[axis] + (index[axis] as f64 + 0.5 + random.random_range(-0.2..0.2)) * spacing;
            let z = bottom + ((number / (columns * rows)) as f64 + 0.5) * spacing;
            let [x, y] = [at(0), at(1)];
            let [u, v] = velocity(x, y);
            let id = FIRST_DROP + drops.len() as u64;
            drops.push(Drop { id, position: [x, y, z], velocity: [u, v, 0.0], volume });
        }
    }
    drops
}

impl VoronoiFlood {
    /// The time step, limited while drops fall: one falls a spacing in some ten steps.
    pub(super) fn limit_time_step(&self, step: f64) -> f64 {
        let fall = 0.1 * (self.solver.mesh.layout.spacing() / self.settings.gravity_m_per_s2).sqrt();
        if self.state.falling.is_empty() { step } else { step.min(fall) }
    }

    pub(super) fn step(&mut self) -> Result<(), ModelError> {
        self.adapt()?;
        self.balance_load_when_due()?;
        let (from, step) = (self.state.time, self.state.time_step);
        let until = from + step;
        let booked = self.state.booked();
        self.move_water(from, step);
        if self.solver.is_broken() {
            return Err(self.breakdown(from));
        }
        self.state.particle_steps += self.solver.wet_cells() as u64;
        self.state.steps += 1;
        self.bring_and_take(from, until);
        self.solver.exchange(|_| true);
        let missing = self.solver.missing_tiles();
        if !missing.is_empty() {
            self.make_tiles(missing)?;
        }
        (self.state.before, self.state.time) = (from, until);
        self.state.booked_before = booked;
        let step = self.solver.plan();
        self.state.time_step = self.limit_time_step(step);
        Ok(())
    }

    /// Moves the water for a step and books the flow over the sides.
    fn move_water(&mut self, from: f64, step: f64) {
        self.boundaries.prepare(&self.solver, from, step, &self.state.beyond);
        let boundaries = &self.boundaries;
        let now = |stage: usize, border: usize| boundaries.now(stage, border);
        let wet_depth = self.settings.wet_depth_m;
        let State { water, momentum, energy, forces, records, .. } = &mut self.state;
        let pushes = &mut self.pushes;
        pushes.fill([ExactSum::default(); 2]);
        // Thrusts of ground and walls are far larger than their sum: only that is booked.
        let mut gained = ExactSum::default();
        let obstacle_of = &self.obstacle_of;
        let mut book = |border: usize, flux: BorderFlux| {
            water.book(-flux.volume);
            energy.book(-DENSITY * flux.energy);
            if let Some(push) = pushes.get_mut(obstacle_of[border] as usize) {
                (0..2).for_each(|axis| push[axis].add(flux.momentum[axis]));
            }
            flux.momentum.into_iter().for_each(|momentum| gained.add(-momentum));
        };
        let mut record = |solver: &Solver, done: f64| maps::record(solver, records, from + done, step, wet_depth);
        let done = self.solver.step(step, &now, &mut book, &mut record);
        let domain = self.solver.domain.as_ref();
        if let Some(domain) = domain {
            let sums = std::iter::once(&mut gained).chain(self.pushes.iter_mut().flatten());
            domain.processes.total(&mut [], &mut sums.collect::<Vec<_>>());
        }
        done.slowed.iter().chain(&done.by_ground).for_each(|momentum| gained.add(*momentum));
        // Sums over all processes are booked by the first.
        if domain.is_none_or(Domain::is_first) {
            momentum.book(DENSITY * gained.value());
        }
        for (force, push) in forces.iter_mut().zip(&self.pushes) {
            (0..2).for_each(|axis| force[axis] = push[axis].value() / step);
        }
        for (impulse, force) in self.state.impulses.iter_mut().zip(&self.state.forces) {
            (0..2).for_each(|axis| impulse[axis] += step * force[axis]);
        }
        self.boundaries.follow(&self.solver, from, step, &mut self.state.beyond);
    }

    /// Lets water come and go beside its motion: structures, inflows, rain, infiltration, what falls.
    fn bring_and_take(&mut self, from: f64, until: f64) {
        let step = until - from;
        let over_crests = walls::overtop(&mut self.solver, step);
        let Self { solver, inflows, structures, patches, weather, state, .. } = self;
        let momentum = |change: &Changed| DENSITY * (change.momentum[0] + change.momentum[1]);
        let is_first = solver.domain.as_ref().is_none_or(Domain::is_first);
        let (water, moments, energy) = (&mut state.water, &mut state.momentum, &mut state.energy);
        let mut book = |change: Changed| {
            // Sums over all processes are booked by the first.
            if is_first {
                water.book(change.volume);
                moments.book(momentum(&change));
                energy.book(DENSITY * change.energy);
            }
        };
        book(Changed { momentum: over_crests.momentum, ..Changed::default() });
        patches.work(structures, &mut state.flows, solver, until, step, &mut book);
        for inflow in inflows.iter() {
            book(inflow.patch.add(solver, inflow.discharge.integral(from, until), inflow.velocity));
        }
        if let Some(weather) = weather {
            let done = weather.pass(solver, &mut state.soaked, from, until, state.steps);
            book(Changed { volume: 0.0, ..done.change });
            state.water.inflow.add_sum(&done.rained);
            state.water.outflow.add_sum(&done.infiltrated);
        }
        self.fall(step);
    }

    /// What is in the air falls; what meets ground or water joins it.
    fn fall(&mut self, step: f64) {
        if self.state.falling.is_empty() {
            return;
        }
        let gravity = self.solver.gravity;
        let mut falling = std::mem::take(&mut self.state.falling);
        falling.iter_mut().for_each(|drop| drop.fall(gravity, step));
        let landed: Vec<usize> = (0..falling.len()).filter(|number| self.has_landed(&falling[*number])).collect();
        // All processes have all drops; whose ground it is says which have landed.
        let landed = match &self.solver.domain {
            Some(domain) => domain.union(landed),
            None => landed,
        };
        let (mut number, mut next) = (0, landed.iter().peekable());
        let has_landed = |_: &mut Drop| {
            number += 1;
            next.next_if_eq(&&(number - 1)).is_some()
        };
        let landed: Vec<Drop> = falling.extract_if(.., has_landed).collect();
        self.state.falling = falling;
        for drop in landed {
            self.land(&drop);
        }
    }

    /// Whether a drop has met water or ground of this process.
    fn has_landed(&self, drop: &Drop) -> bool {
        let [x, y] = inside(self.terrain.bounds(), drop.position);
        let (mesh, domain) = (&self.solver.mesh, self.solver.domain.as_ref());
        match mesh.cell_at([x, y]) {
            Some(cell) => self.solver.owns(cell) && drop.position[2] <= self.solver.water[cell].level,
            None => {
                let is_own = domain.is_none_or(|domain| domain.owns_tile(mesh.layout.nearest([x, y]).0));
                is_own && drop.position[2] <= self.terrain.height(x, y)
            }
        }
    }

    fn land(&mut self, drop: &Drop) {
        let [x, y] = inside(self.terrain.bounds(), drop.position);
        let tile = self.solver.mesh.layout.tile_at([x, y]);
        // An error of too many cells is returned by the step that needs the next ones.
        let _ = self.make_tiles(vec![tile]);
        let momentum = [0, 1].map(|axis| drop.volume * drop.velocity[axis]);
        let cell = self.solver.mesh.cell_at([x, y]).filter(|cell| self.solver.owns(*cell));
        let mut change = Change::default();
        if let Some(cell) = cell {
            change.apply(&mut self.solver, cell, Column { volume: drop.volume, momentum });
        }
        let domain = self.solver.domain.as_ref();
        let (is_on_cell, change) = (domain::any(domain, cell.is_some()), change.in_all(domain));
        // Sums over all processes are booked by the first.
        if domain.is_some_and(|domain| !domain.is_first()) {
            return;
        }
        if is_on_cell {
            self.state.energy.book(DENSITY * change.energy);
            // The drop's own momentum is in the ledger already.
            let lost = [0, 1].map(|axis| change.momentum[axis] - momentum[axis]);
            self.state.momentum.book(DENSITY * (lost[0] + lost[1]));
        } else {
            self.state.water.outflow.add(drop.volume);
            self.state.momentum.book(-DENSITY * (momentum[0] + momentum[1]));
        }
    }

    /// Where the first cell lies whose fluxes are no numbers, in the terrain's own coordinates.
    fn broken_position(&self) -> Option<[f64; 2]> {
        let mesh = &self.solver.mesh;
        let position = |cell: usize| {
            let tile = mesh.layout.tile_and_index(mesh.point[cell]).0 as u32;
            let made = self.tiles().iter().position(|made| *made == tile).unwrap_or(usize::MAX);
            (made, cell, self.terrain.to_own(mesh.centroid[cell]))
        };
        // Of the process whose tile was made first.
        let own = self.solver.broken_cell().map(position);
        let all = match &self.solver.domain {
            Some(domain) => domain.processes.gather_all(own),
            None => vec![own],
        };
        all.into_iter().flatten().min_by_key(|(made, cell, _)| (*made, *cell)).map(|(.., position)| position)
    }

    /// The error that says where a value is not finite; goes back to the state before.
    fn breakdown(&mut self, time: f64) -> ModelError {
        let position = self.broken_position();
        self.solver.take_back();
        self.solver.count();
        let position = position.map_or(String::new(), |[x, y]| format!(" at [{x:.6}, {y:.6}]"));
        ModelError::Breakdown {
            time,
            step: self.state.steps,
            what: format!("a flux{position} is no longer a number; look in the last frame at the water there"),
        }
    }
}

/// The nearest position inside.
fn inside(bounds: Bounds, [x, y, _]: [f64; 3]) -> [f64; 2] {
    [x.clamp(bounds.x_min, bounds.x_max), y.clamp(bounds.y_min, bounds.y_max)]
}

impl Drop {
    fn fall(&mut self, gravity: f64, step: f64) {
        self.position[2] += step * (self.velocity[2] - 0.5 * gravity * step);
        self.velocity[2] -= gravity * step;
        (0..2).for_each(|axis| self.position[axis] += step * self.velocity[axis]);
    }
}
