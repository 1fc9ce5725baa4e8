//! Ground that drinks a pond.

use super::super::rows;
use super::{all_sides, run, settings, worst};
use crate::{Case, Options, Row};
use corpuscle_flood::{Filling, StartWater, VoronoiFlood};
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::{Edge, Flood, GreenAmpt, Horton, Infiltration};
use corpuscle_terrain::{Bounds, Terrain};
use std::sync::Arc;

pub(in super::super) const INFILTRATION: Case = Case {
    name: "flood/voronoi/infiltration",
    about: "What a pond 0.3 m deep in waves of 0.1 m loses in half an hour to ground after Horton 1940 (his integral) and after Green & Ampt 1911 (their \
            equation, solved by bisection), by scheme voronoi, three seeds, particles 2 m apart.",
    slow: false,
    reduced: 2.0,
    run: |_: &Options| rows(INFILTRATION.name, measure()),
};

const LENGTH: f64 = 30.0;
const WIDTH: f64 = 20.0;
const HOURS: f64 = 0.5;

fn measure() -> Result<Vec<Row>, ModelError> {
    let horton = Horton { first_mm_per_h: 200.0, last_mm_per_h: 20.0, decay_per_h: 3.0 };
    let green_ampt = GreenAmpt { conductivity_mm_per_h: 30.0, suction_m: 0.11, deficit: 0.35 };
    let laws = [
        ("relative_error_horton", Infiltration::Horton(horton), by_horton(&horton)),
        ("relative_error_green_ampt", Infiltration::GreenAmpt(green_ampt), by_green_ampt(&green_ampt)),
    ];
    let row = |(measure, law, exact): (&'static str, Infiltration, f64)| {
        let [error] = worst(|seed| Ok([(lost(law, seed)? / exact - 1.0).abs()]))?;
        Ok(Row::at_most(INFILTRATION.name, measure, error, "", 1e-3))
    };
    laws.into_iter().map(row).collect()
}

/// Depth that the pond has lost, m.
fn lost(law: Infiltration, seed: u64) -> Result<f64, ModelError> {
    let bounds = Bounds { x_min: 0.0, x_max: LENGTH, y_min: 0.0, y_max: WIDTH };
    let terrain = Arc::new(Terrain::analytic(bounds, 1.0, |_, _| (0.0, [0.0; 2])));
    let settings = Flood { infiltration: Some(law), ..settings(2.0, 0.03, all_sides(&Edge::Wall)) };
    let water = StartWater {
        filling: Filling::Level(Box::new(|x, _| 0.3 + 0.1 * (std::f64::consts::PI * x / LENGTH).cos())),
        polygon: None,
        velocity: Box::new(|_, _| [0.0; 2]),
    };
    let flood = run(&settings, seed, &terrain, &[water], 3600.0 * HOURS)?;
    Ok(soaked(&flood) / (LENGTH * WIDTH))
}

/// All that has soaked in, m3.
fn soaked(flood: &VoronoiFlood) -> f64 {
    let columns = flood.gauge_columns();
    let column = columns.iter().position(|column| column.quantity == "total_infiltration");
    column.map_or(f64::NAN, |column| flood.gauge_row()[column])
}

/// The integral of f = f_c + (f_0 - f_c) exp(-k t), m (Horton 1940).
fn by_horton(law: &Horton) -> f64 {
    let Horton { first_mm_per_h: first, last_mm_per_h: last, decay_per_h: decay } = *law;
    1e-3 * (last * HOURS + (first - last) / decay * (1.0 - (-decay * HOURS).exp()))
}

/// The depth F for which F - psi theta ln(1 + F / (psi theta)) = K t, m (Green & Ampt 1911).
fn by_green_ampt(law: &GreenAmpt) -> f64 {
    let head = law.suction_m * law.deficit;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let conducted = middle - head * (1.0 + middle / head).ln();
        if conducted < 1e-3 * law.conductivity_mm_per_h * HOURS { low = middle } else { high = middle }
    }
    low
}
