//! Refinement criteria: the resolution that the water requires.

use super::super::VoronoiFlood;
use super::super::domain::{any, total};
use super::super::mesh::{Blocks, Layout};
use super::super::solver::Solver;
use corpuscle_scene::Adaptive;
use rayon::prelude::*;

/// Part of `rise_over_depth` below which cells become coarser (hysteresis).
const COARSEN_FACTOR: f64 = 0.7;

/// Depth over the wet-dry threshold above which refined cells stay refined.
const COARSEN_DEPTH_RATIO: f64 = 0.5;

/// Largest advance of a front in a time step, in spacings of its cells.
const FRONT_ADVANCE: f64 = 0.4;

/// Largest advance of a front between two checks, in sizes of a block: so that blocks just refined reach far enough ahead.
const MAX_FRONT_ADVANCE: f64 = 0.9;

/// Part of the cells that must become superfluous for all to be remade.
const SUPERFLUOUS_SHARE: f64 = 0.2;

/// Halvings of the spacing that a cell requires, and the most that it keeps.
pub(super) type LevelRange = [u8; 2];

impl VoronoiFlood {
    /// The blocks that the water requires; none where the present ones suffice.
    pub(super) fn required_blocks(&mut self) -> Option<Blocks> {
        let wet_depth = self.settings.wet_depth_m;
        let adaptive = self.adaptive.as_mut()?;
        let solver = &self.solver;
        let criteria = Criteria { solver, settings: &adaptive.settings, finest: adaptive.finest, wet_depth };
        adaptive.required.clear();
        adaptive.required.resize(solver.mesh.len(), [0; 2]);
        solver.for_wet_chunks(&mut adaptive.required, |cell, required| *required = criteria.of_cell(cell));
        let blocks = solver.mesh.layout.blocks();
        let present = |block: usize| blocks.levels()[block].max(adaptive.of_parts.get(block).copied().unwrap_or(0));
        let mut levels_required = BlockLevels::new(blocks, &solver.mesh.layout, adaptive.settings.every_steps);
        let mut is_short = false;
        let own = adaptive.required.iter().enumerate().filter(|(cell, _)| solver.owns(*cell));
        for (cell, [least, most]) in own.filter(|(_, required)| required[1] > 0) {
            let at = solver.mesh.centroid[cell];
            levels_required.add(at, [*least, *most]);
            is_short |= *least > 0 && levels_required.round(at, *least).any(|block| present(block) < *least);
        }
        let domain = solver.domain.as_ref();
        if let Some(domain) = domain {
            levels_required.required.iter_mut().for_each(|levels| domain.most(levels));
        }
        let is_short = any(domain, is_short);
        let [least, most] = levels_required.spread();
        let mut new = blocks.cleared();
        for (block, level) in new.levels_mut().iter_mut().enumerate() {
            let required = blocks.levels()[block].clamp(least[block], most[block].max(least[block]));
            // Where parts of the terrain are as fine already, blocks need no level.
            *level =
                if adaptive.of_parts.get(block).is_some_and(|of_parts| *of_parts >= required) { 0 } else { required };
        }
        let spared = points(blocks) - points(&new);
        let mut cells = [(0..solver.mesh.len()).filter(|cell| solver.owns(*cell)).count() as i64];
        total(domain, &mut cells, &mut []);
        (new != *blocks && (is_short || spared > SUPERFLUOUS_SHARE * cells[0] as f64)).then_some(new)
    }
}

/// About how many points blocks add.
fn points(blocks: &Blocks) -> f64 {
    blocks.levels().iter().map(|level| f64::from((1_u32 << (2 * level)) - 1)).sum::<f64>() * blocks.points()
}

/// The criteria of refinement.
struct Criteria<'a> {
    solver: &'a Solver,
    settings: &'a Adaptive,
    finest: u8,
    wet_depth: f64,
}

impl Criteria<'_> {
    /// The levels required by a cell, whatever its level is now.
    fn of_cell(&self, cell: usize) -> LevelRange {
        let depth = self.solver.water[cell].depth;
        if depth <= COARSEN_DEPTH_RATIO * self.wet_depth {
            return [0; 2];
        }
        let is_wet = depth > self.wet_depth;
        if self.settings.fronts && self.is_front(cell) {
            return [if is_wet { self.finest } else { 0 }, self.finest];
        }
        let rise = self.steepness(cell) * self.solver.mesh.layout.spacing();
        let level = |most: f64| {
            let halvings = (rise / (most * depth)).log2().ceil();
            halvings.clamp(0.0, f64::from(self.finest)) as u8
        };
        let most = self.settings.rise_over_depth;
        [if is_wet { level(most) } else { 0 }, level(COARSEN_FACTOR * most)]
    }

    /// Steepest rise or fall of the ground from a cell to one beside it.
    fn steepness(&self, cell: usize) -> f64 {
        let mesh = &self.solver.mesh;
        let to = |link: &super::super::mesh::Link| {
            let other = link.cell()?;
            let face = &mesh.faces[link.face as usize];
            let [x, y] = face.between;
            Some((mesh.bed[other] + mesh.lift_seen(link, cell) - mesh.bed[cell]).abs() / f64::from(x.hypot(y)))
        };
        mesh.links_of(cell).iter().filter_map(to).fold(0.0, f64::max)
    }

    /// Whether a cell beside one is dry.
    fn is_front(&self, cell: usize) -> bool {
        let others = self.solver.mesh.links_of(cell).iter().filter_map(|link| link.cell());
        others.into_iter().any(|other| self.solver.water[other].depth <= COARSEN_DEPTH_RATIO * self.wet_depth)
    }
}

/// The levels required by the cells of each block.
struct BlockLevels<'a> {
    blocks: &'a Blocks,
    layout: &'a Layout,
    /// Advance of fronts between two checks, in spacings of their cells.
    reach: f64,
    required: [Vec<u8>; 2],
}

impl<'a> BlockLevels<'a> {
    fn new(blocks: &'a Blocks, layout: &'a Layout, every_steps: u32) -> Self {
        let reach = FRONT_ADVANCE * f64::from(every_steps);
        Self { blocks, layout, reach, required: [(); 2].map(|()| vec![0; blocks.levels().len()]) }
    }

    /// Adds the levels required by a cell at a position.
    fn add(&mut self, at: [f64; 2], required: LevelRange) {
        let Some(block) = self.block(at) else { return };
        for (levels, level) in self.required.iter_mut().zip(required) {
            levels[block] = levels[block].max(level);
        }
    }

    /// Number of the block that holds a position, beyond joined sides too.
    fn block(&self, at: [f64; 2]) -> Option<usize> {
        self.blocks.at(self.layout.home(at))
    }

    /// The blocks at a position and round it, as far as water in cells of a level may come before the next check.
    fn round(&self, at: [f64; 2], level: u8) -> impl Iterator<Item = usize> {
        let far = self.reach * self.layout.spacing() / f64::from(1 << level);
        let reach = self.blocks.size().map(|size| far.min(MAX_FRONT_ADVANCE * size));
        AROUND.into_iter().filter_map(move |[x, y]| self.block([at[0] + x * reach[0], at[1] + y * reach[1]]))
    }

    /// The levels required by each block and those beside it.
    fn spread(&self) -> [Vec<u8>; 2] {
        let size = self.blocks.size();
        let beside = |block: usize, required: &[u8]| {
            let [x, y] = self.blocks.middle(block);
            let blocks = AROUND.iter().filter_map(|[dx, dy]| self.block([x + dx * size[0], y + dy * size[1]]));
            blocks.map(|block| required[block]).max().unwrap_or(0)
        };
        let spread =
            |required: &Vec<u8>| (0..required.len()).into_par_iter().map(|block| beside(block, required)).collect();
        [spread(&self.required[0]), spread(&self.required[1])]
    }
}

/// A block and the eight round it, in blocks.
const AROUND: [[f64; 2]; 9] =
    [[0.0, 0.0], [-1.0, -1.0], [0.0, -1.0], [1.0, -1.0], [-1.0, 0.0], [1.0, 0.0], [-1.0, 1.0], [0.0, 1.0], [1.0, 1.0]];

/// How often parts of the terrain have the spacing halved all over each block, by its corners and its middle.
pub(super) fn levels_of_parts(layout: &Layout) -> Vec<u8> {
    let blocks = layout.blocks();
    let level = |block: usize| {
        let [[west, south], [east, north]] = blocks.corners(block);
        let positions = [[west, south], [east, south], [east, north], [west, north], blocks.middle(block)];
        positions.into_iter().map(|at| layout.level_of_parts(at)).min().unwrap_or(0)
    };
    (0..blocks.levels().len()).into_par_iter().map(level).collect()
}
