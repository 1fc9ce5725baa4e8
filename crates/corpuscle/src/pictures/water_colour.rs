//! Colours of the water of a flood.

use corpuscle_render::FluidStyle;

/// Colour of the water of a flood.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum WaterColour {
    /// Of a mountain river: one sees to the bed.
    Clear,
    /// Of a lake.
    #[default]
    Blue,
    /// Of a flood that carries soil.
    Brown,
}

impl WaterColour {
    /// Water of particles with a radius, m. Absorption of clear water is that of pure water with some that scatters (Pope and Fry, Applied Optics 36, 1997, 8710: 0.34, 0.06
    /// and 0.01 per metre at 650, 550 and 450 nm); soil absorbs blue light first, and gives back more than water does.
    pub(super) fn style(self, radius: f64) -> FluidStyle {
        let style = FluidStyle::water(radius);
        match self {
            Self::Clear => FluidStyle { absorption: [0.35, 0.09, 0.06], colour: [0.02, 0.10, 0.12], ..style },
            Self::Blue => style,
            Self::Brown => FluidStyle { absorption: [0.8, 1.3, 2.3], colour: [0.30, 0.19, 0.085], ..style },
        }
    }
}
