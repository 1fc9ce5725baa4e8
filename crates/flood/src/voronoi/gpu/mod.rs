//! Steps of scheme `voronoi` on a GPU, in single precision: the cells are made on the CPU and uploaded, the passes of a step run one after another, and nothing
//! is downloaded between the steps of a batch.
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

use super::local::{HIGHEST, REPEATED, WIDENED};
use super::water::Column as ColumnOfCpu;
use corpuscle_gpu::{
    BATCH_START, Batches, Buffers, COMPENSATED_SUMS, GROUP_REDUCTION, Gpu, GpuError, Halt, Kernel, Pass, SeenParticles,
    ShaderLibrary, THREADS, Task, from_halves, from_pair, read, read_together, to_pair, wgpu,
};
use shared::{
    BESIDE_CREST_SLOT, BORDER_SLOT, CELL_SLOT, CREST_SLOT, Column, DISCHARGE_SLOT, FACE_SLOT, Memory, PART_BORDER_SLOT,
    PART_CELL_SLOT, PART_FACE_SLOT, PLAN_CELL_SLOT, PLAN_FACE_SLOT, PLAN_SLOT, Push, Record, STRUCTURE_SLOT, Status,
    Supply,
};
use upload::Input;

const LIBRARY: ShaderLibrary<'_> = &[
    COMPENSATED_SUMS,
    GROUP_REDUCTION,
    ("voronoi_tables", include_str!("voronoi_tables.wgsl")),
    ("voronoi_look_up", include_str!("voronoi_look_up.wgsl")),
    ("voronoi_groups", include_str!("voronoi_groups.wgsl")),
    ("voronoi_plans", include_str!("../local/voronoi_plans.wgsl")),
    ("voronoi_local", include_str!("../local/voronoi_local.wgsl")),
    ("voronoi_record", include_str!("../maps/voronoi_record.wgsl")),
    ("infiltration_laws", include_str!("../rain/infiltration_laws.wgsl")),
    ("voronoi_water", include_str!("voronoi_water.wgsl")),
    ("voronoi_stable", include_str!("voronoi_stable.wgsl")),
    ("voronoi_change", include_str!("voronoi_change.wgsl")),
    ("hydraulics", include_str!("../structures/hydraulics.wgsl")),
    ("voronoi_storage", include_str!("../voronoi_storage.wgsl")),
    ("friction_rate", include_str!("../../friction/friction_rate.wgsl")),
    ("voronoi_friction", include_str!("../friction/voronoi_friction.wgsl")),
    ("voronoi_differences", include_str!("../reconstruction/voronoi_differences.wgsl")),
    ("voronoi_faces", include_str!("../reconstruction/voronoi_faces.wgsl")),
    ("voronoi_riemann", include_str!("../fluxes/voronoi_riemann.wgsl")),
    ("voronoi_boundaries", include_str!("../boundaries/voronoi_boundaries.wgsl")),
];

/// Which stage of a step a kernel is for.
#[derive(Debug, Clone, Copy)]
enum Stage {
    /// The first, or none.
    First,
    /// The second.
    Second,
    /// The end of a step with structures: the water was surveyed before they changed it.
    Surveyed,
}

impl Stage {
    /// The pieces in which the versions of a shader for the stages differ: the stage itself, and whether there is rain, infiltration or inflow.
    fn pieces(self) -> [(&'static str, &'static str); 2] {
        let exchange = ("exchange", include_str!("../rain/voronoi_exchange.wgsl"));
        match self {
            Self::First => [
                ("stage", "const IS_SECOND = false;\nconst IS_SURVEYED = false;\n"),
                ("exchange", "fn exchange(cell: u32, own: ptr<function, Found>) {}\n"),
            ],
            Self::Second => [("stage", "const IS_SECOND = true;\nconst IS_SURVEYED = false;\n"), exchange],
            Self::Surveyed => [("stage", "const IS_SECOND = true;\nconst IS_SURVEYED = true;\n"), exchange],
        }
    }
}

/// The pieces in which shaders differ where cells take steps of their own.
fn time_step_pieces(are_local: bool) -> [(&'static str, &'static str); 3] {
    if are_local {
        [
            ("time_steps", include_str!("../local/voronoi_local.wgsl")),
            ("next", include_str!("../local/voronoi_local_next.wgsl")),
            ("record_step", "fn record_step(cell: u32) {}\n"),
        ]
    } else {
        [
            ("time_steps", include_str!("../local/voronoi_global.wgsl")),
            ("next", include_str!("../local/voronoi_global_next.wgsl")),
            ("record_step", include_str!("../maps/voronoi_record_step.wgsl")),
        ]
    }
}

/// The kernels, in the order of [`SHADERS`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Name {
    Begin,
    Slopes,
    FluxesFirst,
    FluxesSecond,
    Kept,
    UpdateFirst,
    UpdateSecond,
    PushFirst,
    PushSecond,
    Shift,
    Share,
    Follow,
    Survey,
    Crests,
    Overtop,
    Structures,
    End,
    EndWithExchange,
    EndWithStructures,
    Finish,
    // Where cells take steps of their own.
    Part,
    ShowFirst,
    ShowSecond,
    EndPart,
    Levels,
    SpreadThere,
    SpreadBack,
    Paces,
    Near,
    Plan,
}

/// Each kernel with the name and text of its shader, and its stage.
const SHADERS: [(Name, &str, &str, Stage); 30] = [
    (Name::Begin, "voronoi_begin", include_str!("voronoi_begin.wgsl"), Stage::First),
    (Name::Slopes, "voronoi_slopes", include_str!("../reconstruction/voronoi_slopes.wgsl"), Stage::First),
    (Name::FluxesFirst, "voronoi_fluxes", include_str!("../fluxes/voronoi_fluxes.wgsl"), Stage::First),
    (Name::FluxesSecond, "voronoi_fluxes", include_str!("../fluxes/voronoi_fluxes.wgsl"), Stage::Second),
    (Name::Kept, "voronoi_kept", include_str!("../fluxes/voronoi_kept.wgsl"), Stage::First),
    (Name::UpdateFirst, "voronoi_update", include_str!("voronoi_update.wgsl"), Stage::First),
    (Name::UpdateSecond, "voronoi_update", include_str!("voronoi_update.wgsl"), Stage::Second),
    (Name::PushFirst, "voronoi_push", include_str!("../walls/voronoi_push.wgsl"), Stage::First),
    (Name::PushSecond, "voronoi_push", include_str!("../walls/voronoi_push.wgsl"), Stage::Second),
    (Name::Shift, "voronoi_shift", include_str!("../voronoi_shift.wgsl"), Stage::First),
    (Name::Share, "voronoi_share", include_str!("../boundaries/voronoi_share.wgsl"), Stage::First),
    (Name::Follow, "voronoi_follow", include_str!("../boundaries/voronoi_follow.wgsl"), Stage::Second),
    (Name::Survey, "voronoi_survey", include_str!("voronoi_survey.wgsl"), Stage::Second),
    (Name::Crests, "voronoi_crests", include_str!("../walls/voronoi_crests.wgsl"), Stage::Second),
    (Name::Overtop, "voronoi_overtop", include_str!("../walls/voronoi_overtop.wgsl"), Stage::Second),
    (Name::Structures, "voronoi_structures", include_str!("../structures/voronoi_structures.wgsl"), Stage::Second),
    (Name::End, "voronoi_end", include_str!("voronoi_end.wgsl"), Stage::First),
    (Name::EndWithExchange, "voronoi_end", include_str!("voronoi_end.wgsl"), Stage::Second),
    (Name::EndWithStructures, "voronoi_end", include_str!("voronoi_end.wgsl"), Stage::Surveyed),
    (Name::Finish, "voronoi_finish", include_str!("voronoi_finish.wgsl"), Stage::First),
    (Name::Part, "voronoi_part", include_str!("../local/voronoi_part.wgsl"), Stage::First),
    (Name::ShowFirst, "voronoi_show", include_str!("../local/voronoi_show.wgsl"), Stage::First),
    (Name::ShowSecond, "voronoi_show", include_str!("../local/voronoi_show.wgsl"), Stage::Second),
    (Name::EndPart, "voronoi_end_part", include_str!("../local/voronoi_end_part.wgsl"), Stage::Second),
    (Name::Levels, "voronoi_levels", include_str!("../local/voronoi_levels.wgsl"), Stage::First),
    (Name::SpreadThere, "voronoi_spread", include_str!("../local/voronoi_spread.wgsl"), Stage::First),
    (Name::SpreadBack, "voronoi_spread", include_str!("../local/voronoi_spread.wgsl"), Stage::Second),
    (Name::Paces, "voronoi_paces", include_str!("../local/voronoi_paces.wgsl"), Stage::First),
    (Name::Near, "voronoi_near", include_str!("../local/voronoi_near.wgsl"), Stage::First),
    (Name::Plan, "voronoi_plan", include_str!("../local/voronoi_plan.wgsl"), Stage::First),
];

/// Parts of a step at most, where cells take steps of their own.
const MOST_PARTS: usize = 1 << HIGHEST;

/// How often distances spread to neighbours, there and back: at least as often as the farthest that counts, two neighbours beyond those near which stages are repeated.
const SPREADS: usize = (WIDENED[0] as usize + REPEATED + 3).div_ceil(2);

/// The kernels of a flood, in the order of [`SHADERS`]; the last only where cells take steps of their own.
fn kernels(gpu: &Gpu, are_local: bool) -> Vec<Kernel<Memory>> {
    let all = if are_local { SHADERS.len() } else { Name::Part as usize };
    let kernel = |&(_, name, text, stage): &(Name, &'static str, &str, Stage)| {
        let library: Vec<_> =
            LIBRARY.iter().copied().chain(stage.pieces()).chain(time_step_pieces(are_local)).collect();
        Kernel::new(gpu, name, text, &library)
    };
    SHADERS[..all].iter().map(kernel).collect()
}

/// A flood on a GPU.
pub(crate) struct GpuSolver {
    pub batches: Batches,
    kernels: Vec<Kernel<Memory>>,
    memory: Memory,
    /// The kernels with their buffers.
    tasks: Vec<Task>,
    cells: usize,
    sides: Sides,
    status: Status,
    /// The water for drawing, once it is drawn.
    seen: SeenParticles,
}

/// Parts of a flood beside the motion of its water.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sides {
    /// Whether there is rain, infiltration or inflow.
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
    /// Whether a level is prescribed beyond some border.
    holds_levels: bool,
    /// Whether discharges are shared out over border faces.
    shares_discharges: bool,
    /// Whether cells may take steps of their own.
    are_steps_local: bool,
}

/// The state of a flood as downloaded.
pub(super) struct Downloaded {
    /// Columns now, and before the last step.
    pub columns: [Vec<ColumnOfCpu>; 2],
    pub records: Vec<super::maps::Record>,
    /// Infiltrated depth of each cell, m; empty where there is no rain, infiltration or inflow.
    pub soaked: Vec<f32>,
    /// Impulse over density at each border face since the upload, and in the last step, m4/s; empty where there are no obstacles.
    pub pushes: Vec<[[f64; 2]; 2]>,
    /// State of the water beyond each border face; empty where no level is prescribed.
    pub beyond: Vec<f32>,
    /// Discharge of each structure, m3/s.
    pub discharges: Vec<f32>,
}

/// Totals since the flood was uploaded.
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
    /// Of these what the last step brought and took: water and energy in and out, rain, infiltration.
    pub last: [f64; 6],
    /// Time since water last soaked into the ground, s.
    pub since_draught: f64,
}

impl GpuSolver {
    /// Compiles the kernels and uploads a flood.
    ///
    /// # Errors
    /// [`GpuError::Memory`], [`GpuError::TooMany`].
    pub fn new(gpu: Gpu, input: &Input<'_>) -> Result<Self, GpuError> {
        let kernels = kernels(&gpu, input.are_steps_local());
        let (memory, status) = input.upload(&gpu)?;
        let tasks = kernels.iter().map(|kernel| kernel.on(&gpu, &memory)).collect();
        let (cells, sides) = (input.cells(), input.sides());
        let mut solver = Self {
            batches: Batches::new(gpu, "voronoi"),
            kernels,
            memory,
            tasks,
            cells,
            sides,
            status,
            seen: SeenParticles::default(),
        };
        solver.begin();
        Ok(solver)
    }

    /// Uploads a flood whose cells are others now, or whose water was changed; totals start at 0.
    ///
    /// # Errors
    /// As [`GpuSolver::new`].
    pub fn upload_again(&mut self, input: &Input<'_>) -> Result<(), GpuError> {
        let gpu = self.batches.gpu();
        (self.memory, self.status) = input.upload(gpu)?;
        self.tasks = self.kernels.iter().map(|kernel| kernel.on(gpu, &self.memory)).collect();
        self.seen = SeenParticles::default();
        (self.cells, self.sides) = (input.cells(), input.sides());
        self.begin();
        Ok(())
    }

    /// Finds the water of the columns that were uploaded.
    fn begin(&mut self) {
        let groups = self.cells.div_ceil(THREADS as usize) as u32;
        self.batches.submit(|pass| self.tasks[Name::Begin as usize].run(pass, groups));
    }

    /// Takes steps up to a time, s, or as many as a batch has, `most` at most. The number of steps.
    ///
    /// # Errors
    /// [`GpuError::Lost`].
    pub async fn advance(&mut self, until: f64, most: u64) -> Result<(u64, Halt), GpuError> {
        let left = until - from_pair(self.status.clock);
        let count = self.batches.steps(left, f64::from(self.status.step), most);
        self.status = Status { halted: BATCH_START, steps: 0, at_rim: 0, until: to_pair(until), ..self.status };
        let Self { tasks, memory, sides, batches, status, .. } = self;
        let work = |pass: &mut Pass<'_>| Steps { tasks, memory, sides: *sides }.take(pass, count);
        let done = async |gpu: &Gpu| Ok(read(gpu, &memory.status, 1).await?[0]);
        *status = batches.run(count, (&memory.status, &*status), work, done).await?;
        Ok((u64::from(self.status.steps), Halt::of(self.status.halted)))
    }

    /// Totals so far; of pairs the first is in, the second out.
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
            last: [
                from_pair(self.status.last_inflow),
                from_pair(self.status.last_outflow),
                f64::from(self.status.last_energy[1]),
                f64::from(self.status.last_energy[0]),
                from_pair(self.status.last_rained),
                from_pair(self.status.last_infiltrated),
            ],
            since_draught: f64::from(self.status.since_draught),
        }
    }

    /// Reads columns and records back.
    ///
    /// # Errors
    /// [`GpuError::Lost`].
    pub async fn download(&self) -> Result<Downloaded, GpuError> {
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
            read_together(self.batches.gpu(), parts, <[u8]>::to_vec).await?;
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

/// The passes of steps.
struct Steps<'a> {
    tasks: &'a [Task],
    memory: &'a Memory,
    sides: Sides,
}

impl Steps<'_> {
    /// Takes `count` steps, or fewer.
    fn take(&self, pass: &mut Pass<'_>, count: u32) {
        self.finish(pass);
        for _ in 0..count {
            self.step(pass);
            self.finish(pass);
        }
    }

    /// Runs a kernel with as many groups as a slot says.
    fn run(&self, pass: &mut Pass<'_>, name: Name, slot: u32) {
        self.tasks[name as usize].dispatch_indirect(pass, &self.memory.groups, slot);
    }

    /// Books a step, decides whether there is another, and plans it where cells take steps of their own.
    fn finish(&self, pass: &mut Pass<'_>) {
        self.tasks[Name::Finish as usize].run(pass, 1);
        if !self.sides.are_steps_local {
            return;
        }
        self.run(pass, Name::Levels, PLAN_CELL_SLOT);
        for _ in 0..SPREADS {
            self.run(pass, Name::SpreadThere, PLAN_CELL_SLOT);
            self.run(pass, Name::SpreadBack, PLAN_CELL_SLOT);
        }
        self.run(pass, Name::Paces, PLAN_CELL_SLOT);
        self.run(pass, Name::Near, PLAN_FACE_SLOT);
        self.run(pass, Name::Plan, PLAN_SLOT);
    }

    fn step(&self, pass: &mut Pass<'_>) {
        let sides = self.sides;
        if sides.shares_discharges {
            self.run(pass, Name::Share, DISCHARGE_SLOT);
        }
        if sides.are_steps_local {
            for _ in 0..MOST_PARTS {
                self.tasks[Name::Part as usize].run(pass, 1);
                self.move_water(pass, [PART_CELL_SLOT, PART_FACE_SLOT, PART_BORDER_SLOT]);
                self.run(pass, Name::EndPart, PART_CELL_SLOT);
            }
        } else {
            self.move_water(pass, [CELL_SLOT, FACE_SLOT, BORDER_SLOT]);
        }
        if sides.holds_levels {
            self.run(pass, Name::Follow, BORDER_SLOT);
        }
        let has_structures = sides.has_crests || sides.structures > 0;
        if has_structures {
            self.run(pass, Name::Survey, CELL_SLOT);
        }
        if sides.has_crests {
            self.run(pass, Name::Crests, CREST_SLOT);
            self.run(pass, Name::Overtop, BESIDE_CREST_SLOT);
        }
        if sides.structures > 0 {
            self.run(pass, Name::Structures, STRUCTURE_SLOT);
        }
        let end = match sides.exchanges {
            _ if has_structures => Name::EndWithStructures,
            true => Name::EndWithExchange,
            false => Name::End,
        };
        self.run(pass, end, CELL_SLOT);
    }

    /// Both stages of the water's motion, in a step or a part of it, with the slots of cells, faces and border faces.
    fn move_water(&self, pass: &mut Pass<'_>, [cells, faces, borders]: [u32; 3]) {
        let stages = [
            [Name::ShowFirst, Name::FluxesFirst, Name::PushFirst, Name::UpdateFirst],
            [Name::ShowSecond, Name::FluxesSecond, Name::PushSecond, Name::UpdateSecond],
        ];
        for [show, fluxes, push, update] in stages {
            if self.sides.are_steps_local {
                self.run(pass, show, cells);
            }
            self.run(pass, Name::Slopes, cells);
            self.run(pass, fluxes, faces);
            self.run(pass, Name::Kept, cells);
            if self.sides.has_obstacles {
                self.run(pass, push, borders);
            }
            self.run(pass, update, cells);
            if self.sides.has_heights {
                self.run(pass, Name::Shift, cells);
            }
        }
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
        let drawing = (Name::Begin, seen::SHADER.0, seen::SHADER.1, Stage::First);
        for are_local in [false, true] {
            let local_only = |name: Name| name as usize >= Name::Part as usize;
            let all = SHADERS.into_iter().filter(|(name, ..)| are_local || !local_only(*name));
            for (_, name, text, stage) in all.chain([drawing]) {
                let library: Vec<_> =
                    LIBRARY.iter().copied().chain(stage.pieces()).chain(time_step_pieces(are_local)).collect();
                let (text, _) = Memory::declaration().complete(name, text, &library).unwrap_or_else(|e| panic!("{e}"));
                check_shader(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
            }
        }
    }

    #[test]
    fn kernels_stand_in_the_order_of_their_names() {
        assert!(SHADERS.iter().enumerate().all(|(number, (name, ..))| *name as usize == number));
    }

    #[test]
    fn host_and_device_lay_structures_out_alike() {
        check_layouts(&Memory::declaration()).unwrap();
    }
}
