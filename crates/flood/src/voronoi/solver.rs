//! A step of the water: two identical stages, averaged (Heun's method). Each stage is three passes: slopes of cells, fluxes through faces, and the
//! new columns. Where a face takes much of a cell's water two more come between: how much each cell can give, and the fluxes once more.
//!
//! Cells and faces are processed in chunks; chunks without water, and without water beside them, are left out. Every cell gathers what its
//! faces bring in the order of its links, so that the result does not depend on the number of threads.

use super::CHUNK;
use super::boundaries::Now;
use super::domain::Domain;
use super::fluxes::{Flux, Inputs, OnFaces, fluxes_of_chunk};
use super::friction::Slowing;
use super::local::Local;
use super::mesh::{Mesh, NONE};
use super::reconstruction::slopes;
use super::sums::total;
use super::walls::OverCrest;
use super::water::{Column, Slopes, Water};
use corpuscle_model::{ExactSum, ROUNDERS, ReproducibleSum};
use corpuscle_simd::{Level, Simd, dispatch};
use rayon::prelude::*;

/// Time step over the width of a cell and the speed of waves in it: half the stability limit of the scheme in one dimension
/// (Audusse et al. 2004, equation 3.16), nearly in full.
pub(crate) const COURANT: f64 = 0.8;

/// The water of all cells and the memory that a step works in.
pub(crate) struct Solver {
    pub mesh: Mesh,
    pub gravity: f64,
    pub slowing: Slowing,
    /// Longest time step, s.
    pub longest: f64,
    pub columns: Vec<Column>,
    pub water: Vec<Water>,
    slopes: Vec<Slopes>,
    before: Vec<Column>,
    fluxes: Vec<Flux>,
    kept: Vec<f32>,
    /// The largest number of faces of a cell.
    most_faces: usize,
    /// Walls that water may flow over.
    pub crests: Vec<OverCrest>,
    /// Faces on borders.
    pub borders: Vec<u32>,
    /// Over which borders water may come onto dry ground.
    brings: [bool; 6],
    /// Whether a value became not finite in the last stage: the step ends there.
    broken: bool,
    chunks: Chunks,
    /// Cells take steps of their own where that pays; none where all are to take the same.
    pub local: Option<Local>,
    /// The part of this process where several share the cells.
    pub domain: Option<Domain>,
}

/// Which chunks have water, and which touch which.
#[derive(Default)]
struct Chunks {
    wet: Vec<bool>,
    /// Chunks of cells that each chunk of faces touches, and chunks of faces that each chunk of cells touches.
    cells_of_faces: Vec<Vec<u32>>,
    faces_of_cells: Vec<Vec<u32>>,
    active_faces: Vec<bool>,
    /// Those that were active in the last stage: their fluxes are not 0.
    were_active: Vec<bool>,
    active_cells: Vec<bool>,
    /// Chunks of faces over which water may come from beyond a border.
    open: Vec<bool>,
    /// What the passes found in each chunk.
    found: Vec<Found>,
    on_faces: Vec<OnFaces>,
    /// Whether some cell of each chunk may lack the water for its outflow; and whether all were found to have it, `kept` being 1 for all.
    may_drain: Vec<bool>,
    all_kept: Vec<bool>,
}

/// What an update found in a chunk of cells.
#[derive(Debug, Clone, Copy)]
struct Found {
    wet: bool,
    /// Change of momentum over density by friction, m4/s.
    slowed: [ReproducibleSum<f64>; 2],
    /// Shortest time step, s.
    step: f64,
    /// Whether tiles must be made.
    rim: bool,
    /// Number of wet cells of this process.
    count: u32,
    /// Whether a value is not finite.
    broken: bool,
}

const NOTHING: Found = Found {
    wet: false,
    slowed: [ReproducibleSum::NOTHING; 2],
    step: f64::INFINITY,
    rim: false,
    count: 0,
    broken: false,
};

/// What a step did to water and momentum over density: m3 and m4/s.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Done {
    pub slowed: [f64; 2],
    pub by_ground: [f64; 2],
}

/// Outward flux through a border face in a step: volume, m3, momentum over density, m4/s, and energy over density above the level 0, m5/s2.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct BorderFlux {
    pub volume: f64,
    pub momentum: [f64; 2],
    pub energy: f64,
}

impl Solver {
    pub fn new(mesh: Mesh, gravity: f64, slowing: Slowing, longest: f64, brings: [bool; 6]) -> Self {
        let mut solver = Self {
            mesh,
            gravity,
            slowing,
            longest,
            columns: Vec::new(),
            water: Vec::new(),
            slopes: Vec::new(),
            before: Vec::new(),
            fluxes: Vec::new(),
            kept: Vec::new(),
            most_faces: 0,
            crests: Vec::new(),
            borders: Vec::new(),
            brings,
            broken: false,
            chunks: Chunks::default(),
            local: None,
            domain: None,
        };
        solver.grow();
        solver
    }

    /// Has room for the cells and faces that were added to the mesh; new cells are dry.
    pub fn grow(&mut self) {
        let (first_face, faces, cells) = (self.fluxes.len(), self.mesh.faces.len(), self.mesh.len());
        let counts = (self.columns.len()..cells).map(|cell| self.mesh.links_of(cell).len());
        self.most_faces = counts.fold(self.most_faces, usize::max);
        let dry = |cell: usize| Water { level: self.mesh.level(cell, 0.0), ..Water::default() };
        self.water.extend((self.water.len()..cells).map(dry));
        self.columns.resize(cells, Column::default());
        self.before.resize(cells, Column::default());
        self.slopes.resize(cells, Slopes::default());
        self.kept.resize(cells, 1.0);
        self.fluxes.resize(faces, Flux::default());
        let new_borders = (first_face..faces).filter(|face| self.mesh.faces[*face].border().is_some());
        self.borders.extend(new_borders.map(|face| face as u32));
        self.chunks.grow(&self.mesh, first_face, self.brings);
    }

    /// Finds depth, level and velocity of all cells; the longest time step that all can take, s.
    pub fn update_water(&mut self) -> f64 {
        let Self { mesh, columns, water, .. } = self;
        let cells = columns.par_chunks_mut(CHUNK).zip(water.par_chunks_mut(CHUNK)).enumerate();
        cells.for_each(|(chunk, (columns, water))| {
            for (k, (column, water)) in columns.iter_mut().zip(water).enumerate() {
                *water = mesh.water(chunk * CHUNK + k, column);
            }
        });
        self.survey();
        self.time_step()
    }

    /// The same from columns of a finished step, bit for bit as the step computed it.
    pub fn refresh_water(&mut self) {
        let Self { mesh, columns, water, .. } = self;
        water.par_iter_mut().zip(&*columns).enumerate().for_each(|(cell, (water, column))| {
            *water = mesh.water_as_it_is(cell, column);
        });
        self.survey();
    }

    /// Finds wet chunks and the largest stable time step over the water of all cells.
    fn survey(&mut self) {
        let Self { mesh, water, gravity, chunks, domain, .. } = self;
        let (gravity, domain) = (*gravity, domain.as_ref());
        let survey_chunk = |(chunk, water): (usize, &[Water])| {
            let mut found = NOTHING;
            for (k, water) in water.iter().enumerate() {
                let cell = chunk * CHUNK + k;
                if domain.is_none_or(|domain| domain.owns(cell)) {
                    found.see(water, mesh.width[cell], mesh.rim[cell], gravity);
                } else {
                    found.wet |= water.depth > 0.0;
                }
            }
            found
        };
        water.par_chunks(CHUNK).enumerate().map(survey_chunk).collect_into_vec(&mut chunks.found);
        self.mark_wet();
    }

    /// Length of the next step, s: where cells may take steps of their own, and that pays, the longest of them.
    pub fn plan(&mut self) -> f64 {
        if self.local.is_some() {
            // By the water as it is: a state that is restored has the same steps.
            self.survey();
        }
        let shortest = self.time_step();
        let Self { mesh, water, gravity, local, longest, domain, .. } = self;
        let Some(local) = local else { return shortest };
        let longest = *longest;
        let step = |cell: usize| {
            let water = &water[cell];
            let fastest = water.speed() + (*gravity * water.depth).sqrt();
            if water.depth > 0.0 { (COURANT * mesh.width[cell] / fastest).min(longest) } else { f64::INFINITY }
        };
        shortest * local.plan(mesh, shortest, step, domain.as_ref())
    }

    /// Marks the chunks with water.
    fn mark_wet(&mut self) {
        let Chunks { wet, found, .. } = &mut self.chunks;
        wet.iter_mut().zip(&*found).for_each(|(wet, found)| *wet = found.wet);
    }

    /// Marks the chunk of a ghost cell with water.
    pub fn mark_wet_ghost(&mut self, cell: usize) {
        self.chunks.found[cell / CHUNK].wet = true;
    }

    /// The time step that the last update allows, s, in all processes; marks the chunks with water.
    pub fn time_step(&mut self) -> f64 {
        self.mark_wet();
        let step = self.chunks.found.iter().map(|found| COURANT * found.step).fold(self.longest, f64::min);
        self.domain.as_ref().map_or(step, |domain| domain.processes.least(step))
    }

    /// The tiles that must be made, as water stands near them, in the order of their numbers: those of all processes.
    pub fn missing_tiles(&mut self) -> Vec<usize> {
        let mut missing = Vec::new();
        if !self.count() {
            return missing;
        }
        let Self { mesh, water, chunks, domain, .. } = self;
        for chunk in (0..chunks.found.len()).filter(|chunk| chunks.found[*chunk].rim) {
            let cells = chunk * CHUNK..((chunk + 1) * CHUNK).min(water.len());
            let owns = |cell: &usize| domain.as_ref().is_none_or(|domain| domain.owns(*cell));
            for cell in cells.filter(|cell| water[*cell].depth > 0.0 && owns(cell)) {
                mesh.take_rim(cell, &mut missing);
            }
        }
        if let Some(domain) = domain {
            return domain.union(missing);
        }
        missing.sort_unstable();
        missing.dedup();
        missing
    }

    /// Counts the wet cells of all processes; whether any of them needs tiles.
    pub fn count(&mut self) -> bool {
        let mut counts = [i64::from(self.chunks.found.iter().any(|found| found.rim)), self.wet_cells_here() as i64];
        if let Some(domain) = &mut self.domain {
            domain.processes.total(&mut counts, &mut []);
            domain.wet = counts[1] as usize;
        }
        counts[0] > 0
    }

    /// Whether a value became not finite in the last step.
    pub fn is_broken(&self) -> bool {
        self.broken
    }

    /// A cell whose fluxes are no numbers.
    pub fn broken_cell(&self) -> Option<usize> {
        (0..self.mesh.len()).filter(|cell| self.owns(*cell)).find(|&cell| {
            let change = gathered(&self.mesh, &self.fluxes, cell);
            !(change.volume + change.momentum[0] + change.momentum[1]).is_finite()
        })
    }

    /// Puts the columns back to before the last step.
    pub fn take_back(&mut self) {
        self.broken = false;
        self.columns.copy_from_slice(&self.before);
        self.update_water();
    }

    /// Number of wet cells of all processes.
    pub fn wet_cells(&self) -> usize {
        self.domain.as_ref().map_or_else(|| self.wet_cells_here(), |domain| domain.wet)
    }

    /// Number of wet cells of this process.
    pub fn wet_cells_here(&self) -> usize {
        self.chunks.found.iter().map(|found| found.count as usize).sum()
    }

    /// The columns before the last step.
    pub fn before(&self) -> &[Column] {
        &self.before
    }

    /// The same, to be restored.
    pub fn before_mut(&mut self) -> &mut Vec<Column> {
        &mut self.before
    }

    /// The column of a cell has changed.
    pub fn touch(&mut self, cell: usize) {
        let Self { mesh, columns, water, gravity, chunks, .. } = self;
        let was_wet = water[cell].depth > 0.0;
        water[cell] = mesh.water(cell, &mut columns[cell]);
        let found = &mut chunks.found[cell / CHUNK];
        found.count -= u32::from(was_wet);
        found.see(&water[cell], mesh.width[cell], mesh.rim[cell], *gravity);
    }

    /// Takes the column of a ghost cell now and before the step.
    pub fn set_ghost(&mut self, cell: usize, column: Column, before: Column) {
        self.columns[cell] = column;
        self.before[cell] = before;
        self.water[cell] = self.mesh.water_as_it_is(cell, &column);
        if self.water[cell].depth > 0.0 {
            self.mark_wet_ghost(cell);
        }
    }

    /// Goes through the chunks of cells with water, on all threads: `each` gets the numbers of the cells and their entries in `entries`.
    pub fn for_wet_chunks<T: Send>(&self, entries: &mut [T], each: impl Fn(usize, &mut T) + Sync) {
        entries.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, entries)| {
            if self.chunks.found[chunk].wet {
                entries.iter_mut().enumerate().for_each(|(k, entry)| each(chunk * CHUNK + k, entry));
            }
        });
    }

    /// Advances by `step` s. `boundaries` gives the boundary condition of each border face in the first and the second stage, by its number among
    /// [`Solver::borders`]; `book_border` is called with the flux through each. `ended` is called with the time within the step, s, whenever cells have ended a step of their own.
    pub fn step(
        &mut self,
        step: f64,
        boundaries: &(impl Fn(usize, usize) -> Now + Sync),
        book_border: &mut impl FnMut(usize, BorderFlux),
        ended: &mut impl FnMut(&Self, f64),
    ) -> Done {
        let mut done = Done::default();
        self.before.copy_from_slice(&self.columns);
        self.broken = false;
        let parts = self.local.as_ref().map_or(1, Local::parts);
        let shortest = step / f64::from(parts);
        for part in 0..parts {
            self.local.iter_mut().for_each(|local| local.begin(part, step));
            for stage in 0..2 {
                self.stage(shortest, stage, boundaries, book_border, &mut done);
                if self.broken {
                    return done;
                }
            }
            ended(self, f64::from(part + 1) * shortest);
        }
        if self.steps_are_local() {
            self.survey();
            self.count();
        }
        done
    }

    fn stage(
        &mut self,
        step: f64,
        stage: usize,
        boundaries: &(impl Fn(usize, usize) -> Now + Sync),
        book_border: &mut impl FnMut(usize, BorderFlux),
        done: &mut Done,
    ) {
        let second = stage == 1;
        let Self { local, columns, water, .. } = self;
        local.iter_mut().filter(|local| local.is_on()).for_each(|local| local.show(second, columns, water));
        self.chunks.activate(second);
        self.find_slopes();
        let mut by_ground = self.find_fluxes(step, &|border| boundaries(stage, border));
        self.pass_borders(step, book_border);
        let mut slowed = if self.steps_are_local() { self.update_local(second) } else { self.update(step, second) };
        let Self { mesh, local, columns, water, .. } = self;
        let on = local.iter().filter(|local| second && local.is_on());
        on.for_each(|local| local.show_ended(mesh, columns, water));
        let mut counts = [i64::from(self.chunks.found.iter().any(|found| found.broken)), self.wet_cells_here() as i64];
        if let Some(domain) = &mut self.domain {
            let ([g, h], [p, q]) = (&mut by_ground, &mut slowed);
            domain.processes.total(&mut counts, &mut [g, h, p, q]);
            domain.wet = counts[1] as usize;
        }
        self.broken = counts[0] > 0;
        for axis in 0..2 {
            done.by_ground[axis] += 0.5 * step * by_ground[axis].value();
            done.slowed[axis] += 0.5 * slowed[axis].value();
        }
        let local = self.local.take();
        let of_stage = Local::in_use(local.as_ref());
        self.exchange(|cell| of_stage.is_none_or(|local| local.changes(cell, second)));
        self.local = local;
        self.mark_wet();
    }

    /// All cells take the same step from here on, as some were added; whether they did not before.
    pub fn end_local_steps(&mut self) -> bool {
        let were = self.steps_are_local();
        self.local.iter_mut().for_each(Local::end);
        were
    }

    fn steps_are_local(&self) -> bool {
        Local::in_use(self.local.as_ref()).is_some()
    }

    /// Whether a cell has ended a step in the last part of the last step, how long it took, s, and the volume in the cell before it, m3.
    pub fn ended(&self, cell: usize, step: f64) -> Option<(f64, f64)> {
        match Local::in_use(self.local.as_ref()) {
            None => Some((step, self.before[cell].volume)),
            Some(local) => local.has_ended(cell).then(|| (local.step(cell), local.start(cell).volume)),
        }
    }

    fn find_slopes(&mut self) {
        let Self { mesh, water, slopes, chunks, local, .. } = self;
        let local = Local::in_use(local.as_ref());
        slopes.par_chunks_mut(CHUNK).enumerate().filter(|(chunk, _)| chunks.wet[*chunk]).for_each(|(chunk, slopes)| {
            let seen = |cell: usize| local.is_none_or(|local| local.view[cell] <= local.now);
            dispatch!(Level::new(), simd => slopes_of_chunk(simd, mesh, water, chunk * CHUNK, slopes, seen));
        });
    }

    /// Finds the flux through each face for a step of `step` s; the force of the ground on all the water over density, m4/s2.
    fn find_fluxes(&mut self, step: f64, boundaries: &(impl Fn(usize) -> Now + Sync)) -> [ExactSum; 2] {
        self.for_active_faces(step, false, boundaries);
        if self.chunks.find_draining() {
            self.find_kept(step);
            self.for_active_faces(step, true, boundaries);
        }
        total(self.chunks.on_faces.iter().map(|found| &found.by_ground))
    }

    /// Finds the fluxes of the faces in active chunks; where `draining` holds, only of those beside a cell that lacks the water for its outflow, with
    /// what it has.
    fn for_active_faces(&mut self, step: f64, draining: bool, boundaries: &(impl Fn(usize) -> Now + Sync)) {
        let Self { mesh, water, slopes, fluxes, chunks, gravity, borders, kept, most_faces, local, domain, .. } = self;
        let local = Local::in_use(local.as_ref());
        let outflow_time = step * (*most_faces as f64);
        let kept = draining.then_some(&kept[..]);
        let domain = domain.as_ref();
        let inputs = Inputs { mesh, water, slopes, borders, gravity: *gravity, kept, outflow_time, local, domain };
        let Chunks { active_faces, were_active, all_kept, cells_of_faces, on_faces, .. } = chunks;
        let find = |(chunk, (fluxes, found)): (usize, (&mut [Flux], &mut OnFaces))| {
            if !active_faces[chunk] {
                *found = OnFaces::default();
                if were_active[chunk] {
                    fluxes.fill(Flux::default());
                }
            } else if !draining || cells_of_faces[chunk].iter().any(|cells| !all_kept[*cells as usize]) {
                *found =
                    dispatch!(Level::new(), simd => fluxes_of_chunk(simd, &inputs, boundaries, chunk * CHUNK, fluxes));
            }
        };
        fluxes.par_chunks_mut(CHUNK).zip(on_faces).enumerate().for_each(find);
    }

    /// Finds what part of the outflow of each cell it has the water for, in chunks where some cell may lack it.
    fn find_kept(&mut self, step: f64) {
        let Self { mesh, columns, water, fluxes, kept, chunks, local, .. } = self;
        let local = Local::in_use(local.as_ref());
        let Chunks { may_drain, all_kept, .. } = chunks;
        let find = |(chunk, (kept, all_kept)): (usize, (&mut [f32], &mut bool))| {
            if !*all_kept {
                kept.fill(1.0);
            }
            *all_kept = true;
            if may_drain[chunk] {
                for (k, kept) in kept.iter_mut().enumerate() {
                    let cell = chunk * CHUNK + k;
                    let (volume, step) = match local {
                        None => (columns[cell].volume, step),
                        Some(local) => (water[cell].depth * mesh.area[cell], local.step(cell)),
                    };
                    *kept = kept_of_cell(mesh, fluxes, volume, cell, step);
                    *all_kept &= *kept == 1.0;
                }
            }
        };
        kept.par_chunks_mut(CHUNK).zip(all_kept).enumerate().for_each(find);
    }

    /// Books the flux through the border faces in half of `step` s.
    fn pass_borders(&self, step: f64, book_border: &mut impl FnMut(usize, BorderFlux)) {
        let local = Local::in_use(self.local.as_ref());
        for (number, &border) in self.borders.iter().enumerate() {
            let face = &self.mesh.faces[border as usize];
            let cell = face.cells[0] as usize;
            let flux = &self.fluxes[border as usize];
            let takes_part = local.is_none_or(|local| local.takes_part(cell)) && self.owns(cell);
            if !takes_part || (self.water[cell].depth <= 0.0 && flux.volume == 0.0) {
                continue;
            }
            let depth = self.water[cell].depth;
            let half = 0.5 * step * local.map_or(1.0, |local| local.times(cell));
            // The cell's own thrust is left out: its sum round the cell is 0.
            let own = 0.5 * self.gravity * depth * depth;
            let momentum = [0, 1].map(|axis| half * (own * face.normal[axis] - flux.momentum[0][axis]));
            let volume = half * flux.volume;
            let [p, q] = flux.momentum[1];
            // Divided before they are squared: the square of next to nothing is 0.
            let velocity = [p, q].map(|momentum| if flux.volume == 0.0 { 0.0 } else { momentum / flux.volume });
            let speed_squared = velocity[0] * velocity[0] + velocity[1] * velocity[1];
            let energy = volume * (self.gravity * self.water[cell].level + 0.5 * speed_squared);
            book_border(number, BorderFlux { volume, momentum, energy });
        }
    }

    /// Gives each cell what its faces bring in `step` s and slows it; in the second stage averages with the columns before the step. The change of
    /// momentum by friction, over density, m4/s.
    fn update(&mut self, step: f64, second: bool) -> [ExactSum; 2] {
        let Self { mesh, columns, before, water, fluxes, chunks, slowing, gravity, domain, .. } = self;
        let (gravity, active, domain) = (*gravity, &chunks.active_cells, domain.as_ref());
        let update = |(chunk, ((columns, before), water)): (usize, Cells)| {
            let mut found = NOTHING;
            if !active[chunk] {
                return found;
            }
            for (k, (column, water)) in columns.iter_mut().zip(water).enumerate() {
                let cell = chunk * CHUNK + k;
                if domain.is_some_and(|domain| !domain.owns(cell)) {
                    found.wet |= water.depth > 0.0;
                    continue;
                }
                let change = gathered(mesh, fluxes, cell);
                found.broken |= !(change.volume + change.momentum[0] + change.momentum[1]).is_finite();
                if column.volume > 0.0 || change.volume != 0.0 {
                    let slowed = go_on(column, &change, step, slowing, (cell, mesh.area[cell]));
                    if second {
                        *column = column.mean(before[k]);
                    }
                    let unbounded = column.momentum;
                    *water = mesh.water(cell, column);
                    let weight = if second { 2.0 } else { 1.0 };
                    found.slow(|axis| slowed[axis] + weight * (column.momentum[axis] - unbounded[axis]));
                } else if second && before[k].volume > 0.0 {
                    *column = column.mean(before[k]);
                    let unbounded = column.momentum;
                    *water = mesh.water(cell, column);
                    found.slow(|axis| 2.0 * (column.momentum[axis] - unbounded[axis]));
                }
                found.see(water, mesh.width[cell], mesh.rim[cell], gravity);
            }
            found
        };
        let cells = columns.par_chunks_mut(CHUNK).zip(before.par_chunks(CHUNK)).zip(water.par_chunks_mut(CHUNK));
        cells.enumerate().map(update).collect_into_vec(&mut chunks.found);
        total(chunks.found.iter().map(|found| &found.slowed))
    }

    /// The same for cells that take steps of their own: momentum counts by the part of its own step that a cell advances.
    fn update_local(&mut self, second: bool) -> [ExactSum; 2] {
        let Self { mesh, columns, water, fluxes, chunks, slowing, gravity, local, domain, .. } = self;
        let domain = domain.as_ref();
        let Some(local) = local else { return [ExactSum::default(); 2] };
        let (gravity, active, were) = (*gravity, &chunks.active_cells, &chunks.wet);
        let mut sums = std::mem::take(&mut local.sum);
        let local = &*local;
        let update = |(chunk, ((columns, sums), water)): (usize, LocalCells)| {
            // Cells that do not take part now may have water.
            let mut found = Found { wet: were[chunk], ..NOTHING };
            if !active[chunk] {
                return found;
            }
            for (k, ((column, sum), water)) in columns.iter_mut().zip(sums).zip(water).enumerate() {
                let cell = chunk * CHUNK + k;
                if !local.takes_part(cell) || domain.is_some_and(|domain| !domain.owns(cell)) {
                    continue;
                }
                let change = gathered(mesh, fluxes, cell);
                found.broken |= !(change.volume + change.momentum[0] + change.momentum[1]).is_finite();
                let (start, step, share) = (local.start(cell), local.step(cell), local.share(cell));
                let mut next = if second { *column } else { *start };
                let slowed = go_on(&mut next, &change, step, slowing, (cell, mesh.area[cell]));
                let by_friction = slowed.map(|slowed| share * slowed);
                let mut weight = share;
                if second {
                    let mean = next.mean(*start);
                    sum.volume += share * mean.volume;
                    (0..2).for_each(|axis| sum.momentum[axis] += share * mean.momentum[axis]);
                    if !local.ends(cell) {
                        found.slow(|axis| by_friction[axis]);
                        continue;
                    }
                    (next, weight) = (*sum, 2.0);
                }
                let unbounded = next.momentum;
                *water = mesh.water(cell, &mut next);
                found.slow(|axis| by_friction[axis] + weight * (next.momentum[axis] - unbounded[axis]));
                *column = next;
                found.see(water, mesh.width[cell], mesh.rim[cell], gravity);
            }
            found
        };
        let cells = columns.par_chunks_mut(CHUNK).zip(sums.par_chunks_mut(CHUNK)).zip(water.par_chunks_mut(CHUNK));
        cells.enumerate().map(update).collect_into_vec(&mut chunks.found);
        if let Some(local) = &mut self.local {
            local.sum = sums;
        }
        total(self.chunks.found.iter().map(|found| &found.slowed))
    }

    /// Gives back the room that no cell needs.
    pub fn shrink(&mut self) {
        let Self { mesh, columns, water, slopes, before, fluxes, kept, borders, .. } = self;
        mesh.shrink();
        [columns, before].into_iter().for_each(Vec::shrink_to_fit);
        water.shrink_to_fit();
        slopes.shrink_to_fit();
        fluxes.shrink_to_fit();
        kept.shrink_to_fit();
        borders.shrink_to_fit();
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.mesh.bytes()
            + self.columns.capacity() * (2 * size_of::<Column>() + size_of::<Water>() + size_of::<Slopes>() + 4)
            + self.fluxes.capacity() * size_of::<Flux>()
            + self.local.as_ref().map_or(0, Local::bytes)
    }
}

impl Found {
    /// Adds to the change of momentum by friction.
    #[inline(always)]
    fn slow(&mut self, change: impl Fn(usize) -> f64) {
        for (axis, sum) in self.slowed.iter_mut().enumerate() {
            let change = change(axis);
            if change != 0.0 {
                sum.add(change, &ROUNDERS);
            }
        }
    }

    #[inline]
    fn see(&mut self, water: &Water, width: f64, rim: u8, gravity: f64) {
        if water.depth > 0.0 {
            self.wet = true;
            self.count += 1;
            self.rim |= rim != 0;
            self.step = self.step.min(width / (water.speed() + (gravity * water.depth).sqrt()));
        }
    }
}

/// Takes a column an Euler step of `step` s on by a change, a second, and slows it, over a cell of an area, m2; the change of its momentum by
/// friction, over density, m4/s.
#[inline(always)]
fn go_on(column: &mut Column, change: &Column, step: f64, slowing: &Slowing, (cell, area): (usize, f64)) -> [f64; 2] {
    column.volume = (column.volume + step * change.volume).max(0.0);
    (0..2).for_each(|axis| column.momentum[axis] += step * change.momentum[axis]);
    let [p, q] = column.momentum;
    let factor = slowing.factor(cell, column.volume / area, (p * p + q * q).sqrt() / area, step);
    let slowed = column.momentum.map(|momentum| (factor - 1.0) * momentum);
    (0..2).for_each(|axis| column.momentum[axis] += slowed[axis]);
    slowed
}

/// Change of a cell's column, a second.
#[inline(always)]
fn gathered(mesh: &Mesh, fluxes: &[Flux], cell: usize) -> Column {
    let mut change = Column::default();
    for link in mesh.links_of(cell).iter().filter(|link| link.face != NONE) {
        let (flux, side) = (&fluxes[link.face as usize], link.side(cell));
        change.volume += if side == 0 { -flux.volume } else { flux.volume };
        (0..2).for_each(|axis| change.momentum[axis] += flux.momentum[side][axis]);
    }
    change
}

/// What part of its outflow in `step` s a cell with a volume, m3, has the water for.
#[inline(always)]
fn kept_of_cell(mesh: &Mesh, fluxes: &[Flux], volume: f64, cell: usize, step: f64) -> f32 {
    let links = mesh.links_of(cell).iter().filter(|link| link.face != NONE);
    let out = links.map(|link| {
        let volume = fluxes[link.face as usize].volume;
        if link.side(cell) == 0 { volume.max(0.0) } else { (-volume).max(0.0) }
    });
    let outflow = step * out.sum::<f64>();
    // Rounded down: single precision must not take more than there is.
    if outflow > volume { ((volume / outflow) as f32).next_down().max(0.0) } else { 1.0 }
}

/// Columns of a chunk, those at the end of their own steps, and their water.
type LocalCells<'a> = ((&'a mut [Column], &'a mut [Column]), &'a mut [Water]);

/// Columns of a chunk, the same before the step, and their water.
type Cells<'a> = ((&'a mut [Column], &'a [Column]), &'a mut [Water]);

/// Slopes of the wet cells from `first` on for which `seen` holds. Inlined into versions of itself for the vector instructions at hand.
#[inline(always)]
fn slopes_of_chunk<S: Simd>(
    _: S,
    mesh: &Mesh,
    water: &[Water],
    first: usize,
    of_cells: &mut [Slopes],
    seen: impl Fn(usize) -> bool,
) {
    for (k, of_cell) in of_cells.iter_mut().enumerate() {
        if water[first + k].depth > 0.0 && seen(first + k) {
            *of_cell = slopes(mesh, &|cell: usize| water[cell], first + k);
        }
    }
}

impl Chunks {
    /// Takes in the faces from `first_face` on.
    fn grow(&mut self, mesh: &Mesh, first_face: usize, brings: [bool; 6]) {
        let [cells, faces] = [mesh.len(), mesh.faces.len()].map(|count| count.div_ceil(CHUNK));
        self.wet.resize(cells, false);
        self.active_cells.resize(cells, false);
        self.found.resize(cells, NOTHING);
        self.faces_of_cells.resize(cells, Vec::new());
        self.active_faces.resize(faces, false);
        self.were_active.resize(faces, false);
        self.open.resize(faces, false);
        self.on_faces.resize(faces, OnFaces::default());
        self.may_drain.resize(cells, false);
        self.all_kept.resize(cells, true);
        self.cells_of_faces.resize(faces, Vec::new());
        for (number, face) in mesh.faces.iter().enumerate().skip(first_face) {
            let of_face = number / CHUNK;
            self.open[of_face] |= face.border().is_some_and(|border| brings[usize::from(border)]);
            for cell in face.cells.into_iter().filter(|cell| (*cell as usize) < mesh.len()) {
                let of_cell = cell as usize / CHUNK;
                insert(&mut self.cells_of_faces[of_face], of_cell as u32);
                insert(&mut self.faces_of_cells[of_cell], of_face as u32);
            }
        }
    }

    /// Marks the chunks of cells beside faces that take much of a cell's water; whether there are any.
    fn find_draining(&mut self) -> bool {
        let Self { may_drain, on_faces, cells_of_faces, .. } = self;
        if !on_faces.iter().any(|found| found.may_drain) {
            return false;
        }
        may_drain.fill(false);
        for (_, cells) in on_faces.iter().zip(cells_of_faces).filter(|(found, _)| found.may_drain) {
            cells.iter().for_each(|cell| may_drain[*cell as usize] = true);
        }
        true
    }

    /// Marks the chunks of faces that touch water, or a border over which some may come, and those of cells that touch them. In the second stage
    /// those of the first stay marked: their columns are still to be averaged.
    fn activate(&mut self, second: bool) {
        let Self { wet, cells_of_faces, faces_of_cells, active_faces, were_active, active_cells, open, .. } = self;
        were_active.copy_from_slice(active_faces);
        for (number, (active, cells)) in active_faces.iter_mut().zip(cells_of_faces).enumerate() {
            *active = (second && *active) || open[number] || cells.iter().any(|cell| wet[*cell as usize]);
        }
        for (active, faces) in active_cells.iter_mut().zip(faces_of_cells) {
            *active = faces.iter().any(|face| active_faces[*face as usize]);
        }
    }
}

fn insert(list: &mut Vec<u32>, value: u32) {
    if let Err(index) = list.binary_search(&value) {
        list.insert(index, value);
    }
}
