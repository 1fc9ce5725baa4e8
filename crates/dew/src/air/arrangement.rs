//! Particles in the order of their cells, together with their images beyond the faces of the room.

use super::Particle;
use crate::room::Room;
use corpuscle_sph::{Cells, FEWEST, NeighbourLists};
use rayon::prelude::*;

/// What stands at a place of the arrangement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Entry {
    /// The particle, as arranged: itself, or what it is an image of.
    pub particle: u32,
    /// Whether it is an image.
    pub image: bool,
    /// The axes along which the image is mirrored.
    pub mirrored: [bool; 3],
}

/// Particles and images, sorted into cells, with their neighbour lists.
#[derive(Debug, Default)]
pub struct Arrangement {
    /// Cells over particles and images.
    pub cells: Cells<3>,
    /// Neighbour lists of the particles.
    pub lists: NeighbourLists,
    /// What stands at each place.
    pub entries: Vec<Entry>,
    /// Place of each particle.
    pub place_of: Vec<u32>,
    /// Coordinates of the places, m.
    pub x: Vec<f64>,
    /// Coordinates of the places, m.
    pub y: Vec<f64>,
    /// Coordinates of the places, m.
    pub z: Vec<f64>,
    unsorted: [Vec<f64>; 3],
    images: Vec<Entry>,
    new_number: Vec<u32>,
    spare: Vec<Particle>,
}

impl Arrangement {
    /// Sorts the particles, and makes images of those within `reach` of a face.
    pub fn arrange(&mut self, particles: &mut Vec<Particle>, room: &Room, reach: f64) {
        let count = particles.len();
        for (axis, values) in self.unsorted.iter_mut().enumerate() {
            particles.par_iter().with_min_len(FEWEST).map(|p| p.position[axis]).collect_into_vec(values);
        }
        self.add_images(particles, room, reach);
        let [x, y, z] = &self.unsorted;
        let order = self.cells.sort([x, y, z], Cells::<3>::sizes_for(reach));
        for (out, values) in [(&mut self.x, x), (&mut self.y, y), (&mut self.z, z)] {
            order.par_iter().with_min_len(FEWEST).map(|&from| values[from as usize]).collect_into_vec(out);
        }
        self.place_of.clear();
        self.spare.clear();
        self.new_number.resize(count, 0);
        for (place, &from) in order.iter().enumerate() {
            if let Some(particle) = particles.get(from as usize) {
                self.new_number[from as usize] = self.spare.len() as u32;
                self.place_of.push(place as u32);
                self.spare.push(*particle);
            }
        }
        std::mem::swap(particles, &mut self.spare);
        let (images, new_number) = (&self.images, &self.new_number);
        let entry = |&from: &u32| match (from as usize).checked_sub(count) {
            None => Entry { particle: new_number[from as usize], image: false, mirrored: [false; 3] },
            Some(image) => {
                let image = images[image];
                Entry { particle: new_number[image.particle as usize], ..image }
            }
        };
        order.par_iter().with_min_len(FEWEST).map(entry).collect_into_vec(&mut self.entries);
    }

    fn add_images(&mut self, particles: &[Particle], room: &Room, reach: f64) {
        self.images.clear();
        for (number, particle) in particles.iter().enumerate() {
            room.images(particle.position, reach, |image| {
                self.images.push(Entry { particle: number as u32, image: true, mirrored: image.mirrored });
                self.unsorted.iter_mut().zip(image.position).for_each(|(values, at)| values.push(at));
            });
        }
    }

    /// The places' coordinates.
    pub fn places(&self) -> [&[f64]; 3] {
        [&self.x, &self.y, &self.z]
    }

    /// Where a place is, m.
    pub fn at(&self, place: usize) -> [f64; 3] {
        [self.x[place], self.y[place], self.z[place]]
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let columns = 6 * 8 * self.x.capacity();
        let spare = self.spare.capacity() * size_of::<Particle>();
        let numbers = 4 * (self.place_of.capacity() + self.new_number.capacity());
        self.cells.bytes()
            + self.lists.bytes()
            + columns
            + spare
            + numbers
            + size_of::<Entry>() * self.entries.capacity()
    }
}
