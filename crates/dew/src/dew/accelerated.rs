//! Accelerated time: slow processes are accelerated, and the air is unchanged.
//!
//! Temperatures of solids and water on them change `time_factor` times as fast as in reality. Conductivities, diffusivities and velocities of
//! the air are the true ones, and so are Rayleigh, Reynolds, Nusselt and Sherwood numbers. That is right as long as the air settles much faster
//! than the solids change: see [`Dew::lags`].
//!
//! The factor makes solids take heat and water that no air gave. Where air comes and goes, what is in the room is what came in a moment ago,
//! and the balances count the rest as come from outside. In a closed room it is taken from all air equally: its mean changes as fast as
//! the solids, its differences from place to place as in reality.

use super::Dew;
use crate::fan::Fan;
use crate::room::Face;
use corpuscle_model::CompensatedSum;

/// The layer of air before a solid may hold this part of the heat that the solid, accelerated, holds: by so much the air lags behind it.
const MOST_LAG: f64 = 0.1;

/// What the solids took from the air in a step, before the factor.
#[derive(Debug, Default)]
pub(super) struct Taken {
    heat: CompensatedSum,
    water: CompensatedSum,
}

impl Taken {
    /// Adds heat, J, and water, kg.
    pub fn add(&mut self, heat: f64, water: f64) {
        self.heat.add(heat);
        self.water.add(water);
    }
}

impl Dew {
    /// Whether no air enters or leaves.
    pub(crate) fn is_closed(&self) -> bool {
        self.room.faces.as_flattened().iter().all(|face| matches!(face, Face::Wall | Face::Periodic))
    }

    /// Lets the air of a closed room lose in the next step what the solids took more than it gave; else books it.
    pub(super) fn accelerate(&mut self, taken: &Taken) {
        let more = self.settings.time_factor - 1.0;
        if more == 0.0 {
            return;
        }
        let [heat, water] = [&taken.heat, &taken.water].map(|sum| more * sum.value());
        if self.is_closed() {
            let mass = self.particle_mass() * self.air_count() as f64;
            self.state.drift[0] -= (heat - self.latent_heat * water) / (self.air.heat_capacity * mass);
            self.state.drift[1] -= water / mass;
        } else if self.processes.is_first() {
            self.state.energy.book(heat);
            self.state.water.book(water);
        }
    }

    /// Water, kg, and energy, J, of the drift that is not yet applied to the air; negative where the air is to lose them.
    pub(super) fn residual(&self) -> [f64; 2] {
        let mass = self.particle_mass() * self.air_count() as f64;
        let [temperature, vapour] = self.state.drift;
        [mass * vapour, mass * (self.air.heat_capacity * temperature + self.latent_heat * vapour)]
    }

    /// Says which solids change so fast, accelerated, that the air before them cannot follow, and with which factor it would.
    pub(crate) fn lags(&self) -> Vec<String> {
        let factor = self.settings.time_factor;
        let layer = self.air.density * self.air.heat_capacity * self.layer();
        let lag = |body: usize| {
            let of_it = self.solids.particles.iter().enumerate().filter(|(_, particle)| particle.body as usize == body);
            let free = of_it.filter(|(i, _)| !self.solids.is_held(*i));
            let [capacity, area] = free.fold([0.0, 0.0], |[capacity, area], (i, particle)| {
                let area_of_it = if particle.normal.is_some() { particle.area } else { 0.0 };
                [capacity + self.solids.heat_capacity(i), area + area_of_it]
            });
            (capacity > 0.0).then_some((body, layer * area / capacity))
        };
        let too_fast = (0..self.names.len()).filter_map(lag).filter(|(_, lag)| factor > 1.0 && factor * lag > MOST_LAG);
        too_fast
            .map(|(body, lag)| {
                format!(
                    "time_factor: the solid \"{}\" changes so fast that the air before it lags behind: that layer holds {:.0} % of the \
                     heat that the solid holds at a factor of {factor}. Take a time_factor of at most {:.1}",
                    self.names[body],
                    100.0 * factor * lag,
                    (MOST_LAG / lag).max(1.0)
                )
            })
            .collect()
    }

    /// Thickness of a layer of air, m, with the resistance to heat that the air has before a plate as long as the room: in a stream (Pohlhausen 1921,
    /// Nu = 0.664 Re^(1/2) Pr^(1/3)) or where it rises by its warmth (McAdams 1954, Nu = 0.59 Ra^(1/4)); at most half of the room.
    fn layer(&self) -> f64 {
        let size = self.room.size();
        let [least, length] = [f64::min, f64::max].map(|of| size.into_iter().reduce(of).unwrap_or(0.0));
        let [viscosity, diffusivity] = [self.air.viscosity, self.air.heat_diffusivity()];
        let speed = |velocity: &[f64; 3]| velocity.iter().map(|along| along * along).sum::<f64>().sqrt();
        let inlets = self.room.faces.as_flattened().iter().map(|face| match face {
            Face::Inlet(inflow) => speed(&inflow.velocity),
            _ => 0.0,
        });
        let fastest = inlets.chain(self.fans.iter().map(Fan::speed)).fold(0.0, f64::max);
        let in_stream = 0.664 * (fastest * length / viscosity).sqrt() * (viscosity / diffusivity).cbrt();
        let ambient = self.settings.ambient_temperature;
        let contrast = self.state.temperatures.iter().map(|other| (other / ambient - 1.0).abs()).fold(0.0, f64::max);
        let rayleigh = speed(&self.settings.gravity) * contrast * length.powi(3) / (viscosity * diffusivity);
        let nusselt = in_stream.max(0.59 * rayleigh.powf(0.25)).max(1e-9);
        (length / nusselt).min(0.5 * least)
    }
}
