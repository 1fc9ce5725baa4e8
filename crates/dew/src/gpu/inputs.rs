//! What the GPU needs of a model.

use crate::air::{Properties, Scale};
use crate::faces::OpenSide;
use crate::fan::Fan;
use crate::room::{InflowsOverTime, Room};
use crate::settings::Settings;
use crate::solids::Surface;
use crate::solids::sources::HeatSources;
use crate::solids::upload::SolidInputs;

/// What the GPU needs of a model, beside its state.
pub(crate) struct GpuInputs<'a> {
    /// How the model works.
    pub settings: &'a Settings,
    /// The air.
    pub air: &'a Properties,
    /// The box.
    pub room: &'a Room,
    /// The air that comes in where it changes with time.
    pub inflows: &'a InflowsOverTime,
    /// Size of particles.
    pub scale: &'a Scale,
    /// The solids.
    pub solids: SolidInputs<'a>,
    /// Heaters, the outside, radiation.
    pub sources: &'a HeatSources,
    /// The surfaces of the bodies; none where one has none.
    pub surfaces: &'a [Surface],
    /// The fans.
    pub fans: &'a [Fan],
    /// The sides of the room by which air comes and goes.
    pub open_sides: &'a [OpenSide],
    /// Density at which the pressure is that at rest, kg/m3.
    pub rest_density: f64,
    /// Heat of condensation, J/kg.
    pub latent_heat: f64,
    /// The shortest step with which the run goes on, s.
    pub shortest_step: f64,
    /// Particles that can come in a step.
    pub most_in_a_step: usize,
    /// Whether air faster than sound is refused.
    pub refuses_fast: bool,
    /// Whether no air enters or leaves.
    pub is_closed: bool,
}
