//! How the air moves in a step, and how long a step may be.

use super::Dew;
use crate::air::{Arrangement, Column, Entry, Particle, Properties, Rates, Role, Sums, sum_pairs};
use crate::humid_air::{self, HumidAir};
use crate::normalisation::{self, Tensor};
use crate::room::Room;
use crate::settings::Humidity;
use crate::walls::{self, Push};
use rayon::prelude::*;

/// Acceleration limits the time step: this times the root of spacing over acceleration.
pub(crate) const ACCELERATION_LIMIT: f64 = 0.25;

/// Part of the longest step for which no diffusion overshoots its neighbours.
pub(crate) const DIFFUSION_LIMIT: f64 = 0.9;

/// A particle is not moved farther than this in a step to be evened out among its neighbours, in spacings.
pub(crate) const FARTHEST_SPREAD: f64 = 0.05;

/// The largest of what limits the time step.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Extremes {
    pub speed_squared: f64,
    acceleration_squared: f64,
    diffusion: f64,
}

impl Extremes {
    fn of(particle: &Particle, rates: &Rates, air: &Properties) -> Self {
        Self {
            speed_squared: particle.speed_squared(),
            acceleration_squared: particle.acceleration.iter().map(|along| along * along).sum(),
            diffusion: air.largest_diffusivity_at(particle.temperature) * rates.weights,
        }
    }

    /// The larger of both; what is not a number stays none.
    fn or(self, other: Self) -> Self {
        let larger = |a: f64, b: f64| if a > b || a.is_nan() { a } else { b };
        Self {
            speed_squared: larger(self.speed_squared, other.speed_squared),
            acceleration_squared: larger(self.acceleration_squared, other.acceleration_squared),
            diffusion: larger(self.diffusion, other.diffusion),
        }
    }
}

impl Dew {
    /// Half a kick with the old acceleration, then on by a whole step.
    pub(super) fn drift(&mut self, step: f64) {
        let room = self.room;
        let farthest = FARTHEST_SPREAD * self.scale.spacing;
        self.state.air.par_iter_mut().with_min_len(1024).for_each(|particle| {
            if particle.role == Role::Inside {
                (0..3).for_each(|axis| particle.velocity[axis] += 0.5 * step * particle.acceleration[axis]);
            }
            // The transport velocity (Adami, Hu & Adams 2013, equations 6 and 8).
            let along = |axis: usize| {
                let spread = (step * step * particle.spreading[axis]).clamp(-farthest, farthest);
                step * particle.velocity[axis] + spread
            };
            let moved = [along(0), along(1), along(2)];
            (0..3).for_each(|axis| particle.position[axis] += moved[axis]);
            if let Role::Coming(axis, _) = particle.role {
                room.wrap_along(usize::from(axis), &mut particle.position);
            }
            room.keep(&mut particle.position, &mut particle.velocity);
        });
    }

    /// Arranges the air and finds what acts on it; velocities are taken `ahead` s on.
    pub(super) fn evaluate(&mut self, ahead: f64) {
        let Self {
            settings,
            air,
            room,
            scale,
            arrangement,
            contact,
            ghosts,
            sums,
            tensors,
            columns,
            rates,
            state,
            rest_density,
            push,
            ..
        } = self;
        arrangement.arrange(&mut state.air, room, scale.h());
        arrangement.search(scale, sums);
        contact.update(arrangement, scale);
        ghosts.update(arrangement, scale);
        walls::add_density(contact, arrangement, scale, settings.kappa, sums, push);
        walls::add_density(ghosts, arrangement, scale, 1.0, sums, push);
        walls::add_moments(contact, arrangement, scale, sums, push);
        arrangement.normalise(sums, tensors);
        fill_columns(
            arrangement,
            sums,
            tensors,
            columns,
            &mut state.air,
            air,
            *rest_density,
            ahead,
            room,
            scale.h(),
            &state.density_excess_beyond,
        );
        rates.resize(state.air.len(), Rates::default());
        let relative = settings.humidity == Humidity::Relative;
        let saturated = humid_air::saturation_pressure(settings.ambient_temperature);
        let humid_air =
            |particle: &Particle| HumidAir::with_mass_fraction(particle.temperature, air.pressure, particle.vapour);
        if relative {
            for (column, entry) in columns.iter_mut().zip(&arrangement.entries) {
                column.vapour = humid_air(&state.air[entry.particle as usize]).vapour_pressure / saturated;
            }
        }
        sum_pairs(arrangement, columns, scale, air, rates);
        if relative {
            for (rates, particle) in rates.iter_mut().zip(&state.air) {
                rates.moistening *= saturated * humid_air(particle).mass_fraction_slope();
            }
        }
        let walls = Push { contact, ghosts, arrangement, columns, scale, air, kappa: settings.kappa };
        walls.add(rates, push);
    }

    /// The second half of the kick; heat and vapour of the whole step, and what all air gains for accelerated time.
    pub(super) fn kick(&mut self, step: f64, drift: [f64; 2]) -> Extremes {
        let Self { settings, state, rates, air, fans, .. } = self;
        let spreading = air.spreading * air.sound_speed * air.sound_speed;
        let kicked = state.air.par_iter_mut().zip(rates).with_min_len(1024).map(|(particle, rates)| {
            if particle.role != Role::Inside {
                return Extremes::of(particle, rates, air);
            }
            // Boussinesq: air lighter than the ambient air by its temperature and vapour rises.
            let lightness = virtual_temperature(particle.temperature, particle.vapour)
                / virtual_temperature(settings.ambient_temperature, settings.ambient_vapour)
                - 1.0;
            let mut driven = settings.body_acceleration;
            for fan in &*fans {
                let drive = fan.acceleration(particle.position, particle.velocity);
                (0..3).for_each(|axis| driven[axis] += drive[axis]);
            }
            for axis in 0..3 {
                let external = driven[axis] - lightness * settings.gravity[axis];
                particle.acceleration[axis] = rates.acceleration[axis] + external;
                particle.velocity[axis] += 0.5 * step * particle.acceleration[axis];
            }
            particle.spreading = rates.spread.map(|along| spreading * along);
            particle.temperature += step * rates.warming + drift[0];
            particle.vapour += step * rates.moistening + drift[1];
            Extremes::of(particle, rates, air)
        });
        kicked.reduce(Extremes::default, Extremes::or)
    }

    pub(super) fn extremes(&self) -> Extremes {
        let (air, particles) = (&self.air, self.state.air.par_iter().zip(&self.rates).with_min_len(4096));
        particles.map(|(particle, rates)| Extremes::of(particle, rates, air)).reduce(Extremes::default, Extremes::or)
    }

    /// The longest step, s, in which sound does not cross a smoothing length in air of a speed, m/s.
    pub(crate) fn step_by_sound(&self, speed: f64) -> f64 {
        self.settings.cfl * self.scale.h() / (self.air.sound_speed + speed)
    }

    /// The largest sound time step: sound must not cross a smoothing length, nor diffusion overshoot.
    pub(super) fn next_step(&self, stiff: &[f64], extremes: Extremes) -> f64 {
        let [speed, acceleration] = [extremes.speed_squared, extremes.acceleration_squared].map(f64::sqrt);
        let stiffest = stiff.iter().copied().fold(extremes.diffusion, f64::max);
        let by_sound = self.step_by_sound(speed);
        let by_force = ACCELERATION_LIMIT * (self.scale.spacing / acceleration.max(1e-30)).sqrt();
        let by_diffusion = DIFFUSION_LIMIT / stiffest.max(1e-30);
        // What is not a number must not be lost in a minimum.
        if speed.is_finite() && acceleration.is_finite() && stiffest.is_finite() {
            by_sound.min(by_force).min(by_diffusion)
        } else {
            f64::NAN
        }
    }
}

/// T (1 + 0.608 Y), K: temperature at which dry air is as light (Stull 1988, equation 1.5.1).
fn virtual_temperature(temperature: f64, vapour: f64) -> f64 {
    temperature * (1.0 + 0.608 * vapour)
}

/// Fills the columns of particles, with their densities, and of their images.
fn fill_columns(
    arrangement: &Arrangement,
    sums: &[Sums],
    tensors: &[Tensor],
    columns: &mut Vec<Column>,
    particles: &mut [Particle],
    air: &Properties,
    rest_density: f64,
    ahead: f64,
    room: &Room,
    reach: f64,
    density_excess_beyond: &[[f64; 2]; 3],
) {
    particles.par_iter_mut().zip(&arrangement.place_of).with_min_len(1024).for_each(|(particle, &place)| {
        particle.density = air.density * sums[place as usize].filling;
        if matches!(particle.role, Role::Still | Role::Idle) {
            // Where it no longer matters, the air is as it is at rest.
            particle.density = rest_density;
        } else if let Role::Leaving(axis, side) = particle.role {
            particle.density = rest_density * (1.0 + density_excess_beyond[usize::from(axis)][usize::from(side)]);
        } else if let Role::Outside(axis, side) = particle.role {
            let inward = [1.0, -1.0][usize::from(side)] * particle.velocity[usize::from(axis)];
            particle.density = rest_density * (1.0 - 0.5 * (inward.max(0.0) / air.sound_speed).powi(2));
        } else if let Some((axis, side)) = room.outlet_near(particle.position, reach) {
            // Where air would flow back in there is none beyond: that must not suck.
            particle.density = particle.density.max(rest_density * (1.0 + density_excess_beyond[axis][side]));
        }
    });
    let particles = &*particles;
    let column = |(place, entry): (usize, &Entry)| {
        let particle = &particles[entry.particle as usize];
        let mut velocity = particle.velocity;
        for axis in 0..3 {
            if particle.role == Role::Inside {
                velocity[axis] += ahead * particle.acceleration[axis];
            }
            if entry.mirrored[axis] {
                velocity[axis] = -velocity[axis];
            }
        }
        Column {
            position: arrangement.at(place),
            velocity,
            pressure: air.sound_speed * air.sound_speed * (particle.density - rest_density)
                / (particle.density * particle.density),
            temperature: particle.temperature,
            vapour: particle.vapour,
            tensor: normalisation::mirrored(tensors[entry.particle as usize], entry.mirrored),
            transformed: air.transformed(particle.temperature),
        }
    };
    arrangement.entries.par_iter().enumerate().with_min_len(1024).map(column).collect_into_vec(columns);
}
