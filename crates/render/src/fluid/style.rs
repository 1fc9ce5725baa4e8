//! Styles of fluids.

use crate::Stage;
use crate::shared::{FREE_FALL, FluidUniforms};

/// Bare ground in the sun looks dry after about an hour, s.
const DRYING: f64 = 1800.0;

/// Smoothing of the nearest surface of the particles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Smoothing {
    /// None: the particles are visible.
    None,
    /// Bilateral Gaussian, rows and columns, so many times: the flood paper's.
    Bilateral(u32),
    /// Narrow-range filter (Truong and Yuksel 2018): smoother at less cost, and edges stay edges.
    #[default]
    NarrowRange,
}

/// The style of a fluid. Lengths are those of the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FluidStyle {
    /// Smoothing of depth.
    pub smoothing: Smoothing,
    /// Half the width of the smoothing, m: a few radii of the particles.
    pub width: f64,
    /// Largest difference of depth between pixels of one surface, m; standard deviation of the bilateral filter's range.
    pub range: f64,
    /// Depth difference to which larger ones are clamped, m: roundness of edges.
    pub rounding: f64,
    /// Largest radius of the smoothing, pixels.
    pub most_pixels: u32,
    /// Absorption of red, green and blue light, 1/m.
    pub absorption: [f32; 3],
    /// Reflectance of deep water.
    pub colour: [f32; 3],
    /// Depth from which a film of water becomes visible, m: a thinner one does not close.
    pub film: f64,
    /// Strength of the sun's highlight.
    pub highlight: f32,
    /// Its exponent: the greater, the smaller.
    pub exponent: f32,
    /// Opacity of foam: 0 draws none.
    pub foam: f32,
    /// Length of the longest ripples on water that flows, m.
    pub ripple: f64,
    /// Steepness of the ripples of fast water: 0 draws none.
    pub steepness: f32,
    /// Cells in which it is noted which ground was under water, m.
    pub wet_cell: f64,
    /// Time in which wet ground loses all but 1 / e of its darkness, s.
    pub drying: f64,
    /// South-western and north-eastern corner, m, beyond which it is not drawn: where the ground is cut off, water is too.
    pub within: Option<[[f64; 2]; 2]>,
}

impl FluidStyle {
    /// Water of particles with this radius, m.
    pub fn water(radius: f64) -> Self {
        Self {
            smoothing: Smoothing::default(),
            width: 3.0 * radius,
            range: 5.0 * radius,
            rounding: radius,
            most_pixels: 64,
            absorption: [0.60, 0.24, 0.16],
            colour: [0.035, 0.10, 0.13],
            film: 0.01,
            highlight: 1.2,
            exponent: 240.0,
            foam: 1.5,
            ripple: 6.0 * radius,
            steepness: 0.12,
            wet_cell: 1.4 * radius,
            drying: DRYING,
            within: None,
        }
    }

    /// The same water with its turbidity multiplied.
    pub fn turbid(self, times: f64) -> Self {
        Self { absorption: self.absorption.map(|part| part * times as f32), film: self.film / times, ..self }
    }

    /// Time in which a pattern that goes with the water comes and goes, s: that in which water as fast as shallow waves of the ripples' length goes so far
    /// four times.
    fn turn(&self) -> f64 {
        4.0 * (self.ripple / FREE_FALL).sqrt()
    }

    /// The same as shaders have it, at a time, s.
    pub(super) fn uniforms(&self, stage: &Stage, time: f64) -> FluidUniforms {
        let [red, green, blue] = self.absorption;
        let [own_red, own_green, own_blue] = self.colour;
        let [width, range, rounding] = [self.width, self.range, self.rounding].map(|length| stage.length(length));
        let [[west, south], [east, north]] = match self.within {
            Some(corners) => corners.map(|[x, y]| stage.position([x, y, 0.0]).truncate().to_array()),
            None => [[f32::MIN; 2], [f32::MAX; 2]],
        };
        // Single precision would be coarse after hours: patterns come anew after so many turns.
        let time = time.rem_euclid(64.0 * self.turn());
        FluidUniforms {
            absorption: [red, green, blue, self.foam],
            colour: [own_red, own_green, own_blue, self.highlight],
            smoothing: [width, range, rounding, self.most_pixels as f32],
            surface: [self.exponent, self.film as f32, 0.0, 0.0],
            within: [west, south, east, north],
            ripples: [stage.length(self.ripple), self.steepness, time as f32, self.turn() as f32],
        }
    }
}
