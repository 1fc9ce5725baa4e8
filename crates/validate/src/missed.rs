//! Targets that are known to be missed. They are shown beside the value, neither passed nor failed, as long as it does not become worse.

use crate::Row;

/// Case and measure, and the worst value accepted before the row fails.
const MISSED: &[(&str, &str, f64)] = &[
    // 7.3, 3.3 and 1.01 % at the three spacings: the boundary layers are four particles thick.
    ("dew/cavity", "nusselt_error_1e5_40", 0.0125),
    ("flood/voronoi/stoker", "relative_l1_error_1m", 8.8e-4),
    ("flood/voronoi/thacker-radial", "relative_l1_error_2cm", 1.15e-2),
    ("flood/voronoi/thacker-radial", "order", 1.4),
    ("flood/voronoi/lake-blocks", "rms_speed_after_waves", 2e-3),
    ("flood/voronoi/lake-jacksboro", "rms_speed_after_waves_200m", 1.5e-3),
    // 1.6e-14 at 200 m. What runs off a pool in a step is less than the last digit of the lake's cells: likely it is lost there.
    ("flood/voronoi/lake-long", "water_relative_error_after_waves", 3e-13),
    ("flood/voronoi/sheets", "velocity_error_slope_30", 1.3e-2),
    ("flood/voronoi/energy", "highest_energy_of_sloshing", 4.5e-4),
    ("flood/voronoi/malpasset", "rms_change_of_highest_levels", 3.0),
    ("flood/voronoi/invariance", "difference_when_turned", 0.07),
    // The thin water that runs down is half a cell behind, and off the beach the exact solution is linear.
    ("flood/voronoi/beach", "farthest_profile_error_005d", 6e-3),
    // The water is so shallow that nearly all blocks become fine: 1785 of 1851 cells at the start, all of them after a period.
    ("flood/voronoi/adaptive", "bowl_work_over_4cm", 0.97),
    // Without friction broken waves run up 72 % too high at a height of 0.19; at n = 0.01 too low by this, at finer spacings too.
    ("flood/voronoi/run-up", "run_up_error_height_009", 0.09),
    ("flood/voronoi/run-up", "run_up_error_height_019", 0.09),
    ("flood/voronoi/run-up", "run_up_error_height_030", 0.14),
    // What is left at the finest spacing has not been explained.
    ("flood/voronoi/swashes", "macdonald_undulating_manning_order", 0.8),
];

/// Marks the rows whose target is known to be missed and whose value is no worse than accepted.
pub(crate) fn mark(mut rows: Vec<Row>) -> Vec<Row> {
    for row in rows.iter_mut().filter(|row| row.pass == Some(false)) {
        let known = MISSED.iter().find(|(case, measure, _)| row.case == *case && row.measure == *measure);
        let (Some((.., limit)), Some(value)) = (known, row.value) else { continue };
        let is_no_worse = if row.relation == ">=" { value >= *limit } else { value <= *limit };
        if is_no_worse {
            row.pass = None;
            row.reason = Some(format!("target missed; fails if it comes beyond {limit}"));
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_known_miss_that_becomes_worse_fails() {
        let row = |value| Row::at_most("flood/voronoi/stoker", "relative_l1_error_1m", value, "", 8e-4);
        let marked = |value| mark(vec![row(value)])[0].pass;
        assert_eq!([7e-4, 8.5e-4, 9e-4, f64::NAN].map(marked), [Some(true), None, Some(false), Some(false)]);
        let other = Row::at_most("flood/stoker", "relative_l1_error_1m", 8.5e-4, "", 8e-4);
        assert_eq!(mark(vec![other])[0].pass, Some(false));
    }
}
