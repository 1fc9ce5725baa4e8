//! Local time steps: cells that can take longer steps than others do.
//!
//! The shortest step that any cell needs is doubled 0 to [`HIGHEST`] times for each cell: its level. In the time of the longest step cells of lower levels
//! take two or four steps of Heun's method; those of higher levels near them repeat the stages of theirs from the same start each time, and go on by the
//! mean of the results (Constantinescu & Sandu 2007, "Multirate timestepping methods for hyperbolic conservation laws", sections 3 and 4). So
//! every flux counts for the same time on both sides of its face, and each cell goes on by means of Euler steps, none of which takes more water than there is.
//! Where nothing nearby has a lower level each repetition would give the same bits, and is left out.

use super::CHUNK;
use super::domain::{Domain, total};
use super::mesh::Mesh;
use super::water::{Column, Water};
use rayon::prelude::*;

/// The shortest step is doubled so often at most.
pub(crate) const HIGHEST: u8 = 2;

/// A wave that is as fast as its cells allow must not reach cells with longer steps before the end of the longest: cells so many neighbours away at most from those
/// that need the shortest step take it too, and cells so many away from those that need twice that take no longer one.
#[cfg(feature = "gpu")]
pub(crate) const WIDENED: [u32; 2] = [(1 << HIGHEST) + (1 << (HIGHEST - 1)), 1 << (HIGHEST - 1)];

/// Cells as many neighbours away from a cell of a lower level repeat their stages with it: what happens in both stages of a cell does not depend on
/// cells farther away. A flux depends on the two cells beside it and on what these can give, so on their other fluxes, and all of these on slopes.
pub(crate) const REPEATED: usize = 6;

/// How many neighbours away the steps of cells count for what a cell does: its level is lowered by those that need shorter steps, then its pace, and its
/// water is shown as three neighbours see it.
pub(crate) const REACH: usize = (1 << HIGHEST) + (1 << (HIGHEST - 1)) + REPEATED + 3;

/// Steps of their own are taken where they save at least this part of the work.
pub(crate) const LEAST_SAVED: f64 = 0.25;

/// The state of all cells that take steps of their own.
#[derive(Default)]
pub(crate) struct Local {
    /// How often the shortest step is doubled for each cell. Empty where all take the same step.
    level: Vec<u8>,
    /// The lowest level within [`REPEATED`] neighbours: how often the stages are gone through.
    pub pace: Vec<u8>,
    /// The lowest pace of a cell and its neighbours: the fluxes around it are needed as often.
    pub near: Vec<u8>,
    /// The lowest pace within three neighbours: its water must be that of the stage.
    pub view: Vec<u8>,
    spread: Spread,
    /// Columns and water at the start of each cell's own step.
    start: Vec<(Column, Water)>,
    /// Water of each cell in its second stage.
    second: Vec<Water>,
    /// Sums over the repetitions so far.
    pub sum: Vec<Column>,
    /// The highest level of a cell.
    highest: u8,
    /// Cells of a pace up to this take part now.
    pub now: u8,
    /// The part of the longest step that is gone through.
    part: u32,
    /// The shortest step, s.
    pub shortest: f64,
}

impl Local {
    /// Whether cells take steps of their own, those of other processes included.
    pub fn is_on(&self) -> bool {
        self.highest > 0
    }

    /// The steps where cells take steps of their own; none where all take the same.
    pub fn in_use(local: Option<&Self>) -> Option<&Self> {
        local.filter(|local| local.is_on())
    }

    /// Number of the shortest steps in the longest.
    pub fn parts(&self) -> u32 {
        1 << self.highest
    }

    /// All cells take the same step.
    pub fn end(&mut self) {
        self.level.clear();
        self.highest = 0;
    }

    /// Finds the steps of the cells, where `steps` gives the longest that each can take, s, infinite where it is dry. The length of the longest step
    /// over the shortest; 1 where all had better take the same.
    pub fn plan(
        &mut self,
        mesh: &Mesh,
        shortest: f64,
        steps: impl Fn(usize) -> f64 + Sync,
        domain: Option<&Domain>,
    ) -> f64 {
        let cells = mesh.len();
        let Self { level, pace, near, view, spread, .. } = self;
        level.resize(cells, 0);
        level.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, level)| {
            for (k, level) in level.iter_mut().enumerate() {
                let times = steps(chunk * CHUNK + k) / shortest;
                *level = (0..HIGHEST).take_while(|level| times >= f64::from(2_u32 << level)).count() as u8;
            }
        });
        spread.grow(mesh);
        // A wave that is as fast as its cells allow must not reach cells with longer steps before the end of the longest.
        for lower in 0..HIGHEST {
            spread.lower(mesh, level, lower, 1 << (HIGHEST - lower));
        }
        pace.clone_from(level);
        spread.lower(mesh, pace, HIGHEST, REPEATED);
        near.clone_from(pace);
        spread.lower(mesh, near, HIGHEST, 1);
        view.clone_from(near);
        spread.lower(mesh, view, HIGHEST, 2);
        let owns = |cell: usize| domain.is_none_or(|domain| domain.owns(cell));
        let own = self.level.iter().enumerate().filter(|(cell, _)| owns(*cell));
        let mut highest = [own.map(|(_, level)| *level).max().unwrap_or(0)];
        domain.iter().for_each(|domain| domain.most(&mut highest));
        [self.highest] = highest;
        let of_chunk = |(chunk, pace): (usize, &[u8])| {
            let cells = pace.iter().enumerate().map(|(k, pace)| (chunk * CHUNK + k, pace));
            let wet = cells.filter(|(cell, _)| owns(*cell) && steps(*cell) < f64::INFINITY);
            wet.fold([0, 0], |[count, work], (_, pace)| [count + 1, work + (4_u64 >> pace)])
        };
        let add = |a: [u64; 2], b: [u64; 2]| [a[0] + b[0], a[1] + b[1]];
        let counted = self.pace.par_chunks(CHUNK).enumerate().map(of_chunk).reduce(|| [0; 2], add);
        let mut counts = counted.map(|count| count as i64);
        total(domain, &mut counts, &mut []);
        let [count, quarters] = counts;
        let work = 0.25 * quarters as f64;
        if self.highest == 0 || work > (1.0 - LEAST_SAVED) * count as f64 {
            self.end();
            return 1.0;
        }
        self.start.resize(cells, Default::default());
        self.second.resize(cells, Water::default());
        self.sum.resize(cells, Column::default());
        f64::from(self.parts())
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let of_cell = 5 + size_of::<(Column, Water)>() + size_of::<Water>() + size_of::<Column>();
        self.sum.capacity() * of_cell
    }

    /// Begins a part of a step of `step` s.
    pub fn begin(&mut self, part: u32, step: f64) {
        self.part = part;
        self.shortest = step / f64::from(self.parts());
        self.now = if part == 0 { self.highest } else { part.trailing_zeros() as u8 };
    }

    /// The step of a cell, s.
    pub fn step(&self, cell: usize) -> f64 {
        self.shortest * f64::from(1_u32 << self.level[cell])
    }

    /// Whether a cell takes part now.
    pub fn takes_part(&self, cell: usize) -> bool {
        self.pace[cell] <= self.now
    }

    /// For how many of the shortest steps what a cell does now counts.
    pub fn times(&self, cell: usize) -> f64 {
        if self.takes_part(cell) { f64::from(1_u32 << self.pace[cell]) } else { 0.0 }
    }

    /// Which part of its own step is what a cell does now.
    pub fn share(&self, cell: usize) -> f64 {
        1.0 / f64::from(1_u32 << (self.level[cell] - self.pace[cell]))
    }

    /// Whether a cell's own step ends with what it does now.
    pub fn ends(&self, cell: usize) -> bool {
        (self.part + (1 << self.pace[cell])).is_multiple_of(1 << self.level[cell])
    }

    /// Whether a stage changes the column of a cell.
    pub fn changes(&self, cell: usize, second: bool) -> bool {
        self.takes_part(cell) && (!second || self.ends(cell))
    }

    /// Whether a cell's own step ended with this part.
    pub fn has_ended(&self, cell: usize) -> bool {
        (self.part + 1).is_multiple_of(1 << self.level[cell])
    }

    /// Column of a cell at the start of its own step.
    pub fn start(&self, cell: usize) -> &Column {
        &self.start[cell].0
    }

    /// Shows the water as it is in a stage in all cells that those that take part now see; begins the steps of those whose own begin.
    pub fn show(&mut self, second: bool, columns: &[Column], water: &mut [Water]) {
        let Self { level, pace, view, start, second: later, sum, now, .. } = self;
        let now = *now;
        let water = water.par_chunks_mut(CHUNK).zip(later.par_chunks_mut(CHUNK));
        let cells = start.par_chunks_mut(CHUNK).zip(sum.par_chunks_mut(CHUNK)).zip(water).enumerate();
        cells.for_each(|(chunk, ((start, sum), (water, later)))| {
            for k in 0..water.len() {
                let cell = chunk * CHUNK + k;
                if view[cell] > now {
                    continue;
                }
                if second {
                    if pace[cell] > now {
                        water[k] = later[k];
                    } else {
                        later[k] = water[k];
                    }
                } else if level[cell] <= now {
                    start[k] = (columns[cell], water[k]);
                    sum[k] = Column::default();
                } else {
                    water[k] = start[k].1;
                }
            }
        });
    }

    /// Shows the water of cells that had that of their second stage to show, as they left it.
    pub fn show_ended(&self, mesh: &Mesh, columns: &[Column], water: &mut [Water]) {
        if self.now == self.highest {
            return;
        }
        water.par_iter_mut().with_min_len(CHUNK).enumerate().for_each(|(cell, water)| {
            if self.view[cell] <= self.now && !self.takes_part(cell) {
                *water = mesh.water_as_it_is(cell, &columns[cell]);
            }
        });
    }
}

/// Levels of cells on their way to their neighbours.
#[derive(Default)]
struct Spread {
    next: Vec<u8>,
    /// Lowest and highest level in each chunk.
    range: Vec<[u8; 2]>,
    /// The chunks that each chunk has neighbours in.
    beside: Vec<Vec<u32>>,
}

impl Spread {
    /// Finds the chunks beside each other, where cells were added.
    fn grow(&mut self, mesh: &Mesh) {
        if self.next.len() == mesh.len() {
            return;
        }
        self.next.resize(mesh.len(), 0);
        let chunks = mesh.len().div_ceil(CHUNK);
        self.beside.clear();
        let beside = (0..chunks).into_par_iter().map(|chunk| {
            let cells = chunk * CHUNK..((chunk + 1) * CHUNK).min(mesh.len());
            let others = cells.flat_map(|cell| mesh.links_of(cell)).filter_map(|link| link.cell());
            let mut beside: Vec<u32> = others.map(|other| (other / CHUNK) as u32).collect();
            beside.sort_unstable();
            beside.dedup();
            beside
        });
        beside.collect_into_vec(&mut self.beside);
        self.range.resize(chunks, [0; 2]);
    }

    /// Lowers the levels of cells to the lowest of their neighbours where that is at most `up_to`, `times` over.
    fn lower(&mut self, mesh: &Mesh, levels: &mut Vec<u8>, up_to: u8, times: usize) {
        let Self { next, range, beside } = self;
        for _ in 0..times {
            let find = |levels: &[u8]| {
                let lowest = levels.iter().copied().min().unwrap_or(0);
                [lowest, levels.iter().copied().max().unwrap_or(0)]
            };
            levels.par_chunks(CHUNK).map(find).collect_into_vec(range);
            next.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, next)| {
                let first = chunk * CHUNK;
                let own = &levels[first..first + next.len()];
                let lowest = beside[chunk].iter().map(|other| range[*other as usize][0]).min().unwrap_or(u8::MAX);
                if lowest >= range[chunk][1] || lowest > up_to {
                    next.copy_from_slice(own);
                    return;
                }
                for (k, (next, own)) in next.iter_mut().zip(own).enumerate() {
                    let others = mesh.links_of(first + k).iter().filter_map(|link| link.cell());
                    let lowest = if *own == 0 { 0 } else { others.map(|other| levels[other]).min().unwrap_or(*own) };
                    *next = if lowest <= up_to { lowest.min(*own) } else { *own };
                }
            });
            std::mem::swap(levels, next);
        }
    }
}
