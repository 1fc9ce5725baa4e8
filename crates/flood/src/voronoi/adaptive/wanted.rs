//! How fine the water asks cells to be.

use super::super::VoronoiFlood;
use super::super::mesh::{Blocks, Layout};
use super::super::solver::Solver;
use corpuscle_scene::Adaptive as Settings;
use rayon::prelude::*;

/// Cells stay as fine as they are until they would be fine enough for this part of `rise_over_depth`.
const KEPT: f64 = 0.7;

/// Cells that were finer stay so while the water is deeper than this part of the depth of wet ground.
const KEPT_DEPTH: f64 = 0.5;

/// A front comes this far in a time step at most, in spacings of its cells.
const FRONT_STEP: f64 = 0.4;

/// The same over all steps between two looks is taken to be less than this part of a block, so that blocks just made finer are far enough ahead.
const MOST_GUARD: f64 = 0.9;

/// All cells are made anew where this part of them could be spared.
const SPARED: f64 = 0.2;

/// How often a cell asks for the spacing to be halved: at least, and as much as it keeps.
pub(super) type Asked = [u8; 2];

impl VoronoiFlood {
    /// The blocks as the water asks for them; none where those that there are will do.
    pub(super) fn wanted_blocks(&mut self) -> Option<Blocks> {
        let wet_depth = self.settings.wet_depth_m;
        let adaptive = self.adaptive.as_mut()?;
        let solver = &self.solver;
        let ask = Ask { solver, settings: &adaptive.settings, finest: adaptive.finest, wet_depth };
        adaptive.asked.clear();
        adaptive.asked.resize(solver.mesh.len(), [0; 2]);
        solver.for_wet_chunks(&mut adaptive.asked, |cell, asked| *asked = ask.of_cell(cell));
        let blocks = solver.mesh.layout.blocks();
        let present = |block: usize| blocks.levels()[block].max(adaptive.of_parts.get(block).copied().unwrap_or(0));
        let mut wanted = Wanted::new(blocks, &solver.mesh.layout, adaptive.settings.every_steps);
        let mut is_short = false;
        for (cell, [least, most]) in adaptive.asked.iter().enumerate().filter(|(_, asked)| asked[1] > 0) {
            let at = solver.mesh.centroid[cell];
            wanted.add(at, [*least, *most]);
            is_short |= *least > 0 && wanted.round(at, *least).any(|block| present(block) < *least);
        }
        let [least, most] = wanted.spread();
        let mut new = blocks.cleared();
        for (block, level) in new.levels_mut().iter_mut().enumerate() {
            let asked = blocks.levels()[block].clamp(least[block], most[block].max(least[block]));
            // Where parts of the terrain are as fine already nothing is left to ask for.
            *level = if adaptive.of_parts.get(block).is_some_and(|of_parts| *of_parts >= asked) { 0 } else { asked };
        }
        let spared = points(blocks) - points(&new);
        (new != *blocks && (is_short || spared > SPARED * solver.mesh.len() as f64)).then_some(new)
    }
}

/// About how many points blocks add.
fn points(blocks: &Blocks) -> f64 {
    blocks.levels().iter().map(|level| f64::from((1_u32 << (2 * level)) - 1)).sum::<f64>() * blocks.points()
}

/// What cells are asked by.
struct Ask<'a> {
    solver: &'a Solver,
    settings: &'a Settings,
    finest: u8,
    wet_depth: f64,
}

impl Ask<'_> {
    /// How fine a cell asks to be, whatever it is now.
    fn of_cell(&self, cell: usize) -> Asked {
        let depth = self.solver.water[cell].depth;
        if depth <= KEPT_DEPTH * self.wet_depth {
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
        [if is_wet { level(most) } else { 0 }, level(KEPT * most)]
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
        others.into_iter().any(|other| self.solver.water[other].depth <= KEPT_DEPTH * self.wet_depth)
    }
}

/// What the cells of each block ask for.
struct Wanted<'a> {
    blocks: &'a Blocks,
    layout: &'a Layout,
    /// How far fronts come between two looks, in spacings of their cells.
    reach: f64,
    asked: [Vec<u8>; 2],
}

impl<'a> Wanted<'a> {
    fn new(blocks: &'a Blocks, layout: &'a Layout, every_steps: u32) -> Self {
        let reach = FRONT_STEP * f64::from(every_steps);
        Self { blocks, layout, reach, asked: [(); 2].map(|()| vec![0; blocks.levels().len()]) }
    }

    /// A cell at a position asks.
    fn add(&mut self, at: [f64; 2], asked: Asked) {
        let Some(block) = self.block(at) else { return };
        for (levels, level) in self.asked.iter_mut().zip(asked) {
            levels[block] = levels[block].max(level);
        }
    }

    /// Number of the block that holds a position, beyond joined sides too.
    fn block(&self, at: [f64; 2]) -> Option<usize> {
        self.blocks.at(self.layout.home(at))
    }

    /// The blocks at a position and round it, as far as water in cells of a level may come before the next look.
    fn round(&self, at: [f64; 2], level: u8) -> impl Iterator<Item = usize> {
        let far = self.reach * self.layout.spacing() / f64::from(1 << level);
        let reach = self.blocks.size().map(|size| far.min(MOST_GUARD * size));
        AROUND.into_iter().filter_map(move |[x, y]| self.block([at[0] + x * reach[0], at[1] + y * reach[1]]))
    }

    /// What each block and those beside it ask for.
    fn spread(&self) -> [Vec<u8>; 2] {
        let size = self.blocks.size();
        let beside = |block: usize, asked: &[u8]| {
            let [x, y] = self.blocks.middle(block);
            let blocks = AROUND.iter().filter_map(|[dx, dy]| self.block([x + dx * size[0], y + dy * size[1]]));
            blocks.map(|block| asked[block]).max().unwrap_or(0)
        };
        let spread = |asked: &Vec<u8>| (0..asked.len()).into_par_iter().map(|block| beside(block, asked)).collect();
        [spread(&self.asked[0]), spread(&self.asked[1])]
    }
}

/// A place and the eight round it.
const AROUND: [[f64; 2]; 9] =
    [[0.0, 0.0], [-1.0, -1.0], [0.0, -1.0], [1.0, -1.0], [-1.0, 0.0], [1.0, 0.0], [-1.0, 1.0], [0.0, 1.0], [1.0, 1.0]];

/// How often parts of the terrain have the spacing halved all over each block, as far as its corners and its middle tell.
pub(super) fn levels_of_parts(layout: &Layout) -> Vec<u8> {
    let blocks = layout.blocks();
    let level = |block: usize| {
        let [[west, south], [east, north]] = blocks.corners(block);
        let places = [[west, south], [east, south], [east, north], [west, north], blocks.middle(block)];
        places.into_iter().map(|at| layout.level_of_parts(at)).min().unwrap_or(0)
    };
    (0..blocks.levels().len()).into_par_iter().map(level).collect()
}
