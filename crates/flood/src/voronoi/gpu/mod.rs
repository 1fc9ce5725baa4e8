//! Steps of scheme `voronoi` on a GPU, in single precision: the cells are made on the CPU and uploaded, the passes of a step run one after another, and nothing
//! comes back between the steps of a batch.
//!
//! Each pass is a WGSL file in the folder of its CPU code: slopes, fluxes through faces (stored, so that both cells gain and lose the same), the part of its outflow that
//! each cell has the water for, new columns; twice, then the records of the maps and the length of the next step, and `voronoi_finish.wgsl` decides whether there is one.
//! There are no atomics: every cell gathers in the order of its links, so the result does not depend on how the threads run.

mod model;
mod seen;
mod shared;
mod supplies;
mod tables;
mod upload;

pub(super) use model::OnGpu;
pub(super) use shared::{
    BesideCrest, Border, CONSTANT, CULVERT, Crest, DISCHARGE, GREEN_AMPT, HOLD, HORTON, InPatch, LEVEL, LINK, NONE,
    NORMAL, OPEN, OUTFLOW, PADDLE, Part, RATING, SharedDischarge, Structure, WALL, WAVE, WEIR,
};
pub(super) use tables::Tables;

use super::water::Column as ColumnOfCpu;
use corpuscle_gpu::{
    BATCH_START, Batches, Buffers, COMPENSATED_SUMS, GROUP_REDUCTION, Gpu, GpuError, Halt, Kernel, Pass, ShaderLibrary,
    THREADS, Task, from_halves, from_pair, read, read_together, to_pair, wgpu,
};
use seen::Seen;
use shared::{
    BESIDE_CREST_SLOT, BORDER_SLOT, CELL_SLOT, CREST_SLOT, Column, DISCHARGE_SLOT, FACE_SLOT, Memory, Push, Record,
    STRUCTURE_SLOT, Status, Supply,
};
use std::sync::OnceLock;
use upload::Input;

const LIBRARY: ShaderLibrary<'_> = &[
    COMPENSATED_SUMS,
    GROUP_REDUCTION,
    ("voronoi_tables", include_str!("voronoi_tables.wgsl")),
    ("voronoi_record", include_str!("../maps/voronoi_record.wgsl")),
    ("infiltration_laws", include_str!("../rain/infiltration_laws.wgsl")),
    ("voronoi_water", include_str!("voronoi_water.wgsl")),
    ("voronoi_stable", include_str!("voronoi_stable.wgsl")),
    ("voronoi_change", include_str!("voronoi_change.wgsl")),
    ("hydraulics", include_str!("../structures/hydraulics.wgsl")),
    ("voronoi_storage", include_str!("../voronoi_storage.wgsl")),
    ("voronoi_friction", include_str!("../friction/voronoi_friction.wgsl")),
    ("voronoi_differences", include_str!("../reconstruction/voronoi_differences.wgsl")),
    ("voronoi_faces", include_str!("../reconstruction/voronoi_faces.wgsl")),
    ("voronoi_riemann", include_str!("../fluxes/voronoi_riemann.wgsl")),
    ("voronoi_boundaries", include_str!("../boundaries/voronoi_boundaries.wgsl")),
];

/// Pieces in which versions of a shader differ: the stage, whether water comes and goes beside its motion, and whether it was looked at before that.
const VERSIONS: [[(&str, &str); 2]; 3] = [
    [
        ("stage", "const IS_SECOND = false;\nconst IS_LOOKED_AT = false;\n"),
        ("exchange", "fn exchange(cell: u32, own: ptr<function, Found>) {}\n"),
    ],
    [
        ("stage", "const IS_SECOND = true;\nconst IS_LOOKED_AT = false;\n"),
        ("exchange", include_str!("../rain/voronoi_exchange.wgsl")),
    ],
    [
        ("stage", "const IS_SECOND = true;\nconst IS_LOOKED_AT = true;\n"),
        ("exchange", include_str!("../rain/voronoi_exchange.wgsl")),
    ],
];

/// Name, text and version of the kernels.
const SHADERS: [(&str, &str, usize); 20] = [
    ("voronoi_slopes", include_str!("../reconstruction/voronoi_slopes.wgsl"), 0),
    ("voronoi_fluxes", include_str!("../fluxes/voronoi_fluxes.wgsl"), 0),
    ("voronoi_fluxes", include_str!("../fluxes/voronoi_fluxes.wgsl"), 1),
    ("voronoi_kept", include_str!("../fluxes/voronoi_kept.wgsl"), 0),
    ("voronoi_update", include_str!("voronoi_update.wgsl"), 0),
    ("voronoi_update", include_str!("voronoi_update.wgsl"), 1),
    ("voronoi_end", include_str!("voronoi_end.wgsl"), 0),
    ("voronoi_end", include_str!("voronoi_end.wgsl"), 1),
    ("voronoi_finish", include_str!("voronoi_finish.wgsl"), 0),
    ("voronoi_begin", include_str!("voronoi_begin.wgsl"), 0),
    ("voronoi_push", include_str!("../walls/voronoi_push.wgsl"), 0),
    ("voronoi_push", include_str!("../walls/voronoi_push.wgsl"), 1),
    ("voronoi_share", include_str!("../boundaries/voronoi_share.wgsl"), 0),
    ("voronoi_follow", include_str!("../boundaries/voronoi_follow.wgsl"), 1),
    ("voronoi_look", include_str!("voronoi_look.wgsl"), 1),
    ("voronoi_crests", include_str!("../walls/voronoi_crests.wgsl"), 1),
    ("voronoi_overtop", include_str!("../walls/voronoi_overtop.wgsl"), 1),
    ("voronoi_structures", include_str!("../structures/voronoi_structures.wgsl"), 1),
    ("voronoi_end", include_str!("voronoi_end.wgsl"), 2),
    ("voronoi_shift", include_str!("../voronoi_shift.wgsl"), 0),
];

/// The kernel that finds the water of columns.
const BEGIN: usize = 9;

/// The kernels with what they work on.
type Tasks = [Task; SHADERS.len()];

/// A flood on a GPU.
pub(crate) struct GpuSolver {
    pub batches: Batches,
    kernels: [Kernel<Memory>; SHADERS.len()],
    memory: Memory,
    tasks: Tasks,
    cells: usize,
    sides: Sides,
    status: Status,
    /// The water as it is drawn, once somebody has looked.
    seen: OnceLock<Seen>,
}

/// What a flood has beside the motion of its water.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sides {
    /// Whether water comes and goes beside its motion.
    exchanges: bool,
    /// Whether there are obstacles, whose forces are measured.
    has_obstacles: bool,
    borders: usize,
    /// Number of structures.
    structures: usize,
    /// Whether there are crests that water flows over.
    has_crests: bool,
    /// Whether the heights of the ground within cells count.
    has_heights: bool,
    /// Whether the water beyond some border is held at a level.
    holds_levels: bool,
    /// Whether discharges are shared out over border faces.
    shares_discharges: bool,
}

/// The state of a flood as it came back.
pub(super) struct Downloaded {
    /// Columns now, and before the last step.
    pub columns: [Vec<ColumnOfCpu>; 2],
    pub records: Vec<super::maps::Record>,
    /// What has soaked into each cell, m; empty where nothing comes or goes.
    pub soaked: Vec<f32>,
    /// Impulse over density at each border face since the upload, and in the last step, m4/s; empty where there are no obstacles.
    pub pushes: Vec<[[f64; 2]; 2]>,
    /// What is known of the water beyond each border face; empty where no level is held.
    pub beyond: Vec<f32>,
    /// Discharge of each structure, m3/s.
    pub discharges: Vec<f32>,
}

/// What passed since the flood is on the device.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Totals {
    pub time: f64,
    /// Next time step, s.
    pub step: f64,
    pub last_step: f64,
    pub cell_steps: u64,
    /// Number of wet cells.
    pub wet: usize,
    /// In and out.
    pub water: [f64; 2],
    pub energy: [f64; 2],
    pub momentum: [f64; 2],
    pub rained: f64,
    pub infiltrated: f64,
    /// Time since the ground drank, s.
    pub since_draught: f64,
}

impl GpuSolver {
    /// Compiles the kernels and uploads a flood.
    ///
    /// # Errors
    /// [`GpuError::Memory`], [`GpuError::TooMany`].
    pub fn new(gpu: Gpu, input: &Input<'_>) -> Result<Self, GpuError> {
        let kernels = SHADERS.map(|(name, text, version)| {
            let library: Vec<_> = LIBRARY.iter().copied().chain(VERSIONS[version]).collect();
            Kernel::new(&gpu, name, text, &library)
        });
        let (memory, status) = input.upload(&gpu)?;
        let tasks = kernels.each_ref().map(|kernel| kernel.on(&gpu, &memory));
        let (cells, sides) = (input.cells(), input.sides());
        let mut solver = Self {
            batches: Batches::new(gpu, "voronoi"),
            kernels,
            memory,
            tasks,
            cells,
            sides,
            status,
            seen: OnceLock::new(),
        };
        solver.begin();
        Ok(solver)
    }

    /// Uploads a flood whose cells are others now, or whose water was changed; what passed is counted from 0.
    ///
    /// # Errors
    /// As [`GpuSolver::new`].
    pub fn renew(&mut self, input: &Input<'_>) -> Result<(), GpuError> {
        let gpu = self.batches.gpu();
        (self.memory, self.status) = input.upload(gpu)?;
        self.tasks = self.kernels.each_ref().map(|kernel| kernel.on(gpu, &self.memory));
        self.seen = OnceLock::new();
        (self.cells, self.sides) = (input.cells(), input.sides());
        self.begin();
        Ok(())
    }

    /// Finds the water of the columns that were uploaded.
    fn begin(&mut self) {
        let groups = self.cells.div_ceil(THREADS as usize) as u32;
        self.batches.submit(|pass| self.tasks[BEGIN].run(pass, groups));
    }

    /// Takes steps up to a time, s, or as many as a batch has, `most` at most. The number of steps.
    ///
    /// # Errors
    /// [`GpuError::Lost`].
    pub fn advance(&mut self, until: f64, most: u64) -> Result<(u64, Halt), GpuError> {
        let left = until - from_pair(self.status.clock);
        let count = self.batches.steps(left, f64::from(self.status.step), most);
        self.status = Status { halted: BATCH_START, steps: 0, at_rim: 0, until: to_pair(until), ..self.status };
        let Self { tasks, memory, sides, batches, status, .. } = self;
        *status = batches.run(
            count,
            (&memory.status, &*status),
            |pass| steps((tasks, *sides), memory, pass, count),
            |gpu| Ok(read(gpu, &memory.status, 1)?[0]),
        )?;
        Ok((u64::from(self.status.steps), Halt::of(self.status.halted)))
    }

    /// What passed so far, of both values each in and out.
    pub fn totals(&self) -> Totals {
        let Status {
            clock, step, last_step, outflow, inflow, energy_out, energy_in, momentum_out, momentum_in, ..
        } = self.status;
        Totals {
            time: from_pair(clock),
            step: f64::from(step),
            last_step: f64::from(last_step),
            wet: self.status.wet as usize,
            cell_steps: from_halves(self.status.cell_steps),
            water: [inflow, outflow].map(from_pair),
            energy: [energy_in, energy_out].map(from_pair),
            momentum: [momentum_in, momentum_out].map(from_pair),
            rained: from_pair(self.status.rained),
            infiltrated: from_pair(self.status.infiltrated),
            since_draught: f64::from(self.status.since_draught),
        }
    }

    /// Reads columns and records back.
    ///
    /// # Errors
    /// [`GpuError::Lost`].
    pub fn download(&self) -> Result<Downloaded, GpuError> {
        let Memory { columns, records, supplies, pushes, beyond, structure_discharges, .. } = &self.memory;
        let pushed = if self.sides.has_obstacles { self.sides.borders } else { 0 };
        let held = if self.sides.holds_levels { self.sides.borders } else { 0 };
        let supplied = if self.sides.exchanges { self.cells } else { 0 };
        let parts = [
            (columns, 2 * self.cells * size_of::<Column>()),
            (records, self.cells * size_of::<Record>()),
            (supplies, supplied * size_of::<Supply>()),
            (pushes, pushed * size_of::<Push>()),
            (beyond, held * size_of::<f32>()),
            (structure_discharges, self.sides.structures * size_of::<f32>()),
        ];
        let [columns, records, supplies, pushes, beyond, discharges] =
            read_together(self.batches.gpu(), parts, <[u8]>::to_vec)?;
        let columns = bytemuck::pod_collect_to_vec::<u8, Column>(&columns);
        let (now, before) = columns.split_at(self.cells);
        let columns = [now, before].map(|columns| columns.iter().map(column_of).collect());
        let records = bytemuck::pod_collect_to_vec::<u8, Record>(&records).iter().map(record_of).collect();
        let supplies = bytemuck::pod_collect_to_vec::<u8, Supply>(&supplies);
        let soaked = supplies.iter().map(|supply| supply.soaked).collect();
        let pushes = bytemuck::pod_collect_to_vec::<u8, Push>(&pushes).iter().map(push_of).collect();
        let [beyond, discharges] = [beyond, discharges].map(|bytes| bytemuck::pod_collect_to_vec(&bytes));
        Ok(Downloaded { columns, records, soaked, pushes, beyond, discharges })
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        self.memory.in_order().into_iter().map(wgpu::Buffer::size).sum()
    }
}

/// Takes so many steps, or fewer.
fn steps((tasks, sides): (&Tasks, Sides), memory: &Memory, pass: &mut Pass<'_>, count: u32) {
    let [
        slopes,
        fluxes_first,
        fluxes_second,
        kept,
        first,
        second,
        end,
        end_with_exchange,
        finish,
        _,
        push_first,
        push_second,
        share,
        follow,
        look,
        crests,
        overtop,
        structures,
        end_of_works,
        shift,
    ] = tasks;
    let has_works = sides.has_crests || sides.structures > 0;
    let end = match sides.exchanges {
        _ if has_works => end_of_works,
        true => end_with_exchange,
        false => end,
    };
    finish.run(pass, 1);
    for _ in 0..count {
        if sides.shares_discharges {
            share.dispatch_indirect(pass, &memory.groups, DISCHARGE_SLOT);
        }
        for (fluxes, update, push) in [(fluxes_first, first, push_first), (fluxes_second, second, push_second)] {
            for (task, slot) in [(slopes, CELL_SLOT), (fluxes, FACE_SLOT), (kept, CELL_SLOT)] {
                task.dispatch_indirect(pass, &memory.groups, slot);
            }
            if sides.has_obstacles {
                push.dispatch_indirect(pass, &memory.groups, BORDER_SLOT);
            }
            update.dispatch_indirect(pass, &memory.groups, CELL_SLOT);
            if sides.has_heights {
                shift.dispatch_indirect(pass, &memory.groups, CELL_SLOT);
            }
        }
        if sides.holds_levels {
            follow.dispatch_indirect(pass, &memory.groups, BORDER_SLOT);
        }
        if has_works {
            look.dispatch_indirect(pass, &memory.groups, CELL_SLOT);
        }
        if sides.has_crests {
            crests.dispatch_indirect(pass, &memory.groups, CREST_SLOT);
            overtop.dispatch_indirect(pass, &memory.groups, BESIDE_CREST_SLOT);
        }
        if sides.structures > 0 {
            structures.dispatch_indirect(pass, &memory.groups, STRUCTURE_SLOT);
        }
        end.dispatch_indirect(pass, &memory.groups, CELL_SLOT);
        finish.run(pass, 1);
    }
}

fn column_of(column: &Column) -> ColumnOfCpu {
    ColumnOfCpu { volume: from_pair(column.volume), momentum: column.momentum.map(f64::from) }
}

fn push_of(push: &Push) -> [[f64; 2]; 2] {
    [[push.east, push.north].map(from_pair), push.last.map(f64::from)]
}

fn record_of(record: &Record) -> super::maps::Record {
    let Record { fastest, max_depth, hazard, arrival, duration } = *record;
    super::maps::Record { max_depth, fastest, hazard, arrival, duration }
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_gpu::{check_layouts, check_shader};

    #[test]
    fn every_shader_is_valid_and_within_the_floor() {
        let drawing = (seen::SHADER.0, seen::SHADER.1, 0);
        for (name, text, version) in SHADERS.into_iter().chain([drawing]) {
            let library: Vec<_> = LIBRARY.iter().copied().chain(VERSIONS[version]).collect();
            let (text, _) = Memory::declaration().complete(name, text, &library).unwrap_or_else(|e| panic!("{e}"));
            check_shader(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
        }
    }

    #[test]
    fn host_and_device_lay_structures_out_alike() {
        check_layouts(&Memory::declaration()).unwrap();
    }
}
