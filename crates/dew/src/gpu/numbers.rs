//! The parameters of a run in the format of the shaders.

use super::origin::Origin;
use super::shared::{self, Inlet, MOST_FANS, Parameters};
use crate::dew::Dew;
use crate::exchange::saturation;
use crate::faces::BEYOND;
use crate::fan::Fan;
use crate::humid_air::{self, HumidAir, ZERO_CELSIUS};
use crate::room::Face;
use crate::settings::{Condensation, Humidity, Mean};
use corpuscle_sph::kernel::Kernel;

/// Cells go on beyond faces that air passes by as many smoothing lengths as the air does and one more.
const CELLS_BEYOND: f64 = BEYOND + 1.0;

/// Number of particles from which cells are half as large as the support: fewer pairs out of reach are tested. Fewer particles are no work for a GPU, and
/// with cells of the whole reach a lattice of them stays one: what its particles sum up cancels in pairs.
pub(crate) const FINE_CELLS_MIN_PARTICLES: usize = 50_000;

/// More cells are not sorted into.
const MOST_CELLS: f64 = 16e6;

fn narrow(vector: [f64; 3]) -> [f32; 3] {
    vector.map(|along| along as f32)
}

/// The fans of a model, and room for more.
pub(super) fn gpu_fans(dew: &Dew, origin: Origin) -> [shared::Fan; MOST_FANS as usize] {
    let packed = |fan: &Fan| {
        let [low, high] = fan.corners();
        shared::Fan {
            low: origin.relative(low),
            high: origin.relative(high),
            rate: fan.rate() as f32,
            speed: fan.speed() as f32,
            direction: narrow(fan.direction()),
            unused: 0.0,
        }
    };
    std::array::from_fn(|number| dew.fans.get(number).map_or_else(shared::Fan::default, packed))
}

impl Parameters {
    /// Of a model, on a GPU with room for so many particles.
    pub fn of(dew: &Dew, origin: Origin, room: usize) -> Self {
        let full = room.saturating_sub(dew.most_in_a_step()) as u32;
        let mut new = Self { flags: flags(dew), full, ..Self::default() };
        new.set_room(dew, origin, room >= FINE_CELLS_MIN_PARTICLES);
        new.set_air(dew);
        new.set_kernels(dew);
        new.set_inlets(dew);
        new.fans = dew.fans.len().min(MOST_FANS as usize) as u32;
        new
    }

    fn set_room(&mut self, dew: &Dew, origin: Origin, are_many: bool) {
        let (room, h) = (&dew.room, dew.scale.h());
        let beyond = |axis: usize, side: usize| h * if room.faces[axis][side].is_passed() { CELLS_BEYOND } else { 1.0 };
        let corner = [0, 1, 2].map(|axis| room.low[axis] - beyond(axis, 0));
        let size = [0, 1, 2].map(|axis| room.high[axis] + beyond(axis, 1) - corner[axis]);
        (self.low, self.high) = (origin.relative(room.low), origin.relative(room.high));
        (self.h, self.per_h, self.spacing) = (h as f32, (1.0 / h) as f32, dew.scale.spacing as f32);
        for (rule, face) in self.faces.as_flattened_mut().iter_mut().zip(room.faces.as_flattened()) {
            *rule = self::rule(face);
        }
        let cells = |size_of_cell: f64| size.map(|length| (length / size_of_cell).ceil());
        let fits = cells(0.5 * h).iter().product::<f64>() < MOST_CELLS;
        let cell = if are_many && fits { 0.5 * h } else { h };
        (self.corner, self.per_cell) = (origin.relative(corner), (1.0 / cell) as f32);
        self.cells = cells(cell).map(|count| count as u32);
        let apart = room.apart(dew.scale.spacing);
        self.apart = narrow(apart);
        self.deepest = narrow(apart.map(|apart| crate::faces::deepest_outside(h, apart)));
        self.counts = room.counts(dew.scale.spacing).map(|count| count as u32);
    }

    fn set_air(&mut self, dew: &Dew) {
        let (air, settings) = (&dew.air, &dew.settings);
        let diffusivities = [air.heat_diffusivity(), air.vapour_diffusivity];
        let ambient = HumidAir::with_mass_fraction(settings.ambient_temperature, air.pressure, settings.ambient_vapour);
        *self = Self {
            gravity: narrow(settings.gravity),
            driven: narrow(settings.body_acceleration),
            sound: air.sound_speed as f32,
            viscosity: air.viscosity as f32,
            density: air.density as f32,
            rest_density: dew.rest_density as f32,
            kappa: settings.kappa as f32,
            mass: dew.particle_mass() as f32,
            heat_capacity: air.heat_capacity as f32,
            latent_heat: dew.latent_heat as f32,
            time_factor: settings.time_factor as f32,
            heat_diffusivity: diffusivities[0] as f32,
            vapour_diffusivity: diffusivities[1] as f32,
            largest_diffusivity: air.largest_diffusivity_at(air.reference_temperature) as f32,
            vapour_reach: (2.0 * air.density * air.vapour_diffusivity) as f32,
            ambient: settings.ambient_temperature as f32,
            ambient_vapour: settings.ambient_vapour as f32,
            celsius: (settings.ambient_temperature - ZERO_CELSIUS) as f32,
            air_pressure: air.pressure as f32,
            spreading: (air.spreading * air.sound_speed * air.sound_speed) as f32,
            farthest: (crate::dew::FARTHEST_SPREAD * dew.scale.spacing) as f32,
            cfl: settings.cfl as f32,
            shortest_step: dew.shortest_step() as f32,
            slowest: dew.slowest() as f32,
            saturated: humid_air::saturation_pressure(settings.ambient_temperature) as f32,
            ambient_pressure: ambient.vapour_pressure as f32,
            lacking: (saturation(settings.ambient_temperature, air) - settings.ambient_vapour) as f32,
            viscosity_per_kelvin: air.coefficients.viscosity as f32,
            conductivity_per_kelvin: air.coefficients.conductivity as f32,
            diffusivity_per_kelvin: air.coefficients.vapour_diffusivity as f32,
            reference: (air.reference_temperature - settings.ambient_temperature) as f32,
            ..*self
        };
    }

    /// The shaders' kernels are of distances over h and without their factors.
    fn set_kernels(&mut self, dew: &Dew) {
        let crate::air::Scale { volume, to_density, to_gradient, moment, .. } = dew.scale;
        let (h, [value, slope, laplacian]) = (dew.scale.h(), Kernel::<3>::device_factors(dew.settings.kernel));
        let spread = 2.0 * volume * to_gradient * slope / h.powi(4);
        let laplacian = laplacian / h.powi(5) / moment;
        *self = Self {
            of_filling: (to_density * volume * value / h.powi(3)) as f32,
            of_moments: (0.5 * volume * laplacian * h.powi(2)) as f32,
            of_pressure: (0.5 * dew.air.density * spread) as f32,
            of_spread: spread as f32,
            of_laplacian: (0.5 * volume * laplacian) as f32,
            of_pair: (volume * volume * laplacian) as f32,
            ..*self
        };
    }

    fn set_inlets(&mut self, dew: &Dew) {
        let apart = dew.room.apart(dew.scale.spacing);
        for (number, face) in dew.room.faces.as_flattened().iter().enumerate() {
            if let Face::Inlet(inflow) = face {
                let apart = apart[number / 2];
                self.inlets[number] = Inlet {
                    velocity: narrow(inflow.velocity),
                    temperature: (inflow.temperature - dew.settings.ambient_temperature) as f32,
                    vapour: (inflow.vapour - dew.settings.ambient_vapour) as f32,
                    behind: crate::faces::before_inlet(dew.scale.h(), apart) as f32,
                    unused: [0.0; 2],
                };
            }
        }
    }
}

fn rule(face: &Face) -> u32 {
    match face {
        Face::Wall => shared::WALL,
        Face::Periodic => shared::PERIODIC,
        Face::Inlet(_) => shared::INLET,
        Face::Outlet => shared::OUTLET,
        Face::Open => shared::OPEN,
    }
}

fn flags(dew: &Dew) -> u32 {
    let settings = &dew.settings;
    let particles = settings.condensation == Condensation::Particle;
    let all = [
        (dew.room.faces.as_flattened().iter().any(Face::is_passed), shared::IS_PASSED),
        (!particles, shared::DIFFUSES),
        (settings.fog, shared::FOGS),
        (settings.fog || particles, shared::SATURATES),
        (dew.wetting.is_some(), shared::REFUSES_FAST),
        (settings.humidity == Humidity::Relative, shared::RELATIVE),
        (settings.low_utility.is_some(), shared::FINDS_LOW_UTILITY),
        (dew.is_closed(), shared::IS_CLOSED),
        (settings.mean == Mean::Harmonic, shared::IS_HARMONIC),
    ];
    all.into_iter().filter_map(|(is_set, flag)| is_set.then_some(flag)).sum()
}
