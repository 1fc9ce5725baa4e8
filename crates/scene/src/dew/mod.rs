//! What a dew scene says: humid air, cold solids, and the drops on them.
//!
//! Lengths are in m, temperatures in °C; every position, velocity and acceleration has three numbers.

mod check;
mod faces;
mod fan;
mod scene;
mod solids;

pub use faces::*;
pub use fan::*;
pub use solids::*;

use crate::KernelName;
use serde::{Deserialize, Serialize};

/// 0 °C, K.
pub const ZERO_CELSIUS: f64 = 273.15;

/// The `[dew]` table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Dew {
    /// The box: lengths of its sides, m. Its corner is at the origin.
    pub size_m: [f64; 3],
    /// Distance between particles at the start, m.
    pub spacing_m: f64,
    /// Which laws of transport hold where `[dew.transport]` does not say otherwise.
    #[serde(default)]
    pub scheme: Scheme,
    /// The smoothing kernel of the air.
    #[serde(default)]
    pub kernel: KernelName,
    /// Acceleration of gravity, m/s2; a scene is tilted by turning it.
    #[serde(default = "downward")]
    pub gravity_m_per_s2: [f64; 3],
    /// Whether air rises and sinks by its warmth and vapour; drops feel gravity in any case.
    #[serde(default = "yes")]
    pub buoyancy: bool,
    /// Temperatures of solids and water on them change this many times faster than in reality, at least 1.
    #[serde(default = "one")]
    pub time_factor: f64,
    /// The air at the start.
    pub air: Air,
    /// The sides of the box.
    #[serde(default)]
    pub faces: Faces,
    /// Fans.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fan: Vec<Fan>,
    /// How air is kept out of solids.
    #[serde(default)]
    pub boundary: Boundary,
    /// How heat and vapour move.
    #[serde(default)]
    pub transport: Transport,
    /// The drops.
    #[serde(default)]
    pub drops: Drops,
    /// Air that no longer matters. Left out: all air matters.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub low_utility: Option<LowUtility>,
    /// What the particle files show.
    #[serde(default)]
    pub output: Output,
    /// The solids.
    #[serde(default)]
    pub solid: Vec<Solid>,
}

fn yes() -> bool {
    true
}

fn one() -> f64 {
    1.0
}

fn downward() -> [f64; 3] {
    [0.0, 0.0, -9.81]
}

/// Which laws of transport hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scheme {
    /// Vapour and heat are conserved: flux of vapour by the gradient of its mass fraction, harmonic mean of conductivities,
    /// latent heat released.
    #[default]
    Physical,
    /// As patented (CN106650064B): particles of air condense, relative humidity diffuses, arithmetic mean of diffusivities, no latent heat.
    ParticleCondensation,
}

/// Humid air. Give exactly one of `relative_humidity`, `dew_point_c` and `mixing_ratio`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Air {
    /// Temperature, °C.
    pub temperature_c: f64,
    /// Vapour pressure over that of saturation, from 0 to 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub relative_humidity: Option<f64>,
    /// Temperature at which it would be saturated, °C.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dew_point_c: Option<f64>,
    /// Mass of vapour over that of dry air.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mixing_ratio: Option<f64>,
    /// Pressure, Pa.
    #[serde(default = "standard_pressure")]
    pub pressure_pa: f64,
    /// Velocity at the start, m/s.
    #[serde(default)]
    pub velocity_m_per_s: [f64; 3],
}

fn standard_pressure() -> f64 {
    101_325.0
}

/// How air is kept out of solids.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Boundary {
    /// The method.
    pub treatment: Treatment,
    /// A particle of a solid is a boundary particle where the gradient of colour, times the spacing, is above this.
    pub colour_threshold: f64,
    /// How dense solids are for the air beside them, over air at rest, in the density correction: 1 where their particles fill them.
    pub kappa: f64,
}

impl Default for Boundary {
    fn default() -> Self {
        Self { treatment: Treatment::default(), colour_threshold: 0.15, kappa: 1.0 }
    }
}

/// How air is kept out of solids.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Treatment {
    /// Boundary particles join the density sum of the air.
    #[default]
    DensityCorrection,
    /// Boundary particles push air away.
    VirtualForce,
    /// Solids are filled with ghosts of the air, placed at random and relaxed (Schechter & Bridson 2012).
    Ghost,
    /// Nothing: air gets in. For comparison.
    None,
}

/// How heat and vapour move.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Transport {
    /// Mean of the conductivities (in scheme `particle-condensation` diffusivities) of two particles. Left out: as the scheme has it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub conductivity_mean: Option<Mean>,
    /// What of the vapour diffuses. Left out: as the scheme has it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub humidity: Option<HumidityTransport>,
    /// Whether condensation warms. Left out: as the scheme has it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub latent_heat: Option<bool>,
    /// Diffusivity of vapour in air, m2/s, the same at all temperatures. Left out: by temperature and pressure, as are the next three.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vapour_diffusivity_m2_per_s: Option<f64>,
    /// Conductivity of air, W/(m K).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub air_conductivity_w_per_m_k: Option<f64>,
    /// Heat capacity of air at constant pressure, J/(kg K).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub air_heat_capacity_j_per_kg_k: Option<f64>,
    /// Viscosity of air, Pa s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub air_viscosity_pa_s: Option<f64>,
}

/// Mean of two conductivities.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mean {
    /// 2 a b / (a + b): keeps the flux through a contact.
    Harmonic,
    /// (a + b) / 2, as patented.
    Arithmetic,
}

/// What of the vapour diffuses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum HumidityTransport {
    /// Its part of the mass: vapour is conserved.
    MassFraction,
    /// Relative humidity, as patented: not conserved where temperatures differ.
    RelativeHumidity,
}

/// The drops.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Drops {
    /// Angle between drop and solid, measured inside the drop, degrees.
    pub contact_angle_deg: f64,
    /// Contact angle at which a drop recedes, degrees. Left out: below the contact angle by 16 degrees times its sine.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub receding_angle_deg: Option<f64>,
    /// Contact angle at which a drop advances, degrees. Left out: above the contact angle by as much.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub advancing_angle_deg: Option<f64>,
    /// Friction that holds a drop, over the force with which the air presses it on the solid (mu_f), in place of advancing and receding angles. Left
    /// out: angles (`physical`), 1.3e-4 (`particle-condensation`).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
    /// Viscosity of water, Pa s, by which a drop that slides is braked.
    pub viscosity_pa_s: f64,
    /// Surface tension of water, N/m.
    pub surface_tension_n_per_m: f64,
    /// Radius of the smallest drop that is followed by itself, m. Left out: 1e-5, or more where there would be too many drops.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smallest_radius_m: Option<f64>,
    /// Density of nucleation sites, at which drops begin, 1/m2.
    pub sites_per_m2: f64,
}

impl Drops {
    /// Receding and advancing angle, degrees: those of the scene, or as far from the contact angle as holds a hemisphere of 2 mm on an upright pane.
    pub fn angles_deg(&self) -> [f64; 2] {
        let off = 16.0 * self.contact_angle_deg.to_radians().sin();
        let receding = self.receding_angle_deg.unwrap_or(self.contact_angle_deg - off);
        [receding, self.advancing_angle_deg.unwrap_or(self.contact_angle_deg + off)]
    }
}

impl Default for Drops {
    /// Water at 20 °C on clean, not fresh, glass, whose first drops are 10 micrometres apart; its viscosity after IAPWS (2008).
    fn default() -> Self {
        Self {
            contact_angle_deg: 90.0,
            receding_angle_deg: None,
            advancing_angle_deg: None,
            friction: None,
            viscosity_pa_s: 1.0016e-3,
            surface_tension_n_per_m: 0.0728,
            smallest_radius_m: None,
            sites_per_m2: 1e10,
        }
    }
}

/// Air that no longer matters only moves, and after a while it is taken out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LowUtility {
    /// Air farther than this from all solids that keeps receding is of low utility: smoothing lengths.
    pub distance: f64,
    /// It is taken out when it was of low utility for longer than this, s.
    pub after_s: f64,
}

impl Default for LowUtility {
    fn default() -> Self {
        Self { distance: 5.0, after_s: 1.0 }
    }
}

/// What the particle files show.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Output {
    /// Particles of air.
    pub air: bool,
    /// Particles of solids.
    pub solids: bool,
}

impl Default for Output {
    fn default() -> Self {
        Self { air: true, solids: true }
    }
}
