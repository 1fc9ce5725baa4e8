//! Heat that solids get from elsewhere than the air in the box and other solids: heaters, air outside the box, radiation.

mod areas;

use super::Solids;
use crate::bodies::Body;
use crate::humid_air::ZERO_CELSIUS;
use crate::room::Room;
use areas::Measured;
use corpuscle_scene::Table;

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

/// What a surface exchanges heat with.
#[derive(Debug, Clone)]
pub(crate) struct Surroundings {
    /// Heat transfer coefficient, W/(m2 K).
    pub transfer: f64,
    /// Temperature of the air, °C, over time.
    pub air: Table,
    /// Emissivity of the surface.
    pub emissivity: f64,
    /// Temperature of what the surface sees, °C, over time.
    pub seen: Table,
}

/// What heats and cools a body.
#[derive(Debug, Clone, Default)]
pub(crate) struct HeatSources {
    /// Power of its heater over time, and whether in W/m2; else in W.
    pub heater: Option<(Table, bool)>,
    /// The side of the box in which it is, by axis and end, and what is outside.
    pub outside: Option<([usize; 2], Surroundings)>,
    /// What the surface in the box sees.
    pub radiation: Option<Surroundings>,
}

/// A part of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Part {
    /// Area, m2.
    pub area: f64,
    /// Resistance to heat between the particle and the surface, m2 K/W: the distance over the conductivity.
    pub resistance: f64,
}

/// What a particle has of its body's sources.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Share {
    /// Part of the heater's power.
    pub heater: f64,
    /// In the side of the box.
    pub outside: Part,
    /// Of the surface in the box.
    pub radiation: Part,
}

/// What heats and cools the solids, with what each of their particles has of it. Nothing is in the lists where no body has any source.
#[derive(Debug, Clone, Default)]
pub(crate) struct Sources {
    /// Of each body.
    pub bodies: Vec<HeatSources>,
    /// Power of each body's heater over the numbers of its table, 1 or m2.
    pub heated: Vec<f64>,
    /// Of each particle of the solids.
    pub shares: Vec<Share>,
}

/// What a surface sees at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Seen {
    /// W/(m2 K).
    pub transfer: f64,
    /// K.
    pub air: f64,
    /// Emissivity times the Stefan-Boltzmann constant, W/(m2 K4).
    pub radiance: f64,
    /// K.
    pub seen: f64,
}

impl Surroundings {
    fn at(&self, time: f64) -> Seen {
        Seen {
            transfer: self.transfer,
            air: self.air.at(time) + ZERO_CELSIUS,
            radiance: self.emissivity * STEFAN_BOLTZMANN,
            seen: self.seen.at(time) + ZERO_CELSIUS,
        }
    }
}

/// Iterations of Newton's method for the temperature of a surface: enough for one that glowing surroundings warm by hundreds of K.
const ITERATIONS: usize = 5;

impl Seen {
    /// Heat into the surface, W/m2, and how much less it is for each K that the particle behind it is warmer, W/(m2 K).
    ///
    /// Newton's law of cooling and grey radiation, q = h (T_a - T_s) + e sigma (T_r^4 - T_s^4) (Incropera & DeWitt 2002, equations 1.3a and
    /// 1.7), where the surface's temperature T_s is that of the particle and q times the resistance between them.
    fn heat(&self, temperature: f64, resistance: f64) -> [f64; 2] {
        let at = |surface: f64| {
            let (a, b) = (self.seen, surface);
            let flux = self.transfer * (self.air - b) + self.radiance * (a - b) * (a + b) * (a * a + b * b);
            [flux, self.transfer + 4.0 * self.radiance * b.powi(3)]
        };
        let mut warmer = 0.0;
        for _ in 0..ITERATIONS {
            let [flux, slope] = at(temperature + warmer);
            warmer += (resistance * flux - warmer) / (1.0 + resistance * slope);
        }
        let [flux, slope] = at(temperature + warmer);
        [flux, slope / (1.0 + resistance * slope)]
    }
}

impl Sources {
    /// Of bodies as told by a scene.
    pub fn new(bodies: &[Body], solids: &Solids, room: &Room, spacing: f64) -> Self {
        let sources: Vec<HeatSources> = bodies.iter().map(|body| body.sources.clone()).collect();
        if sources.iter().all(HeatSources::is_none) {
            return Self::default();
        }
        let mut shares = vec![Share::default(); solids.particles.len()];
        let mut heated = vec![0.0; bodies.len()];
        for (number, (body, sources)) in bodies.iter().zip(&sources).enumerate().filter(|(_, (_, of))| !of.is_none()) {
            let measured = Measured::new(solids, number as u32, &body.solid, room, spacing);
            let conductivity = body.material.conductivity;
            let of_body = |i: &usize| solids.particles[*i].body as usize == number;
            let own: Vec<usize> = (0..shares.len()).filter(of_body).collect();
            let in_box = measured.in_box();
            if let Some((_, is_per_area)) = sources.heater {
                let volume: f64 = own.iter().map(|&i| solids.particles[i].volume).sum();
                own.iter().for_each(|&i| shares[i].heater = solids.particles[i].volume / volume);
                heated[number] = if is_per_area { in_box.iter().sum() } else { 1.0 };
            }
            if let Some((side, _)) = sources.outside {
                let in_side = measured.in_side(side);
                let [axis, end] = side;
                let plane = [room.low, room.high][end][axis];
                for &i in &own {
                    let away = (solids.particles[i].position[axis] - plane).abs();
                    shares[i].outside = Part { area: in_side[i], resistance: away / conductivity };
                }
            }
            if sources.radiation.is_some() {
                for &i in &own {
                    let below = -body.solid.signed_distance(solids.particles[i].position);
                    shares[i].radiation = Part { area: in_box[i], resistance: below.max(0.0) / conductivity };
                }
            }
        }
        Self { bodies: sources, heated, shares }
    }

    /// Adds to the heat that each particle gets, W, and to the sums of its conductances, W/K, what sources give at a time; and gives what of it each
    /// body gets, W, in `given`.
    pub fn give(
        &self,
        time: f64,
        solids: &Solids,
        temperatures: &[f64],
        heat: &mut [f64],
        conductances: &mut [f64],
        given: &mut [[f64; 3]],
    ) {
        given.fill([0.0; 3]);
        if self.shares.is_empty() {
            return;
        }
        let mut now = (usize::MAX, Now::default());
        for (i, share) in self.shares.iter().enumerate() {
            let body = solids.particles[i].body as usize;
            if now.0 != body {
                now = (body, self.bodies[body].at(time, self.heated[body]));
            }
            let (now, temperature) = (&now.1, temperatures[i]);
            let mut from = |kind: usize, watts: f64, conductance: f64| {
                heat[i] += watts;
                conductances[i] += conductance;
                given[body][kind] += watts;
            };
            from(HEATER, share.heater * now.power, 0.0);
            for (kind, part, seen) in
                [(OUTSIDE, share.outside, &now.outside), (RADIATION, share.radiation, &now.radiation)]
            {
                if let Some(seen) = seen.as_ref().filter(|_| part.area > 0.0) {
                    let [flux, conductance] = seen.heat(temperature, part.resistance);
                    from(kind, part.area * flux, part.area * conductance);
                }
            }
        }
    }

    /// Temperatures, K, that solids may come to by their surroundings and heaters: by these the speed of the air is estimated.
    pub fn temperatures(bodies: &[Body]) -> impl Iterator<Item = f64> + '_ {
        let largest = |table: &Table| table.rows().iter().map(|row| row[1]).fold(0.0, f64::max);
        bodies.iter().flat_map(move |body| {
            let HeatSources { heater, outside, radiation } = &body.sources;
            let surroundings = outside.iter().map(|(_, seen)| seen).chain(radiation);
            let tables = surroundings.flat_map(|seen| [(seen.transfer, &seen.air), (seen.emissivity, &seen.seen)]);
            let seen = tables.filter(|(strength, _)| *strength > 0.0).flat_map(|(_, table)| table.rows());
            let area = body.solid.area();
            let heated = heater.iter().map(move |(table, is_per_area)| {
                let flux = largest(table) / if *is_per_area { 1.0 } else { area };
                body.temperature.at(0.0) + flux / USUAL_TRANSFER
            });
            seen.map(|row| row[1]).chain(heated).map(|celsius| celsius + ZERO_CELSIUS)
        })
    }
}

/// What a body's sources are at a time.
#[derive(Debug, Clone, Copy, Default)]
struct Now {
    /// W.
    power: f64,
    outside: Option<Seen>,
    radiation: Option<Seen>,
}

impl HeatSources {
    /// Whether there is no source.
    pub fn is_none(&self) -> bool {
        self.heater.is_none() && self.outside.is_none() && self.radiation.is_none()
    }

    fn at(&self, time: f64, heated: f64) -> Now {
        Now {
            power: self.heater.as_ref().map_or(0.0, |(table, _)| heated * table.at(time)),
            outside: self.outside.as_ref().map(|(_, seen)| seen.at(time)),
            radiation: self.radiation.as_ref().map(|seen| seen.at(time)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{STEFAN_BOLTZMANN, Seen};
    use proptest::prelude::*;

    proptest! {
        /// What flows into the surface flows on to the particle, and the slope is that of the heat.
        #[test]
        fn the_surface_passes_on_what_it_gets(
            transfer in 0.0..200.0_f64, air in 230.0..330.0_f64, emissivity in 0.0..1.0_f64, seen in 150.0..1200.0_f64,
            temperature in 240.0..600.0_f64, resistance in 0.0..0.02_f64,
        ) {
            let around = Seen { transfer, air, radiance: emissivity * STEFAN_BOLTZMANN, seen };
            let [heat, slope] = around.heat(temperature, resistance);
            let surface = temperature + resistance * heat;
            let law = transfer * (air - surface) + around.radiance * (seen.powi(4) - surface.powi(4));
            prop_assert!((heat - law).abs() <= 1e-4 * heat.abs() + 1e-3, "{heat} for {law}");
            let warmer = around.heat(temperature + 0.01, resistance)[0];
            prop_assert!(((heat - warmer) / 0.01 - slope).abs() < 0.01 * slope + 1e-6, "{slope}");
        }
    }
}
