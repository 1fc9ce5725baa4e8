//! Particles in cell order, together with their images beyond the edges.

use crate::edges::{EdgeRules, Image};
use corpuscle_sph::{Cells, NeighbourLists};

/// One place in the arrangement: a particle itself, or its image beyond an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Entry {
    /// The particle, as numbered before arranging.
    pub from: u32,
    /// Where its image stands.
    pub image: Image,
}

/// How far from an edge a particle has an image, in reaches: some of those beyond it reach farther than itself.
const IMAGE_MARGIN: f64 = 1.5;

/// Stands for no particle: an image.
pub const IMAGE: u32 = u32::MAX;

/// Particles and images, sorted into cells, with their neighbour lists.
#[derive(Debug, Default)]
pub struct Arrangement {
    /// Cells over particles and images.
    pub cells: Cells,
    /// Neighbour lists over particles and images.
    pub lists: NeighbourLists,
    /// What stands at each place of the sorted order.
    pub entries: Vec<Entry>,
    /// The place of each particle, in sorted order.
    pub real: Vec<u32>,
    /// The particle at each place, in sorted order; [`IMAGE`] for an image.
    pub particle: Vec<u32>,
    /// The images: their place and the place of the particle that they show.
    pub images: Vec<(u32, u32)>,
    /// Places, sorted.
    pub x: Vec<f64>,
    /// Places, sorted.
    pub y: Vec<f64>,
    /// Squares of the reaches, sorted.
    pub reach_squared: Vec<f64>,
    reach: Vec<f64>,
    unsorted: Unsorted,
}

#[derive(Debug, Default)]
struct Unsorted {
    entries: Vec<Entry>,
    x: Vec<f64>,
    y: Vec<f64>,
    reach: Vec<f64>,
    place_of: Vec<u32>,
}

impl Arrangement {
    /// Arranges particles given as (x, y, reach) and their images beyond the edges.
    pub fn arrange(&mut self, particles: impl Iterator<Item = (f64, f64, f64)>, edges: &EdgeRules, cell_size: f64) {
        let before = &mut self.unsorted;
        before.entries.clear();
        before.x.clear();
        before.y.clear();
        before.reach.clear();
        for (from, (x, y, reach)) in particles.enumerate() {
            let mut put = |image: Image, x: f64, y: f64| {
                before.entries.push(Entry { from: from as u32, image });
                before.x.push(x);
                before.y.push(y);
                before.reach.push(reach);
            };
            put(Image::NONE, x, y);
            edges.images(x, y, IMAGE_MARGIN * reach, put);
        }
        let order = self.cells.sort(&before.x, &before.y, cell_size);
        gather(&mut self.entries, order, &before.entries);
        gather(&mut self.x, order, &before.x);
        gather(&mut self.y, order, &before.y);
        gather(&mut self.reach, order, &before.reach);
        self.reach_squared.clear();
        self.reach_squared.extend(self.reach.iter().map(|reach| reach * reach));
        self.cells.set_reach(&self.reach);
        self.find_images();
    }

    fn find_images(&mut self) {
        let place_of = &mut self.unsorted.place_of;
        place_of.clear();
        place_of.resize(self.entries.len(), 0);
        self.real.clear();
        self.particle.clear();
        for (place, entry) in self.entries.iter().enumerate() {
            if entry.image == Image::NONE {
                place_of[entry.from as usize] = place as u32;
                self.particle.push(self.real.len() as u32);
                self.real.push(place as u32);
            } else {
                self.particle.push(IMAGE);
            }
        }
        self.images.clear();
        if self.real.len() < self.entries.len() {
            let images = self.entries.iter().enumerate().filter(|(_, entry)| entry.image != Image::NONE);
            self.images.extend(images.map(|(place, entry)| (place as u32, place_of[entry.from as usize])));
        }
    }

    /// Brings `particles` into sorted order, by way of `spare`.
    pub fn sort<T: Copy>(&self, particles: &mut Vec<T>, spare: &mut Vec<T>) {
        spare.clear();
        spare.extend(self.real.iter().map(|&place| particles[self.entries[place as usize].from as usize]));
        std::mem::swap(particles, spare);
    }

    /// Places in the arrangement: particles and images.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.cells.bytes() + self.lists.bytes() + self.len() * (2 * 8 + 8 * 4 + 8 * 3 + 4)
    }
}

fn gather<T: Copy>(out: &mut Vec<T>, order: &[u32], values: &[T]) {
    out.clear();
    out.extend(order.iter().map(|&from| values[from as usize]));
}
