//! The parameters of a run in the format of the shaders.

use super::GpuInputs;
use crate::constants::{BEYOND, FARTHEST_SPREAD};
use crate::exchange::saturation;
use crate::fan::Fan;
use crate::humid_air::{self, HumidAir, ZERO_CELSIUS};
use crate::origin::Origin;
use crate::room::Face;
use crate::settings::{Condensation, Humidity, Mean};
use crate::shared::{self, Inlet, MOST_FANS, Parameters};
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

/// The fans, and room for more.
pub(super) fn gpu_fans(inputs: &GpuInputs, origin: Origin) -> [shared::Fan; MOST_FANS as usize] {
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
    std::array::from_fn(|number| inputs.fans.get(number).map_or_else(shared::Fan::default, packed))
}

impl Parameters {
    /// Of a model, on a GPU with room for so many particles.
    pub fn of(inputs: &GpuInputs, origin: Origin, room: usize) -> Self {
        let full = room.saturating_sub(inputs.most_in_a_step) as u32;
        let mut new = Self { flags: flags(inputs), full, ..Self::default() };
        new.set_room(inputs, origin, room >= FINE_CELLS_MIN_PARTICLES);
        new.set_air(inputs);
        new.set_kernels(inputs);
        new.set_inlets(inputs);
        new.fans = inputs.fans.len().min(MOST_FANS as usize) as u32;
        new
    }

    fn set_room(&mut self, inputs: &GpuInputs, origin: Origin, are_many: bool) {
        let (room, h) = (inputs.room, inputs.scale.h());
        let beyond = |axis: usize, side: usize| h * if room.faces[axis][side].is_passed() { CELLS_BEYOND } else { 1.0 };
        let corner = [0, 1, 2].map(|axis| room.low[axis] - beyond(axis, 0));
        let size = [0, 1, 2].map(|axis| room.high[axis] + beyond(axis, 1) - corner[axis]);
        (self.low, self.high) = (origin.relative(room.low), origin.relative(room.high));
        (self.h, self.per_h, self.spacing) = (h as f32, (1.0 / h) as f32, inputs.scale.spacing as f32);
        for (rule, face) in self.faces.as_flattened_mut().iter_mut().zip(room.faces.as_flattened()) {
            *rule = self::rule(face);
        }
        let cells = |size_of_cell: f64| size.map(|length| (length / size_of_cell).ceil());
        let fits = cells(0.5 * h).iter().product::<f64>() < MOST_CELLS;
        let cell = if are_many && fits { 0.5 * h } else { h };
        (self.corner, self.per_cell) = (origin.relative(corner), (1.0 / cell) as f32);
        self.cells = cells(cell).map(|count| count as u32);
        let apart = room.apart(inputs.scale.spacing);
        self.apart = narrow(apart);
        self.deepest = narrow(apart.map(|apart| crate::faces::deepest_outside(h, apart)));
        self.counts = room.counts(inputs.scale.spacing).map(|count| count as u32);
    }

    fn set_air(&mut self, inputs: &GpuInputs) {
        let (air, settings) = (inputs.air, inputs.settings);
        let diffusivities = [air.heat_diffusivity(), air.vapour_diffusivity];
        let ambient = HumidAir::with_mass_fraction(settings.ambient_temperature, air.pressure, settings.ambient_vapour);
        *self = Self {
            gravity: narrow(settings.gravity),
            driven: narrow(settings.body_acceleration),
            sound: air.sound_speed as f32,
            viscosity: air.viscosity as f32,
            density: air.density as f32,
            rest_density: inputs.rest_density as f32,
            kappa: settings.kappa as f32,
            mass: air.particle_mass(inputs.scale) as f32,
            heat_capacity: air.heat_capacity as f32,
            latent_heat: inputs.latent_heat as f32,
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
            farthest: (FARTHEST_SPREAD * inputs.scale.spacing) as f32,
            cfl: settings.cfl as f32,
            shortest_step: inputs.shortest_step as f32,
            slowest: crate::faces::slowest(air) as f32,
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
    fn set_kernels(&mut self, inputs: &GpuInputs) {
        let crate::air::Scale { volume, to_density, to_gradient, moment, .. } = *inputs.scale;
        let (h, [value, slope, laplacian]) = (inputs.scale.h(), Kernel::<3>::device_factors(inputs.settings.kernel));
        let spread = 2.0 * volume * to_gradient * slope / h.powi(4);
        let laplacian = laplacian / h.powi(5) / moment;
        *self = Self {
            of_filling: (to_density * volume * value / h.powi(3)) as f32,
            of_moments: (0.5 * volume * laplacian * h.powi(2)) as f32,
            of_pressure: (0.5 * inputs.air.density * spread) as f32,
            of_spread: spread as f32,
            of_laplacian: (0.5 * volume * laplacian) as f32,
            of_pair: (volume * volume * laplacian) as f32,
            ..*self
        };
    }

    fn set_inlets(&mut self, inputs: &GpuInputs) {
        let apart = inputs.room.apart(inputs.scale.spacing);
        for (number, face) in inputs.room.faces.as_flattened().iter().enumerate() {
            if let Face::Inlet(inflow) = face {
                let apart = apart[number / 2];
                self.inlets[number] = Inlet {
                    velocity: narrow(inflow.velocity),
                    temperature: (inflow.temperature - inputs.settings.ambient_temperature) as f32,
                    vapour: (inflow.vapour - inputs.settings.ambient_vapour) as f32,
                    behind: crate::faces::before_inlet(inputs.scale.h(), apart) as f32,
                    ..Inlet::default()
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

fn flags(inputs: &GpuInputs) -> u32 {
    let settings = inputs.settings;
    let particles = settings.condensation == Condensation::Particle;
    let all = [
        (inputs.room.faces.as_flattened().iter().any(Face::is_passed), shared::IS_PASSED),
        (!particles, shared::DIFFUSES),
        (settings.fog, shared::FOGS),
        (settings.fog || particles, shared::SATURATES),
        (inputs.refuses_fast, shared::REFUSES_FAST),
        (settings.humidity == Humidity::Relative, shared::RELATIVE),
        (settings.low_utility.is_some(), shared::FINDS_LOW_UTILITY),
        (inputs.is_closed, shared::IS_CLOSED),
        (settings.mean == Mean::Harmonic, shared::IS_HARMONIC),
    ];
    all.into_iter().filter_map(|(is_set, flag)| is_set.then_some(flag)).sum()
}
