//! The passes of a step, each with what it works on.

use super::shared::{
    self, Before, BeforeColumn, Column, MEASURING_GROUPS, MOST_FANS, OutsideColumn, Parameters, Partial, Status,
    Surface,
};
use super::solids::{CardSolids, filled};
use super::sources::CardSources;
use corpuscle_gpu::{
    CellSort, DECLARED, Gpu, GpuError, Kernel, Pass, SUMS_BEFORE, SortSlots, THREADS, Task, storage, uniform, wgpu,
};

/// Pieces that the shaders import, but for what they share with the host.
const PIECES: &[(&str, &str)] = &[
    SUMS_BEFORE,
    ("dew_card", include_str!("dew_card.wgsl")),
    ("dew_columns", include_str!("dew_columns.wgsl")),
    ("dew_neighbours", include_str!("dew_neighbours.wgsl")),
    ("dew_humid", include_str!("dew_humid.wgsl")),
    ("dew_normalisation", include_str!("dew_normalisation.wgsl")),
    ("dew_rows", include_str!("dew_rows.wgsl")),
    ("dew_saturate", include_str!("dew_saturate.wgsl")),
    ("dew_utility", include_str!("dew_utility.wgsl")),
];

/// Pieces that the shaders import; `shared` is the text of what they share with the host.
pub(super) fn library(shared: &str) -> Vec<(&'static str, &str)> {
    PIECES.iter().copied().chain([(DECLARED, shared)]).collect()
}

/// Slots of the numbers of groups: see `dew_finish.wgsl`.
const SLOTS: SortSlots = SortSlots { particles: 0, cells: 1, blocks: 2, once: 3 };
const SOLIDS: u64 = 4;
const BODIES: u64 = 5;

/// Everything on the device.
#[derive(Debug)]
pub(super) struct Tasks {
    pub parameters: wgpu::Buffer,
    pub status: wgpu::Buffer,
    pub particles: wgpu::Buffer,
    pub solids: wgpu::Buffer,
    pub waters: wgpu::Buffer,
    pub bodies: wgpu::Buffer,
    pub rows: wgpu::Buffer,
    /// Bytes held.
    pub bytes: u64,
    groups: wgpu::Buffer,
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
    /// What gauges tell of the air.
    pub measure: Task,
    pub measured: wgpu::Buffer,
}

impl Tasks {
    /// For so many particles of air at most, with columns outside open sides.
    pub fn new(
        gpu: &Gpu,
        count: usize,
        parameters: &Parameters,
        fans: &[shared::Fan; MOST_FANS as usize],
        solids: &CardSolids,
        sources: Option<&CardSources>,
        outside: &[OutsideColumn],
        field: &[f32],
    ) -> Result<Self, GpuError> {
        let CardSolids { start: site_start, sites, own, pairs, .. } = solids;
        let cells = parameters.cells.iter().product::<u32>() as usize + 1;
        let is_passed = parameters.flags & super::shared::IS_PASSED != 0;
        let parameters = uniform(gpu, "parameters of the air", parameters);
        let fans = uniform(gpu, "fans", fans);
        let rows = storage::<shared::Row>(gpu, "temperatures held", solids.rows.len())?;
        let status = storage::<Status>(gpu, "status", 1)?;
        let groups = storage::<[u32; 3]>(gpu, "groups", 6)?;
        let particles = storage::<shared::Particle>(gpu, "air", count)?;
        let ordered = storage::<shared::Particle>(gpu, "air in order", count)?;
        let keys = storage::<u32>(gpu, "numbers of particles", count)?;
        let spots = storage::<[f32; 4]>(gpu, "places of particles", count)?;
        let columns = storage::<Column>(gpu, "columns of air", count)?;
        let partials = storage::<Partial>(gpu, "sums of groups", count.div_ceil(THREADS as usize))?;
        let before = storage::<Before>(gpu, "sums before faces", count.div_ceil(THREADS as usize))?;
        let columns_before = storage::<BeforeColumn>(gpu, "sums before columns", outside.len())?;
        let is_open = !outside.is_empty();
        let outside = filled(gpu, "columns outside", outside)?;
        let field = filled(gpu, "distances to solids", field)?;
        let states = storage::<shared::Solid>(gpu, "states of solids", solids.count)?;
        let waters = storage::<shared::Water>(gpu, "water on solids", solids.count)?;
        let surfaces = storage::<Surface>(gpu, "surfaces", solids.count)?;
        let bodies = filled::<shared::Body>(gpu, "solids", &solids.bodies)?;
        let measured = storage::<shared::Measured>(gpu, "sums for gauges", MEASURING_GROUPS as usize)?;
        let sort = CellSort::new(gpu, count, cells, &status, &keys)?;
        let of_air = [&particles, &ordered, &keys, &spots, &columns, &partials, &before, &sort.places, &sort.order];
        let of_cells = [&sort.counts, &sort.start, site_start];
        let of_solids = [&states, &waters, &surfaces, sites, own, pairs];
        let bytes = of_air.into_iter().chain(of_cells).chain(of_solids).map(wgpu::Buffer::size).sum();
        let shared = shared::declaration().types();
        let library = library(&shared);
        let task = |name, text, buffers: &[Option<&wgpu::Buffer>]| {
            let bindings = buffers.iter().map(|buffer| buffer.map(wgpu::Buffer::as_entire_binding));
            Kernel::new(gpu, name, text, &library).on_those(gpu, bindings)
        };
        macro_rules! shader {
            ($name:literal, [$first:expr, $($buffer:expr),*]) => {
                task($name, include_str!(concat!($name, ".wgsl")), &[$first, $(Some(&$buffer)),*])
            };
        }
        let has_solids = solids.count > 0;
        let all = Some(&parameters);
        Ok(Self {
            drift: shader!("dew_drift", [all, status, particles, before]),
            let_in: is_passed.then(|| shader!("dew_let_in", [all, status, particles, before, groups])),
            cross: shader!(
                "dew_cross",
                [all, status, particles, sort.counts, sort.places, keys, partials, columns_before, field]
            ),
            outside: is_open.then(|| {
                shader!(
                    "dew_outside",
                    [all, status, particles, columns_before, outside, sort.counts, sort.places, keys, groups]
                )
            }),
            reorder: shader!("dew_reorder", [all, status, sort.start, sort.order, particles, ordered, spots, outside]),
            density: shader!(
                "dew_density",
                [all, status, sort.start, spots, ordered, particles, columns, *site_start, *sites]
            ),
            surfaces: has_solids.then(|| {
                shader!("dew_surfaces", [all, status, sort.start, columns, *own, states, surfaces, *pairs, waters])
            }),
            sources: sources.map(|of| {
                shader!("dew_sources", [all, status, states, surfaces, of.rows, of.shares, bodies, of.sources])
            }),
            forces: shader!(
                "dew_forces",
                [all, status, sort.start, columns, particles, *site_start, *sites, surfaces, partials, fans]
            ),
            take_up: has_solids.then(|| {
                [
                    shader!("dew_take_up", [all, status, sort.start, spots, particles, *own, surfaces, states, waters]),
                    shader!("dew_bodies", [all, states, bodies, status, rows]),
                ]
            }),
            finish: shader!("dew_finish", [all, status, partials, groups, bodies, *own]),
            measure: shader!("dew_measure", [None, status, particles, measured]),
            measured,
            parameters,
            status,
            particles,
            solids: states,
            waters,
            bodies,
            rows,
            bytes,
            groups,
            sort,
        })
    }

    /// Decides whether to go on, and then takes so many steps, or fewer: from where it is to halt they do nothing.
    pub fn steps(&self, pass: &mut Pass<'_>, count: u32) {
        self.finish.run(pass, 1);
        for _ in 0..count {
            self.step(pass);
        }
    }

    fn step(&self, pass: &mut Pass<'_>) {
        let groups = &self.groups;
        self.drift.run_as_told(pass, groups, SLOTS.particles);
        if let Some(let_in) = &self.let_in {
            let_in.run(pass, 1);
        }
        self.cross.run_as_told(pass, groups, SLOTS.particles);
        if let Some(outside) = &self.outside {
            outside.run(pass, 1);
        }
        self.sort.sort(pass, groups, SLOTS);
        self.reorder.run_as_told(pass, groups, SLOTS.particles);
        self.density.run_as_told(pass, groups, SLOTS.particles);
        if let Some(surfaces) = &self.surfaces {
            surfaces.run_as_told(pass, groups, SOLIDS);
        }
        if let Some(sources) = &self.sources {
            sources.run_as_told(pass, groups, BODIES);
        }
        self.forces.run_as_told(pass, groups, SLOTS.particles);
        if let Some([take_up, bodies]) = &self.take_up {
            take_up.run_as_told(pass, groups, SOLIDS);
            bodies.run_as_told(pass, groups, BODIES);
        }
        self.finish.run(pass, 1);
    }
}
