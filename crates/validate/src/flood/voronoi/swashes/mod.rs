//! All exact solutions of the reference data by scheme `voronoi`, written by SWASHES 1.05 (Delestre et al. 2013, *International Journal for
//! Numerical Methods in Fluids* 72).

mod bowls;
mod breaks;
mod channels;
mod profile;

use profile::{Profile, numbers};

use super::super::{order, rows};
use super::worst;
use crate::device::is_reduced;
use crate::{Case, Options, Row};
use corpuscle_model::ModelError;
use std::path::Path;

pub(in super::super) const SWASHES: Case = Case {
    name: "flood/voronoi/swashes",
    about: "Every exact solution in the folder of reference data (SWASHES 1.05, Delestre et al. 2013) by scheme voronoi, three seeds, three spacings: mean \
            |h - h_exact| / mean h_exact at the finest, and the order between the widest and the finest. Steady flows start dry or from still water.",
    slow: true,
    reduced: 6.0,
    run: swashes,
};

/// Width of a strip in spacings; its long sides are joined.
const WIDTH: f64 = 5.0;

/// One solution: how it is measured, and what it must keep.
struct Solution {
    /// Name of its file without `.txt`.
    file: &'static str,
    /// The finest distance between particles, m.
    spacing: f64,
    /// mean |h - h_exact| / mean h_exact of a file at a spacing, m, and a seed.
    error: fn(&Path, f64, u64) -> Result<f64, ModelError>,
    /// Bound of the error at the finest spacing.
    bound: f64,
    /// Why an order of 0.9 is not to be expected, where it is not.
    no_order: Option<&'static str>,
}

const fn solution(
    file: &'static str,
    spacing: f64,
    error: fn(&Path, f64, u64) -> Result<f64, ModelError>,
    bound: f64,
    no_order: Option<&'static str>,
) -> Solution {
    Solution { file, spacing, error, bound, no_order }
}

const LEVEL: Option<&str> =
    Some("the lake is level but for rounding; what is measured is the shore between positions of the file");
const STEP: Option<&str> = Some("a shock, and a step that is one spacing wide: an order of 1 at most");
const DRESSLER: Option<&str> = Some("the solution itself is approximate at its tip");

const SOLUTIONS: [Solution; 17] = [
    solution("lake_emerged_bump", 0.2, breaks::lake, 1e-3, LEVEL),
    solution("stoker", 0.04, breaks::stoker, 8e-3, None),
    solution("ritter", 0.04, breaks::ritter, 6e-3, None),
    solution("dressler_friction", 4.0, breaks::dressler, 8e-3, DRESSLER),
    solution("dambreak_step", 0.1, breaks::step, 2e-2, STEP),
    solution("thacker_1d_planar", 0.016, breaks::parabola, 7e-3, None),
    solution("2d_t1_1", 0.025, bowls::curved, 4e-2, None),
    solution("2d_t1_2", 0.04, bowls::plane, 5e-2, None),
    solution("bump_subcritical", 0.4, channels::bump_subcritical, 1e-3, None),
    solution("bump_transcritical_noshock", 0.4, channels::bump_transcritical, 7e-3, None),
    solution("bump_transcritical_shock", 0.4, channels::bump_shock, 1e-2, None),
    solution("macdonald_long_subcritical_manning", 8.0, channels::long_subcritical, 3e-3, None),
    solution("macdonald_long_super2sub_manning", 10.0, channels::long_jump, 4e-3, None),
    solution("macdonald_short_shock_manning", 2.0, channels::short_shock, 1e-2, None),
    solution("macdonald_undulating_manning", 20.0, channels::undulating, 4e-3, None),
    solution("macdonald_rain_subcritical_manning", 10.0, channels::rain, 7e-3, None),
    solution("mobile_rain", 16.0, channels::mobile_rain, 6e-3, None),
];

/// Left out at the reduced size: the first two are `flood/voronoi/thacker-radial` and `flood/voronoi/thacker-planar`, the others have rain by a function.
const LEFT_OUT: [&str; 4] = ["2d_t1_1", "2d_t1_2", "macdonald_rain_subcritical_manning", "mobile_rain"];

fn swashes(options: &Options) -> Vec<Row> {
    let Some(data) = &options.data else { return vec![Row::without_data(SWASHES.name, options)] };
    let wanted = SOLUTIONS.iter().filter(|solution| !is_reduced() || !LEFT_OUT.contains(&solution.file));
    wanted.flat_map(|solution| rows(SWASHES.name, solution.measure(&data.join("swashes")))).collect()
}

impl Solution {
    fn measure(&self, folder: &Path) -> Result<Vec<Row>, ModelError> {
        let path = folder.join(self.file).with_extension("txt");
        let mut errors = [0.0; 3];
        for (error, times) in errors.iter_mut().zip([1.0, 2.0, 4.0]) {
            let [found] = worst(|seed| Ok([(self.error)(&path, times * self.spacing, seed)?]))?;
            *error = found;
        }
        let measure = |what: &str| format!("{}_{what}", self.file);
        let found = order(errors[0], errors[2], 4.0);
        let order = measure("order");
        Ok(vec![
            Row::at_most(SWASHES.name, &measure("error"), errors[0], "", self.bound),
            match self.no_order {
                None => Row::at_least(SWASHES.name, &order, found, "", 0.9),
                Some(why) => Row::beside(SWASHES.name, &order, found, "", 0.9, why),
            },
        ])
    }
}
