//! The part of the air that one of several processes computes, and what it exchanges with the others.
//!
//! The room is divided into tiles, each of which belongs to a process (`tiles.rs`). A process has the air in its tiles, and copies of the air
//! of others within reach of it (`halo.rs`). Solids are whole at every process, their temperatures, the water and the drops on them: each process finds what air and
//! solids exchange in its tiles (`solids.rs`) and sends it to all, and what follows from it is the same everywhere. Neighbours stand in the same order at every process,
//! and sums over the air are exact: results have the same bits for any number of processes.

mod halo;
mod solids;
mod tiles;

pub(crate) use halo::Halo;

use crate::air::{Part, Particle, Role};
use crate::normalisation::Tensor;
use crate::room::Room;
use bytemuck::Pod;
use corpuscle_processes::{Lead, Link, MAX_IMBALANCE, Processes, imbalance};
use halo::Distribution;
use std::sync::Arc;
use tiles::Tiles;

/// Room for rounding where a part ends, over the reach.
const MARGIN: f64 = 1e-6;

/// The part of a process, and its connections to the others.
pub(crate) struct Domain {
    link: Arc<dyn Link>,
    tiles: Tiles,
    /// The process of each tile.
    owners: Vec<u16>,
    /// Whether all tiles round each are its process's own.
    is_inner: Vec<bool>,
    /// The processes that have tiles beside the own, in order.
    beside: Vec<usize>,
    pub halo: Halo,
    /// The part of the room within reach of the own air.
    pub part: Part,
    /// Particles of air of all processes, and those of them in the room.
    pub air: [usize; 2],
    /// Set where the model is set up, so that the other processes wait for commands.
    lead: Option<Lead>,
}

impl Domain {
    /// The part of a process of a room whose air has such a reach, m; none where it is alone.
    pub fn new(processes: &Processes, room: &Room, reach: f64) -> Option<Self> {
        let link = processes.link()?;
        let tiles = Tiles::new(room, reach);
        let mut domain = Self {
            link: Arc::clone(link),
            owners: Vec::new(),
            is_inner: Vec::new(),
            beside: Vec::new(),
            halo: Halo::default(),
            part: Part::WHOLE,
            air: [0; 2],
            lead: None,
            tiles,
        };
        domain.assign(domain.owners_for(&vec![1.0; domain.tiles.len()]), room, reach);
        Some(domain)
    }

    /// From here on the other processes wait for commands of the first.
    pub fn lead(&mut self, processes: &Processes) {
        self.lead = Some(processes.lead());
    }

    /// The process of each tile, by the work in each.
    fn owners_for(&self, work: &[f64]) -> Vec<u16> {
        tiles::owners(self.tiles.counts, work, self.link.count())
    }

    /// Gives tiles to processes. The air moves when it is shared next.
    fn assign(&mut self, owners: Vec<u16>, room: &Room, reach: f64) {
        self.owners = owners;
        let own = self.link.rank();
        let is_own = |tile: usize| usize::from(self.owners[tile]) == own;
        self.is_inner = vec![false; self.tiles.len()];
        self.beside.clear();
        for tile in (0..self.tiles.len()).filter(|tile| is_own(*tile)) {
            self.is_inner[tile] = self.tiles.round(tile).all(is_own);
            self.beside.extend(self.tiles.round(tile).map(|near| usize::from(self.owners[near])));
        }
        self.beside.sort_unstable();
        self.beside.dedup();
        self.beside.retain(|process| *process != own);
        let bounds = self.tiles.bounds((0..self.tiles.len()).filter(|tile| is_own(*tile)));
        let margin = (1.0 + MARGIN) * reach;
        self.part = bounds.map_or(Part([room.low; 2]), |[low, high]| {
            Part([low.map(|corner| corner - margin), high.map(|corner| corner + margin)])
        });
    }

    fn owner(&self, position: [f64; 3]) -> usize {
        usize::from(self.owners[self.tiles.of(position)])
    }

    /// Whether this process computes what is at a position.
    pub fn owns(&self, position: [f64; 3]) -> bool {
        self.owner(position) == self.link.rank()
    }

    /// Sends the air that has left this part to its processes, takes what has come, and fills the halo, whose velocities are taken `ahead` s on.
    pub fn share(&mut self, processes: &Processes, air: &mut Vec<Particle>, room: &Room, reach: f64, ahead: f64) {
        let mut outgoing: Vec<(usize, Vec<Particle>)> = Vec::new();
        air.retain(|particle| {
            let owner = self.owner(particle.position);
            let stays = owner == self.link.rank();
            if !stays {
                match outgoing.iter_mut().find(|(process, _)| *process == owner) {
                    Some((_, particles)) => particles.push(*particle),
                    None => outgoing.push((owner, vec![*particle])),
                }
            }
            stays
        });
        let incoming: Vec<(usize, Vec<Particle>)> = processes.swap(outgoing);
        air.extend(incoming.into_iter().flat_map(|(_, particles)| particles));
        self.air = total_of(processes, air);
        let Self { link, tiles, owners, is_inner, beside, halo, .. } = self;
        halo.fill(&**link, &Distribution { tiles, owners, is_inner, beside }, air, room, reach, ahead);
    }

    /// Moves tiles to other processes where the work is distributed too unevenly. The air moves when it is shared next.
    pub fn balance(&mut self, processes: &Processes, air: &[Particle], room: &Room, reach: f64) {
        let mut work = self.work(air);
        processes.total(&mut work, &mut []);
        let work: Vec<f64> = work.into_iter().map(|count| count as f64).collect();
        let imbalance = |owners: &[u16]| imbalance(owners, &work, processes.count());
        let present = imbalance(&self.owners);
        if present > MAX_IMBALANCE {
            let owners = self.owners_for(&work);
            if imbalance(&owners) < present {
                self.assign(owners, room, reach);
            }
        }
    }

    /// Keeps of the whole air, which all processes have, the part of this one.
    pub fn keep_part(&mut self, air: &mut Vec<Particle>, room: &Room, reach: f64) {
        let inside = air.iter().filter(|particle| particle.role == Role::Inside).count();
        self.air = [air.len(), inside];
        let work: Vec<f64> = self.work(air).into_iter().map(|count| count as f64).collect();
        self.assign(self.owners_for(&work), room, reach);
        air.retain(|particle| self.owns(particle.position));
    }

    /// Exchanges densities and tensors of the air that was shared and then arranged.
    pub fn exchange(&mut self, air: &[Particle], new_number: &[u32], tensors: &mut Vec<Tensor>) {
        self.halo.exchange(&*self.link, air, new_number, tensors);
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        3 * self.tiles.len() + self.halo.bytes()
    }

    /// Number of particles in each tile.
    fn work(&self, air: &[Particle]) -> Vec<i64> {
        let mut work = vec![0; self.tiles.len()];
        air.iter().for_each(|particle| work[self.tiles.of(particle.position)] += 1);
        work
    }
}

/// What was sent as bytes, which need not be aligned.
fn from_bytes<T: Pod>(bytes: &[u8]) -> Vec<T> {
    bytes.chunks_exact(size_of::<T>()).map(bytemuck::pod_read_unaligned).collect()
}

/// Particles of air, and those in the room, of all processes.
fn total_of(processes: &Processes, air: &[Particle]) -> [usize; 2] {
    let inside = air.iter().filter(|particle| particle.role == Role::Inside).count();
    let mut counts = [air.len(), inside].map(|count| count as i64);
    processes.total(&mut counts, &mut []);
    counts.map(|count| count as usize)
}
