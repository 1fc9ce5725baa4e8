//! What splitting and merging of particles gains, on a dry front and under rain.

use super::dam_break::{self, DAM, TIME, UPSTREAM};
use super::device::{rounding, water_rounding};
use super::weather::Plane;
use super::{GRAVITY, rows};
use crate::{Case, Row};
use corpuscle_flood::Flood;
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::Refinement;

pub(super) const REFINEMENT: Case = Case {
    name: "flood/refinement",
    about: "Ritter's dam break at 2 m and rain on a plane at 1 m, with particles split where water is thin and without: where the sheet \
            is less than 1.4 m deep, depth, velocity and the water in strips of 8 m; on the plane, depth at 2800 places. Gains are errors \
            without over errors with.",
    slow: true,
    reduced: 2.0,
    run: |_| rows(REFINEMENT.name, refinement()),
};

/// The sheet begins where the exact flow goes at this many times the speed of waves upstream; beyond, it is 1.34 m deep at most.
const SHEET: f64 = 0.9;

/// Length of the strips in which water is counted, m.
const STRIP: f64 = 8.0;

/// What is wrong in the sheet of a dam break.
struct Sheet {
    /// mean |d - d_exact| / mean d_exact.
    depth: f64,
    /// mean |u - u_exact|, m/s, where it is deeper than 1 cm.
    velocity: f64,
    /// mean |volume - exact| / mean exact of strips: the particles themselves, not what is sampled of them.
    strips: f64,
    /// From where it is 1 cm deep to where it should be, m.
    front: f64,
}

fn refinement() -> Result<Vec<Row>, ModelError> {
    let name = REFINEMENT.name;
    let (spacing, refined) = (2.0, Some(Refinement::default()));
    let broken = |refinement| dam_break::run_to_end(spacing, 0.0, refinement);
    let (plain, fine) = (broken(None)?, broken(refined)?);
    let work = |fine: &Flood, plain: &Flood| fine.particle_steps() as f64 / plain.particle_steps() as f64;
    let dam_work = work(&fine, &plain);
    let ledger = fine.ledger();
    let [without, with] = [&plain, &fine].map(|flood| sheet(flood, 14.0 * spacing));
    let plane = Plane::STEADY;
    let (plain, fine) = (plane.run(1.0, None)?, plane.run(1.0, refined)?);
    let rain_work = work(&fine, &plain);
    let [dry_rain, fine_rain] = [&plain, &fine].map(|flood| plane.error_of_samples(flood));
    let coarse = 2.0 * spacing;
    let sheet_of_coarse = |refinement| {
        let flood = dam_break::run_to_end(coarse, 0.0, refinement)?;
        Ok::<_, ModelError>(sheet(&flood, 14.0 * coarse).depth)
    };
    let [coarse_without, coarse_with] = [sheet_of_coarse(None)?, sheet_of_coarse(refined)?];
    let at_most = |measure, value: f64, unit, bound| Row::at_most(name, measure, value, unit, bound);
    let gain = |measure, without: f64, with: f64, bound| Row::at_least(name, measure, without / with, "", bound);
    Ok(vec![
        at_most("ritter_sheet_depth_error", with.depth, "", 0.045),
        at_most("ritter_sheet_velocity_error", with.velocity, "m/s", 0.1),
        at_most("ritter_sheet_strip_error", with.strips, "", 0.08),
        at_most("ritter_front_error", with.front, "m", 6.0),
        at_most("ritter_work", dam_work, "", 1.3),
        gain("ritter_front_gain", without.front, with.front, 4.0),
        gain("ritter_sheet_depth_gain", without.depth, with.depth, 1.3),
        gain("ritter_sheet_velocity_gain", without.velocity, with.velocity, 2.0),
        gain("ritter_sheet_strip_gain", without.strips, with.strips, 4.0),
        at_most("ritter_water_relative_error", ledger.balances[0].relative_error().abs(), "", water_rounding()),
        at_most("ritter_momentum_relative_error", ledger.balances[1].relative_error().abs(), "", rounding(1e-12, 1e-6)),
        Row::beside(
            name,
            "ritter_sheet_depth_error_4m",
            coarse_with,
            "",
            coarse_without,
            "the sheet's depth without splitting: at 4 m the halvings disturb it more than their closeness helps",
        ),
        at_most("rain_work", rain_work, "", 4.5),
        at_most("rain_depth_error", fine_rain, "", 0.06),
        gain("rain_depth_gain", dry_rain, fine_rain, 4.0),
        at_most("rain_outflow_error", plane.error_of_outflow(&fine).abs(), "", 0.01),
        at_most("rain_water_relative_error", fine.ledger().balances[0].relative_error().abs(), "", water_rounding()),
    ])
}

fn sheet(flood: &Flood, width: f64) -> Sheet {
    let wave = (GRAVITY * UPSTREAM).sqrt();
    let depth = |x: f64| dam_break::exact_depth((x - DAM) / TIME, 0.0);
    let velocity = |x: f64| 2.0 / 3.0 * (wave + (x - DAM) / TIME);
    let first = (DAM + SHEET * wave * TIME).ceil() as usize;
    let lines = 7;
    let (mut wrong, mut right, mut off, mut places, mut front) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for x in (first..dam_break::LENGTH as usize).map(|metre| metre as f64 + 0.5) {
        let samples: Vec<_> =
            (0..lines).map(|line| flood.sample(x, width * (f64::from(line) + 0.5) / f64::from(lines))).collect();
        let mean =
            |of: &dyn Fn(&corpuscle_flood::Sample) -> f64| samples.iter().map(of).sum::<f64>() / f64::from(lines);
        right += depth(x);
        wrong += mean(&|sample| (sample.depth - depth(x)).abs());
        if mean(&|sample| sample.depth) > 0.01 {
            front = x;
            if depth(x) > 0.01 {
                off += mean(&|sample| (sample.velocity[0] - velocity(x)).abs());
                places += 1.0;
            }
        }
    }
    let (mut wrong_strips, mut right_strips) = (0.0, 0.0);
    let pieces = 80;
    for strip in (first / STRIP as usize + 1)..(dam_break::LENGTH / STRIP) as usize {
        let from = STRIP * strip as f64;
        let here = flood.particles().iter().filter(|particle| (from..from + STRIP).contains(&particle.x));
        let found = here.map(|particle| particle.volume).sum::<f64>() / (STRIP * width);
        let piece = |k: i32| depth(from + STRIP * (f64::from(k) + 0.5) / f64::from(pieces));
        let exact = (0..pieces).map(piece).sum::<f64>() / f64::from(pieces);
        wrong_strips += (found - exact).abs();
        right_strips += exact;
    }
    // sqrt(g d) = (2 c - x / t) / 3 at a depth of 1 cm.
    let exact_front = DAM + TIME * (2.0 * wave - 3.0 * (GRAVITY * 0.01).sqrt());
    Sheet {
        depth: wrong / right,
        velocity: off / places,
        strips: wrong_strips / right_strips,
        front: (front - exact_front).abs(),
    }
}
