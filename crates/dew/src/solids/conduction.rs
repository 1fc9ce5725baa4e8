//! Heat through and between solids.

use super::{Searched, Site, Solids};
use crate::air::Scale;
use crate::normalisation::{self, Moments, Tensor};
use crate::room::Room;
use crate::settings::Mean;
use corpuscle_sph::BLOCK;
use corpuscle_sph::kernel::SmoothingKernel;
use rayon::prelude::*;

/// Conductances of all pairs of solid particles within reach of each other, and of the cells of walls behind solids.
#[derive(Debug, Clone, Default)]
pub struct Conduction {
    start: Vec<u32>,
    other: Vec<u32>,
    /// W/K.
    conductance: Vec<f64>,
}

/// Two neighbours at opposite offsets lie within this of each other's mirror image, over the spacing.
const OPPOSITE: f64 = 0.5;

impl Conduction {
    /// Finds the pairs.
    ///
    /// dT_i/dt = (1/(rho_i c_i)) sum_j V_j k_ij (T_j - T_i) lap W_ij (Cleary & Monaghan 1999 with the viscosity kernel's
    /// Laplacian), normalised where the particles stand as they do: see `normalisation/mod.rs`.
    pub fn new(solids: &Solids, room: &Room, scale: &Scale, mean: Mean) -> Self {
        let h = scale.h();
        let all = Searched::new(&solids.sites(room, h, |_| true), h);
        let tensors: Vec<Tensor> =
            (0..solids.particles.len()).into_par_iter().map(|i| tensor(solids, &all, scale, i)).collect();
        let pairs_of = |i: usize| {
            let own = &solids.particles[i];
            let near = all.near(own.position, h).filter(|(_, r_squared)| *r_squared > 0.0);
            let pair = |(site, r_squared): (&Site, f64)| {
                let j = site.particle as usize;
                let offset = [0, 1, 2].map(|axis| site.position[axis] - own.position[axis]);
                let seen = normalisation::mirrored(tensors[j], site.mirrored);
                let factor = normalisation::factor(&tensors[i], offset) + normalisation::factor(&seen, offset);
                let laplacian = 0.5 * factor * scale.kernel.laplacian(r_squared.sqrt()) / scale.moment;
                let volumes = own.volume * solids.particles[j].volume;
                let (own, other) = (solids.material(i), solids.material(j));
                let conductivity = mean.conductivity(own.conductor(), other.conductor());
                (site.particle, volumes * conductivity * laplacian)
            };
            near.map(pair).collect::<Vec<_>>()
        };
        let mut conduction = Self { start: vec![0], ..Self::default() };
        // In blocks, so that lists of pairs do not fill the memory twice.
        for first in (0..solids.particles.len()).step_by(16 * BLOCK) {
            let last = (first + 16 * BLOCK).min(solids.particles.len());
            for pairs in (first..last).into_par_iter().map(pairs_of).collect::<Vec<_>>() {
                for (other, conductance) in pairs {
                    conduction.other.push(other);
                    conduction.conductance.push(conductance);
                }
                conduction.start.push(conduction.other.len() as u32);
            }
        }
        conduction
    }

    /// Adds conductances, W/K, between pairs of `nodes` in all.
    pub(crate) fn connect(&mut self, nodes: usize, links: &[(u32, u32, f64)]) {
        let both = links.iter().flat_map(|&(a, b, conductance)| [(a, b, conductance), (b, a, conductance)]);
        let mut added: Vec<(u32, u32, f64)> = both.collect();
        added.sort_by_key(|&(node, other, _)| (node, other));
        let before = std::mem::replace(self, Self { start: vec![0], ..Self::default() });
        let mut added = added.into_iter().peekable();
        for node in 0..nodes {
            if node + 1 < before.start.len() {
                for (other, conductance) in before.pairs(node) {
                    self.other.push(other as u32);
                    self.conductance.push(conductance);
                }
            }
            while let Some((_, other, conductance)) = added.next_if(|&(of, ..)| of as usize == node) {
                self.other.push(other);
                self.conductance.push(conductance);
            }
            self.start.push(self.other.len() as u32);
        }
    }

    /// The particles that are near one, and the conductances to them, W/K.
    pub(crate) fn pairs(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.start[i] as usize..self.start[i + 1] as usize;
        self.other[range.clone()].iter().map(|&other| other as usize).zip(self.conductance[range].iter().copied())
    }

    /// Heat that flows to particle `i`, W.
    pub fn heat(&self, i: usize, temperatures: &[f64]) -> f64 {
        self.pairs(i).map(|(other, conductance)| conductance * (temperatures[other] - temperatures[i])).sum()
    }

    /// Sum of the conductances of a particle, W/K.
    pub fn sum(&self, i: usize) -> f64 {
        self.pairs(i).map(|(_, conductance)| conductance).sum()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        4 * (self.start.capacity() + self.other.capacity()) + 8 * self.conductance.capacity()
    }
}

/// By which the Laplacian of particle `i` is normalised. A neighbour that has none opposite, at a surface, counts twice, as if the solid
/// went on there.
fn tensor(solids: &Solids, all: &Searched, scale: &Scale, i: usize) -> Tensor {
    let position = solids.particles[i].position;
    let opposite = |site: &Site| {
        let opposite = [0, 1, 2].map(|axis| 2.0 * position[axis] - site.position[axis]);
        all.near(opposite, OPPOSITE * scale.spacing).next().is_some()
    };
    let mut moments = Moments::default();
    for (site, r_squared) in all.near(position, scale.h()).filter(|(_, r_squared)| *r_squared > 0.0) {
        let share = if opposite(site) { 1.0 } else { 2.0 };
        let volume = solids.particles[site.particle as usize].volume;
        let weight = share * volume * scale.kernel.laplacian(r_squared.sqrt()) / (2.0 * scale.moment * r_squared);
        let products = normalisation::products([0, 1, 2].map(|axis| site.position[axis] - position[axis]));
        moments.iter_mut().zip(products).for_each(|(sum, product)| *sum += weight * product);
    }
    normalisation::tensor(&moments)
}
