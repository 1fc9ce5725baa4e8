//! Nucleation sites: where drops begin, and the area whose water each gathers.
//!
//! Sites are random positions on the surfaces, from the scene's seed and their density alone, so that drops do not depend on how far
//! apart the particles are. Of sites that are nearer to one another than two of the smallest drops one is kept: drops there
//! merge before they are seen (random sequential addition; Feder, J. Theor. Biol. 87, 1980, 237: disks cover 0.547 at most, as much as
//! drops that grow and merge do, 0.55: Fritter, Knobler & Beysens, Phys. Rev. A 43, 1991, 2858).

use super::grid::Grid;
use super::{Patch, SurfaceWater, distance2, dot};
use corpuscle_solids::Solid;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use std::f64::consts::PI;

/// Largest part of a plane that disks cover which are put there one after another and do not overlap (Feder 1980).
const JAMMING_COVERAGE: f64 = 0.547;

/// Positions for each site, by which areas are measured: at least so many, and more, up to `MAX_SAMPLE_RATIO` times as many, where a solid then has fewer than
/// `MIN_SAMPLES_PER_SOLID`.
const SAMPLES_PER_SITE: f64 = 32.0;
const MAX_SAMPLE_RATIO: f64 = 12.5;
const MIN_SAMPLES_PER_SOLID: f64 = 4e5;

/// Surfaces with more sites are refused: their positions alone would take more than 1.2 GB while areas are measured.
pub const MOST_SITES: f64 = 5e5;

/// A nucleation site.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Site {
    /// Number of the solid.
    pub solid: u32,
    /// Where it is, on the surface, m.
    pub position: [f64; 3],
    /// Outward unit normal there.
    pub normal: [f64; 3],
    /// The patch that has the most of its area.
    pub patch: u32,
}

/// What a site has of a patch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Piece {
    pub patch: u32,
    pub site: u32,
    /// Part of the patch's area that the site gathers from.
    pub of_patch: f64,
    /// Part of the site's area that is in the patch.
    pub of_site: f64,
}

/// Sites, and the pieces of patches that they gather from, in the order of patches.
#[derive(Debug, Clone)]
pub(super) struct Sites {
    pub all: Vec<Site>,
    pub grid: Grid,
    pub pieces: Vec<Piece>,
}

/// A position on a surface at which a drop may begin.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    solid: u32,
    position: [f64; 3],
    normal: [f64; 3],
    /// Whether there is a nucleation site; others only measure area.
    nucleates: bool,
    /// Its rank in a random order.
    order: u64,
}

impl Candidate {
    /// Whether another part of the surface is of the same side of the same solid.
    fn is_beside(&self, solid: u32, normal: [f64; 3]) -> bool {
        self.solid == solid && dot(self.normal, normal) > 0.5
    }
}

/// Largest density of kept sites, 1/m2, for the radius `reach` of drops when they become resolved, m.
pub fn most_per_area(reach: f64) -> f64 {
    JAMMING_COVERAGE / (PI * reach * reach)
}

impl Sites {
    /// Scatters sites over the solids with drops, and gives each patch of one with a film a site of its own; drops reach as far as `reach`, m, from their middles when they
    /// are seen; `room` are the smallest and the largest coordinates.
    pub fn scatter(
        solids: &[Solid],
        patches: &[Patch],
        water: &[SurfaceWater],
        reach: f64,
        room: [[f64; 3]; 2],
        seed: u64,
    ) -> Self {
        let of_patches: Vec<f64> = patches.iter().map(Patch::reach).collect();
        let patch_grid = Grid::new(patches.iter().map(|patch| patch.position), &of_patches);
        let mut candidates = Vec::new();
        let with_drops = (0..solids.len()).filter(|&number| !water[number].is_film());
        for number in with_drops {
            let solid = &solids[number];
            let per_area = water[number].sites_per_area();
            let Some(within) = around_patches(patches, number, reach) else { continue };
            let scatter = Scatter { solid, number: number as u32, per_area, reach, room, within };
            candidates.extend(scatter.candidates(seed));
        }
        let mut sites = kept(&candidates, 2.0 * reach);
        let apart = |solid: u32| reach.max(0.5 / water[solid as usize].sites_per_area().sqrt());
        let file = |sites: &[Site], wider: f64| {
            let wide: Vec<f64> = sites.iter().map(|site| wider * apart(site.solid)).collect();
            Grid::new(sites.iter().map(|site| site.position), &wide)
        };
        let grid = file(&sites, 1.0);
        let farthest = of_patches.iter().fold(0.0, |most: f64, &reach| most.max(PATCH_MARGIN * reach));
        let pair = |candidate: &Candidate| {
            let patch_at = |at: usize| (patches[at].solid, patches[at].normal, patches[at].position);
            let patch = nearest(&patch_grid, candidate, farthest, patch_at)?;
            if distance2(patches[patch].position, candidate.position) > (PATCH_MARGIN * of_patches[patch]).powi(2) {
                return None;
            }
            let site_at = |at: usize| (sites[at].solid, sites[at].normal, sites[at].position);
            let mut around = (0..SITE_SEARCH_DOUBLINGS).map(|times| apart(candidate.solid) * f64::from(1 << times));
            let site = around.find_map(|around| nearest(&grid, candidate, around, site_at))?;
            Some((patch as u32, site as u32))
        };
        let mut pairs: Vec<(u32, u32)> = candidates.par_iter().filter_map(pair).collect();
        pairs.par_sort_unstable();
        add_films(&mut pairs, &mut sites, patches, water);
        add_bare_patches(&mut pairs, &mut sites, patches);
        let pieces = pieces(&pairs, &mut sites, patches.len());
        // Drops are mostly much larger than sites are apart.
        let grid = file(&sites, SITE_CELL_RATIO);
        Self { all: sites, grid, pieces }
    }
}

/// A part of space.
#[derive(Debug, Clone, Copy)]
struct Cube {
    middle: [f64; 3],
    side: f64,
    /// Its own, whatever other cubes there are: three bits for each division.
    number: u64,
}

/// A solid on which positions are scattered.
struct Scatter<'a> {
    solid: &'a Solid,
    number: u32,
    per_area: f64,
    reach: f64,
    room: [[f64; 3]; 2],
    /// Smallest and largest coordinates of the searched region.
    within: [[f64; 3]; 2],
}

/// The box of a solid's patches and what is near; none where it has no patch.
fn around_patches(patches: &[Patch], solid: usize, reach: f64) -> Option<[[f64; 3]; 2]> {
    let of_solid = patches.iter().filter(|patch| patch.solid as usize == solid);
    of_solid.fold(None, |bounds: Option<[[f64; 3]; 2]>, patch| {
        let more = 1.5 * patch.reach() + reach;
        let [low, high] = bounds.unwrap_or([[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]]);
        Some([
            std::array::from_fn(|axis| low[axis].min(patch.position[axis] - more)),
            std::array::from_fn(|axis| high[axis].max(patch.position[axis] + more)),
        ])
    })
}

impl Scatter<'_> {
    /// Positions on the surface. They are drawn evenly from the space within `reach` outside of it, cube by cube, each with
    /// random numbers of its own.
    fn candidates(&self, seed: u64) -> Vec<Candidate> {
        let mut cubes = Vec::new();
        let [low, high] = self.solid.bounds();
        let side = (0..3).map(|axis| high[axis] - low[axis] + 2.0 * self.reach).fold(0.0, f64::max);
        let middle = std::array::from_fn(|axis| 0.5 * (low[axis] + high[axis]));
        self.divide(&Cube { middle, side, number: 1 }, &mut cubes);
        let drawn = cubes.par_iter().flat_map_iter(|cube| {
            let mut random = ChaCha8Rng::seed_from_u64(seed.wrapping_add(u64::from(self.number) << 32));
            random.set_stream(cube.number);
            self.candidates_in(cube, &mut random)
        });
        drawn.collect()
    }

    /// Cubes of four times the reach or less that the surface may pass.
    fn divide(&self, cube: &Cube, cubes: &mut Vec<Cube>) {
        let &Cube { middle, side, number } = cube;
        let farthest = 0.5 * 3_f64.sqrt() * side;
        let is_out_of = |[low, high]: &[[f64; 3]; 2]| {
            (0..3).any(|axis| middle[axis] + 0.5 * side < low[axis] || middle[axis] - 0.5 * side > high[axis])
        };
        let distance = self.solid.signed_distance(middle);
        if is_out_of(&self.room) || is_out_of(&self.within) || distance < -farthest || distance > farthest + self.reach
        {
            return;
        }
        if side <= 4.0 * self.reach {
            cubes.push(*cube);
            return;
        }
        for part in 0..8 {
            let offset = |axis: usize| if part >> axis & 1 == 0 { -0.25 * side } else { 0.25 * side };
            let middle = std::array::from_fn(|axis| middle[axis] + offset(axis));
            self.divide(&Cube { middle, side: 0.5 * side, number: number << 3 | part }, cubes);
        }
    }

    /// Density of the positions, 1/m2. It depends on nothing but the solid and its sites.
    fn samples_per_area(&self) -> f64 {
        let least = SAMPLES_PER_SITE * self.per_area.min(most_per_area(self.reach));
        (MIN_SAMPLES_PER_SOLID / self.solid.area()).clamp(least, MAX_SAMPLE_RATIO * least)
    }

    fn candidates_in(&self, cube: &Cube, random: &mut ChaCha8Rng) -> Vec<Candidate> {
        let &Cube { middle, side, .. } = cube;
        let per_area = self.samples_per_area();
        let expected = per_area / self.reach * side.powi(3);
        let count = expected as u64 + u64::from(random.random_range(0.0..1.0) < expected.fract());
        (0..count)
            .filter_map(|_| {
                let drawn = middle.map(|x| x + side * random.random_range(-0.5..0.5));
                let nucleates = random.random_range(0.0..1.0) * per_area < self.per_area;
                let order = random.random();
                self.candidate(drawn, nucleates, order)
            })
            .collect()
    }

    /// The point of the surface below a point within reach of it; none below what is nearest to an edge or beyond the room.
    fn candidate(&self, drawn: [f64; 3], nucleates: bool, order: u64) -> Option<Candidate> {
        let nearest = self.solid.nearest(drawn);
        if nearest.distance <= 0.0 || nearest.distance > self.reach {
            return None;
        }
        let along =
            |from: [f64; 3], offset: f64| std::array::from_fn(|axis| from[axis] + offset * nearest.normal[axis]);
        let position = along(drawn, -nearest.distance);
        let is_in_room = (0..3).all(|axis| (self.room[0][axis]..=self.room[1][axis]).contains(&position[axis]));
        let depth = 0.1 * self.reach;
        let is_at_edge = || (self.solid.signed_distance(along(position, -depth)) + depth).abs() > 0.1 * depth;
        if !is_in_room || is_at_edge() {
            return None;
        }
        Some(Candidate { solid: self.number, position, normal: nearest.normal, nucleates, order })
    }
}

/// Candidates that are compared with the sites before them at once.
const CANDIDATES_AT_ONCE: usize = 1 << 14;

/// Of the candidates that nucleate, solid by solid and one after another in their random order, those that no kept one is nearer to than `apart`, m.
fn kept(candidates: &[Candidate], apart: f64) -> Vec<Site> {
    let nucleating = candidates.iter().enumerate().filter(|(_, candidate)| candidate.nucleates);
    let mut order: Vec<(u32, u64, u32)> =
        nucleating.map(|(at, candidate)| (candidate.solid, candidate.order, at as u32)).collect();
    order.par_sort_unstable();
    let mut cells = Cells::new(apart);
    for some in order.chunks(CANDIDATES_AT_ONCE) {
        let is_free = |candidate: &&Candidate| !cells.has_beside(candidate, apart);
        let free: Vec<&Candidate> = some.par_iter().map(|&(.., at)| &candidates[at as usize]).filter(is_free).collect();
        for candidate in free {
            if !cells.has_beside(candidate, apart) {
                let Candidate { solid, position, normal, .. } = *candidate;
                cells.add(Site { solid, position, normal, patch: 0 });
            }
        }
    }
    cells.sites
}

/// Sites filed by cells one by one, to be found within a distance of half a cell.
struct Cells {
    /// Side of a cell, m.
    side: f64,
    sites: Vec<Site>,
    /// The last site of each cell, and of each site the one before it in its cell.
    last: FxHashMap<[i64; 3], u32>,
    before: Vec<Option<u32>>,
}

impl Cells {
    fn new(within: f64) -> Self {
        Self { side: 2.0 * within, sites: Vec::new(), last: FxHashMap::default(), before: Vec::new() }
    }

    fn cell(&self, position: [f64; 3]) -> [i64; 3] {
        position.map(|x| (x / self.side).floor() as i64)
    }

    fn add(&mut self, site: Site) {
        let number = self.sites.len() as u32;
        let cell = self.cell(site.position);
        self.before.push(self.last.insert(cell, number));
        self.sites.push(site);
    }

    /// Whether a site is nearer to a candidate than `apart`, m, on the same side of the same solid.
    fn has_beside(&self, candidate: &Candidate, apart: f64) -> bool {
        let is_near = |other: &Site| {
            distance2(other.position, candidate.position) < apart * apart
                && candidate.is_beside(other.solid, other.normal)
        };
        self.around(candidate.position).any(is_near)
    }

    /// Sites, among them all that are as near to a position as half a cell; those of its own cell first.
    fn around(&self, position: [f64; 3]) -> impl Iterator<Item = &Site> {
        let own = self.cell(position);
        let beside = self.cell(position.map(|x| x - 0.5 * self.side));
        // Of the cells before and behind its own the nearer one.
        let nearer = |axis: usize| if beside[axis] < own[axis] { own[axis] - 1 } else { own[axis] + 1 };
        let cells = [0, 1, 2].map(|axis| [own[axis], nearer(axis)]);
        let near = (0..8_usize).map(move |at| [0, 1, 2].map(|axis| cells[axis][at >> axis & 1]));
        let lasts = near.filter_map(|cell| self.last.get(&cell).copied());
        let numbers = lasts.flat_map(|last| std::iter::successors(Some(last), |&number| self.before[number as usize]));
        numbers.map(|number| &self.sites[number as usize])
    }
}

/// The nearest within a distance on the same side of the same solid, where `of` gives solid, normal and position of each in `grid`.
fn nearest(
    grid: &Grid,
    candidate: &Candidate,
    within: f64,
    of: impl Fn(usize) -> (u32, [f64; 3], [f64; 3]),
) -> Option<usize> {
    let mut best: Option<(f64, usize)> = None;
    // What is filed reaches out itself.
    grid.near(candidate.position, (within - grid.smallest()).max(0.0), 0.0, |at| {
        let (solid, normal, position) = of(at);
        let away = distance2(position, candidate.position);
        let is_near = away <= within * within && candidate.is_beside(solid, normal);
        if is_near && best.is_none_or(|best| (away, at) < best) {
            best = Some((away, at));
        }
    });
    best.map(|(_, at)| at)
}

/// Width of the cells in which sites below drops are searched, over the distance between sites.
const SITE_CELL_RATIO: f64 = 4.0;

/// A position is on the nearest patch where it is within so many times the distance of its corners.
const PATCH_MARGIN: f64 = 1.2;

/// Most doublings of the radius in which the nearest site is searched; the first is the distance between sites.
const SITE_SEARCH_DOUBLINGS: u32 = 4;

/// Gives each patch with a film a site of its own.
fn add_films(pairs: &mut Vec<(u32, u32)>, sites: &mut Vec<Site>, patches: &[Patch], water: &[SurfaceWater]) {
    let is_film = |patch: &Patch| water[patch.solid as usize].is_film();
    for (number, patch) in patches.iter().enumerate().filter(|(_, patch)| is_film(patch)) {
        let Patch { solid, position, normal, .. } = *patch;
        pairs.push((number as u32, sites.len() as u32));
        sites.push(Site { solid, position, normal, patch: number as u32 });
    }
}

/// Patches that no position is on, as they are small, gather for the nearest site; where there is none, for one of their own.
fn add_bare_patches(pairs: &mut Vec<(u32, u32)>, sites: &mut Vec<Site>, patches: &[Patch]) {
    let mut has_any = vec![false; patches.len()];
    pairs.iter().for_each(|&(patch, _)| has_any[patch as usize] = true);
    for (number, patch) in patches.iter().enumerate().filter(|(number, _)| !has_any[*number]) {
        let of_side = |site: &&Site| site.solid == patch.solid && dot(site.normal, patch.normal) > 0.5;
        let away = |site: &Site| distance2(site.position, patch.position);
        let near = sites.iter().enumerate().filter(|(_, site)| of_side(site));
        let nearest = near.min_by(|a, b| away(a.1).total_cmp(&away(b.1))).map(|(at, _)| at);
        let site = nearest.unwrap_or_else(|| {
            let Patch { solid, position, normal, .. } = *patch;
            sites.push(Site { solid, position, normal, patch: number as u32 });
            sites.len() - 1
        });
        pairs.push((number as u32, site as u32));
    }
    pairs.sort_unstable();
}

/// What each site has of each patch, from sorted pairs of the two, one for each position; sites with nothing are taken out.
fn pieces(pairs: &[(u32, u32)], sites: &mut Vec<Site>, patches: usize) -> Vec<Piece> {
    let (mut of_patch, mut of_site) = (vec![0_u32; patches], vec![0_u32; sites.len()]);
    for &(patch, site) in pairs {
        of_patch[patch as usize] += 1;
        of_site[site as usize] += 1;
    }
    let mut number = vec![0_u32; sites.len()];
    let mut count = 0;
    for (at, &pairs) in of_site.iter().enumerate() {
        number[at] = count;
        count += u32::from(pairs > 0);
    }
    let mut at = 0;
    sites.retain(|_| {
        at += 1;
        of_site[at - 1] > 0
    });
    let mut most = vec![0_u32; sites.len()];
    pairs
        .chunk_by(|a, b| a == b)
        .map(|alike| {
            let ((patch, site), count) = (alike[0], alike.len() as u32);
            let kept = number[site as usize] as usize;
            if count > most[kept] {
                (most[kept], sites[kept].patch) = (count, patch);
            }
            let part = |all: u32| f64::from(count) / f64::from(all);
            Piece {
                patch,
                site: kept as u32,
                of_patch: part(of_patch[patch as usize]),
                of_site: part(of_site[site as usize]),
            }
        })
        .collect()
}
