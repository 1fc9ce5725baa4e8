//! Heat, vapour and water between air and solids in a step.

use super::Dew;
use super::accelerated::Taken;
use super::motion::larger;
use crate::air::{Particle, Rates, Role, order_of};
use crate::exchange::{Exchange, ToAir, Work, excess};
use crate::room::Face;
use crate::settings::Condensation;
use crate::state::State;
use corpuscle_model::ExactSum;
use rayon::prelude::*;

/// Particles that are summed up on one thread.
const SUMMED_TOGETHER: usize = 4096;

/// Water that a particle of air deposits: its order among the air of all processes, the water, kg, and the shares of boundary particles.
type Deposit = (([u32; 3], u64), f64, Vec<(u32, f64)>);

impl Dew {
    /// What air and solids exchange as they stand.
    fn at_surfaces(&self) -> Exchange<'_> {
        Exchange {
            contact: &self.contact,
            arrangement: &self.arrangement,
            columns: &self.columns,
            solids: &self.solids,
            temperatures: &self.state.temperatures,
            water: &self.state.water_on,
            evaporation: &self.evaporation,
            scale: &self.scale,
            air: &self.air,
            settings: &self.settings,
            latent_heat: self.latent_heat,
        }
    }

    /// Heat and vapour between air and solids, and through solids, in a step.
    pub(super) fn exchange(&mut self, step: f64) {
        let mut work = std::mem::take(&mut self.work);
        let Work { to_solids, to_air, share_of, heat, stiff, supplied, .. } = &mut work;
        supplied.resize(self.state.supplied.len(), [0.0; 3]);
        let exchange = self.at_surfaces();
        let factor = self.settings.time_factor;
        exchange.to_solids(factor * step, |site| self.owns(site.position), to_solids);
        let particles = self.solids.particles.len();
        share_of.clear();
        share_of.resize(particles, 1.0);
        let nodes = self.domain.as_ref().map_or(0..self.solids.nodes(), |domain| domain.own_nodes(self.solids.nodes()));
        let conducted = |i| if nodes.contains(&i) { self.conduction.heat(i, &self.state.temperatures) } else { 0.0 };
        (0..self.solids.nodes()).into_par_iter().with_min_len(1024).map(conducted).collect_into_vec(heat);
        if let Some(domain) = &self.domain {
            domain.complete(&self.contact.sites, to_solids, heat);
        }
        stiff.clear();
        stiff.resize(self.contact.near.len(), 0.0);
        stiff.extend_from_slice(&self.conductances);
        let (of_air, of_solids) = stiff.split_at_mut(self.contact.near.len());
        let real = self.contact.sites.iter().zip(&*to_solids).filter(|(site, _)| !site.is_ghost_particle);
        for (site, given) in real.clone() {
            let particle = site.particle as usize;
            share_of[particle] = given.share;
            heat[particle] += given.heat;
            of_solids[particle] += given.conductance;
        }
        exchange.to_air(share_of, to_air);
        self.state.heat_flow.fill(0.0);
        let middle = self.state.time + 0.5 * step;
        self.sources.add_heat(middle, &self.solids, &self.state.temperatures, heat, of_solids, supplied);
        let books = self.processes.is_first();
        for (sums, watts) in self.state.supplied.iter_mut().zip(&*supplied) {
            for (sum, &watts) in sums.iter_mut().zip(watts) {
                sum.add(factor * step * watts);
                if books {
                    self.state.energy.book(factor * step * watts);
                }
            }
        }
        let mut taken = Taken::default();
        for (site, given) in real {
            taken.add(step * given.heat, step * given.water);
            self.state.heat_flow[self.solids.particles[site.particle as usize].body as usize] += given.heat;
            // What rounding leaves of the last of the water is nothing.
            let water = &mut self.state.water_on[site.particle as usize];
            *water = larger(*water + factor * step * given.water, 0.0);
        }
        for (i, &heat) in heat.iter().enumerate() {
            of_solids[i] *= factor / self.solids.heat_capacity(i);
            let heat = factor * heat;
            if self.solids.is_held(i) {
                self.state.held_heat[self.solids.particles[i].body as usize].add(-step * heat);
                if books {
                    self.state.energy.book(-step * heat);
                }
                of_solids[i] = 0.0;
            } else {
                self.state.temperatures[i] += step * heat / self.solids.heat_capacity(i);
            }
        }
        self.accelerate(&taken);
        self.book_open_faces(step, to_air);
        for ((near, given), stiff) in self.contact.near.iter().zip(&*to_air).zip(of_air) {
            let rates = &mut self.rates[near.particle as usize];
            rates.warming += given.warming;
            rates.moistening += given.moistening;
            *stiff = given.stiffness;
        }
        self.work = work;
    }

    /// Books what diffuses across open faces. Between particles in the room all cancels, so what they gain together has come
    /// from beyond; what solids give to air beyond has left, and what air in the room gets from ghost particles of solids beyond has come from there.
    fn book_open_faces(&mut self, step: f64, to_air: &[ToAir]) {
        // Even where no air is beyond, ghost particles of solids may be.
        if !self.room.faces.iter().flatten().any(Face::is_passed) {
            return;
        }
        let State { air, water, energy, .. } = &mut self.state;
        let mass = self.air.density * self.scale.volume;
        let energy_of = |warming: f64, moistening: f64| {
            mass * step * (self.air.heat_capacity * warming + self.latent_heat * moistening)
        };
        let sum = |(air, rates): (&[Particle], &[Rates])| {
            let mut sums = [ExactSum::default(); 2];
            for (_, rates) in air.iter().zip(rates).filter(|(particle, _)| particle.role == Role::Inside) {
                sums[0].add(mass * step * rates.moistening);
                sums[1].add(energy_of(rates.warming, rates.moistening));
            }
            sums
        };
        let both = |mut sums: [ExactSum; 2], others: [ExactSum; 2]| {
            sums.iter_mut().zip(&others).for_each(|(sum, other)| sum.add_sum(other));
            sums
        };
        let chunks = air.par_chunks(SUMMED_TOGETHER).zip(self.rates.par_chunks(SUMMED_TOGETHER));
        let mut gained = chunks.map(sum).reduce(<[ExactSum; 2]>::default, both);
        self.processes.total(&mut [], &mut gained.each_mut());
        if self.processes.is_first() {
            water.book(gained[0].value());
            energy.book(gained[1].value());
        }
        for (near, given) in self.contact.near.iter().zip(to_air) {
            let [warming, moistening] = given.from_beyond;
            let [warming, moistening] = match air[near.particle as usize].role {
                Role::Inside => [warming, moistening],
                _ => [warming - given.warming, moistening - given.moistening],
            };
            if [warming, moistening] != [0.0; 2] {
                water.book(mass * step * moistening);
                energy.book(energy_of(warming, moistening));
            }
        }
    }

    /// What is beyond saturation condenses: at a surface onto it where that is required, else as fog, which evaporates
    /// again in drier air.
    pub(super) fn saturate(&mut self, step: f64) {
        if !self.settings.fog && self.settings.condensation != Condensation::Particle {
            return;
        }
        let mut excesses = std::mem::take(&mut self.work.excesses);
        let Self { air, state, latent_heat, .. } = &*self;
        let find = |particle: &Particle| {
            let near_saturation = particle.role == Role::Inside
                && (particle.fog > 0.0 || particle.vapour > crate::exchange::saturation(particle.temperature, air));
            if near_saturation { excess(particle, air, *latent_heat).max(-particle.fog) } else { 0.0 }
        };
        state.air.par_iter().with_min_len(1024).map(find).collect_into_vec(&mut excesses);
        self.deposit(&mut excesses, step);
        if self.settings.fog {
            self.turn_to_fog(&excesses);
        }
        self.work.excesses = excesses;
    }

    /// What particles have too much becomes fog, or fog becomes what they lack.
    fn turn_to_fog(&mut self, excesses: &[f64]) {
        let mass = self.particle_mass();
        let warming = self.latent_heat / self.air.heat_capacity;
        for (particle, &excess) in self.state.air.iter_mut().zip(excesses).filter(|(_, excess)| **excess != 0.0) {
            particle.vapour -= excess;
            particle.fog += excess;
            particle.temperature += warming * excess;
            self.state.fogged.add(mass * excess);
        }
    }

    /// Deposits the excess of particles at a surface onto it, with its heat, and removes it from `excesses`.
    fn deposit(&mut self, excesses: &mut [f64], step: f64) {
        let mass = self.particle_mass();
        let mut shares = std::mem::take(&mut self.work.shares);
        // Of several processes, to be told to all.
        let mut told: Vec<Deposit> = Vec::new();
        for at in 0..self.contact.near.len() {
            let particle = self.contact.near[at].particle as usize;
            if excesses[particle] > 0.0 {
                self.at_surfaces().shares(&self.contact.near[at], &mut shares);
                if !shares.is_empty() {
                    let water = mass * std::mem::replace(&mut excesses[particle], 0.0);
                    self.take_from_air(particle, water, &shares);
                    if self.domain.is_some() {
                        let order = order_of(&self.state.air[particle], &self.room, self.scale.h());
                        told.push((order, water, shares.clone()));
                    } else {
                        self.deposit_of(water, &shares, step);
                    }
                }
            }
        }
        if self.domain.is_some() {
            let mut all: Vec<Deposit> = self.processes.gather_all(told).into_iter().flatten().collect();
            // As one process finds them.
            all.sort_unstable_by_key(|(order, ..)| *order);
            all.iter().for_each(|(_, water, shares)| self.deposit_of(*water, shares, step));
        }
        self.work.shares = shares;
    }

    /// Part of the heat that condensation sets free at the surface at a boundary particle which the solid takes: the better conductor takes the most of it.
    fn to_solid(&self, site: usize) -> f64 {
        let conductivity = self.solids.material(site).conductivity;
        conductivity / (conductivity + self.air.conductivity)
    }

    /// Takes the vapour of water that is deposited, kg, from an air particle, and gives it its part of the heat.
    fn take_from_air(&mut self, particle: usize, water: f64, shares: &[(u32, f64)]) {
        let mass = self.particle_mass();
        self.state.air[particle].vapour -= water / mass;
        for &(site, share) in shares {
            let heat = self.latent_heat * water * share;
            let kept = 1.0 - self.to_solid(site as usize);
            self.state.air[particle].temperature += kept * heat / (mass * self.air.heat_capacity);
        }
    }

    /// Deposits water of an air particle, kg, onto the boundary particles near it by their shares.
    fn deposit_of(&mut self, water: f64, shares: &[(u32, f64)], step: f64) {
        let factor = self.settings.time_factor;
        let mut taken = Taken::default();
        for &(site, share) in shares {
            let site = site as usize;
            let heat = self.latent_heat * water * share;
            self.state.water_on[site] += factor * water * share;
            let to_solid = self.to_solid(site);
            self.state.heat_flow[self.solids.particles[site].body as usize] += to_solid * heat / step;
            taken.add(to_solid * heat, water * share);
            let heat = factor * heat;
            if self.solids.is_held(site) {
                self.state.held_heat[self.solids.particles[site].body as usize].add(-to_solid * heat);
                if self.processes.is_first() {
                    self.state.energy.book(-to_solid * heat);
                }
            } else {
                self.state.temperatures[site] += to_solid * heat / self.solids.heat_capacity(site);
            }
        }
        self.accelerate(&taken);
    }
}
