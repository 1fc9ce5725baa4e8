//! Heat, vapour and water between air and solids in a step.

use super::accelerated::Taken;
use super::{Dew, State};
use crate::air::{Particle, Role};
use crate::exchange::{Exchange, ToAir, Work, excess};
use crate::room::Face;
use crate::settings::Condensation;
use corpuscle_model::CompensatedSum;
use rayon::prelude::*;

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
        exchange.to_solids(factor * step, to_solids);
        let particles = self.solids.particles.len();
        share_of.clear();
        share_of.resize(particles, 1.0);
        let conducted = |i| self.conduction.heat(i, &self.state.temperatures);
        (0..self.solids.nodes()).into_par_iter().with_min_len(1024).map(conducted).collect_into_vec(heat);
        stiff.clear();
        stiff.resize(self.contact.near.len(), 0.0);
        stiff.extend_from_slice(&self.conductances);
        let (of_air, of_solids) = stiff.split_at_mut(self.contact.near.len());
        let real = self.contact.sites.iter().zip(&*to_solids).filter(|(site, _)| !site.image);
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
        for (sums, watts) in self.state.supplied.iter_mut().zip(&*supplied) {
            for (sum, &watts) in sums.iter_mut().zip(watts) {
                sum.add(factor * step * watts);
                self.state.energy.book(factor * step * watts);
            }
        }
        let mut taken = Taken::default();
        for (site, given) in real {
            taken.add(step * given.heat, step * given.water);
            self.state.heat_flow[self.solids.particles[site.particle as usize].body as usize] += given.heat;
            // What rounding leaves of the last of the water is nothing.
            let water = &mut self.state.water_on[site.particle as usize];
            *water = (*water + factor * step * given.water).max(0.0);
        }
        for (i, &heat) in heat.iter().enumerate() {
            of_solids[i] *= factor / self.solids.heat_capacity(i);
            let heat = factor * heat;
            if self.solids.is_held(i) {
                self.state.held_heat[self.solids.particles[i].body as usize].add(-step * heat);
                self.state.energy.book(-step * heat);
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
    /// from beyond; what solids give to air beyond has left, and what air in the room gets from images of solids beyond has come from there.
    fn book_open_faces(&mut self, step: f64, to_air: &[ToAir]) {
        // Even where no air is beyond, images of solids may be.
        if !self.room.faces.iter().flatten().any(Face::is_passed) {
            return;
        }
        let State { air, water, energy, .. } = &mut self.state;
        let mass = self.air.density * self.scale.volume;
        let energy_of = |warming: f64, moistening: f64| {
            mass * step * (self.air.heat_capacity * warming + self.latent_heat * moistening)
        };
        let inside = || air.iter().zip(&self.rates).filter(|(particle, _)| particle.role == Role::Inside);
        let gained: CompensatedSum = inside().map(|(_, rates)| mass * step * rates.moistening).collect();
        water.book(gained.value());
        let gained: CompensatedSum = inside().map(|(_, rates)| energy_of(rates.warming, rates.moistening)).collect();
        energy.book(gained.value());
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
        for at in 0..self.contact.near.len() {
            let particle = self.contact.near[at].particle as usize;
            if excesses[particle] > 0.0 {
                self.at_surfaces().shares(&self.contact.near[at], &mut shares);
                if !shares.is_empty() {
                    let water = mass * std::mem::replace(&mut excesses[particle], 0.0);
                    self.deposit_of(particle, water, &shares, step);
                }
            }
        }
        self.work.shares = shares;
    }

    /// Deposits water of an air particle, kg, onto the boundary particles near it by their shares.
    fn deposit_of(&mut self, particle: usize, water: f64, shares: &[(u32, f64)], step: f64) {
        let mass = self.particle_mass();
        let factor = self.settings.time_factor;
        let mut taken = Taken::default();
        let air = &mut self.state.air[particle];
        air.vapour -= water / mass;
        for &(site, share) in shares {
            let site = site as usize;
            let heat = self.latent_heat * water * share;
            self.state.water_on[site] += factor * water * share;
            // The heat is set free at the surface, from where the better conductor takes the most of it.
            let conductivity = self.solids.material(site).conductivity;
            let to_solid = conductivity / (conductivity + self.air.conductivity);
            air.temperature += (1.0 - to_solid) * heat / (mass * self.air.heat_capacity);
            self.state.heat_flow[self.solids.particles[site].body as usize] += to_solid * heat / step;
            taken.add(to_solid * heat, water * share);
            let heat = factor * heat;
            if self.solids.is_held(site) {
                self.state.held_heat[self.solids.particles[site].body as usize].add(-to_solid * heat);
                self.state.energy.book(-to_solid * heat);
            } else {
                self.state.temperatures[site] += to_solid * heat / self.solids.heat_capacity(site);
            }
        }
        self.accelerate(&taken);
    }
}
