//! What solids do to the motion of the air.

use crate::air::{Arrangement, Column, Properties, Rates, Scale, Sums};
use crate::constants::{RANGE, STRENGTH};
use crate::normalisation::{self, Moments};
use crate::settings::WallTreatment;
use crate::solids::contact::{Contact, Near, Pair};
use corpuscle_sph::kernel::SmoothingKernel;
use rayon::prelude::*;

/// What walls add to each air particle near solids, kept between steps.
#[derive(Debug, Default)]
pub struct Work {
    parts: Vec<f64>,
    moments: Vec<Moments>,
    pushes: Vec<Rates>,
}

/// Solids join the density of the air near them: rho_i = sum_air m_j W_ij + sum_b V_b kappa rho_0 W_ib. The kernel lets a
/// wall's part fade smoothly with its distance.
pub fn add_density(
    contact: &Contact,
    arrangement: &Arrangement,
    scale: &Scale,
    kappa: f64,
    sums: &mut [Sums],
    work: &mut Work,
) {
    let of_one = |near: &Near| {
        let joins = |pair: &&Pair| contact.walls[pair.other as usize] == WallTreatment::DensityCorrection;
        let part = |pair: &Pair| contact.volumes[pair.other as usize] * scale.kernel.value(pair.r * pair.r);
        contact.of_air(near).iter().filter(joins).map(part).sum::<f64>()
    };
    contact.near.par_iter().map(of_one).collect_into_vec(&mut work.parts);
    for (near, part) in contact.near.iter().zip(&work.parts) {
        sums[arrangement.index_of[near.particle as usize] as usize].filling += kappa * scale.to_density * part;
    }
}

/// Solids join the moments of the Laplacian, by which diffusion is made exact.
pub fn add_moments(contact: &Contact, arrangement: &Arrangement, scale: &Scale, sums: &mut [Sums], work: &mut Work) {
    let of_one = |near: &Near| {
        let position = arrangement.at(arrangement.index_of[near.particle as usize] as usize);
        let mut moments = Moments::default();
        for pair in contact.of_air(near).iter().filter(|pair| pair.r > 0.0) {
            let number = pair.other as usize;
            let weight = contact.volumes[number] * scale.kernel.laplacian(pair.r) / (pair.r * pair.r);
            let products = normalisation::products(contact.offset(number, position));
            moments.iter_mut().zip(products).for_each(|(sum, product)| *sum += weight * product);
        }
        moments
    };
    contact.near.par_iter().map(of_one).collect_into_vec(&mut work.moments);
    for (near, moments) in contact.near.iter().zip(&work.moments) {
        let sums = &mut sums[arrangement.index_of[near.particle as usize] as usize].moments;
        sums.iter_mut().zip(moments).for_each(|(sum, part)| *sum += 0.5 / scale.moment * part);
    }
}

/// What walls add to the acceleration of the air near solids.
pub struct Push<'a> {
    /// Particles of the solids.
    pub contact: &'a Contact,
    /// Ghost samples in them.
    pub ghosts: &'a Contact,
    /// As arranged.
    pub arrangement: &'a Arrangement,
    /// Columns of the air.
    pub columns: &'a [Column],
    /// Size of particles.
    pub scale: &'a Scale,
    /// The air.
    pub air: &'a Properties,
    /// The constant kappa of the density.
    pub kappa: f64,
}

/// Distance, over the spacing, at which the repulsion is so weak that air at rest stays slow.
pub const CALM: f64 = 1.3;

impl Push<'_> {
    /// Adds to the rates.
    pub fn add(&self, rates: &mut [Rates], work: &mut Work) {
        let pushes = &mut work.pushes;
        let some = |treatment| self.contact.walls.contains(&treatment);
        if some(WallTreatment::DensityCorrection) {
            self.add_of(self.contact, rates, pushes, |near, rates| self.press(self.contact, self.kappa, near, rates));
        }
        if some(WallTreatment::VirtualForce) {
            self.add_of(self.contact, rates, pushes, |near, rates| self.repel(near, rates));
        }
        self.add_of(self.ghosts, rates, pushes, |near, rates| self.press(self.ghosts, 1.0, near, rates));
        self.add_of(self.contact, rates, pushes, |near, rates| self.stick(near, rates));
    }

    fn add_of(
        &self,
        contact: &Contact,
        rates: &mut [Rates],
        pushes: &mut Vec<Rates>,
        add: impl Fn(&Near, &mut Rates) + Sync,
    ) {
        let parts = contact.near.par_iter().map(|near| {
            let mut part = Rates::default();
            add(near, &mut part);
            part
        });
        parts.collect_into_vec(pushes);
        for (near, part) in contact.near.iter().zip(&*pushes) {
            let rates = &mut rates[near.particle as usize];
            for axis in 0..3 {
                rates.acceleration[axis] += part.acceleration[axis];
                rates.spread[axis] += part.spread[axis];
            }
            rates.weights += part.weights;
        }
    }

    fn column(&self, near: &Near) -> &Column {
        &self.columns[self.arrangement.index_of[near.particle as usize] as usize]
    }

    /// Sum of `strength`, of distance and volume, along the way from each site near that keeps air out by `walls` to the air.
    fn along(
        &self,
        contact: &Contact,
        near: &Near,
        walls: WallTreatment,
        strength: impl Fn(f64, f64) -> f64,
    ) -> [f64; 3] {
        let own = self.column(near);
        let mut sum = [0.0; 3];
        for pair in contact.of_air(near).iter().filter(|pair| contact.walls[pair.other as usize] == walls) {
            let site = contact.sites[pair.other as usize].position;
            let r = pair.r.max(1e-9 * self.scale.spacing);
            let push = strength(r, contact.volumes[pair.other as usize]) / r;
            (0..3).for_each(|axis| sum[axis] += push * (own.position[axis] - site[axis]));
        }
        sum
    }

    /// The wall has the air's own pressure (Akinci et al. 2012 with the wall's part of the symmetric form): a
    /// pressure that is the same everywhere moves nothing. Air that comes against the wall at u is held up by rho c u (Joukowsky
    /// 1898: the pressure with which a rigid wall stops it). Particles spread from it as from each other.
    fn press(&self, contact: &Contact, kappa: f64, near: &Near, rates: &mut Rates) {
        let Scale { kernel, to_gradient, .. } = *self.scale;
        let slope = |r, volume| 2.0 * kappa * to_gradient * volume * kernel.slope(r);
        let spread = self.along(contact, near, WallTreatment::DensityCorrection, slope);
        let own = self.column(near);
        let crowding = spread.iter().map(|along| along * along).sum::<f64>().sqrt();
        let inward = -(0..3).map(|axis| own.velocity[axis] * spread[axis]).sum::<f64>() / crowding.max(1e-30);
        let pressure = self.air.density * own.pressure + self.air.sound_speed * inward.max(0.0);
        rates.spread = spread;
        rates.acceleration = spread.map(|along| pressure * along);
    }

    /// D ((r_0/r)^4 - (r_0/r)^2)/r (Monaghan 1994, equation 4.1).
    fn repel(&self, near: &Near, rates: &mut Rates) {
        let range = RANGE * self.scale.spacing;
        let strength = STRENGTH * self.air.sound_speed * self.air.sound_speed;
        rates.acceleration = self.along(self.contact, near, WallTreatment::VirtualForce, |r, _| {
            let ratio = (range / r).powi(2);
            if r < range { strength * (ratio * ratio - ratio) / r } else { 0.0 }
        });
    }

    /// Air at a wall is at rest: viscosity against a wall half way between the air and the site.
    fn stick(&self, near: &Near, rates: &mut Rates) {
        let own = self.column(near);
        let Scale { kernel, moment, .. } = *self.scale;
        let weight = |pair: &Pair| {
            let factor = normalisation::factor(&own.tensor, self.contact.offset(pair.other as usize, own.position));
            self.contact.volumes[pair.other as usize] * kernel.laplacian(pair.r) * factor
        };
        let weight = self.contact.of_air(near).iter().map(weight).sum::<f64>() / moment;
        let viscosity = self.air.viscosity_at(own.temperature);
        (0..3).for_each(|axis| rates.acceleration[axis] -= 2.0 * viscosity * weight * own.velocity[axis]);
        rates.weights += 2.0 * weight;
    }
}
