//! The same set-up turned, and in other units of length.

use super::super::{GRAVITY, rows};
use super::dam_breaks::exact_depth;
use super::{all_sides, run, settings};
use crate::{Case, Options, Row};
use corpuscle_flood::{Filling, StartWater};
use corpuscle_model::ModelError;
use corpuscle_scene::{Edge, Flood};
use corpuscle_terrain::{Bounds, Terrain};
use std::sync::Arc;

pub(in super::super) const INVARIANCE: Case = Case {
    name: "flood/voronoi/invariance",
    about: "A dam break onto a wet bed, 10 m against 1 m, down a plane of fall 0.02 after 4 s by scheme voronoi, particles 2 m apart, mean of nine \
            seeds (exact: Stoker 1957 in the frame that falls with the slope): ground and water turned by 30 degrees, and all lengths a \
            hundred times as large, must give the same error.",
    slow: false,
    reduced: 4.0,
    run: |_: &Options| rows(INVARIANCE.name, measure()),
};

/// Half the width of the ground, s, and its fall. What walls do does not come to where depths are compared.
const HALF: f64 = 100.0;
const TIME: f64 = 4.0;
const FALL: f64 = 0.02;

/// Seeds of the particles' positions.
const SEEDS: u64 = 9;

/// Half of the length and of the width of the rectangle in which depths are compared.
const COMPARED: [i32; 2] = [60, 15];

fn measure() -> Result<Vec<Row>, ModelError> {
    let plain = Turned { degrees: 0.0, unit: 1.0 }.error()?;
    let turned = Turned { degrees: 30.0, unit: 1.0 }.error()?;
    let scaled = Turned { degrees: 0.0, unit: 100.0 }.error()?;
    let row = |measure, value, bound| Row::at_most(INVARIANCE.name, measure, value, "", bound);
    Ok(vec![
        row("relative_l1_error", plain, 1.5e-2),
        row("difference_when_turned", (turned / plain - 1.0).abs(), 0.05),
        row("difference_in_other_units", (scaled / plain - 1.0).abs(), 0.01),
    ])
}

struct Turned {
    degrees: f64,
    /// Number of units of length in a metre.
    unit: f64,
}

impl Turned {
    /// Mean over nine seeds of mean |h - h_exact| / mean h_exact.
    fn error(&self) -> Result<f64, ModelError> {
        let errors = (1..=SEEDS).map(|seed| self.of_seed(seed)).collect::<Result<Vec<f64>, ModelError>>()?;
        Ok(errors.iter().sum::<f64>() / errors.len() as f64)
    }

    fn of_seed(&self, seed: u64) -> Result<f64, ModelError> {
        let unit = self.unit;
        let (sin, cos) = self.degrees.to_radians().sin_cos();
        let half = HALF * unit;
        let bounds = Bounds { x_min: -half, x_max: half, y_min: -half, y_max: half };
        let slope = [-FALL * cos, -FALL * sin];
        let ground = move |x: f64, y: f64| (slope[0] * x + slope[1] * y, slope);
        let terrain = Arc::new(Terrain::analytic(bounds, unit, ground));
        let pool = |depth: f64, from: f64, to: f64| {
            let corners = [[from, -1e3], [to, -1e3], [to, 1e3], [from, 1e3]];
            StartWater {
                filling: Filling::Depth(Box::new(move |_, _| depth * unit)),
                polygon: Some(corners.map(|[s, t]| [unit * (s * cos - t * sin), unit * (s * sin + t * cos)]).to_vec()),
                velocity: Box::new(|_, _| [0.0; 2]),
            }
        };
        let water = [pool(10.0, -1e3, 0.0), pool(1.0, 0.0, 1e3)];
        let settings = settings(2.0 * unit, 0.0, all_sides(&Edge::Wall));
        let settings = Flood { gravity_m_per_s2: unit * GRAVITY, ..settings };
        let flood = run(&settings, seed, &terrain, &water, TIME)?;
        let fallen = 0.5 * GRAVITY * FALL * TIME * TIME;
        let (mut wrong, mut right) = (0.0, 0.0);
        for along in -COMPARED[0]..COMPARED[0] {
            for across in -COMPARED[1]..COMPARED[1] {
                let [s, t] = [along, across].map(|k| f64::from(k) + 0.5);
                let exact = exact_depth((s - fallen) / TIME, 1.0);
                let depth = flood.sample(unit * (s * cos - t * sin), unit * (s * sin + t * cos)).depth / unit;
                wrong += (depth - exact).abs();
                right += exact;
            }
        }
        Ok(wrong / right)
    }
}
