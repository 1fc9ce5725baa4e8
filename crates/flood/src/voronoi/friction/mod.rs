//! Bed friction within a stage of a step.

use crate::friction::{Law, Roughness};

/// Water counts as at least this deep, m: the laws are not made for films that are thinner than the grains of the bed.
pub(crate) const THINNEST: f64 = 1e-5;

/// Less than the cube root of [`THINNEST`], m^(1/3).
const THINNEST_ROOT: f64 = 0.02;

/// Water less deep than this does not move where there is friction, m.
pub(crate) const STILL: f64 = 1e-9;

/// How the bed slows the water in each cell.
#[derive(Debug)]
pub(crate) struct Slowing {
    law: Law,
    coefficient: OfCells,
}

/// The coefficient of the law: g n^2, g / C^2 or g S.
#[derive(Debug)]
enum OfCells {
    /// The same for all.
    Even(f64),
    /// For each cell.
    Each(Vec<f32>),
}

impl Slowing {
    /// The law of a scene, over no cells yet.
    pub fn of(roughness: &Roughness, gravity: f64) -> Self {
        let law = roughness.law;
        match roughness.number.even() {
            Some(number) => Self::even(law, law.coefficient(gravity, number)),
            None => Self { law, coefficient: OfCells::Each(Vec::new()) },
        }
    }

    /// A law with the same coefficient for all cells.
    pub fn even(law: Law, coefficient: f64) -> Self {
        Self { law, coefficient: OfCells::Even(coefficient) }
    }

    /// The law.
    #[cfg(feature = "gpu")]
    pub fn law(&self) -> Law {
        self.law
    }

    /// The law's coefficient in a cell.
    #[inline(always)]
    pub fn coefficient(&self, cell: usize) -> f64 {
        match &self.coefficient {
            OfCells::Even(coefficient) => *coefficient,
            OfCells::Each(of_cells) => f64::from(of_cells[cell]),
        }
    }

    /// Sets the roughness of cells that were added, by their centroids.
    pub fn extend(&mut self, roughness: &Roughness, gravity: f64, centroids: &[[f64; 2]]) {
        if let OfCells::Each(of_cells) = &mut self.coefficient {
            let new = centroids[of_cells.len()..]
                .iter()
                .map(|[x, y]| self.law.coefficient(gravity, roughness.number.at(*x, *y)) as f32);
            of_cells.extend(new);
        }
    }

    /// Velocity over the root of the slope and the depth to 2/3, m^(1/3)/s; none where the law is not Manning's, or there is no friction.
    pub fn conveyance(&self, cell: usize, gravity: f64) -> Option<f64> {
        let squared = if self.law == Law::Manning { self.coefficient(cell) } else { 0.0 };
        (squared > 0.0).then(|| (gravity / squared).sqrt())
    }

    /// By what the momentum is multiplied over `step` s: a backward Euler step of du/dt = -k |u| u or -k u for the depth as it is, which balances
    /// the slope in normal flow whatever the step.
    #[inline]
    pub fn factor(&self, cell: usize, depth: f64, momentum_per_area: f64, step: f64) -> f64 {
        let coefficient = self.coefficient(cell);
        if coefficient == 0.0 {
            return 1.0;
        }
        if self.law.is_linear() {
            return 1.0 / (1.0 + step * coefficient);
        }
        let thick = depth.max(THINNEST);
        // The root of any depth is above this: nearly still water need not have its own found.
        if 4.0 * step * coefficient * momentum_per_area < 1e-17 * THINNEST_ROOT * thick * thick {
            return 1.0;
        }
        if depth < STILL {
            return 0.0;
        }
        let rate = coefficient / self.law.power_of(thick);
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
        let slowing = Slowing::even(Law::Manning, gravity * n * n);
        for step in [1e-3, 1.0, 1e3] {
            let pushed = depth * (normal + step * gravity * slope);
            let velocity = pushed * slowing.factor(0, depth, pushed, step) / depth;
            assert!((velocity / normal - 1.0).abs() < 1e-12);
        }
    }
}
