//! Scheme `voronoi`: particles are columns of water over their Voronoi cells, which exchange volume and momentum through the closed faces between
//! them (a finite-volume method of second order).
//!
//! | folder | what |
//! |---|---|
//! | `mesh` | cells and faces, made where there is water or may be next |
//! | `reconstruction` | slopes of cells, values at faces |
//! | `fluxes` | the Riemann solver and the ground's thrust |
//! | `walls` | outlines of obstacles and of ground without data, lines |
//! | `boundaries` | the sides of the terrain |
//! | `friction` | Manning, Chezy, linear |
//! | `start`, `rain`, `structures` | sources and sinks of water |
//! | `domain` | the part of one of several processes |
//! | `maps` | what happened in each cell, on the terrain's grid |
//! | `adaptive` | cells that follow the water |
//! | `gpu` | the same steps on a GPU; each pass's WGSL stands in the folder of the pass |
//!
//! `solver.rs` is a step of the water, `local/` which cells take longer ones,
//! `storage.rs` what a cell holds below a level, `step.rs` one of the model.

mod adaptive;
mod bed;
mod boundaries;
mod change;
mod domain;
mod finer;
mod fluxes;
mod friction;
#[cfg(feature = "gpu")]
mod gpu;
mod local;
mod maps;
mod measures;
mod mesh;
mod model;
mod open;
mod patch;
mod rain;
mod reconstruction;
mod sampling;
mod solver;
mod start;
mod step;
mod storage;
mod structures;
mod sums;
#[cfg(test)]
mod tests;
mod to_come;
mod walls;
mod water;

pub use rain::RainFunction;

use self::structures::{Flows, Structures};
use crate::friction::Roughness;
use crate::gauges::{LineGauge, PointGauge};
use crate::sampling::Sample;
use crate::zone::Zone;
use adaptive::Adaptive;
use bed::Bed;
use boundaries::Boundaries;
use change::Overrides;
use corpuscle_model::{Account, ExactSum};
use corpuscle_scene::{Flood, Table};
use corpuscle_terrain::Terrain;
use domain::Domain;
use maps::Record;
use patch::Patch;
use rain::{Soaked, Weather};
use sampling::Sampler;
use serde::{Deserialize, Serialize};
use solver::Solver;
use std::path::PathBuf;
use std::sync::Arc;
use structures::Patches;
use water::{Column, Water};

/// Density of water, kg/m3.
const DENSITY: f64 = 1000.0;

/// Cells, or faces, that a thread goes through at a time.
const CHUNK: usize = 1024;

/// A flood by scheme `voronoi`.
pub struct VoronoiFlood {
    settings: Flood,
    /// What relative paths refer to.
    folder: PathBuf,
    terrain: Arc<Terrain>,
    bed: Bed,
    roughness: Roughness,
    boundaries: Boundaries,
    /// The obstacle at each border face of the solver; [`mesh::NONE`] at others.
    obstacle_of: Vec<u32>,
    /// Area of each obstacle from which rain runs off, m2.
    roofs: Vec<f64>,
    solver: Solver,
    adaptive: Option<Adaptive>,
    /// How many tiles were made for inflows, structures and held sides: the first ones.
    zone_tiles: usize,
    inflows: Vec<Inflow>,
    weather: Option<Weather>,
    structures: Structures,
    patches: Patches,
    points: Vec<PointGauge>,
    lines: Vec<LineGauge>,
    /// What each obstacle took up in the step, over density, m4/s.
    pushes: Vec<[ExactSum; 2]>,
    state: State,
    /// The time shown, s: not after the state's, and not before that of the step before.
    shown: f64,
    /// What the scene says of the values over time that were changed since.
    written: Vec<(change::Over, Table)>,
    /// The GPU that takes the steps, if one does.
    #[cfg(feature = "gpu")]
    on_gpu: Option<Box<gpu::OnGpu>>,
}

/// Water that comes in over a part of the ground.
struct Inflow {
    zone: Zone,
    patch: Patch,
    /// m3/s over time.
    discharge: Table,
    /// m/s.
    velocity: [f64; 2],
}

/// Everything that changes.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct State {
    time: f64,
    /// Time before the last step, s.
    before: f64,
    steps: u64,
    particle_steps: u64,
    /// Next time step, s.
    time_step: f64,
    /// The tiles that were made, in order.
    tiles: Vec<u32>,
    /// Number of cells and of border faces of each; found when it is saved.
    counts: Vec<domain::Counts>,
    /// Water of the cells now, and before the last step. Kept in the solver while the model runs.
    columns: [Vec<Column>; 2],
    records: Vec<Record>,
    /// State of the water beyond each border face: see [`Boundaries::beyond_at_start`].
    beyond: Vec<f64>,
    falling: Vec<step::Drop>,
    soaked: Soaked,
    flows: Flows,
    water: Account,
    momentum: Account,
    /// Energy of the water on the ground above the level 0, J; what friction, waves that break and the scheme take is not booked.
    energy: Account,
    /// What [`State::booked`] was before the last step.
    booked_before: [ExactSum; BOOKED],
    /// Momentum that each obstacle took up so far, over density, m4/s, and a second in the last step, m4/s2.
    impulses: Vec<[f64; 2]>,
    forces: Vec<[f64; 2]>,
    warnings: Vec<String>,
    overrides: Overrides,
    /// Blocks with finer cells, by number, and how often the spacing is halved there. Kept in the mesh while the model runs.
    blocks: Vec<(u32, u8)>,
    /// How often the cells were remade.
    remakes: u64,
}

/// Number of sums in [`State::booked`].
const BOOKED: usize = 6;

impl State {
    /// What came in and went out of water, m3, and of energy, J; rain, and what soaked in, m3.
    fn booked(&self) -> [ExactSum; BOOKED] {
        let Self { water, energy, soaked, .. } = self;
        [water.inflow, water.outflow, energy.inflow, energy.outflow, soaked.rained, soaked.infiltrated]
    }
}

impl VoronoiFlood {
    /// The `[flood]` of the scene with every default that depends on ground and water filled in.
    pub fn settings(&self) -> &Flood {
        &self.settings
    }

    /// The water at a position in model coordinates, at the time shown; where several processes share the flood, in the part of this one.
    pub fn sample(&self, x: f64, y: f64) -> Sample {
        self.sampler().at(x, y)
    }

    /// The longest stable time step from here (CFL), s.
    pub fn time_step(&self) -> f64 {
        self.state.time_step
    }

    /// Bytes held for the cells and the work on them.
    pub fn bytes(&self) -> usize {
        self.solver.bytes() + self.state.records.capacity() * size_of::<Record>()
    }

    /// Number of cells, dry ones included.
    pub fn cells(&self) -> usize {
        self.solver.mesh.len()
    }

    /// For each wet cell of this process at the end of the last step: centroid, m, area, m2, mean ground, m, depth, m, velocity, m/s.
    pub fn wet_cells(&self) -> impl Iterator<Item = WetCell> + '_ {
        let mesh = &self.solver.mesh;
        let wet =
            self.solver.water.iter().enumerate().filter(|(cell, water)| water.depth > 0.0 && self.solver.owns(*cell));
        wet.map(|(cell, water)| WetCell {
            centroid: mesh.centroid[cell],
            area: mesh.area[cell],
            bed: mesh.bed[cell],
            depth: water.depth,
            level: water.level,
            velocity: water.velocity,
        })
    }

    /// Kinetic and potential energy of the water, J, the latter above a level, m. Where several processes share the flood all of them call this.
    pub fn energy(&self, level: f64) -> [f64; 2] {
        self.energy_of(&self.solver.columns, level)
    }

    /// The same of other columns of the cells.
    fn energy_of(&self, columns: &[Column], level: f64) -> [f64; 2] {
        let mesh = &self.solver.mesh;
        let gravity = self.solver.gravity;
        let columns = columns.iter().enumerate().filter(|(cell, _)| self.solver.owns(*cell));
        let mut kinetic = columns.clone().map(|(_, column)| column.kinetic()).collect::<ExactSum>();
        let potential =
            columns.map(|(cell, column)| gravity * (mesh.potential(cell, column.volume) - level * column.volume));
        let mut potential = potential.collect::<ExactSum>();
        domain::total(self.solver.domain.as_ref(), &mut [], &mut [&mut kinetic, &mut potential]);
        [kinetic, potential].map(|sum| DENSITY * sum.value())
    }

    /// Energy that the water has and a lake at rest at a level, m, would not have, J: kinetic, and what it takes to raise and lower the surface from
    /// that level in each cell. Not below 0, and small where the water nearly is such a lake: nothing cancels out. Where several processes share the flood all of them call this.
    pub fn energy_above_lake(&self, level: f64) -> f64 {
        let mesh = &self.solver.mesh;
        let of_cell = |(cell, column): (usize, &Column)| {
            let depth = column.volume / mesh.area[cell];
            column.kinetic() + self.solver.gravity * mesh.area[cell] * mesh.raised(cell, depth, level)
        };
        DENSITY * domain::total_of(self.solver.domain.as_ref(), self.own_columns().map(of_cell).collect())
    }

    /// How far the time shown is from the begin of the last step, 0, to its end, 1.
    fn share_shown(&self) -> f64 {
        let State { time, before, .. } = &self.state;
        if time > before { ((self.shown - before) / (time - before)).clamp(0.0, 1.0) } else { 1.0 }
    }

    /// Time from that which is shown to the end of the last step, s.
    fn rest_of_step(&self) -> f64 {
        (1.0 - self.share_shown()) * (self.state.time - self.state.before)
    }

    /// The water of a cell at the time shown.
    fn water_shown(&self, cell: usize) -> Water {
        let share = self.share_shown();
        if share == 1.0 {
            return self.solver.water[cell];
        }
        let mesh = &self.solver.mesh;
        let columns = [&self.solver.before()[cell], &self.solver.columns[cell]];
        maps::between(mesh, cell, columns, share)
    }

    fn sampler(&self) -> Sampler<'_, impl Fn(usize) -> Water> {
        Sampler { mesh: &self.solver.mesh, terrain: &self.terrain, water: |cell| self.water_shown(cell) }
    }

    /// The columns of the cells that this process computes.
    fn own_columns(&self) -> impl Iterator<Item = (usize, &Column)> + Clone {
        self.solver.columns.iter().enumerate().filter(|(cell, _)| self.solver.owns(*cell))
    }

    /// Water in the air, which the first process counts.
    fn falling(&self) -> impl Iterator<Item = &step::Drop> {
        let counts = self.solver.domain.as_ref().is_none_or(Domain::is_first);
        self.state.falling.iter().filter(move |_| counts)
    }

    /// Water in the model, m3.
    fn stored(&self) -> f64 {
        let columns = self.own_columns().map(|(_, column)| column.volume);
        let all = columns.chain(self.falling().map(|drop| drop.volume)).collect();
        domain::total_of(self.solver.domain.as_ref(), all)
    }

    /// Momentum of all water if it were as fast as waves on it, kg m/s.
    fn momentum_of_waves(&self) -> f64 {
        let waves = self.wet_cells().map(|cell| cell.area * cell.depth * (self.solver.gravity * cell.depth).sqrt());
        DENSITY * domain::total_of(self.solver.domain.as_ref(), waves.collect())
    }

    /// Momentum of the water, sum of its two components, kg m/s.
    fn momentum(&self) -> f64 {
        let columns = self.own_columns().map(|(_, column)| column.momentum[0] + column.momentum[1]);
        let falling = self.falling().map(|drop| drop.volume * (drop.velocity[0] + drop.velocity[1]));
        DENSITY * domain::total_of(self.solver.domain.as_ref(), columns.chain(falling).collect())
    }
}

/// The water of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WetCell {
    /// Centroid in model coordinates, m.
    pub centroid: [f64; 2],
    /// Area, m2.
    pub area: f64,
    /// Mean height of the ground, m.
    pub bed: f64,
    /// Depth, m: volume over area.
    pub depth: f64,
    /// Level of the surface, m.
    pub level: f64,
    /// Velocity `[east, north]`, m/s.
    pub velocity: [f64; 2],
}
