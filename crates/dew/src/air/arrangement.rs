//! Particles in the order of their cells, together with their ghost particles beyond the faces of the room.
//!
//! Cells are the same for any distribution of the air over processes, and within a cell particles stand by their identities: so neighbours have the same order
//! everywhere.

use super::{HaloParticle, Particle};
use crate::constants::BEYOND;
use crate::room::{Face, Room};
use corpuscle_sph::{Cells, FEWEST, NeighbourLists};
use rayon::prelude::*;

/// What stands at an index of the arrangement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Entry {
    /// The particle, as arranged: itself, or what it is a ghost particle of. Those of the halo are counted after the own.
    pub particle: u32,
    /// Whether it is a ghost particle, or of the halo: its neighbours are not searched.
    pub is_ghost_particle: bool,
    /// The axes along which the ghost particle is mirrored.
    pub mirrored: [bool; 3],
}

/// Particles and ghost particles, sorted into cells, with their neighbour lists.
#[derive(Debug, Default)]
pub struct Arrangement {
    /// Cells over particles and ghost particles.
    pub cells: Cells<3>,
    /// Neighbour lists of the particles.
    pub lists: NeighbourLists,
    /// What stands at each index.
    pub entries: Vec<Entry>,
    /// Index of each particle.
    pub index_of: Vec<u32>,
    /// Coordinates of the positions, m.
    pub x: Vec<f64>,
    /// Coordinates of the positions, m.
    pub y: Vec<f64>,
    /// Coordinates of the positions, m.
    pub z: Vec<f64>,
    unsorted: [Vec<f64>; 3],
    ids: Vec<u64>,
    ghosts: Vec<Entry>,
    /// Number of each particle after the last sort, by that before.
    pub new_number: Vec<u32>,
    /// The part of the room that the own particles are in.
    part: Part,
    spare: Vec<Particle>,
}

/// A part of the room as a box: its lowest and its highest corner, m, with `reach` to the sides where the room goes on, and without bounds where it ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Part(pub [[f64; 3]; 2]);

impl Default for Part {
    fn default() -> Self {
        Self::WHOLE
    }
}

impl Part {
    /// The whole room.
    pub const WHOLE: Self = Self([[f64::NEG_INFINITY; 3], [f64::INFINITY; 3]]);

    /// Whether a position lies in it.
    pub fn contains(&self, position: [f64; 3]) -> bool {
        (0..3).all(|axis| (self.0[0][axis]..=self.0[1][axis]).contains(&position[axis]))
    }
}

/// The box that holds a room and all particles and ghost particles beyond its faces: its lowest and its highest corner, m.
fn with_what_is_beyond(room: &Room, reach: f64) -> [[f64; 3]; 2] {
    let margin = |face: &Face| if face.is_passed() { (BEYOND + 1.0) * reach } else { reach };
    let end = |side: usize, sign: f64| {
        let corner = [room.low, room.high][side];
        [0, 1, 2].map(|axis| corner[axis] + sign * margin(&room.faces[axis][side]))
    };
    [end(0, -1.0), end(1, 1.0)]
}

/// The order of a particle among the air of all processes, once arranged: by its cell, then by its identity.
pub(crate) fn order_of(particle: &Particle, room: &Room, reach: f64) -> ([u32; 3], u64) {
    let ([low, _], sizes) = (with_what_is_beyond(room, reach), Cells::<3>::sizes_for(reach));
    // As the cells number theirs.
    let along = |axis: usize| ((particle.position[axis] - low[axis]) * (1.0 / sizes[axis])) as u32;
    ([along(2), along(1), along(0)], particle.id)
}

impl Arrangement {
    /// Sorts the particles and those of the halo, and makes ghost particles of those within `reach` of a face. The particles are in a `part` of the room.
    pub fn arrange(
        &mut self,
        particles: &mut Vec<Particle>,
        halo: &[HaloParticle],
        room: &Room,
        reach: f64,
        part: Part,
    ) {
        let count = particles.len();
        for (axis, values) in self.unsorted.iter_mut().enumerate() {
            particles.par_iter().with_min_len(FEWEST).map(|p| p.position[axis]).collect_into_vec(values);
        }
        particles.par_iter().with_min_len(FEWEST).map(|particle| particle.id).collect_into_vec(&mut self.ids);
        self.add_ghost_particles(particles, halo, room, reach);
        self.part = part;
        let [x, y, z] = &self.unsorted;
        let [low, high] = with_what_is_beyond(room, reach);
        let clamped = part.0.map(|corner| [0, 1, 2].map(|axis| corner[axis].clamp(low[axis], high[axis])));
        self.cells.sort_part([x, y, z], Cells::<3>::sizes_for(reach), low, clamped);
        let ids = &self.ids;
        let order = self.cells.sort_each_cell_by(|from| ids[from as usize]);
        for (out, values) in [(&mut self.x, x), (&mut self.y, y), (&mut self.z, z)] {
            order.par_iter().with_min_len(FEWEST).map(|&from| values[from as usize]).collect_into_vec(out);
        }
        self.index_of.clear();
        self.spare.clear();
        self.new_number.resize(count, 0);
        for (index, &from) in order.iter().enumerate() {
            if let Some(particle) = particles.get(from as usize) {
                self.new_number[from as usize] = self.spare.len() as u32;
                self.index_of.push(index as u32);
                self.spare.push(*particle);
            }
        }
        std::mem::swap(particles, &mut self.spare);
        let (ghosts, new_number) = (&self.ghosts, &self.new_number);
        let entry = |&from: &u32| match (from as usize).checked_sub(count) {
            None => Entry { particle: new_number[from as usize], is_ghost_particle: false, mirrored: [false; 3] },
            Some(ghost) => {
                let ghost = ghosts[ghost];
                let particle = new_number.get(ghost.particle as usize).copied().unwrap_or(ghost.particle);
                Entry { particle, ..ghost }
            }
        };
        order.par_iter().with_min_len(FEWEST).map(entry).collect_into_vec(&mut self.entries);
    }

    /// Adds ghost particles of particles, and the halo with its ghost particles.
    fn add_ghost_particles(&mut self, particles: &[Particle], halo: &[HaloParticle], room: &Room, reach: f64) {
        self.ghosts.clear();
        let Self { ghosts, unsorted, ids, .. } = self;
        let mut add = |number: usize, id: u64, position: [f64; 3], mirrored: [bool; 3]| {
            ghosts.push(Entry { particle: number as u32, is_ghost_particle: true, mirrored });
            unsorted.iter_mut().zip(position).for_each(|(values, at)| values.push(at));
            ids.push(id);
        };
        for (number, particle) in particles.iter().enumerate() {
            room.ghost_particles(particle.position, reach, |ghost| {
                add(number, particle.id, ghost.position, ghost.mirrored)
            });
        }
        for (number, particle) in (particles.len()..).zip(halo) {
            add(number, particle.id, particle.position, [false; 3]);
            room.ghost_particles(particle.position, reach, |ghost| {
                add(number, particle.id, ghost.position, ghost.mirrored)
            });
        }
    }

    /// Whether air in the part that was arranged can be within the reach of a position.
    pub fn may_be_near(&self, position: [f64; 3]) -> bool {
        self.part.contains(position)
    }

    /// Coordinates of the positions, by axis, m.
    pub fn positions(&self) -> [&[f64]; 3] {
        [&self.x, &self.y, &self.z]
    }

    /// Position of what stands at an index, m.
    pub fn at(&self, index: usize) -> [f64; 3] {
        [self.x[index], self.y[index], self.z[index]]
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let columns = 7 * 8 * self.x.capacity();
        let spare = self.spare.capacity() * size_of::<Particle>();
        let numbers = 4 * (self.index_of.capacity() + self.new_number.capacity());
        self.cells.bytes()
            + self.lists.bytes()
            + columns
            + spare
            + numbers
            + size_of::<Entry>() * self.entries.capacity()
    }
}
