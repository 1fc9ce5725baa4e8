//! All exact solutions of the reference data, written by SWASHES 1.05 (Delestre et al. 2013, *International Journal for Numerical
//! Methods in Fluids* 72).

mod bowls;
mod breaks;
mod channels;
mod profile;

pub(super) use channels::mobile_rain_at as mobile_rain;
pub(super) use profile::{Profile, numbers};

use super::rows;
use crate::device::is_reduced;
use crate::{Case, Options, Row};
use corpuscle_model::ModelError;
use std::path::Path;

pub(super) const SWASHES: Case = Case {
    name: "flood/swashes",
    about: "Every exact solution in the folder of reference data (SWASHES 1.05, Delestre et al. 2013): mean |h - h_exact| / mean \
            h_exact at two spacings, the second twice the first, and the order between them. Steady flows begin as they are and must \
            stay while water passes through; at both ends the channel runs on evenly.",
    slow: true,
    reduced: 2.0,
    run: swashes,
};

/// One solution: how it is measured, and what it must keep.
struct Solution {
    /// Name of its file without `.txt`.
    file: &'static str,
    /// The finer distance between particles, m.
    spacing: f64,
    /// mean |h - h_exact| / mean h_exact at that distance and the file.
    error: fn(&Path, f64) -> Result<f64, ModelError>,
    /// Bound of the error, and of the order where one is to be expected.
    bound: f64,
    order: Option<f64>,
}

const fn solution(
    file: &'static str,
    spacing: f64,
    error: fn(&Path, f64) -> Result<f64, ModelError>,
    bound: f64,
    order: Option<f64>,
) -> Solution {
    Solution { file, spacing, error, bound, order }
}

const SOLUTIONS: [Solution; 17] = [
    solution("lake_emerged_bump", 0.1, breaks::lake, 1e-3, None),
    solution("stoker", 0.04, breaks::stoker, 8e-3, Some(0.5)),
    solution("ritter", 0.04, breaks::ritter, 6e-3, Some(0.4)),
    solution("dressler_friction", 4.0, breaks::dressler, 8e-3, None),
    solution("dambreak_step", 0.1, breaks::step, 2e-2, None),
    solution("thacker_1d_planar", 0.01, breaks::parabola, 7e-3, Some(0.45)),
    solution("2d_t1_1", 0.02, bowls::curved, 4e-2, Some(0.45)),
    solution("2d_t1_2", 0.02, bowls::plane, 5e-2, Some(0.45)),
    solution("bump_subcritical", 0.2, channels::bump_subcritical, 1e-3, Some(0.45)),
    solution("bump_transcritical_noshock", 0.2, channels::bump_transcritical, 7e-3, Some(0.45)),
    solution("bump_transcritical_shock", 0.2, channels::bump_shock, 1e-2, Some(0.45)),
    solution("macdonald_long_subcritical_manning", 5.0, channels::long_subcritical, 3e-3, None),
    solution("macdonald_long_super2sub_manning", 5.0, channels::long_jump, 4e-3, None),
    solution("macdonald_short_shock_manning", 1.0, channels::short_shock, 1e-2, Some(0.45)),
    solution("macdonald_undulating_manning", 10.0, channels::undulating, 4e-3, None),
    solution("macdonald_rain_subcritical_manning", 5.0, channels::rain, 7e-3, None),
    solution("mobile_rain", 4.0, channels::mobile_rain, 6e-3, None),
];

/// Left out at the reduced size: the first two are `flood/thacker-radial` and `flood/thacker-planar`, and all three take longest.
const LONG: [&str; 3] = ["2d_t1_1", "2d_t1_2", "mobile_rain"];

fn swashes(options: &Options) -> Vec<Row> {
    let Some(data) = &options.data else { return vec![Row::without_data(SWASHES.name, options)] };
    let wanted = SOLUTIONS.iter().filter(|solution| !is_reduced() || !LONG.contains(&solution.file));
    let measured = wanted.map(|solution| rows(SWASHES.name, solution.measure(&data.join("swashes"))));
    measured.flatten().collect()
}

impl Solution {
    fn measure(&self, folder: &Path) -> Result<Vec<Row>, ModelError> {
        let path = folder.join(self.file).with_extension("txt");
        let measure = |what: &str| format!("{}_{what}", self.file);
        let coarse = (self.error)(&path, 2.0 * self.spacing)?;
        if is_reduced() {
            return Ok(vec![Row::at_most(SWASHES.name, &measure("error"), coarse, "", self.bound)]);
        }
        let fine = (self.error)(&path, self.spacing)?;
        let error = Row::at_most(SWASHES.name, &measure("error"), fine, "", self.bound);
        let twice = Row::beside(SWASHES.name, &measure("error_at_twice"), coarse, "", fine, "for the order");
        let order = super::order(fine, coarse, 2.0);
        let order = match self.order {
            Some(least) => Row::at_least(SWASHES.name, &measure("order"), order, "", least),
            None => Row::beside(SWASHES.name, &measure("order"), order, "", 0.0, "no order is to be expected"),
        };
        Ok(vec![error, twice, order])
    }
}
