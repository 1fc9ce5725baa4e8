//! What an error costs: the dam breaks with exact solutions, by schemes voronoi and balanced at three spacings.

use super::dam_break::{self, TIME};
use super::voronoi::dam_breaks;
use crate::Rate;
use crate::bench::Stepped;
use corpuscle_model::ModelError;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

const SPACINGS: [f64; 3] = [4.0, 2.0, 1.0];

/// Error and cost of each dam break, scheme and spacing. The cost is that of all threads, for each metre of the channel's width; setting up does not count.
pub(super) fn measured() -> Vec<Rate> {
    let mut rates = Vec::new();
    for (name, downstream) in [("stoker", 1.0), ("ritter", 0.0)] {
        for spacing in SPACINGS {
            let name = |scheme: &str| format!("flood/error-cost/{name}-{scheme}-{spacing}m");
            let by_cells = dam_breaks::broken(0.0, spacing, 1, downstream).and_then(|flood| {
                let width = dam_breaks::WIDTH * spacing;
                entries(name("voronoi"), flood, width, |flood| dam_breaks::error(flood, spacing, downstream))
            });
            let by_kernels = dam_break::run_until(0.0, spacing, downstream, None).and_then(|flood| {
                let width = dam_break::WIDTH * spacing;
                entries(name("balanced"), flood, width, |flood| dam_break::error(flood, spacing, downstream))
            });
            rates.extend(by_cells.unwrap_or_default());
            rates.extend(by_kernels.unwrap_or_default());
        }
    }
    rates
}

fn entries<M: Stepped>(
    name: String,
    mut model: M,
    width: f64,
    error: impl Fn(&M) -> f64,
) -> Result<Vec<Rate>, ModelError> {
    let (particles, threads) = (model.particles(), rayon::current_num_threads());
    let began = Instant::now();
    model.advance_to(TIME, &AtomicBool::new(false))?;
    let cost = began.elapsed().as_secs_f64() * threads as f64 / width;
    let entry = |rate: f64, unit: &str| Rate {
        name: name.clone(),
        particles,
        dimensions: 2,
        packing: None,
        threads,
        device: None,
        rate,
        rate_unit: unit.into(),
        bytes_per_particle: model.bytes() as f64 / particles as f64,
        passes: Vec::new(),
    };
    Ok(vec![entry(error(&model), "relative_l1_error"), entry(cost, "core_s_per_m")])
}
