//! Heat and vapour between air and the surface of solids.
//!
//! Both sides of a pair find the same flux from the same numbers, so nothing is made or lost but by rounding.

use crate::air::{Arrangement, Column, Particle, Properties, Scale};
use crate::humid_air::HumidAir;
use crate::normalisation;
use crate::settings::{Condensation, Settings};
use crate::solids::contact::{Contact, Near, Pair};
use crate::solids::{Site, Solids};
use corpuscle_sph::kernel::SmoothingKernel;
use rayon::prelude::*;

/// What air and solids exchange, with everything that it depends on.
pub struct Exchange<'a> {
    /// Sites of the solids.
    pub contact: &'a Contact,
    /// As arranged.
    pub arrangement: &'a Arrangement,
    /// Columns of the air.
    pub columns: &'a [Column],
    /// The solids.
    pub solids: &'a Solids,
    /// Temperature of each of their particles, K.
    pub temperatures: &'a [f64],
    /// Water on each of their particles, kg.
    pub water: &'a [f64],
    /// Part of the evaporation of a wet surface that it lets go.
    pub evaporation: &'a [f64],
    /// Size of particles.
    pub scale: &'a Scale,
    /// The air.
    pub air: &'a Properties,
    /// What was chosen.
    pub settings: &'a Settings,
    /// Heat of condensation, J/kg.
    pub latent_heat: f64,
}

/// What a solid's particle gets in a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ToSolid {
    /// Heat, W, that of condensation included.
    pub heat: f64,
    /// Water, kg/s.
    pub water: f64,
    /// Part of the required evaporation for which there is water.
    pub share: f64,
    /// Sum of its conductances to air, W/K.
    pub conductance: f64,
}

/// What an air particle gets in a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ToAir {
    /// K/s.
    pub warming: f64,
    /// 1/s.
    pub moistening: f64,
    /// Its part of the diagonal of the diffusion matrix, 1/s.
    pub stiffness: f64,
    /// Warming, K/s, and moistening, 1/s, by ghost particles beyond sides that air passes.
    pub from_beyond: [f64; 2],
}

/// Room for what is found in a step, kept from step to step.
#[derive(Debug, Default)]
pub struct Work {
    /// What each site gets.
    pub to_solids: Vec<ToSolid>,
    /// What each air particle near a site gets.
    pub to_air: Vec<ToAir>,
    /// Share of evaporation of each particle of the solids.
    pub share_of: Vec<f64>,
    /// Heat that each particle of the solids gets, W.
    pub heat: Vec<f64>,
    /// Heat that each solid gets from its heater, from outside and by radiation, W.
    pub supplied: Vec<[f64; 3]>,
    /// How stiff diffusion was, 1/s, for the air near sites, then for the particles of the solids.
    pub stiff: Vec<f64>,
    /// What each particle of air has beyond saturation, part of the mass.
    pub excesses: Vec<f64>,
    /// How the water of a particle is divided.
    pub shares: Vec<(u32, f64)>,
}

/// A pair of site and air.
struct Flux {
    /// Conductance with which the air is warmed, W/K, and with which the solid is.
    conductance: [f64; 2],
    /// Temperature of the air less that of the solid, K.
    difference: f64,
    /// Water that condenses, kg/s; evaporation is negative, and goes on only where there is water.
    water: f64,
    /// Part of the heat at the surface that goes to the solid, as if the air were at the reference temperature: how it conducts changes little of it.
    to_solid: f64,
}

/// Part of the mass that is vapour in saturated air; all of it where water boils.
pub fn saturation(temperature: f64, air: &Properties) -> f64 {
    let saturated = HumidAir::with_relative_humidity(temperature, air.pressure, 1.0);
    HumidAir { vapour_pressure: saturated.vapour_pressure.min(air.pressure), ..saturated }.mass_fraction()
}

impl Exchange<'_> {
    /// Between the site and the air at an index, `r` apart.
    fn flux(&self, site: usize, index: usize, r: f64) -> Flux {
        let particle = self.contact.sites[site].particle as usize;
        let air = &self.columns[index];
        let volume = self.contact.volumes[site];
        let factor = normalisation::factor(&air.tensor, self.contact.offset(site, air.position));
        let weight = volume * self.scale.kernel.laplacian(r) * factor / self.scale.moment;
        let of_pair = self.scale.volume * weight;
        let solid_temperature = self.temperatures[particle];
        let between = 0.5 * (air.temperature + solid_temperature);
        let (of_air, of_solid) = (self.air.conductor_at(between), self.solids.material(particle).conductor());
        let mean = self.settings.mean;
        let conductance =
            [mean.conductivity(of_air, of_solid), mean.conductivity(of_solid, of_air)].map(|mean| of_pair * mean);
        let difference = air.temperature - solid_temperature;
        // Half way between them, with the same flux of heat on both sides.
        let to_solid = of_solid.conductivity / (of_solid.conductivity + self.air.conductivity);
        let mut water = 0.0;
        if self.settings.condensation == Condensation::Diffusion && self.solids.particles[particle].normal.is_some() {
            let surface = solid_temperature + (1.0 - to_solid) * difference;
            // The surface is half way: the same factor 2 as the harmonic mean with a perfect conductor.
            let diffusivity = self.air.vapour_diffusivity_at(0.5 * (air.temperature + surface));
            let reach = 2.0 * self.air.density * diffusivity * of_pair;
            water = reach * (air.vapour - saturation(surface, self.air));
            if water < 0.0 {
                water *= if self.water[particle] > 0.0 { self.evaporation[particle] } else { 0.0 };
            }
        }
        Flux { conductance, difference, water, to_solid }
    }

    /// What every site gets that `owns` holds for, where the water on it changes for `step` s, into `given`. Ghost particles of sites get nothing.
    pub fn to_solids(&self, step: f64, owns: impl Fn(&Site) -> bool + Sync, given: &mut Vec<ToSolid>) {
        let sites = self.contact.sites.par_iter().enumerate();
        let of = |(number, site): (usize, &Site)| {
            if site.is_ghost_particle || !owns(site) { ToSolid::default() } else { self.to_solid(number, step) }
        };
        sites.map(of).collect_into_vec(given);
    }

    fn to_solid(&self, site: usize, step: f64) -> ToSolid {
        let fluxes = || self.contact.of_site(site).iter().map(|pair| self.flux(site, pair.other as usize, pair.r));
        let evaporation: f64 = fluxes().map(|flux| (-flux.water).max(0.0)).sum();
        let water = self.water[self.contact.sites[site].particle as usize];
        let share = if evaporation * step > water { water / (evaporation * step) } else { 1.0 };
        fluxes().fold(ToSolid { share, ..ToSolid::default() }, |sum, flux| {
            let water = limited(flux.water, share);
            let heat = flux.conductance[1] * flux.difference + flux.to_solid * self.latent_heat * water;
            let conductance = sum.conductance + flux.conductance[1];
            ToSolid { heat: sum.heat + heat, water: sum.water + water, conductance, share }
        })
    }

    /// Adds what every air particle near a site receives to `given`; `share_of` gives the share of evaporation of a solid's particle.
    pub fn to_air(&self, share_of: &[f64], given: &mut Vec<ToAir>) {
        self.contact.near.par_iter().map(|near| self.to_one(near, share_of)).collect_into_vec(given);
    }

    fn to_one(&self, near: &Near, share_of: &[f64]) -> ToAir {
        let index = self.arrangement.index_of[near.particle as usize] as usize;
        let mass = self.air.density * self.scale.volume;
        let capacity = mass * self.air.heat_capacity;
        let mut sum = ToAir::default();
        for pair in self.contact.of_air(near) {
            let flux = self.flux(pair.other as usize, index, pair.r);
            let site = &self.contact.sites[pair.other as usize];
            let water = limited(flux.water, share_of[site.particle as usize]);
            let released = (1.0 - flux.to_solid) * self.latent_heat * water;
            let warming = (released - flux.conductance[0] * flux.difference) / capacity;
            sum.warming += warming;
            sum.moistening -= water / mass;
            if site.beyond {
                sum.from_beyond = [sum.from_beyond[0] + warming, sum.from_beyond[1] - water / mass];
            }
            sum.stiffness += flux.conductance[0] / capacity;
        }
        sum
    }

    /// How an air particle's water is divided among the boundary particles near it: pairs of the numbers of boundary particles and
    /// parts, in `shares`. Empty where none is near.
    pub fn shares(&self, near: &Near, shares: &mut Vec<(u32, f64)>) {
        let part = |pair: &Pair| {
            let Site { particle, beyond, .. } = self.contact.sites[pair.other as usize];
            let weight = self.contact.volumes[pair.other as usize] * self.scale.kernel.value(pair.r * pair.r);
            let is_boundary = self.solids.particles[particle as usize].normal.is_some();
            (is_boundary && !beyond && weight > 0.0).then_some((particle, weight))
        };
        shares.clear();
        shares.extend(self.contact.of_air(near).iter().filter_map(part));
        let sum: f64 = shares.iter().map(|(_, weight)| weight).sum();
        shares.iter_mut().for_each(|(_, weight)| *weight /= sum);
    }
}

fn limited(water: f64, share: f64) -> f64 {
    if water < 0.0 { share * water } else { water }
}

/// Vapour that saturated air has too much, part of the mass: what must condense so that the air is saturated at the
/// temperature that it then has when it takes up the heat. Negative where it could take up fog.
pub fn excess(particle: &Particle, air: &Properties, latent_heat: f64) -> f64 {
    let warming = latent_heat / air.heat_capacity;
    let mut condensed = 0.0;
    // Newton's method; two steps leave an error far below the formula's own.
    for _ in 0..3 {
        let temperature = particle.temperature + warming * condensed;
        let step = 0.01;
        let saturated = saturation(temperature, air);
        let slope = (saturation(temperature + step, air) - saturated) / step;
        condensed += (particle.vapour - condensed - saturated) / (1.0 + warming * slope);
    }
    condensed
}
