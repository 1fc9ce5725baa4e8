//! How the air moves in a step, and how long a step may be.

use super::Dew;
use crate::air::{Arrangement, Column, Entry, HaloParticle, Part, Particle, Properties, Rates, Role, Sums, sum_pairs};
use crate::constants::{ACCELERATION_LIMIT, DIFFUSION_LIMIT, FARTHEST_SPREAD};
use crate::domain::Halo;
use crate::humid_air::{self, HumidAir, virtual_temperature};
use crate::normalisation::{self, Tensor};
use crate::room::Room;
use crate::settings::Humidity;
use crate::walls::{self, Push};
use corpuscle_processes::Processes;
use rayon::prelude::*;

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

    /// The largest of all processes.
    fn of_all(self, processes: &Processes) -> Self {
        if processes.count() == 1 {
            return self;
        }
        let Self { speed_squared, acceleration_squared, diffusion } = self;
        let all = processes.gather_all([speed_squared, acceleration_squared, diffusion]);
        let of = |[speed_squared, acceleration_squared, diffusion]: [f64; 3]| Self {
            speed_squared,
            acceleration_squared,
            diffusion,
        };
        all.into_iter().map(of).fold(Self::default(), Self::or)
    }

    /// The larger of both.
    fn or(self, other: Self) -> Self {
        Self {
            speed_squared: larger(self.speed_squared, other.speed_squared),
            acceleration_squared: larger(self.acceleration_squared, other.acceleration_squared),
            diffusion: larger(self.diffusion, other.diffusion),
        }
    }
}

/// The larger of two numbers; NaN where one of them is, unlike `f64::max`.
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
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
        self.share_air(ahead);
        let Self {
            domain,
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
        let (halo, part): (&[_], _) = match domain {
            Some(domain) => (&domain.halo.particles, domain.part),
            None => (&[], Part::WHOLE),
        };
        arrangement.arrange(&mut state.air, halo, room, scale.h(), part);
        arrangement.search(scale, sums);
        contact.update(arrangement, scale);
        ghosts.update(arrangement, scale);
        walls::add_density(contact, arrangement, scale, settings.kappa, sums, push);
        walls::add_density(ghosts, arrangement, scale, 1.0, sums, push);
        walls::add_moments(contact, arrangement, scale, sums, push);
        arrangement.normalise(sums, tensors);
        set_densities(
            arrangement,
            sums,
            &mut state.air,
            air,
            *rest_density,
            room,
            scale.h(),
            &state.density_excess_beyond,
        );
        if let Some(domain) = domain {
            domain.exchange(&state.air, &arrangement.new_number, tensors);
        }
        let halo = domain.as_ref().map(|domain| &domain.halo);
        fill_columns(arrangement, tensors, columns, &state.air, halo, air, *rest_density, ahead);
        rates.resize(state.air.len(), Rates::default());
        let relative = settings.humidity == Humidity::Relative;
        let saturated = humid_air::saturation_pressure(settings.ambient_temperature);
        let humid_air = |temperature: f64, vapour: f64| HumidAir::with_mass_fraction(temperature, air.pressure, vapour);
        if relative {
            for column in &mut *columns {
                column.vapour = humid_air(column.temperature, column.vapour).vapour_pressure / saturated;
            }
        }
        sum_pairs(arrangement, columns, scale, air, rates);
        if relative {
            for (rates, particle) in rates.iter_mut().zip(&state.air) {
                let slope = humid_air(particle.temperature, particle.vapour).mass_fraction_slope();
                rates.moistening *= saturated * slope;
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
        kicked.reduce(Extremes::default, Extremes::or).of_all(&self.processes)
    }

    pub(super) fn extremes(&self) -> Extremes {
        let (air, particles) = (&self.air, self.state.air.par_iter().zip(&self.rates).with_min_len(4096));
        let own = particles.map(|(particle, rates)| Extremes::of(particle, rates, air));
        own.reduce(Extremes::default, Extremes::or).of_all(&self.processes)
    }

    /// The longest step, s, in which sound does not cross a smoothing length in air of a speed, m/s.
    pub(crate) fn step_by_sound(&self, speed: f64) -> f64 {
        self.settings.cfl * self.scale.h() / (self.air.sound_speed + speed)
    }

    /// The largest stable time step (CFL): sound must not cross a smoothing length, nor diffusion overshoot.
    pub(super) fn next_step(&self, stiff: &[f64], extremes: Extremes) -> f64 {
        let [speed, acceleration] = [extremes.speed_squared, extremes.acceleration_squared].map(f64::sqrt);
        let stiffest = stiff.iter().copied().fold(extremes.diffusion, larger);
        // Infinite where it is not a number, or a value of the air is not: a least number of several processes could lose it.
        let stiffest = if stiffest.is_nan() || self.has_not_finite() { f64::INFINITY } else { stiffest };
        let stiffest = -self.processes.least(-stiffest);
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

/// Sets the densities of particles.
fn set_densities(
    arrangement: &Arrangement,
    sums: &[Sums],
    particles: &mut [Particle],
    air: &Properties,
    rest_density: f64,
    room: &Room,
    reach: f64,
    density_excess_beyond: &[[f64; 2]; 3],
) {
    particles.par_iter_mut().zip(&arrangement.index_of).with_min_len(1024).for_each(|(particle, &index)| {
        particle.density = air.density * sums[index as usize].filling;
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
}

/// Fills the columns of particles, of the halo, and of their ghost particles; `tensors` are those of the particles, then of the halo.
fn fill_columns(
    arrangement: &Arrangement,
    tensors: &[Tensor],
    columns: &mut Vec<Column>,
    particles: &[Particle],
    halo: Option<&Halo>,
    air: &Properties,
    rest_density: f64,
    ahead: f64,
) {
    let seen = |number: usize| match (particles.get(number), halo) {
        (None, Some(halo)) => {
            let HaloParticle { velocity, temperature, vapour, .. } = halo.particles[number - particles.len()];
            (velocity, halo.densities[number - particles.len()], temperature, vapour)
        }
        _ => {
            let particle = &particles[number];
            (particle.velocity_ahead(ahead), particle.density, particle.temperature, particle.vapour)
        }
    };
    let column = |(index, entry): (usize, &Entry)| {
        let (mut velocity, density, temperature, vapour) = seen(entry.particle as usize);
        for (along, mirrored) in velocity.iter_mut().zip(entry.mirrored) {
            *along = if mirrored { -*along } else { *along };
        }
        Column {
            position: arrangement.at(index),
            velocity,
            pressure: air.sound_speed * air.sound_speed * (density - rest_density) / (density * density),
            temperature,
            vapour,
            tensor: normalisation::mirrored(tensors[entry.particle as usize], entry.mirrored),
            transformed: air.transformed(temperature),
        }
    };
    arrangement.entries.par_iter().enumerate().with_min_len(1024).map(column).collect_into_vec(columns);
}
