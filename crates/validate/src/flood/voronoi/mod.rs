//! Cases of scheme `voronoi`. Particles lie on no lattice; each measure is the worst of three seeds of their positions.

mod adaptive;
mod balances;
mod beach;
mod cylinder;
pub(super) mod dam_breaks;
mod ea_test5;
mod infiltration;
mod invariance;
mod isolated_building;
mod lakes;
mod malpasset;
mod measured;
mod noise;
mod rain;
mod sheets;
mod storage;
mod structures;
mod swashes;
mod thacker;
mod tide;
mod triangular_obstacle;
pub(super) mod vortex;
mod waves;

pub(super) use adaptive::ADAPTIVE;
pub(super) use balances::{ENERGY, LEDGER, MOMENTUM};
pub(super) use beach::{BEACH, RUN_UP, SENT_WAVE};
pub(super) use cylinder::CYLINDER_FORCE;
pub(super) use dam_breaks::{FINER, RITTER, STOKER};
pub(super) use ea_test5::EA_TEST5;
pub(super) use infiltration::INFILTRATION;
pub(super) use invariance::INVARIANCE;
pub(super) use isolated_building::ISOLATED_BUILDING;
pub(super) use lakes::{BLOCKS, ISLANDS, JACKSBORO, LONG};
pub(super) use malpasset::MALPASSET;
pub(super) use rain::RAIN;
pub(super) use sheets::SHEETS;
pub(super) use storage::STORAGE;
pub(super) use structures::STRUCTURES;
pub(super) use swashes::SWASHES;
pub(super) use thacker::{PLANAR, RADIAL};
pub(super) use tide::TIDE;
pub(super) use triangular_obstacle::TRIANGULAR_OBSTACLE;
pub(super) use vortex::VORTEX;
pub(super) use waves::WAVES;

use super::device::ready;
use super::{GRAVITY, order};
use crate::Row;
use crate::device::{reduced, sized};
use corpuscle_flood::{StartWater, VoronoiFlood};
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::{Edge, Edges, Flood, Manning};
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Seeds of the particles' positions.
const SEEDS: [u64; 3] = [1, 2, 3];

/// Settings with a spacing, m, Manning's n and edges.
fn settings(spacing_m: f64, manning: f64, edges: Edges) -> Flood {
    Flood {
        spacing_m: Some(sized(spacing_m)),
        gravity_m_per_s2: GRAVITY,
        manning: Manning::Number(manning),
        // Maps are not used; frames show all that moves.
        wet_depth_m: 1e-6,
        edges,
        ..Flood::default()
    }
}

/// The same on all four sides.
fn all_sides(edge: &Edge) -> Edges {
    Edges { west: edge.clone(), east: edge.clone(), south: edge.clone(), north: edge.clone() }
}

fn set_up(
    settings: &Flood,
    seed: u64,
    terrain: &Arc<Terrain>,
    water: &[StartWater],
) -> Result<VoronoiFlood, ModelError> {
    ready(VoronoiFlood::with_water(settings, seed, Path::new("."), Arc::clone(terrain), water)?)
}

/// Goes on to `time` s.
fn advance(flood: &mut VoronoiFlood, time: f64) -> Result<(), ModelError> {
    flood.advance_to(time, &AtomicBool::new(false))
}

/// A flood that was set up and ran to `time` s.
fn run(
    settings: &Flood,
    seed: u64,
    terrain: &Arc<Terrain>,
    water: &[StartWater],
    time: f64,
) -> Result<VoronoiFlood, ModelError> {
    let mut flood = set_up(settings, seed, terrain, water)?;
    advance(&mut flood, time)?;
    Ok(flood)
}

/// The largest of three seeds, value by value.
fn worst<const N: usize>(measure: impl Fn(u64) -> Result<[f64; N], ModelError>) -> Result<[f64; N], ModelError> {
    let mut worst = [f64::NEG_INFINITY; N];
    for &seed in reduced(&SEEDS) {
        for (worst, value) in worst.iter_mut().zip(measure(seed)?) {
            // A value that is not a number is the worst, too.
            *worst = if value.is_nan() || worst.is_nan() { f64::NAN } else { worst.max(value) };
        }
    }
    Ok(worst)
}

/// Errors at a spacing and at twice and four times it: each with the name of its row and its bound, and the least order between the widest and the
/// finest.
struct Convergence {
    case: &'static str,
    /// Spacings from fine to wide, m, with names of measures and bounds of the error.
    spacings: [(f64, &'static str, f64); 3],
    order: (&'static str, f64),
}

impl Convergence {
    /// The rows, with the error of a spacing and a seed given by `error`; the worst seed counts.
    fn rows(&self, error: impl Fn(f64, u64) -> Result<f64, ModelError>) -> Result<Vec<Row>, ModelError> {
        let mut rows = Vec::new();
        let mut errors = Vec::new();
        for (spacing, measure, bound) in self.spacings {
            let [found] = worst(|seed| Ok([error(spacing, seed)?]))?;
            errors.push(found);
            rows.push(Row::at_most(self.case, measure, found, "", bound));
        }
        let (measure, least) = self.order;
        rows.push(Row::at_least(self.case, measure, order(errors[0], errors[2], 4.0), "", least));
        Ok(rows)
    }
}

/// Cells as a flood shows them at its time, those with next to no water left out.
struct Cell {
    at: [f64; 2],
    area: f64,
    depth: f64,
}

fn cells(flood: &VoronoiFlood) -> Vec<Cell> {
    let frame = flood.frame();
    let set = &frame.sets[0];
    let cell = |k: usize| {
        let [x, y, _] = set.position[k];
        let area = 4.0 * set.radius[k] * set.radius[k];
        Cell { at: [x, y], area, depth: set.mass[k] / (1000.0 * area) }
    };
    (0..set.id.len()).map(cell).collect()
}
