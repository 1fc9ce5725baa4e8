//! Particles that stand for a solid.
//!
//! The box round the solid is divided into equal cells of about the spacing. A cell that the surface cuts keeps the part
//! inside: its volume, and its centre of mass for a position. Parts of less than half a cell join a neighbour. So a box is
//! sampled as a perfect lattice with its first layer half a spacing below the surface, and a sum over the particles is a
//! second-order integral over any solid.

mod cells;

use crate::shape::above_zero;
use crate::{Solid, SolidError};
use cells::{Cell, Cells};
use std::collections::HashMap;

/// How deep below its surface a solid is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Depth {
    /// All of it.
    Full,
    /// So many layers of particles.
    Layers(u32),
}

/// Particles that stand for a solid. Those of so many layers are among those of the whole solid, with the same volumes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Samples {
    /// Positions, m; all inside the solid.
    pub positions: Vec<[f64; 3]>,
    /// Volumes, m³; those of all particles of a solid sum to its volume.
    pub volumes: Vec<f64>,
    /// Surface of the solid that each stands for, m², 0 for those inside; their sum is the solid's surface.
    pub areas: Vec<f64>,
}

/// More particles than this do not fit in the memory of usual machines beside what moves between them.
const MOST_SAMPLES: f64 = 1e8;

/// Samples a solid in its own coordinates.
pub(crate) fn sample(solid: &Solid, spacing: f64, depth: Depth) -> Result<Samples, SolidError> {
    above_zero("the distance between particles in m", spacing)?;
    refuse_too_many(solid, spacing, depth)?;
    let cells = Cells::new(solid, spacing, depth);
    let (found, whole) = cells.find();
    let (parts, grown) = joined(&cells, found);
    let whole = whole - grown;
    let cell_volume = cells.cell_volume();
    // Whole cells have their volume; what the parts have too much or too little is given to all of them in proportion.
    let sum_of = |of: fn(&Cell) -> f64| parts.iter().filter(|part| part.is_cut).map(of).sum::<f64>();
    let (cut_volume, area) = (sum_of(|part| part.fraction), sum_of(|part| part.area));
    let to_volume = (solid.volume() - whole as f64 * cell_volume) / cut_volume;
    let to_area = solid.area() / area;
    let volume = |part: &Cell| if part.is_cut { part.fraction * to_volume } else { cell_volume };
    Ok(Samples {
        positions: parts.iter().map(|part| part.centre).collect(),
        volumes: parts.iter().map(volume).collect(),
        areas: parts.iter().map(|part| if part.is_cut { part.area * to_area } else { 0.0 }).collect(),
    })
}

fn refuse_too_many(solid: &Solid, spacing: f64, depth: Depth) -> Result<(), SolidError> {
    let (volume, area) = (solid.volume(), solid.area());
    let in_layers = match depth {
        Depth::Full => f64::INFINITY,
        // One more for the cells that are tested on both sides of the surface.
        Depth::Layers(layers) => area * f64::from(layers + 1) / spacing.powi(2),
    };
    let count = (volume / spacing.powi(3)).max(area / spacing.powi(2)).min(in_layers);
    let fits = count <= MOST_SAMPLES;
    if fits { Ok(()) } else { Err(SolidError::TooManySamples { volume, area, spacing, count, most: MOST_SAMPLES }) }
}

/// Joins parts of less than half a cell to the nearest of the neighbours that have more. Gives also the number of whole
/// cells that grew and so are whole no longer.
fn joined(cells: &Cells, mut found: Vec<Cell>) -> (Vec<Cell>, u64) {
    let at: HashMap<[u32; 3], usize> = found.iter().enumerate().map(|(at, cell)| (cell.index, at)).collect();
    let small = |cell: &Cell| cell.is_cut && cell.fraction < 0.5;
    let moves: Vec<_> = (0..found.len()).filter(|&at| small(&found[at])).collect();
    let targets: Vec<Option<usize>> = moves
        .iter()
        .map(|&part| {
            let neighbours = cells.neighbours(found[part].index).filter_map(|index| at.get(&index).copied());
            let distance = |other: usize| distance2(found[part].centre, found[other].centre);
            let larger = neighbours.filter(|&other| !small(&found[other]));
            larger.min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
        })
        .collect();
    let mut grown = 0;
    for (&part, target) in moves.iter().zip(&targets) {
        let Some(target) = *target else { continue };
        let joining = std::mem::replace(&mut found[part].fraction, 0.0);
        let area = std::mem::replace(&mut found[part].area, 0.0);
        let (from, into) = (found[part].centre, &mut found[target]);
        let sum = into.fraction + joining;
        let centre = std::array::from_fn(|axis| (into.fraction * into.centre[axis] + joining * from[axis]) / sum);
        grown += u64::from(!into.is_cut);
        (into.fraction, into.centre, into.is_cut) = (sum, centre, true);
        into.area += area;
    }
    found.retain(|cell| cell.fraction > 0.0);
    for cell in found.iter_mut().filter(|cell| cell.is_cut) {
        cells.move_inside(cell);
    }
    found.retain(|cell| cell.fraction > 0.0);
    (found, grown)
}

fn distance2(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum()
}
