//! Heat that solids get from elsewhere than the air in the box and other solids: heaters, air outside the box, radiation.

mod areas;
#[cfg(feature = "gpu")]
pub(crate) mod upload;

use super::Solids;
use super::wall::{self, WallLayer};
use crate::constants::ITERATIONS;
use crate::humid_air::ZERO_CELSIUS;
use crate::room::Room;
use crate::solids::bodies::Body;
use areas::AreaSampler;
use corpuscle_scene::Table;
use serde::{Deserialize, Serialize};

/// Stefan-Boltzmann constant, W/(m2 K4) (CODATA 2018).
pub(crate) const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;

/// Heat transfer from a plate by natural convection and radiation together, W/(m2 K): about this of a plate at room temperature (Incropera & DeWitt
/// 2002, table 1.1 and section 1.2.3). By it the temperature that a heater may reach is estimated.
const USUAL_TRANSFER: f64 = 10.0;

/// Kinds of heat, as they are counted.
pub(crate) const HEATER: usize = 0;
/// From outside the box.
pub(crate) const OUTSIDE: usize = 1;
/// By radiation of the surface in the box.
pub(crate) const RADIATION: usize = 2;

/// Surroundings of a surface: conditions of a heat flux by convection and radiation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Surroundings {
    /// Heat transfer coefficient, W/(m2 K).
    pub transfer_coefficient: f64,
    /// Temperature of the air, °C, over time.
    pub air_temperature: Table,
    /// Emissivity of the surface.
    pub emissivity: f64,
    /// Mean radiant temperature, °C, over time; that of the air where it is left out.
    pub radiant_temperature: Option<Table>,
}

/// What is beyond a side of the box.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Outside {
    /// The side, by axis and end.
    pub side: [usize; 2],
    /// Between the solid and the air outside.
    pub layers: Vec<WallLayer>,
    /// The air outside.
    pub surroundings: Surroundings,
}

/// Heat sources of a body.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct BodySources {
    /// Power of its heater over time, and whether in W/m2; else in W.
    pub heater: Option<(Table, bool)>,
    /// What is beyond a side of the box that it reaches.
    pub outside: Option<Outside>,
    /// Surroundings of the surface in the box, which radiate.
    pub radiation: Option<Surroundings>,
}

/// Part of a surface that a particle stands for.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct SurfacePart {
    /// Area, m2.
    pub area: f64,
    /// Thermal resistance between the particle and the surface, m2 K/W: the distance over the conductivity.
    pub resistance: f64,
}

/// Share of a particle in the heat sources of its body.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct ParticleShare {
    /// Part of the heater's power.
    pub heater: f64,
    /// In the side of the box.
    pub outside: SurfacePart,
    /// Of the surface in the box.
    pub radiation: SurfacePart,
}

/// Heat sources of all bodies and of the walls behind them, with the share of each particle and cell. The lists are empty where no body has any.
#[derive(Debug, Clone, Default)]
pub(crate) struct HeatSources {
    /// Of each body, then of each wall.
    pub bodies: Vec<BodySources>,
    /// Factor of the numbers in each table of power: 1, or the body's area where they are in W/m2.
    pub power_factors: Vec<f64>,
    /// Of each particle of the solids, then of each cell of walls.
    pub shares: Vec<ParticleShare>,
}

/// Surroundings at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Conditions {
    /// Heat transfer coefficient, W/(m2 K).
    pub transfer_coefficient: f64,
    /// Temperature of the air, K.
    pub air_temperature: f64,
    /// Emissivity times the Stefan-Boltzmann constant, W/(m2 K4).
    pub emissivity_sigma: f64,
    /// Mean radiant temperature, K.
    pub radiant_temperature: f64,
}

impl Surroundings {
    /// Mean radiant temperature, °C, over time.
    pub fn radiant(&self) -> &Table {
        self.radiant_temperature.as_ref().unwrap_or(&self.air_temperature)
    }

    pub(super) fn at(&self, time: f64) -> Conditions {
        Conditions {
            transfer_coefficient: self.transfer_coefficient,
            air_temperature: self.air_temperature.at(time) + ZERO_CELSIUS,
            emissivity_sigma: self.emissivity * STEFAN_BOLTZMANN,
            radiant_temperature: self.radiant().at(time) + ZERO_CELSIUS,
        }
    }
}

impl Conditions {
    /// Heat flux into the surface, W/m2, and by how much it falls with the temperature of the particle behind it, W/(m2 K).
    ///
    /// Newton's law of cooling and grey radiation, q = h (T_a - T_s) + e sigma (T_r^4 - T_s^4) (Incropera & DeWitt 2002, equations 1.3a and
    /// 1.7), where the surface's temperature T_s is that of the particle and q times the resistance between them. The first estimate of T_s is by the
    /// coefficient of radiation between the particle and the surroundings: from the particle's temperature, Newton's method overshoots by hundreds of K
    /// where the surroundings glow.
    pub(super) fn flux(&self, temperature: f64, resistance: f64) -> [f64; 2] {
        // e sigma (T_r + T_s) (T_r^2 + T_s^2), equation 1.9.
        let radiation = |surface: f64| {
            let (a, b) = (self.radiant_temperature, surface);
            self.emissivity_sigma * (a + b) * (a * a + b * b)
        };
        let at = |surface: f64| {
            let convected = self.transfer_coefficient * (self.air_temperature - surface);
            let slope = self.transfer_coefficient + 4.0 * self.emissivity_sigma * surface.powi(3);
            [convected + radiation(surface) * (self.radiant_temperature - surface), slope]
        };
        let mut difference =
            resistance * at(temperature)[0] / (1.0 + resistance * (self.transfer_coefficient + radiation(temperature)));
        for _ in 0..ITERATIONS {
            let [flux, slope] = at(temperature + difference);
            difference += (resistance * flux - difference) / (1.0 + resistance * slope);
        }
        let [flux, slope] = at(temperature + difference);
        [flux, slope / (1.0 + resistance * slope)]
    }
}

impl HeatSources {
    /// Heat sources of the bodies of a scene.
    pub fn new(bodies: &[Body], solids: &Solids, room: &Room, spacing: f64) -> Self {
        if bodies.iter().all(|body| body.sources.is_none()) {
            return Self::default();
        }
        let mut sources = Self {
            bodies: bodies.iter().map(|body| body.sources.clone()).collect(),
            power_factors: vec![0.0; solids.groups()],
            shares: vec![ParticleShare::default(); solids.nodes()],
        };
        for (number, body) in bodies.iter().enumerate().filter(|(_, body)| !body.sources.is_none()) {
            sources.share(number, body, solids, room, spacing);
        }
        // The air outside is beyond the wall.
        for &body in &solids.walls {
            let outside = sources.bodies[body as usize].outside.take();
            sources.bodies.push(BodySources { outside, ..BodySources::default() });
        }
        let of_cells = &mut sources.shares[solids.particles.len()..];
        of_cells.iter_mut().zip(&solids.cells).for_each(|(share, cell)| share.outside = cell.outer);
        sources
    }

    /// The particles of a body that lie in the side of the box that it reaches, with the part of the side before each.
    pub(super) fn parts_in_side(
        number: usize,
        body: &Body,
        solids: &Solids,
        room: &Room,
        spacing: f64,
    ) -> Vec<(u32, SurfacePart)> {
        let Some(Outside { side: [axis, end], .. }) = body.sources.outside else { return Vec::new() };
        let areas = AreaSampler::new(solids, number as u32, &body.solid, room, spacing).in_side([axis, end]);
        let plane = [room.low, room.high][end][axis];
        let part = |(particle, area): (usize, f64)| {
            let depth = (solids.particles[particle].position[axis] - plane).abs();
            (particle as u32, SurfacePart { area, resistance: depth / body.material.conductivity })
        };
        areas.into_iter().enumerate().filter(|(_, area)| *area > 0.0).map(part).collect()
    }

    /// Divides the heat sources of a body among its particles.
    fn share(&mut self, number: usize, body: &Body, solids: &Solids, room: &Room, spacing: f64) {
        let BodySources { heater, outside, radiation } = &body.sources;
        let areas = AreaSampler::new(solids, number as u32, &body.solid, room, spacing);
        let conductivity = body.material.conductivity;
        let particles = || solids.particles.iter().enumerate().filter(|(_, particle)| particle.body as usize == number);
        let is_per_area = heater.as_ref().is_some_and(|(_, is_per_area)| *is_per_area);
        let in_box = if is_per_area || radiation.is_some() { areas.in_box() } else { Vec::new() };
        if heater.is_some() {
            let volume: f64 = particles().map(|(_, particle)| particle.volume).sum();
            particles().for_each(|(i, particle)| self.shares[i].heater = particle.volume / volume);
            self.power_factors[number] = if is_per_area { in_box.iter().sum() } else { 1.0 };
        }
        if let Some(outside) = outside.as_ref().filter(|outside| !wall::holds_heat(&outside.layers)) {
            let of_gaps = wall::resistance_of_gaps(&outside.layers);
            for (i, part) in Self::parts_in_side(number, body, solids, room, spacing) {
                let resistance = part.resistance + of_gaps;
                self.shares[i as usize].outside = SurfacePart { resistance, ..part };
            }
        }
        if radiation.is_some() {
            for (i, particle) in particles() {
                let depth = -body.solid.signed_distance(particle.position);
                self.shares[i].radiation = SurfacePart { area: in_box[i], resistance: depth.max(0.0) / conductivity };
            }
        }
    }

    /// Adds what the sources supply at a time to the heat that each particle gets, W, and to the sums of its conductances, W/K. Stores in `supplied` what each
    /// body gets of each kind, W.
    pub fn add_heat(
        &self,
        time: f64,
        solids: &Solids,
        temperatures: &[f64],
        heat: &mut [f64],
        conductances: &mut [f64],
        supplied: &mut [[f64; 3]],
    ) {
        supplied.fill([0.0; 3]);
        let mut current = (usize::MAX, BodyConditions::default());
        for (i, share) in self.shares.iter().enumerate() {
            let body = solids.group(i);
            if current.0 != body {
                current = (body, self.bodies[body].at(time, self.power_factors[body]));
            }
            let BodyConditions { power, outside, radiation } = current.1;
            let mut add = |kind: usize, watts: f64, conductance: f64| {
                heat[i] += watts;
                conductances[i] += conductance;
                supplied[body][kind] += watts;
            };
            add(HEATER, share.heater * power, 0.0);
            for (kind, part, conditions) in [(OUTSIDE, share.outside, outside), (RADIATION, share.radiation, radiation)]
            {
                if let Some(conditions) = conditions.filter(|_| part.area > 0.0) {
                    let [flux, slope] = conditions.flux(temperatures[i], part.resistance);
                    add(kind, part.area * flux, part.area * slope);
                }
            }
        }
    }

    /// Temperatures, K, that solids may come to by their surroundings and heaters: by these the speed of the air is estimated.
    pub fn temperatures(bodies: &[Body]) -> impl Iterator<Item = f64> + '_ {
        let largest = |table: &Table| table.rows().iter().map(|row| row[1]).fold(0.0, f64::max);
        bodies.iter().flat_map(move |body| {
            let BodySources { heater, outside, radiation } = &body.sources;
            let surroundings = outside.iter().map(|outside| &outside.surroundings).chain(radiation);
            let tables = surroundings
                .flat_map(|of| [(of.transfer_coefficient, &of.air_temperature), (of.emissivity, of.radiant())]);
            let ambient = tables.filter(|(factor, _)| *factor > 0.0).flat_map(|(_, table)| table.rows());
            let area = body.solid.area();
            let heated = heater.iter().map(move |(table, is_per_area)| {
                let flux = largest(table) / if *is_per_area { 1.0 } else { area };
                body.temperature.at(0.0) + flux / USUAL_TRANSFER
            });
            ambient.map(|row| row[1]).chain(heated).map(|celsius| celsius + ZERO_CELSIUS)
        })
    }
}

/// Heat sources of a body at a time.
#[derive(Debug, Clone, Copy, Default)]
struct BodyConditions {
    /// Power of the heater, W.
    power: f64,
    outside: Option<Conditions>,
    radiation: Option<Conditions>,
}

impl BodySources {
    /// Whether there is no source.
    pub fn is_none(&self) -> bool {
        self.heater.is_none() && self.outside.is_none() && self.radiation.is_none()
    }

    fn at(&self, time: f64, power_factor: f64) -> BodyConditions {
        BodyConditions {
            power: self.heater.as_ref().map_or(0.0, |(table, _)| power_factor * table.at(time)),
            outside: self.outside.as_ref().map(|outside| outside.surroundings.at(time)),
            radiation: self.radiation.as_ref().map(|surroundings| surroundings.at(time)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Conditions, STEFAN_BOLTZMANN};
    use proptest::prelude::*;

    proptest! {
        /// The flux into the surface is that from the surface to the particle, and the slope is its derivative.
        #[test]
        fn flux_is_the_same_on_both_sides_of_the_surface(
            transfer_coefficient in 0.0..200.0_f64, air_temperature in 230.0..330.0_f64, emissivity in 0.0..1.0_f64,
            radiant_temperature in 150.0..1200.0_f64, temperature in 240.0..600.0_f64, resistance in 0.0..0.02_f64,
        ) {
            let emissivity_sigma = emissivity * STEFAN_BOLTZMANN;
            let conditions = Conditions { transfer_coefficient, air_temperature, emissivity_sigma, radiant_temperature };
            let [flux, slope] = conditions.flux(temperature, resistance);
            let surface = temperature + resistance * flux;
            let radiation = emissivity_sigma * (radiant_temperature.powi(4) - surface.powi(4));
            let law = transfer_coefficient * (air_temperature - surface) + radiation;
            prop_assert!((flux - law).abs() <= 1e-6 * flux.abs() + 1e-6, "{flux} for {law}");
            let warmer = conditions.flux(temperature + 0.01, resistance)[0];
            prop_assert!(((flux - warmer) / 0.01 - slope).abs() < 0.01 * slope + 1e-6, "{slope}");
        }
    }
}
