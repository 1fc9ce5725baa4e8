//! How much water soaks into the ground, where it always stands on it.

use corpuscle_scene::LandClass;

/// m/s in a mm/h.
pub(crate) const MM_PER_H: f64 = 1e-3 / 3600.0;

/// A law of infiltration. What has soaked in so far, m, is its only memory: where less water comes than the ground would take,
/// the ground fills more slowly, as it should (after Rossman & Huber 2016, SWMM Reference Manual I, sections 4.3 and 4.4).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Law {
    /// At one rate, m/s.
    Constant(f64),
    /// Horton 1940: the rate falls from `first` to `last`, m/s, as exp(-decay t).
    Horton { first: f64, last: f64, decay: f64 },
    /// Green & Ampt 1911: conductivity (1 + head / soaked), with head = suction x deficit.
    GreenAmpt { conductivity: f64, head: f64 },
}

impl Law {
    pub fn of(scene: &corpuscle_scene::Infiltration) -> Self {
        match scene {
            corpuscle_scene::Infiltration::Constant(constant) => Self::Constant(MM_PER_H * constant.rate_mm_per_h),
            corpuscle_scene::Infiltration::Horton(horton) => Self::Horton {
                first: MM_PER_H * horton.first_mm_per_h,
                last: MM_PER_H * horton.last_mm_per_h,
                decay: horton.decay_per_h / 3600.0,
            },
            corpuscle_scene::Infiltration::GreenAmpt(ground) => Self::GreenAmpt {
                conductivity: MM_PER_H * ground.conductivity_mm_per_h,
                head: ground.suction_m * ground.deficit,
            },
        }
    }

    /// Kind and numbers, as `infiltration_laws.wgsl` takes them.
    #[cfg(feature = "gpu")]
    pub fn numbers(self) -> [f32; 4] {
        use crate::voronoi::gpu::{CONSTANT, GREEN_AMPT, HORTON};
        let (kind, numbers) = match self {
            Self::Constant(rate) => (CONSTANT, [rate, 0.0, 0.0]),
            Self::Horton { first, last, decay } => (HORTON, [first, last, decay]),
            Self::GreenAmpt { conductivity, head } => (GREEN_AMPT, [conductivity, head, 0.0]),
        };
        let [a, b, c] = numbers.map(|number| number as f32);
        [kind, a, b, c]
    }

    /// What soaks in within `step` s, m, where `soaked` m have before.
    pub fn demand(self, soaked: f64, step: f64) -> f64 {
        match self {
            Self::Constant(rate) => rate * step,
            Self::Horton { first, last, decay } => {
                let by = |time: f64| last * time + (first - last) / decay * -(-decay * time).exp_m1();
                (by(horton_time(soaked, first, last, decay) + step) - soaked).max(0.0)
            }
            Self::GreenAmpt { conductivity, head } => green_ampt(soaked, conductivity * step, head) - soaked,
        }
    }
}

/// The time after which `soaked` has soaked in, water always standing: the root of last t + (first - last) (1 - e^(-kt)) / k =
/// soaked. Newton's method from below a concave function never passes the root.
fn horton_time(soaked: f64, first: f64, last: f64, decay: f64) -> f64 {
    let mut time = 0.0;
    for _ in 0..NEWTON_ITERATIONS {
        let missing = soaked - last * time + (first - last) / decay * (-decay * time).exp_m1();
        let rate = last + (first - last) * (-decay * time).exp();
        if rate <= 0.0 || missing <= 1e-15 * soaked {
            break;
        }
        time += missing / rate;
    }
    time
}

/// Water that has soaked in after another `conducted` = K t: F - F0 - head ln((F + head) / (F0 + head)) = K t, by Newton's method
/// from above: the function is convex, and the first guess is beyond the root.
fn green_ampt(soaked: f64, conducted: f64, head: f64) -> f64 {
    if head <= 0.0 || conducted <= 0.0 {
        return soaked + conducted;
    }
    let mut total = soaked + conducted + (2.0 * conducted * (soaked + head)).sqrt();
    for _ in 0..NEWTON_ITERATIONS {
        let excess = total - soaked - head * ((total - soaked) / (soaked + head)).ln_1p() - conducted;
        let next = total - excess * (total + head) / total;
        if (next - total).abs() <= 1e-15 * total {
            break;
        }
        total = next;
    }
    total
}

/// Most iterations of Newton's method, which ends earlier where it has all digits; on a GPU, in single precision, `NEWTON_ITERATIONS_ON_GPU`.
const NEWTON_ITERATIONS: usize = 60;

/// The laws of a scene: those of its kinds of ground, which say where they differ from the rest.
pub(crate) fn of_class(class: &LandClass, rest: Option<Law>) -> Option<Law> {
    class.infiltration.as_ref().map(Law::of).or(rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HORTON: Law = Law::Horton { first: 3e-5, last: 4e-6, decay: 1e-3 };
    const GREEN_AMPT: Law = Law::GreenAmpt { conductivity: 3e-6, head: 0.03 };

    /// What has soaked in after `time` in steps of `step`.
    fn after(law: Law, time: f64, step: f64) -> f64 {
        let steps = (time / step).round() as usize;
        (0..steps).fold(0.0, |soaked, _| soaked + law.demand(soaked, step))
    }

    #[test]
    fn horton_soaks_in_his_integral_whatever_the_step() {
        let exact = |t: f64| 4e-6 * t + 2.6e-5 / 1e-3 * (1.0 - (-1e-3 * t).exp());
        for step in [1.0, 60.0, 3600.0] {
            assert!((after(HORTON, 3600.0, step) / exact(3600.0) - 1.0).abs() < 1e-10);
        }
    }

    #[test]
    fn green_ampt_solves_their_equation_whatever_the_step() {
        for step in [1.0, 60.0, 7200.0] {
            let soaked = after(GREEN_AMPT, 7200.0, step);
            let residual = soaked - 0.03 * (1.0 + soaked / 0.03).ln() - 3e-6 * 7200.0;
            assert!(residual.abs() < 1e-11, "{step}: {soaked} {residual}");
        }
    }

    #[test]
    fn dry_ground_takes_more_than_wet_ground() {
        for law in [HORTON, GREEN_AMPT] {
            assert!(law.demand(0.0, 60.0) > 1.5 * law.demand(0.05, 60.0));
        }
        assert_eq!(Law::Constant(2e-6).demand(0.5, 30.0), 2e-6 * 30.0);
        let sealed = Law::GreenAmpt { conductivity: 0.0, head: 0.1 };
        assert_eq!(sealed.demand(0.0, 60.0), 0.0);
        let sealing = Law::Horton { first: 1e-5, last: 0.0, decay: 1e-3 };
        assert!(sealing.demand(1e-2, 60.0) < 1e-6 && sealing.demand(0.02, 60.0) >= 0.0);
    }
}
