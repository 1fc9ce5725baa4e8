//! Constants of the method that passes on the CPU and on the GPU share (`shared.rs` has them for the shaders).

/// Distance beyond an open face at which air is removed, in smoothing lengths: particles inside have neighbours in the first, and these in the second.
pub const BEYOND: f64 = 2.0;

/// Thickness of the layer before an outlet whose mean particle shift is applied to the air beyond, in smoothing lengths: less than one layer of particles,
/// so that a layer keeps the shift that moves it as a whole; without it sound between an inlet and the outlet grows.
pub const OUTLET_LAYER: f64 = 0.2;

/// Acceleration limits the time step: this times the root of spacing over acceleration.
pub const ACCELERATION_LIMIT: f64 = 0.25;

/// Part of the longest step for which no diffusion overshoots its neighbours.
pub const DIFFUSION_LIMIT: f64 = 0.9;

/// A particle is not moved farther than this in a step to be evened out among its neighbours, in spacings.
pub const FARTHEST_SPREAD: f64 = 0.05;

/// Repulsion at the distance at which it begins, over the square of the speed of sound and the spacing's inverse
/// (Monaghan 1994 takes the square of the fastest speed, a hundredth of that; the strong force is to hold at any speed).
pub const STRENGTH: f64 = 0.3;

/// Distance from a solid's particle at which repulsion begins, over the spacing.
pub const RANGE: f64 = 1.5;

/// Steps between two searches for air of low utility.
pub const UTILITY_STEPS: u64 = 10;

/// Displacement along the velocity after which distances to solids are compared, in smoothing lengths.
pub const PROBE_STEP: f64 = 0.05;

/// Iterations of Newton's method for the temperature of a surface, after a first estimate: enough for one that glowing surroundings warm by hundreds of K.
pub const ITERATIONS: usize = 4;
