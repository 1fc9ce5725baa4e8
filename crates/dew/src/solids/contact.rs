//! Which air is within reach of which sites of solids.

use super::{Searched, Site, distance_squared};
use crate::air::{Arrangement, Scale};
use crate::settings::WallTreatment;
use rayon::prelude::*;
use std::ops::Range;

/// Sites of one work unit; results never depend on the number of threads.
const SITES_PER_BLOCK: usize = 128;

/// Sites, and the air near each, from both sides.
#[derive(Debug, Default)]
pub struct Contact {
    /// The sites, in the order of their cells.
    pub sites: Vec<Site>,
    /// Volume of each, m3.
    pub volumes: Vec<f64>,
    /// How each keeps air out.
    pub walls: Vec<WallTreatment>,
    blocks: Vec<Block>,
    /// Air particles that have a site near, in order.
    pub near: Vec<Near>,
    pairs: Vec<Pair>,
    count: Vec<u32>,
}

#[derive(Debug, Default)]
struct Block {
    start: Vec<u32>,
    pairs: Vec<Pair>,
}

/// A neighbour on the other side.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Pair {
    /// For a site the index of the air in the arrangement; for air the number of the site.
    pub other: u32,
    /// Distance, m.
    pub r: f64,
}

/// An air particle near a solid.
#[derive(Debug, Clone, PartialEq)]
pub struct Near {
    /// Its number.
    pub particle: u32,
    pairs: Range<usize>,
}

impl Contact {
    /// Between air and these sites.
    pub fn new(
        sites: &[Site],
        volume: impl Fn(&Site) -> f64,
        walls: impl Fn(&Site) -> WallTreatment,
        reach: f64,
    ) -> Self {
        let sites = Searched::new(sites, reach).sites;
        let volumes = sites.iter().map(volume).collect();
        let walls = sites.iter().map(walls).collect();
        Self { sites, volumes, walls, ..Self::default() }
    }

    /// Finds the pairs of neighbours.
    pub fn update(&mut self, arrangement: &Arrangement, scale: &Scale) {
        self.near.clear();
        if self.sites.is_empty() {
            return;
        }
        let h = scale.h();
        self.blocks.resize_with(self.sites.len().div_ceil(SITES_PER_BLOCK), Block::default);
        let blocks = self.blocks.par_iter_mut().zip(self.sites.par_chunks(SITES_PER_BLOCK));
        blocks.for_each(|(block, sites)| block.find(sites, arrangement, h));
        self.turn(arrangement);
    }

    /// Makes the lists of the air from those of the sites.
    fn turn(&mut self, arrangement: &Arrangement) {
        let particles = arrangement.index_of.len();
        self.count.clear();
        self.count.resize(particles, 0);
        let particle = |pair: &Pair| {
            let entry = arrangement.entries[pair.other as usize];
            (!entry.is_ghost_particle).then_some(entry.particle as usize)
        };
        let mut sum = 0;
        for pair in self.blocks.iter().flat_map(|block| &block.pairs) {
            if let Some(particle) = particle(pair) {
                self.count[particle] += 1;
                sum += 1;
            }
        }
        // From here on a count is where the next pair of the particle goes.
        let mut end = 0;
        for (particle, count) in self.count.iter_mut().enumerate().filter(|(_, count)| **count > 0) {
            let start = end;
            end += *count as usize;
            self.near.push(Near { particle: particle as u32, pairs: start..end });
            *count = start as u32;
        }
        self.pairs.resize(sum, Pair::default());
        for site in 0..self.sites.len() {
            for pair in self.blocks[site / SITES_PER_BLOCK].of(site % SITES_PER_BLOCK) {
                if let Some(particle) = particle(pair) {
                    self.pairs[self.count[particle] as usize] = Pair { other: site as u32, r: pair.r };
                    self.count[particle] += 1;
                }
            }
        }
    }

    /// The sites near an air particle.
    pub fn of_air(&self, near: &Near) -> &[Pair] {
        &self.pairs[near.pairs.clone()]
    }

    /// The air near a site.
    pub fn of_site(&self, site: usize) -> &[Pair] {
        self.blocks.get(site / SITES_PER_BLOCK).map_or(&[], |block| block.of(site % SITES_PER_BLOCK))
    }

    /// From a position to a site, m.
    pub fn offset(&self, site: usize, position: [f64; 3]) -> [f64; 3] {
        let of_site = self.sites[site].position;
        [0, 1, 2].map(|axis| of_site[axis] - position[axis])
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let of_blocks: usize = self.blocks.iter().map(|block| block.pairs.capacity() * size_of::<Pair>()).sum();
        let sites = self.sites.capacity() * (size_of::<Site>() + 8);
        of_blocks + sites + self.pairs.capacity() * size_of::<Pair>() + 4 * self.count.capacity()
    }
}

impl Block {
    fn find(&mut self, sites: &[Site], arrangement: &Arrangement, reach: f64) {
        self.start.clear();
        self.pairs.clear();
        self.start.push(0);
        for site in sites {
            if !arrangement.may_be_near(site.position) {
                self.start.push(self.pairs.len() as u32);
                continue;
            }
            for index in arrangement.cells.ranges_within(site.position, reach).flatten() {
                let r_squared = distance_squared(arrangement.at(index), site.position);
                if r_squared < reach * reach {
                    self.pairs.push(Pair { other: index as u32, r: r_squared.sqrt() });
                }
            }
            self.start.push(self.pairs.len() as u32);
        }
    }

    fn of(&self, site: usize) -> &[Pair] {
        &self.pairs[self.start[site] as usize..self.start[site + 1] as usize]
    }
}
