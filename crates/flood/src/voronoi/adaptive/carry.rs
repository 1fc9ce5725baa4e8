//! Water, and what is known of it, from old cells to new ones.
//!
//! The water of each old cell is distributed to its pieces. In a lake they have one level; in a sheet on a slope one depth; in between some of each, and all
//! follow the slopes of the water as far as the cells beside it go. Volume and momentum of the pieces are those of the cell.

use super::super::bed::Bed;
use super::super::maps::{DRY, Record};
use super::super::mesh::{Mesh, NONE};
use super::super::sampling::{Sampler, Within};
use super::super::solver::Solver;
use super::super::water::{Column, DEPTH, EAST, LEVEL, Water};
use super::Old;
use super::overlap::{Overlap, Piece};
use corpuscle_terrain::Terrain;
use rayon::prelude::*;

/// Rounds of Newton's method; the volume below a level is made of straight lines, so that it ends at the exact one.
const ROUNDS: usize = 100;

/// What the new cells have of the old ones.
pub(super) struct Carried {
    pub columns: Vec<Column>,
    pub records: Vec<Record>,
    /// What has soaked in, m.
    pub soaked: Vec<f32>,
}

/// What a piece has.
struct Share {
    cell: u32,
    area: f64,
    column: Column,
    /// Highest depth that it had, m.
    max_depth: f64,
}

/// Carries everything over. In the order of the old cells, so that the result does not depend on the number of threads.
pub(super) fn carry(old: &Old, new: &Solver, bed: &Bed, terrain: &Terrain) -> Carried {
    let overlap = Overlap::new(&old.solver.mesh, &new.mesh, bed);
    let cells = new.mesh.len();
    let soaks = !old.soaked.is_empty();
    let mut columns = vec![Column::default(); cells];
    let mut soaked = vec![0.0; if soaks { cells } else { 0 }];
    let mut records = Records { sums: Vec::new(), of_cell: vec![NONE; cells], whole: vec![DRY; cells] };
    let of_cell = |cell: usize| {
        let is_new = overlap.same[cell] == NONE && !old.is_blank(cell);
        if is_new { shares(old, cell, &overlap.pieces(cell), terrain) } else { Vec::new() }
    };
    let all: Vec<Vec<Share>> = (0..old.solver.mesh.len()).into_par_iter().with_min_len(64).map(of_cell).collect();
    for (cell, shares) in all.iter().enumerate() {
        let same = overlap.same[cell];
        if same != NONE {
            columns[same as usize] = old.solver.columns[cell];
            records.whole[same as usize] = old.records[cell];
            if soaks {
                soaked[same as usize] = f64::from(old.soaked[cell]);
            }
        }
        for share in shares {
            let column = &mut columns[share.cell as usize];
            column.volume += share.column.volume;
            (0..2).for_each(|axis| column.momentum[axis] += share.column.momentum[axis]);
            records.add(share, &old.records[cell]);
            if soaks {
                let part = share.area / new.mesh.area[share.cell as usize];
                soaked[share.cell as usize] += part * f64::from(old.soaked[cell]);
            }
        }
    }
    let soaked = soaked.into_iter().map(|depth| depth as f32).collect();
    Carried { columns, records: records.finished(&new.mesh), soaked }
}

impl Old {
    /// Whether nothing is known of a cell: it is dry, and always was.
    fn is_blank(&self, cell: usize) -> bool {
        let never = self.records[cell].arrival.is_nan() && self.records[cell].max_depth == 0.0;
        self.solver.columns[cell].volume <= 0.0 && never && self.soaked.get(cell).is_none_or(|soaked| *soaked == 0.0)
    }
}

/// What the pieces of an old cell have of it.
fn shares(old: &Old, cell: usize, pieces: &[Piece], terrain: &Terrain) -> Vec<Share> {
    let mesh = &old.solver.mesh;
    let column = old.solver.columns[cell];
    let now = Sampler { mesh, terrain, water: |cell: usize| old.solver.water[cell] };
    let highest = |cell: usize| {
        let depth = f64::from(old.records[cell].max_depth);
        Water { depth, level: mesh.level(cell, depth), velocity: [0.0; 2] }
    };
    let within = now.within(cell);
    let volumes = handed_out(pieces, within.as_ref(), column.volume);
    let momenta = carried_along(pieces, within.as_ref(), &volumes, &column);
    let max_depth = highest(cell).depth;
    let within = Sampler { mesh, terrain, water: highest }.within(cell);
    let most = handed_out(pieces, within.as_ref(), max_depth * mesh.area[cell]);
    let share = |((piece, volume), (momentum, most)): ((&Piece, f64), ([f64; 2], f64))| Share {
        cell: piece.cell,
        area: piece.area,
        column: Column { volume, momentum },
        max_depth: most / piece.area,
    };
    pieces.iter().zip(volumes).zip(momenta.into_iter().zip(most)).map(share).collect()
}

/// The volume, m3, that each piece has of that of a cell in which the water varies as `within` says.
fn handed_out(pieces: &[Piece], within: Option<&Within>, volume: f64) -> Vec<f64> {
    let Some(within) = within.filter(|_| volume > 0.0) else { return vec![0.0; pieces.len()] };
    // By the level: its change from the middle of the cell to the piece is taken off the ground.
    let raised = |piece: &Piece| within.value(LEVEL, piece.from_centroid) - within.here.level;
    let raised: Vec<f64> = pieces.iter().map(raised).collect();
    let level = common_level(pieces, &raised, volume);
    let by_level: Vec<f64> =
        pieces.iter().zip(&raised).map(|(piece, raised)| piece.area * piece.depth_below(level + raised)).collect();
    let depth = |piece: &Piece| piece.area * within.value(DEPTH, piece.from_centroid).max(0.0);
    let by_depth: Vec<f64> = pieces.iter().map(depth).collect();
    let [by_level, by_depth] = [by_level, by_depth].map(|shares| scaled(&shares, pieces, volume));
    let share = within.level_share;
    let mixed = by_level.iter().zip(&by_depth);
    let mut volumes: Vec<f64> = mixed.map(|(level, depth)| share * level + (1.0 - share) * depth).collect();
    settle(&mut volumes, volume);
    volumes
}

/// Shares of pieces, made a volume, m3, together; in proportion to their areas where there are none but by rounding.
fn scaled(shares: &[f64], pieces: &[Piece], volume: f64) -> Vec<f64> {
    let factor = volume / shares.iter().sum::<f64>();
    if factor.is_finite() {
        return shares.iter().map(|share| factor * share).collect();
    }
    let area: f64 = pieces.iter().map(|piece| piece.area).sum();
    pieces.iter().map(|piece| volume * (piece.area / area)).collect()
}

/// Adds what rounding left of a sum to the largest of the values.
fn settle(values: &mut [f64], sum: f64) {
    let rest = sum - values.iter().sum::<f64>();
    if let Some(largest) = values.iter_mut().max_by(|a, b| a.total_cmp(b)) {
        *largest += rest;
    }
}

/// The level above the old cell's mean ground, m, below which pieces hold a volume, m3, together, where the water stands `raised` m higher in each.
fn common_level(pieces: &[Piece], raised: &[f64], volume: f64) -> f64 {
    let area: f64 = pieces.iter().map(|piece| piece.area).sum();
    let highest = pieces.iter().zip(raised).map(|(piece, raised)| piece.top() - raised);
    let mut level = highest.fold(f64::NEG_INFINITY, f64::max) + volume / area;
    for _ in 0..ROUNDS {
        let (mut held, mut wet) = (0.0, 0.0);
        for (piece, raised) in pieces.iter().zip(raised) {
            held += piece.area * piece.depth_below(level + raised);
            wet += piece.area * piece.wet_share(level + raised);
        }
        let next = level - (held - volume) / wet;
        // From above it falls to the exact one, until rounding.
        if next.is_nan() || next >= level {
            break;
        }
        level = next;
    }
    level
}

/// The momentum over density, m4/s, of each piece of a cell: its volume times the velocity there, plus the same change of velocity for all, so that the sum is conserved.
fn carried_along(pieces: &[Piece], within: Option<&Within>, volumes: &[f64], column: &Column) -> Vec<[f64; 2]> {
    let Some(within) = within else { return vec![[0.0; 2]; pieces.len()] };
    let velocity = |piece: &Piece| [0, 1].map(|axis| within.value(EAST + axis, piece.from_centroid));
    let velocities: Vec<[f64; 2]> = pieces.iter().map(velocity).collect();
    let missing = [0, 1].map(|axis| {
        let sum: f64 = velocities.iter().zip(volumes).map(|(velocity, volume)| volume * velocity[axis]).sum();
        (column.momentum[axis] - sum) / column.volume
    });
    let momentum = |(velocity, volume): (&[f64; 2], &f64)| [0, 1].map(|axis| volume * (velocity[axis] + missing[axis]));
    velocities.iter().zip(volumes).map(momentum).collect()
}

/// Records of new cells: whole ones, and those put together from pieces.
struct Records {
    whole: Vec<Record>,
    /// Entry of each cell in `sums`; [`NONE`] where it has no pieces.
    of_cell: Vec<u32>,
    sums: Vec<Sum>,
}

/// Sums over the pieces of a cell, each by its area; all but the depth over those that were wet.
#[derive(Debug, Clone, Copy, Default)]
struct Sum {
    cell: u32,
    depth: f64,
    wet: f64,
    velocity: [f64; 2],
    speed: f64,
    hazard: f64,
    arrival: f64,
    duration: f64,
}

impl Records {
    fn add(&mut self, share: &Share, record: &Record) {
        let entry = &mut self.of_cell[share.cell as usize];
        if *entry == NONE {
            *entry = self.sums.len() as u32;
            self.sums.push(Sum { cell: share.cell, ..Sum::default() });
        }
        let sum = &mut self.sums[*entry as usize];
        sum.depth += share.area * share.max_depth;
        if record.arrival.is_nan() || share.max_depth <= 0.0 {
            return;
        }
        let add = |to: &mut f64, value: f32| *to += share.area * f64::from(value);
        sum.wet += share.area;
        (0..2).for_each(|axis| add(&mut sum.velocity[axis], record.fastest[axis]));
        add(&mut sum.speed, record.max_speed());
        add(&mut sum.hazard, record.hazard);
        add(&mut sum.arrival, record.arrival);
        add(&mut sum.duration, record.duration);
    }

    fn finished(self, mesh: &Mesh) -> Vec<Record> {
        let mut records = self.whole;
        for sum in &self.sums {
            let cell = sum.cell as usize;
            records[cell] = sum.record(mesh.area[cell]);
        }
        records
    }
}

impl Sum {
    /// The record of a cell of an area, m2: means over its pieces.
    fn record(&self, area: f64) -> Record {
        if self.wet <= 0.0 {
            return DRY;
        }
        let mean = |sum: f64| (sum / self.wet) as f32;
        let [east, north] = self.velocity;
        let length = east.hypot(north);
        // As fast as the pieces, in their mean direction.
        let factor = if length > 0.0 { self.speed / length } else { 0.0 };
        Record {
            max_depth: (self.depth / area) as f32,
            fastest: self.velocity.map(|sum| mean(factor * sum)),
            hazard: mean(self.hazard),
            arrival: mean(self.arrival),
            duration: mean(self.duration),
        }
    }
}
