//! How the model works, as far as it can be chosen.

use corpuscle_scene::KernelName;
use serde::{Deserialize, Serialize};

/// What keeps air out of solids.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum WallTreatment {
    /// The solid's particles join the air's density, and push back with the air's own pressure.
    #[default]
    DensityCorrection,
    /// A strong short-range repulsion (Monaghan 1994).
    VirtualForce,
    /// Random samples throughout the solid stand for air (Schechter & Bridson 2012).
    Ghosts,
    /// Nothing: to show what the others are for.
    None,
}

/// How heat passes between unlike neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Mean {
    /// By the harmonic mean of the conductivities, 2 a b / (a + b): that of two resistances in a row (Cleary & Monaghan
    /// 1999, equation 29).
    #[default]
    Harmonic,
    /// By the arithmetic mean of the conductivities, to show what it errs by.
    Arithmetic,
    /// As published: each warms by the arithmetic mean of the diffusivities. Heat is not conserved.
    Diffusivity,
}

/// What conducts heat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conductor {
    /// Conductivity, W/(m K).
    pub conductivity: f64,
    /// Heat capacity of a cubic metre, J/(m3 K).
    pub capacity: f64,
}

impl Mean {
    /// Conductivity with which `own` is warmed by `other`, W/(m K).
    pub fn conductivity(self, own: Conductor, other: Conductor) -> f64 {
        let (a, b) = (own.conductivity, other.conductivity);
        match self {
            Self::Harmonic if a + b > 0.0 => 2.0 * a * b / (a + b),
            Self::Harmonic => 0.0,
            Self::Arithmetic => 0.5 * (a + b),
            Self::Diffusivity => 0.5 * (a + own.capacity * b / other.capacity),
        }
    }
}

/// How vapour becomes water on a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Condensation {
    /// Vapour diffuses to the surface, where air is saturated at the surface's temperature; and back from water there.
    #[default]
    Diffusion,
    /// As published: a particle of air at the surface that is colder than its dew point deposits its excess.
    Particle,
}

/// What of the vapour diffuses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Humidity {
    /// Its part of the mass: vapour is conserved.
    #[default]
    MassFraction,
    /// As published: relative humidity, referred to the ambient temperature. Vapour is conserved but for the bend of the mass fraction
    /// over the vapour pressure, which is below a percent.
    Relative,
}

/// Air that no longer matters (patent CN106650064B): it only moves, and after a while it is taken out.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LowUtility {
    /// Air farther than this from all solids that keeps receding is of low utility, smoothing lengths.
    pub distance: f64,
    /// It is taken out when it was of low utility for longer than this, s.
    pub after: f64,
}

/// Colour gradient of a boundary of solids over the spacing, at least; on a plane it is about 0.5.
pub(crate) const BOUNDARY_THRESHOLD: f64 = 0.15;

/// What can be chosen of how the model works.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Distance of air particles, m.
    pub spacing: f64,
    /// The smoothing kernel.
    pub kernel: KernelName,
    /// What keeps air out of solids.
    pub walls: WallTreatment,
    /// How heat passes between unlike neighbours.
    pub mean: Mean,
    /// What of the vapour diffuses; relative humidity only where particles condense.
    pub humidity: Humidity,
    /// How vapour becomes water on a surface.
    pub condensation: Condensation,
    /// Whether supersaturated air away from solids turns to fog.
    pub fog: bool,
    /// Acceleration of gravity by which warm and moist air rises, m/s2.
    pub gravity: [f64; 3],
    /// Temperature of air that neither rises nor sinks, K.
    pub ambient_temperature: f64,
    /// Vapour of air that neither rises nor sinks, part of the mass.
    pub ambient_vapour: f64,
    /// Acceleration of all air, m/s2.
    pub body_acceleration: [f64; 3],
    /// How many times faster than in reality the slow processes go: the temperatures of the solids and the water on them. See
    /// `dew/accelerated.rs`.
    pub time_factor: f64,
    /// Air that no longer matters; none: all air matters.
    pub low_utility: Option<LowUtility>,
    /// Time step over the time in which sound crosses a smoothing length.
    pub cfl: f64,
    /// Colour gradient over the spacing above which a solid's particle is a boundary particle.
    pub threshold: f64,
    /// The constant kappa that makes up for how sparsely solids are sampled: 1 where their particles fill them.
    pub kappa: f64,
}

impl Settings {
    /// The defaults for air particles a `spacing` apart, m, at a temperature, K, with so much vapour.
    pub fn new(spacing: f64, ambient_temperature: f64, ambient_vapour: f64) -> Self {
        Self {
            spacing,
            kernel: KernelName::default(),
            walls: WallTreatment::default(),
            mean: Mean::default(),
            humidity: Humidity::default(),
            condensation: Condensation::default(),
            fog: true,
            gravity: [0.0, 0.0, -9.81],
            ambient_temperature,
            ambient_vapour,
            body_acceleration: [0.0; 3],
            time_factor: 1.0,
            low_utility: None,
            cfl: 0.25,
            threshold: BOUNDARY_THRESHOLD,
            kappa: 1.0,
        }
    }
}
