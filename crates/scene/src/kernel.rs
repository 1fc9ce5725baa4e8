//! The smoothing kernels that scenes can choose from.

use serde::{Deserialize, Serialize};

/// A smoothing kernel, for models whose fields are weighted sums over neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum KernelName {
    /// Poly6 for density, spiky for pressure, the viscosity kernel for diffusion (Müller, Charypar & Gross 2003): as published.
    #[default]
    Mueller,
    /// The cubic spline for all of them (Monaghan & Lattanzio 1985).
    CubicSpline,
    /// Wendland's C2 for all of them (Wendland 1995).
    WendlandC2,
}

impl KernelName {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Mueller, Self::CubicSpline, Self::WendlandC2];
}
