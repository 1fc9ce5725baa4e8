//! The passes of a step, each with what it works on.

use crate::shared::{
    BeforeColumn, BeforeOutlet, Body, Fan, IS_PASSED, MEASURING_GROUPS, MOST_FANS, Measured, Memory, OutsideColumn,
    Packed, PackedColumn, Parameters, Partial, Row, Shown, Solid, Status, Surface, Water,
};
use crate::solids::sources::upload::GpuSources;
use crate::solids::upload::{GpuSolids, filled};
use corpuscle_gpu::{
    Buffers, COMPENSATED_SUMS, CellSort, GROUP_REDUCTION, Gpu, GpuError, Kernel, Pass, SUMS_BEFORE, SortSlots, THREADS,
    Task, storage, uniform, wgpu,
};
use corpuscle_sph::kernel::{CUBIC_SPLINE_SHAPE, KERNEL_PIECE};

/// Pieces that the shaders import, but for what they share with the host, and the smoothing kernel.
pub(super) const PIECES: &[(&str, &str)] = &[
    SUMS_BEFORE,
    COMPENSATED_SUMS,
    GROUP_REDUCTION,
    CUBIC_SPLINE_SHAPE,
    ("dew_particles", include_str!("../air/dew_particles.wgsl")),
    ("dew_columns", include_str!("../faces/dew_columns.wgsl")),
    ("dew_neighbours", include_str!("../air/dew_neighbours.wgsl")),
    ("dew_humid", include_str!("../humid_air/dew_humid.wgsl")),
    ("dew_normalisation", include_str!("../normalisation/dew_normalisation.wgsl")),
    ("dew_rows", include_str!("../solids/sources/dew_rows.wgsl")),
    ("dew_saturate", include_str!("../exchange/dew_saturate.wgsl")),
    ("dew_utility", include_str!("../utility/dew_utility.wgsl")),
];

/// These pieces and the smoothing kernel.
pub(crate) fn pieces(kernel: &str) -> Vec<(&str, &str)> {
    PIECES.iter().copied().chain([(KERNEL_PIECE, kernel)]).collect()
}

/// Slots of the numbers of groups: see `dew_finish.wgsl`.
const SLOTS: SortSlots = SortSlots::FIRST;
const SOLIDS: u32 = 4;
const BODIES: u32 = 5;

/// Everything on the device.
#[derive(Debug)]
pub(super) struct Tasks {
    pub memory: Memory,
    sort: CellSort,
    drift: Task,
    /// Where air passes a face.
    let_in: Option<Task>,
    cross: Task,
    /// Where there is a side that is open.
    outside: Option<Task>,
    reorder: Task,
    density: Task,
    /// What solids exchange with the air, where there are any: before the forces, and after.
    surfaces: Option<Task>,
    /// Heat from elsewhere, where there is any.
    sources: Option<Task>,
    forces: Task,
    take_up: Option<[Task; 2]>,
    finish: Task,
    /// The tasks of gauges of the air.
    pub measure: Task,
}

impl Tasks {
    /// For so many particles of air at most, with the smoothing kernel as a piece, columns outside open sides, and with so many rows of values over time.
    pub fn new(
        gpu: &Gpu,
        kernel: &str,
        count: usize,
        parameters: &Parameters,
        fans: &[Fan; MOST_FANS as usize],
        solids: GpuSolids,
        sources: Option<&GpuSources>,
        rows: usize,
        outside: &[OutsideColumn],
        field: &[f32],
    ) -> Result<Self, GpuError> {
        let GpuSolids { start: site_start, sites, own, pairs, count: of_solids, bodies } = solids;
        let cells = parameters.cells.iter().product::<u32>() as usize + 1;
        let groups = count.div_ceil(THREADS as usize);
        let status = storage::<Status>(gpu, "status", 1)?;
        let keys = storage::<u32>(gpu, "numbers of particles", count)?;
        let sort = CellSort::new(gpu, count, cells, &status, &keys)?;
        let memory = Memory {
            parameters: uniform(gpu, "parameters of the air", parameters),
            status,
            particles: storage::<Packed>(gpu, "air", count)?,
            ordered: storage::<Packed>(gpu, "air in order", count)?,
            spots: storage::<[f32; 4]>(gpu, "positions of particles", count)?,
            columns: storage::<PackedColumn>(gpu, "columns of air", count)?,
            partials: storage::<Partial>(gpu, "sums of groups", groups)?,
            before: storage::<[BeforeOutlet; 6]>(gpu, "sums before faces", groups)?,
            columns_before: storage::<BeforeColumn>(gpu, "sums before columns", outside.len())?,
            outside_columns: filled(gpu, "columns outside", outside)?,
            counts: sort.counts.clone(),
            cell_slots: sort.cell_slots.clone(),
            keys,
            start: sort.start.clone(),
            order: sort.order.clone(),
            groups: storage::<[u32; 3]>(gpu, "groups", 6)?,
            site_start,
            sites,
            own,
            solids: storage::<Solid>(gpu, "states of solids", of_solids)?,
            waters: storage::<Water>(gpu, "water on solids", of_solids)?,
            surfaces: storage::<Surface>(gpu, "surfaces", of_solids)?,
            pairs,
            bodies: filled::<Body>(gpu, "solids", &bodies)?,
            rows: storage::<Row>(gpu, "values over time", rows)?,
            shares: filled(gpu, "shares of sources", sources.map_or(&[][..], |sources| &sources.shares))?,
            sources: filled(gpu, "sources of heat", sources.map_or(&[][..], |sources| &sources.initial))?,
            measured: storage::<Measured>(gpu, "sums for gauges", MEASURING_GROUPS as usize)?,
            field: filled(gpu, "distances to solids", field)?,
            fans: uniform(gpu, "fans", fans),
            seen_at: uniform(gpu, "time shown", &Shown::default()),
            drawn: storage::<[u32; 16]>(gpu, "nothing drawn", 1)?,
        };
        let pieces = pieces(kernel);
        let task = |name, text| Kernel::<Memory>::new(gpu, name, text, &pieces).on(gpu, &memory);
        macro_rules! shader {
            ($folder:literal, $name:literal) => {
                task($name, include_str!(concat!("../", $folder, "/", $name, ".wgsl")))
            };
        }
        let has_solids = of_solids > 0;
        Ok(Self {
            drift: shader!("dew", "dew_drift"),
            let_in: (parameters.flags & IS_PASSED != 0).then(|| shader!("faces", "dew_let_in")),
            cross: shader!("faces", "dew_cross"),
            outside: (!outside.is_empty()).then(|| shader!("faces", "dew_outside")),
            reorder: shader!("gpu", "dew_reorder"),
            density: shader!("air", "dew_density"),
            surfaces: has_solids.then(|| shader!("exchange", "dew_surfaces")),
            sources: sources.map(|_| shader!("solids/sources", "dew_sources")),
            forces: shader!("dew", "dew_forces"),
            take_up: has_solids.then(|| [shader!("exchange", "dew_take_up"), shader!("solids", "dew_bodies")]),
            finish: shader!("gpu", "dew_finish"),
            measure: shader!("measures", "dew_measure"),
            memory,
            sort,
        })
    }

    /// Bytes held.
    pub fn bytes(&self) -> u64 {
        self.memory.in_order().into_iter().map(wgpu::Buffer::size).sum()
    }

    /// Decides whether to go on, and then takes so many steps, or fewer: from where it is to halt they do nothing.
    pub fn steps(&self, pass: &mut Pass<'_>, count: u32) {
        self.finish.run(pass, 1);
        for _ in 0..count {
            self.step(pass);
        }
    }

    fn step(&self, pass: &mut Pass<'_>) {
        let groups = &self.memory.groups;
        self.drift.dispatch_indirect(pass, groups, SLOTS.particles);
        if let Some(let_in) = &self.let_in {
            let_in.run(pass, 1);
        }
        self.cross.dispatch_indirect(pass, groups, SLOTS.particles);
        if let Some(outside) = &self.outside {
            outside.run(pass, 1);
        }
        self.sort.sort(pass, groups, SLOTS);
        self.reorder.dispatch_indirect(pass, groups, SLOTS.particles);
        self.density.dispatch_indirect(pass, groups, SLOTS.particles);
        if let Some(surfaces) = &self.surfaces {
            surfaces.dispatch_indirect(pass, groups, SOLIDS);
        }
        if let Some(sources) = &self.sources {
            sources.dispatch_indirect(pass, groups, BODIES);
        }
        self.forces.dispatch_indirect(pass, groups, SLOTS.particles);
        if let Some([take_up, bodies]) = &self.take_up {
            take_up.dispatch_indirect(pass, groups, SOLIDS);
            bodies.dispatch_indirect(pass, groups, BODIES);
        }
        self.finish.run(pass, 1);
    }
}
