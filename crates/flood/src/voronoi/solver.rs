//! A step of the water: two identical stages, averaged (Heun's method). Each stage is four passes: slopes of cells, fluxes through faces, how much each
//! cell can give, and the new columns.
//!
//! Cells and faces are gone through in chunks; chunks without water, and without water beside them, are left out. Every cell gathers what its
//! faces bring in the order of its links, so that the result does not depend on the number of threads.

use super::boundaries::{Now, through};
use super::fluxes::{Flux, between};
use super::friction::Slowing;
use super::mesh::{Crest, Face, Mesh, NONE, SOLID};
use super::reconstruction::{at_face, at_side, at_wall, slopes};
use super::water::{Column, Slopes, Water};
use corpuscle_lanes::{Level, Simd, dispatch};
use corpuscle_model::ExactSum;
use rayon::prelude::*;

/// Cells and faces in a chunk.
const CHUNK: usize = 1024;

/// Time step over the width of a cell and the speed of waves in it: half the stability limit of the scheme in one dimension
/// (Audusse et al. 2004, equation 3.16), nearly in full.
const COURANT: f64 = 0.8;

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
    /// Walls that water may flow over, and the cells on both sides.
    pub crests: Vec<([u32; 2], Crest)>,
    /// Faces on borders.
    pub borders: Vec<u32>,
    /// Over which borders water may come onto dry ground.
    brings: [bool; 5],
    chunks: Chunks,
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
    on_faces: Vec<[f64; 2]>,
    /// Whether all cells of each chunk have the water for their outflow.
    all_kept: Vec<bool>,
}

/// What an update found in a chunk of cells.
#[derive(Debug, Clone, Copy)]
struct Found {
    wet: bool,
    /// Change of momentum over density by friction, m4/s.
    slowed: [f64; 2],
    /// Shortest time step, s.
    step: f64,
    /// Whether tiles must be made.
    rim: bool,
    /// Number of wet cells.
    count: u32,
    /// Whether something came to no number.
    broken: bool,
}

const NOTHING: Found = Found { wet: false, slowed: [0.0; 2], step: f64::INFINITY, rim: false, count: 0, broken: false };

/// What a step did to water and momentum over density: m3 and m4/s.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Done {
    pub slowed: [f64; 2],
    pub by_ground: [f64; 2],
}

/// What passed a border face in a step outwards: volume, m3, momentum over density, m4/s, and energy over density above the level 0, m5/s2.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Passed {
    pub volume: f64,
    pub momentum: [f64; 2],
    pub energy: f64,
}

impl Solver {
    pub fn new(mesh: Mesh, gravity: f64, slowing: Slowing, longest: f64, brings: [bool; 5]) -> Self {
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
            crests: Vec::new(),
            borders: Vec::new(),
            brings,
            chunks: Chunks::default(),
        };
        solver.grow();
        solver
    }

    /// Has room for the cells and faces that were added to the mesh; new cells are dry.
    pub fn grow(&mut self) {
        let (first_face, faces, cells) = (self.fluxes.len(), self.mesh.faces.len(), self.mesh.len());
        let dry = |cell: usize| Water { level: self.mesh.bed[cell], ..Water::default() };
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

    /// Finds depth, level and velocity of all cells; the longest time step that they allow, s.
    pub fn renew(&mut self) -> f64 {
        let Self { mesh, columns, water, gravity, chunks, .. } = self;
        let gravity = *gravity;
        let renew = |(chunk, (columns, water)): (usize, (&mut [Column], &mut [Water]))| {
            let mut found = NOTHING;
            for (k, (column, water)) in columns.iter_mut().zip(water).enumerate() {
                let cell = chunk * CHUNK + k;
                *water = Water::of(column, mesh.area[cell], mesh.bed[cell]);
                found.see(water, mesh.width[cell], mesh.rim[cell], gravity);
            }
            found
        };
        let cells = columns.par_chunks_mut(CHUNK).zip(water.par_chunks_mut(CHUNK)).enumerate();
        cells.map(renew).collect_into_vec(&mut chunks.found);
        self.time_step()
    }

    /// The time step that the last update allows, s; marks the chunks with water.
    pub fn time_step(&mut self) -> f64 {
        let Chunks { wet, found, .. } = &mut self.chunks;
        wet.iter_mut().zip(&*found).for_each(|(wet, found)| *wet = found.wet);
        found.iter().map(|found| COURANT * found.step).fold(self.longest, f64::min)
    }

    /// The tiles that must be made, as water stands near them, in the order of their numbers.
    pub fn missing_tiles(&mut self) -> Vec<usize> {
        let Self { mesh, water, chunks, .. } = self;
        let mut missing = Vec::new();
        for chunk in (0..chunks.found.len()).filter(|chunk| chunks.found[*chunk].rim) {
            let cells = chunk * CHUNK..((chunk + 1) * CHUNK).min(water.len());
            for cell in cells.filter(|cell| water[*cell].depth > 0.0) {
                mesh.take_rim(cell, &mut missing);
            }
        }
        missing.sort_unstable();
        missing.dedup();
        missing
    }

    /// Whether something came to no number in the last step.
    pub fn is_broken(&self) -> bool {
        self.chunks.found.iter().any(|found| found.broken)
    }

    /// A cell whose fluxes are no numbers.
    pub fn broken_cell(&self) -> Option<usize> {
        (0..self.mesh.len()).find(|&cell| {
            let change = gathered(&self.mesh, &self.fluxes, &self.kept, cell);
            !(change.volume + change.momentum[0] + change.momentum[1]).is_finite()
        })
    }

    /// Puts the columns back to before the last step.
    pub fn take_back(&mut self) {
        self.columns.copy_from_slice(&self.before);
        self.renew();
    }

    /// Number of wet cells.
    pub fn wet_cells(&self) -> usize {
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
        water[cell] = Water::of(&mut columns[cell], mesh.area[cell], mesh.bed[cell]);
        let found = &mut chunks.found[cell / CHUNK];
        found.count -= u32::from(was_wet);
        found.see(&water[cell], mesh.width[cell], mesh.rim[cell], *gravity);
    }

    /// Goes through the chunks of cells with water, on all threads: `each` gets the numbers of the cells and their entries in `entries`.
    pub fn for_wet_chunks<T: Send>(&self, entries: &mut [T], each: impl Fn(usize, &mut T) + Sync) {
        entries.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, entries)| {
            if self.chunks.found[chunk].wet {
                entries.iter_mut().enumerate().for_each(|(k, entry)| each(chunk * CHUNK + k, entry));
            }
        });
    }

    /// Goes on by `step` s. `boundaries` gives what each border face does in the first and the second stage, by its number among
    /// [`Solver::borders`]; `passed` is told what passed each.
    pub fn step(
        &mut self,
        step: f64,
        boundaries: &(impl Fn(usize, usize) -> Now + Sync),
        passed: &mut impl FnMut(usize, Passed),
    ) -> (f64, Done) {
        let mut done = Done::default();
        self.before.copy_from_slice(&self.columns);
        for stage in 0..2 {
            self.chunks.activate(stage == 1);
            self.find_slopes();
            let by_ground = self.find_fluxes(&|border| boundaries(stage, border));
            self.find_kept(step);
            self.pass_borders(step, passed);
            let slowed = self.update(step, stage == 1);
            for axis in 0..2 {
                done.by_ground[axis] += 0.5 * step * by_ground[axis];
                done.slowed[axis] += 0.5 * slowed[axis];
            }
            self.time_step();
        }
        (self.time_step(), done)
    }

    fn find_slopes(&mut self) {
        let Self { mesh, water, slopes, chunks, .. } = self;
        slopes.par_chunks_mut(CHUNK).enumerate().filter(|(chunk, _)| chunks.wet[*chunk]).for_each(|(chunk, slopes)| {
            dispatch!(Level::new(), simd => slopes_of_chunk(simd, mesh, water, chunk * CHUNK, slopes));
        });
    }

    /// Finds the flux through each face; the force of the ground on all the water over density, m4/s2.
    fn find_fluxes(&mut self, boundaries: &(impl Fn(usize) -> Now + Sync)) -> [f64; 2] {
        let Self { mesh, water, slopes, fluxes, chunks, gravity, borders, .. } = self;
        let (gravity, active, were_active) = (*gravity, &chunks.active_faces, &chunks.were_active);
        let find = |(chunk, fluxes): (usize, &mut [Flux])| {
            let mut ground = [0.0; 2];
            if !active[chunk] {
                if were_active[chunk] {
                    fluxes.fill(Flux::default());
                }
                return ground;
            }
            let inputs = Inputs { mesh, water, slopes, borders, gravity };
            dispatch!(Level::new(), simd => fluxes_of_chunk(simd, &inputs, boundaries, chunk * CHUNK, fluxes, &mut ground));
            ground
        };
        fluxes.par_chunks_mut(CHUNK).enumerate().map(find).collect_into_vec(&mut chunks.on_faces);
        sum(chunks.on_faces.iter())
    }

    /// Finds what part of the outflow of each cell it has the water for.
    fn find_kept(&mut self, step: f64) {
        let Self { mesh, columns, fluxes, kept, chunks, .. } = self;
        let wet = &chunks.wet;
        let find = |(chunk, kept): (usize, &mut [f32])| {
            let mut all = true;
            if !wet[chunk] {
                return all;
            }
            for (k, kept) in kept.iter_mut().enumerate() {
                let cell = chunk * CHUNK + k;
                let volume = columns[cell].volume;
                *kept = 1.0;
                if volume <= 0.0 {
                    continue;
                }
                let out = |link: &super::mesh::Link| {
                    if link.face == NONE {
                        return 0.0;
                    }
                    let volume = fluxes[link.face as usize].volume;
                    let is_first = mesh.faces[link.face as usize].cells[0] == cell as u32;
                    if is_first { volume.max(0.0) } else { (-volume).max(0.0) }
                };
                let outflow = step * mesh.links_of(cell).iter().map(out).sum::<f64>();
                if outflow > volume {
                    // Rounded down: single precision must not take more than there is.
                    *kept = ((volume / outflow) as f32).next_down().max(0.0);
                    all = false;
                }
            }
            all
        };
        kept.par_chunks_mut(CHUNK).enumerate().map(find).collect_into_vec(&mut chunks.all_kept);
    }

    /// Tells what passes the faces on borders in half of `step` s.
    fn pass_borders(&self, step: f64, passed: &mut impl FnMut(usize, Passed)) {
        for (number, &border) in self.borders.iter().enumerate() {
            let face = &self.mesh.faces[border as usize];
            let cell = face.cells[0] as usize;
            let flux = &self.fluxes[border as usize];
            if self.water[cell].depth <= 0.0 && flux.volume == 0.0 {
                continue;
            }
            let kept = if flux.volume > 0.0 { f64::from(self.kept[cell]) } else { 1.0 };
            let depth = self.water[cell].depth;
            // The cell's own thrust is left out: round the cell it comes to nothing.
            let thrust = flux.thrust[0] + 0.5 * self.gravity * depth * depth;
            let half = 0.5 * step;
            let momentum = [0, 1].map(|axis| half * (kept * flux.carried[axis] + thrust * face.normal[axis]));
            let volume = half * kept * flux.volume;
            let [p, q] = flux.carried;
            let speed_squared = if flux.volume == 0.0 { 0.0 } else { (p * p + q * q) / (flux.volume * flux.volume) };
            let energy = volume * (self.gravity * self.water[cell].level + 0.5 * speed_squared);
            passed(number, Passed { volume, momentum, energy });
        }
    }

    /// Gives each cell what its faces bring in `step` s and slows it; in the second stage averages with the columns before the step. The change of
    /// momentum by friction, over density, m4/s.
    fn update(&mut self, step: f64, second: bool) -> [f64; 2] {
        let Self { mesh, columns, before, water, fluxes, kept, chunks, slowing, gravity, .. } = self;
        let (gravity, active) = (*gravity, &chunks.active_cells);
        let kept: &[f32] = if chunks.all_kept.iter().all(|all| *all) { &[] } else { kept };
        let update = |(chunk, ((columns, before), water)): (usize, Cells)| {
            let mut found = NOTHING;
            if !active[chunk] {
                return found;
            }
            for (k, (column, water)) in columns.iter_mut().zip(water).enumerate() {
                let cell = chunk * CHUNK + k;
                let change = gathered(mesh, fluxes, kept, cell);
                found.broken |= !(change.volume + change.momentum[0] + change.momentum[1]).is_finite();
                if column.volume > 0.0 || change.volume != 0.0 {
                    column.volume = (column.volume + step * change.volume).max(0.0);
                    (0..2).for_each(|axis| column.momentum[axis] += step * change.momentum[axis]);
                    let area = mesh.area[cell];
                    let [p, q] = column.momentum;
                    let factor = slowing.factor(cell, column.volume / area, (p * p + q * q).sqrt() / area, step);
                    (0..2).for_each(|axis| {
                        let slowed = (factor - 1.0) * column.momentum[axis];
                        column.momentum[axis] += slowed;
                        found.slowed[axis] += slowed;
                    });
                    if second {
                        *column = column.mean(before[k]);
                    }
                    let [p, q] = column.momentum;
                    *water = Water::of(column, area, mesh.bed[cell]);
                    let weight = if second { 2.0 } else { 1.0 };
                    found.slowed[0] += weight * (column.momentum[0] - p);
                    found.slowed[1] += weight * (column.momentum[1] - q);
                } else if second && before[k].volume > 0.0 {
                    *column = column.mean(before[k]);
                    *water = Water::of(column, mesh.area[cell], mesh.bed[cell]);
                }
                found.see(water, mesh.width[cell], mesh.rim[cell], gravity);
            }
            found
        };
        let cells = columns.par_chunks_mut(CHUNK).zip(before.par_chunks(CHUNK)).zip(water.par_chunks_mut(CHUNK));
        cells.enumerate().map(update).collect_into_vec(&mut chunks.found);
        sum(chunks.found.iter().map(|found| &found.slowed))
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.mesh.bytes()
            + self.columns.capacity() * (2 * size_of::<Column>() + size_of::<Water>() + size_of::<Slopes>() + 4)
            + self.fluxes.capacity() * size_of::<Flux>()
    }
}

impl Found {
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

/// Change of a cell's column, a second. `kept` is empty where all cells have the water for their outflow.
#[inline(always)]
fn gathered(mesh: &Mesh, fluxes: &[Flux], kept: &[f32], cell: usize) -> Column {
    let mut change = Column::default();
    for link in mesh.links_of(cell) {
        if link.face == NONE {
            continue;
        }
        let (face, flux) = (&mesh.faces[link.face as usize], &fluxes[link.face as usize]);
        let (side, sign) = if face.cells[0] == cell as u32 { (0, -1.0) } else { (1, 1.0) };
        let kept = if kept.is_empty() {
            1.0
        } else {
            let donor = face.cells[usize::from(flux.volume <= 0.0)];
            kept.get(donor as usize).map_or(1.0, |kept| f64::from(*kept))
        };
        change.volume += sign * kept * flux.volume;
        for axis in 0..2 {
            change.momentum[axis] += sign * (kept * flux.carried[axis] + flux.thrust[side] * face.normal[axis]);
        }
    }
    change
}

/// Columns of a chunk, the same before the step, and their water.
type Cells<'a> = ((&'a mut [Column], &'a [Column]), &'a mut [Water]);

/// What fluxes are found from.
struct Inputs<'a> {
    mesh: &'a Mesh,
    water: &'a [Water],
    slopes: &'a [Slopes],
    borders: &'a [u32],
    gravity: f64,
}

/// Slopes of the wet cells from `first` on. Inlined into versions of itself for the vector instructions at hand.
#[inline(always)]
fn slopes_of_chunk<S: Simd>(_: S, mesh: &Mesh, water: &[Water], first: usize, of_cells: &mut [Slopes]) {
    for (k, of_cell) in of_cells.iter_mut().enumerate() {
        if water[first + k].depth > 0.0 {
            *of_cell = slopes(mesh, &|cell: usize| water[cell], first + k);
        }
    }
}

/// Fluxes through the faces from `first` on; adds the force of the ground to `ground`.
#[inline(always)]
fn fluxes_of_chunk<S: Simd>(
    simd: S,
    inputs: &Inputs,
    boundaries: &impl Fn(usize) -> Now,
    first: usize,
    fluxes: &mut [Flux],
    ground: &mut [f64; 2],
) {
    let faces = inputs.mesh.faces[first..].iter();
    for (k, (flux, face)) in fluxes.iter_mut().zip(faces).enumerate() {
        let number = first + k;
        if face.border().is_some() {
            let border = || boundaries(inputs.borders.binary_search(&(number as u32)).unwrap_or(0));
            border_flux(simd, inputs, face, border, flux);
        } else {
            let pushed = inner_flux(simd, inputs, face, inputs.mesh.lift_of(number), flux);
            ground[0] += pushed * face.normal[0];
            ground[1] += pushed * face.normal[1];
        }
    }
}

/// The flux between two cells; the ground's thrust over the length of the face.
#[inline(always)]
fn inner_flux<S: Simd>(simd: S, inputs: &Inputs, face: &Face, lift: f64, flux: &mut Flux) -> f64 {
    let Inputs { water, slopes, gravity, .. } = *inputs;
    let [i, j] = face.cells.map(|cell| cell as usize);
    let (here, there) = (&water[i], &water[j]);
    if here.depth <= 0.0 && there.depth <= 0.0 {
        *flux = Flux::default();
        return 0.0;
    }
    let length = (face.normal[0] * face.normal[0] + face.normal[1] * face.normal[1]).sqrt();
    let normal = [face.normal[0] / length, face.normal[1] / length];
    let at = at_face(simd, [here, there], [&slopes[i], &slopes[j]], lift, face, normal);
    let own = [[here.depth, here.level], [there.depth, there.level + lift]];
    let found = between(at, own, gravity);
    *flux = found.through(length, normal);
    let half = 0.5 * gravity;
    (found.thrust[1] + half * there.depth * there.depth) - (found.thrust[0] + half * here.depth * here.depth)
}

/// The flux out of a cell over a border.
#[inline(always)]
fn border_flux<S: Simd>(simd: S, inputs: &Inputs, face: &Face, boundary: impl FnOnce() -> Now, flux: &mut Flux) {
    let cell = face.cells[0] as usize;
    let here = &inputs.water[cell];
    let now = if face.border() == Some(SOLID) { Now::Wall } else { boundary() };
    if here.depth <= 0.0 && !matches!(now, Now::Beyond(..) | Now::Discharge(_)) {
        *flux = Flux::default();
        return;
    }
    let length = (face.normal[0] * face.normal[0] + face.normal[1] * face.normal[1]).sqrt();
    let [nx, ny] = [face.normal[0] / length, face.normal[1] / length];
    let at = if matches!(now, Now::Wall) {
        at_wall(simd, here, &inputs.slopes[cell], face, [nx, ny])
    } else {
        at_side(here, [nx, ny])
    };
    *flux = through(now, at, [here.depth, here.level], inputs.gravity).through(length, [nx, ny]);
}

impl Chunks {
    /// Takes in the faces from `first_face` on.
    fn grow(&mut self, mesh: &Mesh, first_face: usize, brings: [bool; 5]) {
        let [cells, faces] = [mesh.len(), mesh.faces.len()].map(|count| count.div_ceil(CHUNK));
        self.wet.resize(cells, false);
        self.active_cells.resize(cells, false);
        self.found.resize(cells, NOTHING);
        self.faces_of_cells.resize(cells, Vec::new());
        self.active_faces.resize(faces, false);
        self.were_active.resize(faces, false);
        self.open.resize(faces, false);
        self.on_faces.resize(faces, [0.0; 2]);
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
    if let Err(place) = list.binary_search(&value) {
        list.insert(place, value);
    }
}

fn sum<'a>(parts: impl Iterator<Item = &'a [f64; 2]> + Clone) -> [f64; 2] {
    [0, 1].map(|axis| parts.clone().map(|part| part[axis]).collect::<ExactSum>().value())
}
