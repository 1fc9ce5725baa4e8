//! Upload of a flood.

use super::super::structures::{Flows, Structures};
use super::Sides;
use super::shared::{
    BorderTotals, CellPosition, Column, Face, Flux, Found, Ground, Link, Memory, NONE, PLAN_SLOT, Parameters, Plan,
    Push, Record, Shown, Slopes, Status, Water,
};
use super::supplies::{supplies, supply_tables};
use super::tables::Tables;
use crate::voronoi::Inflow;
use crate::voronoi::boundaries::Boundaries;
use crate::voronoi::local::Local;
use crate::voronoi::maps;
use crate::voronoi::mesh::{self, Mesh};
use crate::voronoi::rain::{Soaked, Weather};
use crate::voronoi::solver::Solver;
use crate::voronoi::structures::Patches;
use crate::voronoi::{walls, water};
use corpuscle_gpu::{BATCH_START, Gpu, GpuError, MOST_GROUPS, THREADS, filled, storage, to_pair, uniform};

/// The parts of a flood that are uploaded.
pub(crate) struct Input<'a> {
    pub solver: &'a Solver,
    pub boundaries: &'a Boundaries,
    /// State of the water beyond each border face: see [`Boundaries::beyond_at_start`].
    pub beyond: &'a [f64],
    pub records: &'a [maps::Record],
    pub time: f64,
    pub step: f64,
    pub last_step: f64,
    pub wet_depth: f64,
    pub steps: u64,
    pub inflows: &'a [Inflow],
    pub weather: Option<&'a Weather>,
    pub structures: &'a Structures,
    pub patches: &'a Patches,
    pub flows: &'a Flows,
    /// The obstacle at each border face.
    pub obstacle_of: &'a [u32],
    pub soaked: &'a Soaked,
}

impl Input<'_> {
    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.solver.mesh.len()
    }

    /// Whether there is rain, infiltration or inflow.
    pub fn exchanges(&self) -> bool {
        !self.inflows.is_empty() || self.weather.is_some() || self.has_structures()
    }

    /// Whether there are structures, or crests that water flows over.
    fn has_structures(&self) -> bool {
        !self.structures.is_empty() || !self.solver.crests.is_empty()
    }

    /// Whether cells may take steps of their own.
    pub fn are_steps_local(&self) -> bool {
        self.solver.local.is_some()
    }

    /// The parts of the flood beside the motion of the water.
    pub fn sides(&self) -> Sides {
        Sides {
            exchanges: self.exchanges(),
            has_obstacles: self.obstacle_of.iter().any(|obstacle| *obstacle != mesh::NONE),
            borders: self.solver.borders.len(),
            structures: self.structures.count(),
            has_heights: self.solver.mesh.heights().is_some(),
            has_crests: !self.solver.crests.is_empty(),
            holds_levels: self.boundaries.holds_levels(),
            shares_discharges: self.boundaries.shares_discharges(),
            are_steps_local: self.are_steps_local(),
        }
    }

    /// Allocates the buffers on the device and fills them.
    ///
    /// # Errors
    /// [`GpuError::Memory`], [`GpuError::TooMany`].
    pub fn upload(&self, gpu: &Gpu) -> Result<(Memory, Status), GpuError> {
        let mesh = &self.solver.mesh;
        let (cells, faces) = (mesh.len(), mesh.faces.len());
        let most = MOST_GROUPS as usize * THREADS as usize;
        if cells.max(faces) > most {
            return Err(GpuError::TooMany { count: cells.max(faces), most });
        }
        let groups = cells.div_ceil(THREADS as usize);
        let status = self.status();
        let mut tables = Tables::default();
        let of_supplies = supply_tables(self, &mut tables);
        let sides = self.boundaries.upload(self.solver, self.beyond, self.obstacle_of, &mut tables);
        let mut works = self.patches.upload(self.structures, mesh, &mut tables);
        let over = walls::upload::upload(&self.solver.crests, mesh);
        let mut words = tables.words();
        works.add_numbers(&mut words);
        let supplies = supplies(self, &of_supplies, &mut words);
        let heights = add_heights(mesh, &mut words);
        let parameters = Parameters {
            heights,
            tables: tables.count(),
            rain_table: of_supplies.rain,
            discharges: sides.discharges.len() as u32,
            crests: over.crests.len() as u32,
            beside_crests: over.beside.len() as u32,
            structures: works.structures.len() as u32,
            crest_coefficient: walls::crest_coefficient(self.solver.gravity) as f32,
            ..self.parameters()
        };
        let memory = Memory {
            parameters: uniform(gpu, "parameters", &parameters),
            status: filled(gpu, "status", &[status])?,
            groups: filled(gpu, "groups", &[[0_u32, 1, 1]; PLAN_SLOT as usize + 1])?,
            ground: filled(gpu, "cells", &(0..cells).map(|cell| self.ground(cell)).collect::<Vec<_>>())?,
            links: filled(gpu, "links", &(0..cells).flat_map(|cell| links(mesh, cell)).collect::<Vec<_>>())?,
            faces: filled(gpu, "faces", &self.faces())?,
            borders: filled(gpu, "borders", &sides.borders)?,
            beyond: filled(gpu, "water beyond borders", &sides.beyond)?,
            discharges: filled(gpu, "discharges", &sides.discharges)?,
            parts: filled(gpu, "parts of discharges", &sides.parts)?,
            columns: filled(gpu, "columns", &self.columns())?,
            water: storage::<Water>(gpu, "water", if self.are_steps_local() { 2 * cells } else { cells })?,
            slopes: storage::<Slopes>(gpu, "slopes", cells)?,
            fluxes: storage::<Flux>(gpu, "fluxes", faces)?,
            kept: storage::<f32>(gpu, "kept parts", cells)?,
            distances: storage::<u32>(gpu, "distances of cells", if self.are_steps_local() { 2 * cells } else { 0 })?,
            plans: storage::<Plan>(gpu, "plans of groups", if self.are_steps_local() { groups } else { 0 })?,
            records: filled(gpu, "records", &self.records.iter().map(record_of).collect::<Vec<_>>())?,
            border_totals: storage::<BorderTotals>(gpu, "sums of groups", groups + 1)?,
            found: storage::<Found>(gpu, "steps of groups", groups)?,
            pushes: storage::<Push>(gpu, "pushes", sides.borders.len())?,
            crests: filled(gpu, "crests", &over.crests)?,
            beside_crests: filled(gpu, "cells beside crests", &over.beside)?,
            crest_entries: filled(gpu, "crests of cells", &over.entries)?,
            structures: filled(gpu, "structures", &works.structures)?,
            in_patches: filled(gpu, "cells of patches", &works.in_patches)?,
            structure_discharges: filled(gpu, "discharges of structures", &self.discharges())?,
            positions: filled::<CellPosition>(gpu, "positions of cells", &[])?,
            shown: uniform(gpu, "time shown", &Shown::default()),
            drawn: filled::<u32>(gpu, "water as seen", &[])?,
            supplies: filled(gpu, "supplies", &supplies)?,
            tables: filled(gpu, "tables", &words)?,
        };
        Ok((memory, status))
    }

    fn parameters(&self) -> Parameters {
        let Solver { mesh, gravity, slowing, longest, .. } = self.solver;
        Parameters {
            gravity: *gravity as f32,
            longest: *longest as f32,
            wet_depth: self.wet_depth as f32,
            cells: mesh.len() as u32,
            faces: mesh.faces.len() as u32,
            borders: self.solver.borders.len() as u32,
            friction_exponent: slowing.law().exponent(),
            ..Parameters::default()
        }
    }

    fn status(&self) -> Status {
        let wet = self.solver.wet_cells() as u32;
        // Cells that take steps of their own have these planned on the GPU.
        let parts = Local::in_use(self.solver.local.as_ref()).map_or(1, Local::parts);
        Status {
            clock: to_pair(self.time),
            step: self.step as f32,
            last_step: self.last_step as f32,
            halted: BATCH_START,
            since_draught: (self.time - self.soaked.until) as f32,
            all_steps: self.steps as u32,
            wet,
            parts: if parts > 1 { 0 } else { 1 },
            shortest: (self.step / f64::from(parts)) as f32,
            ..Status::default()
        }
    }

    fn ground(&self, cell: usize) -> Ground {
        let Solver { mesh, slowing, .. } = self.solver;
        Ground {
            area: mesh.area[cell] as f32,
            width: mesh.width[cell] as f32,
            bed: mesh.bed[cell] as f32,
            friction: slowing.coefficient(cell) as f32,
            first_link: mesh.first_link[cell],
            end_link: mesh.first_link[cell + 1],
            rim: u32::from(mesh.rim[cell] != 0),
            paces: 0,
        }
    }

    fn faces(&self) -> Vec<Face> {
        let mesh = &self.solver.mesh;
        let mut borders = 0..;
        let face = |(number, face): (usize, &mesh::Face)| {
            let [first, second] = face.cells;
            let is_border = face.border().is_some();
            let rise = if is_border { 0.0 } else { rise(mesh, [first, second], mesh.lift_of(number)) };
            Face {
                normal: single(face.normal),
                between: face.between,
                offset: face.offset,
                rise,
                first,
                second: if is_border { NONE } else { second },
                border: if is_border { borders.next().unwrap_or(NONE) } else { NONE },
            }
        };
        mesh.faces.iter().enumerate().map(face).collect()
    }

    /// Discharges of structures in the last step, m3/s.
    fn discharges(&self) -> Vec<f32> {
        let held = vec![0.0; self.structures.held.len()];
        let [outflows, links] = [&self.flows.outflows, &self.flows.links]
            .map(|flows| flows.iter().map(|flow| *flow as f32).collect::<Vec<_>>());
        [outflows, held, links].concat()
    }

    fn columns(&self) -> Vec<Column> {
        let column =
            |column: &water::Column| Column { volume: to_pair(column.volume), momentum: single(column.momentum) };
        let mut columns: Vec<_> = self.solver.columns.iter().chain(self.solver.before()).map(column).collect();
        if self.are_steps_local() {
            columns.resize(4 * self.cells(), Column::default());
        }
        columns
    }
}

fn single(pair: [f64; 2]) -> [f32; 2] {
    pair.map(|value| value as f32)
}

/// Bed of the second cell above that of the first, m.
fn rise(mesh: &Mesh, [first, second]: [u32; 2], lift: f64) -> f32 {
    (mesh.bed[second as usize] + lift - mesh.bed[first as usize]) as f32
}

fn links(mesh: &Mesh, cell: usize) -> impl Iterator<Item = Link> + '_ {
    mesh.links_of(cell).iter().map(move |link| {
        let side = link.side(cell);
        let normal = if link.face == mesh::NONE { [0.0; 2] } else { mesh.faces[link.face as usize].normal };
        let outward = if side == 0 { normal } else { normal.map(|n| -n) };
        let neighbour = link.cell().map_or(NONE, |other| other as u32);
        let rise = link.cell().map_or(0.0, |other| rise(mesh, [cell as u32, other as u32], mesh.lift_seen(link, cell)));
        Link { gradient: link.gradient, normal: single(outward), rise, neighbour, face: link.face, side: side as u32 }
    })
}

/// Adds the heights of the parts of all cells, where they count; returns the index of the first.
fn add_heights(mesh: &Mesh, words: &mut Vec<u32>) -> u32 {
    let Some(heights) = mesh.heights() else { return NONE };
    let first = words.len() as u32;
    words.extend(heights.flatten().map(|height| (height as f32).to_bits()));
    first
}

fn record_of(record: &maps::Record) -> Record {
    let maps::Record { max_depth, fastest, hazard, arrival, duration } = *record;
    Record { fastest, max_depth, hazard, arrival, duration }
}
