//! Friction of the ground on the particles.

#[cfg(feature = "gpu")]
pub(super) mod upload;

use super::particle::Particle;
use crate::friction::Roughness;

impl Roughness {
    /// Slows a particle for `step` s by a backward Euler step of dv/dt = -k |v| v or -k v, for the depth as it is. That stops water but
    /// never turns it round, and keeps water steady where friction balances another force, however long the step.
    ///
    /// Gives the change of momentum over density, sum of both components, m4/s.
    #[inline]
    pub(super) fn slow(&self, particle: &mut Particle, gravity: f64, step: f64) -> f64 {
        let coefficient = self.law.coefficient(gravity, self.number.at(particle.x, particle.y));
        let factor = if self.law.is_linear() {
            1.0 / (1.0 + step * coefficient)
        } else {
            let k = coefficient / self.law.power_of(particle.depth);
            2.0 / (1.0 + (1.0 + 4.0 * k * step * particle.speed()).sqrt())
        };
        let before = particle.u + particle.v;
        particle.u *= factor;
        particle.v *= factor;
        particle.volume * (particle.u + particle.v - before)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::{Coefficient, Law};

    fn particle() -> Particle {
        let mut particle = Particle::new(0, 0.0, 0.0, 1.0, 1.0);
        (particle.u, particle.v, particle.depth) = (3.0, 4.0, 0.5);
        particle
    }

    /// In small steps the exact solutions; in any step v' with v' + k |v'| v' step = v, along v.
    #[test]
    fn friction_follows_its_laws() {
        let manning = 9.81 * 0.03 * 0.03 / 0.5_f64.powf(4.0 / 3.0);
        let chezy = 9.81 / (40.0 * 40.0 * 0.5);
        let rough = [
            (Law::Manning, 0.03, manning, true),
            (Law::Chezy, 40.0, chezy, true),
            (Law::Linear, 0.01, 9.81 * 0.01, false),
        ];
        for (law, number, k, quadratic) in rough {
            let rough = Roughness { law, number: Coefficient::Even(number) };
            let (mut once, mut often) = (particle(), particle());
            let impulse = rough.slow(&mut once, 9.81, 2.0);
            assert_eq!(impulse, once.u + once.v - 7.0);
            let speed = once.speed();
            let before = speed + 2.0 * k * speed * if quadratic { speed } else { 1.0 };
            assert!((before - 5.0).abs() < 1e-12 && (once.u / once.v - 0.75).abs() < 1e-12);
            for _ in 0..10_000 {
                rough.slow(&mut often, 9.81, 2e-4);
            }
            let exact = if quadratic { 5.0 / (1.0 + 2.0 * k * 5.0) } else { 5.0 * (-2.0 * k).exp() };
            assert!((often.speed() / exact - 1.0).abs() < 1e-4, "{} {exact}", often.speed());
        }
    }
}
