//! What an error costs: the dam breaks with exact solutions, and a vortex, by scheme voronoi at three spacings.

use super::voronoi::dam_breaks::{self, TIME};
use super::voronoi::vortex;
use crate::Rate;
use crate::bench::Stepped;
use corpuscle_model::ModelError;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

const SPACINGS: [f64; 3] = [4.0, 2.0, 1.0];

/// Unit of the cost of a dam break.
const PER_WIDTH: &str = "core_s_per_m";

/// Error and cost of each dam break and spacing. The cost is that of all threads, for each metre of the channel's width; setting up does not count.
pub(super) fn measured() -> Vec<Rate> {
    let of_one = |name: &str, downstream: f64, spacing: f64| {
        let flood = dam_breaks::broken(0.0, spacing, 1, downstream)?;
        let width = dam_breaks::WIDTH * spacing;
        let name = format!("flood/error-cost/{name}-{spacing}m");
        entries(name, flood, TIME, (1.0 / width, PER_WIDTH), |flood| dam_breaks::error(flood, spacing, downstream))
    };
    let breaks = [("stoker", 1.0), ("ritter", 0.0)];
    let all = breaks.into_iter().flat_map(|(name, downstream)| SPACINGS.map(|spacing| (name, downstream, spacing)));
    all.flat_map(|(name, downstream, spacing)| of_one(name, downstream, spacing).unwrap_or_default()).collect()
}

/// Error of the velocity and cost of the carried vortex at each spacing; the cost is that of all threads.
pub(super) fn of_vortex() -> Vec<Rate> {
    let of_spacing = |spacing: f64| {
        let name = format!("flood/voronoi-vortex/{spacing}m");
        let flood = vortex::start(spacing, 1)?;
        entries(name, flood, vortex::TIME, (1.0, "core_s"), |flood| vortex::errors(flood)[0])
    };
    vortex::SPACINGS.into_iter().rev().flat_map(|spacing| of_spacing(spacing).unwrap_or_default()).collect()
}

/// Error at `time` s, and the cost until then, as so many of a unit for each core-second.
fn entries<M: Stepped>(
    name: String,
    mut model: M,
    time: f64,
    (per_core_second, unit_of_cost): (f64, &str),
    error: impl Fn(&M) -> f64,
) -> Result<Vec<Rate>, ModelError> {
    let (particles, threads) = (model.particles(), rayon::current_num_threads());
    let began = Instant::now();
    model.advance_to(time, &AtomicBool::new(false))?;
    let cost = began.elapsed().as_secs_f64() * threads as f64 * per_core_second;
    let entry = |rate: f64, unit: &str| Rate {
        name: name.clone(),
        particles,
        dimensions: 2,
        packing: None,
        threads,
        device: None,
        rate,
        rate_unit: unit.into(),
        processes: None,
        bytes_per_particle: model.bytes() as f64 / particles as f64,
        passes: Vec::new(),
    };
    Ok(vec![entry(error(&model), "relative_l1_error"), entry(cost, unit_of_cost)])
}
