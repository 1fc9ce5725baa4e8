//! Bed friction within a stage of a step.

use crate::friction::Roughness;
use corpuscle_scene::Friction;

/// Water counts as at least this deep, m: the laws are not made for films that are thinner than the grains of the bed.
pub(crate) const THINNEST: f64 = 1e-5;

/// Less than the cube root of [`THINNEST`], m^(1/3).
const THINNEST_ROOT: f64 = 0.02;

/// Water less deep than this does not move where there is friction, m.
pub(crate) const STILL: f64 = 1e-9;

/// How the bed slows the water in each cell.
#[derive(Debug)]
pub(crate) enum Slowing {
    /// Manning 1891: the same g n^2 everywhere, m^(1/3).
    Manning(f64),
    /// The same for each cell.
    ManningOfCells(Vec<f32>),
    /// Chezy 1775: g / C^2.
    Chezy(f64),
    /// In proportion to the velocity: the rate g S, 1/s.
    Linear(f64),
}

impl Slowing {
    /// The law of a scene, over no cells yet.
    pub fn of(roughness: &Roughness, gravity: f64) -> Self {
        match roughness {
            Roughness::Other(Friction::Chezy(c)) => Self::Chezy(gravity / (c * c)),
            Roughness::Other(Friction::Linear(slope)) => Self::Linear(gravity * slope),
            Roughness::Manning(n) => match n.even() {
                Some(n) => Self::Manning(gravity * n * n),
                None => Self::ManningOfCells(Vec::new()),
            },
        }
    }

    /// Looks up the roughness of cells that were added, by their centroids.
    pub fn extend(&mut self, roughness: &Roughness, gravity: f64, centroids: &[[f64; 2]]) {
        if let (Self::ManningOfCells(of_cells), Roughness::Manning(n)) = (self, roughness) {
            let new = centroids[of_cells.len()..].iter().map(|[x, y]| {
                let n = n.at(*x, *y);
                (gravity * n * n) as f32
            });
            of_cells.extend(new);
        }
    }

    /// Velocity over the root of the slope and the depth to 2/3, m^(1/3)/s; none where the law is not Manning's, or there is no friction.
    pub fn conveyance(&self, cell: usize, gravity: f64) -> Option<f64> {
        let squared = match self {
            Self::Manning(gnn) => *gnn,
            Self::ManningOfCells(of_cells) => f64::from(of_cells[cell]),
            Self::Chezy(_) | Self::Linear(_) => 0.0,
        };
        (squared > 0.0).then(|| (gravity / squared).sqrt())
    }

    /// By what the momentum is multiplied over `step` s: a backward Euler step of du/dt = -k |u| u or -k u for the depth as it is, which balances
    /// the slope in normal flow whatever the step.
    #[inline]
    pub fn factor(&self, cell: usize, depth: f64, momentum_per_area: f64, step: f64) -> f64 {
        let thick = depth.max(THINNEST);
        // The root of any depth is above this: nearly still water need not have its own found.
        let nothing = |g: f64| 4.0 * step * g * momentum_per_area < 1e-17 * THINNEST_ROOT * thick * thick;
        let rate = match self {
            Self::Manning(0.0) => return 1.0,
            Self::Manning(gnn) if nothing(*gnn) => return 1.0,
            Self::Linear(rate) => return 1.0 / (1.0 + step * rate),
            _ if depth < STILL => return 0.0,
            _ if momentum_per_area == 0.0 => return 1.0,
            Self::Manning(gnn) => gnn / (thick * thick.cbrt()),
            Self::ManningOfCells(of_cells) => f64::from(of_cells[cell]) / (thick * thick.cbrt()),
            Self::Chezy(gcc) => gcc / thick,
        };
        2.0 / (1.0 + (1.0 + 4.0 * step * rate * momentum_per_area / thick).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Water on a slope has the velocity of Manning's formula after one long step already.
    #[test]
    fn normal_flow_is_exact_for_any_step() {
        let (gravity, n, depth, slope) = (9.81_f64, 0.03_f64, 0.2_f64, 0.01_f64);
        let normal = depth.powf(2.0 / 3.0) * slope.sqrt() / n;
        let slowing = Slowing::Manning(gravity * n * n);
        for step in [1e-3, 1.0, 1e3] {
            let pushed = depth * (normal + step * gravity * slope);
            let velocity = pushed * slowing.factor(0, depth, pushed, step) / depth;
            assert!((velocity / normal - 1.0).abs() < 1e-12);
        }
    }
}
