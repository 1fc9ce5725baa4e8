//! Copies of the air of other processes that is within reach of the own.

use super::from_bytes;
use super::tiles::Tiles;
use crate::air::{HaloParticle, Particle};
use crate::normalisation::Tensor;
use crate::room::Room;
use corpuscle_processes::Link;

/// Numbers that are exchanged for a particle after sums over its neighbours: density and tensor.
const NUMBERS: usize = 7;

/// Copies of the air of other processes.
#[derive(Debug, Default)]
pub(crate) struct Halo {
    /// The particles, by their processes.
    pub particles: Vec<HaloParticle>,
    /// Their densities, kg/m3.
    pub densities: Vec<f64>,
    /// Their normalisation tensors.
    pub tensors: Vec<Tensor>,
    /// Own particles that each of the processes beside this one needs, by their numbers before they are arranged.
    sent: Vec<(usize, Vec<u32>)>,
    outgoing: Vec<(usize, Vec<f64>)>,
    incoming: Vec<(usize, Vec<f64>)>,
}

/// The tiles of the room, with their processes.
pub(super) struct Distribution<'a> {
    pub tiles: &'a Tiles,
    pub owners: &'a [u16],
    /// Whether all tiles round each are its process's own.
    pub is_inner: &'a [bool],
    /// The processes that have tiles beside the own.
    pub beside: &'a [usize],
}

impl Halo {
    /// Sends the own air to the processes that have air within its `reach`, m, or within that of its ghost particles, and takes theirs. Velocities are taken `ahead` s on.
    pub(super) fn fill(
        &mut self,
        link: &dyn Link,
        distribution: &Distribution<'_>,
        air: &[Particle],
        room: &Room,
        reach: f64,
        ahead: f64,
    ) {
        let Distribution { tiles, owners, is_inner, beside } = *distribution;
        self.sent.clear();
        self.sent.extend(beside.iter().map(|process| (*process, Vec::new())));
        for (number, particle) in air.iter().enumerate().filter(|(_, particle)| !is_inner[tiles.of(particle.position)])
        {
            let mut send_to_those_near = |position: [f64; 3]| {
                for tile in tiles.near(position, reach) {
                    let owner = usize::from(owners[tile]);
                    if let Ok(at) = beside.binary_search(&owner) {
                        let numbers = &mut self.sent[at].1;
                        if numbers.last() != Some(&(number as u32)) {
                            numbers.push(number as u32);
                        }
                    }
                }
            };
            send_to_those_near(particle.position);
            room.ghost_particles(particle.position, reach, |ghost| send_to_those_near(ghost.position));
        }
        let copies = |(process, numbers): &(usize, Vec<u32>)| {
            let copy = |number: &u32| HaloParticle::new(&air[*number as usize], ahead);
            (*process, numbers.iter().map(copy).collect::<Vec<_>>())
        };
        let copies: Vec<_> = self.sent.iter().map(copies).collect();
        let bytes: Vec<(usize, &[u8])> =
            copies.iter().map(|(to, copies)| (*to, bytemuck::cast_slice(copies))).collect();
        let received = link.send_receive(&bytes, beside);
        self.particles.clear();
        self.incoming.clear();
        for (process, bytes) in beside.iter().zip(received) {
            let theirs: Vec<HaloParticle> = from_bytes(&bytes);
            self.incoming.push((*process, vec![0.0; NUMBERS * theirs.len()]));
            self.particles.extend(theirs);
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let numbers = |of: &[(usize, Vec<f64>)]| of.iter().map(|(_, numbers)| 8 * numbers.capacity()).sum::<usize>();
        let sent: usize = self.sent.iter().map(|(_, numbers)| 4 * numbers.capacity()).sum();
        let a_particle = size_of::<HaloParticle>() + size_of::<f64>() + size_of::<Tensor>();
        a_particle * self.particles.capacity() + sent + numbers(&self.outgoing) + numbers(&self.incoming)
    }

    /// Exchanges what sums over neighbours have given: densities, and the tensors of the own air and, after them, of the halo. `new_number` is that of
    /// each particle since it was sent.
    pub fn exchange(&mut self, link: &dyn Link, air: &[Particle], new_number: &[u32], tensors: &mut Vec<Tensor>) {
        self.outgoing.clear();
        for (process, numbers) in &self.sent {
            let found = numbers.iter().flat_map(|number| {
                let number = new_number[*number as usize] as usize;
                std::iter::once(air[number].density).chain(tensors[number])
            });
            self.outgoing.push((*process, found.collect()));
        }
        link.exchange(&self.outgoing, &mut self.incoming);
        self.densities.clear();
        self.tensors.clear();
        for [density, tensor @ ..] in self.incoming.iter().flat_map(|(_, numbers)| numbers.as_chunks::<NUMBERS>().0) {
            self.densities.push(*density);
            self.tensors.push(*tensor);
        }
        tensors.extend_from_slice(&self.tensors);
    }
}
