//! Rain, infiltration, and the ledger of all that comes and goes.

use super::device::water_rounding;
use super::{rows, run, settings, strip, water_everywhere};
use crate::{Case, Row};
use corpuscle_flood::Flood;
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::{
    Edge, Edges, Flood as Settings, GreenAmpt, Horton, Infiltration, Inflow, Link, LinkLaw, Manning, Outflow, Rain,
    Refinement, Series, Weir,
};
use corpuscle_terrain::{Bounds, Terrain};
use std::sync::Arc;

pub(super) const RAIN_ON_A_PLANE: Case = Case {
    name: "flood/rain-plane",
    about: "50 mm/h on a dry plane 100 m long (fall 0.02, n 0.1) for 2400 s, twice as long as it takes to be steady: outflow by \
            then and depth along the plane against the kinematic wave (Henderson & Wooding 1964).",
    slow: false,
    reduced: 2.0,
    run: |_| rows(RAIN_ON_A_PLANE.name, rain_on_a_plane()),
};

pub(super) const INFILTRATION: Case = Case {
    name: "flood/infiltration",
    about: "What a pond 0.3 m deep loses in half an hour to ground after Horton 1940 (his integral) and after Green & Ampt 1911 \
            (their equation, solved by bisection).",
    slow: false,
    reduced: 2.0,
    run: |_| rows(INFILTRATION.name, infiltration()),
};

pub(super) const LEDGER: Case = Case {
    name: "flood/ledger",
    about: "A slope with rain, infiltration, an inflow, a weir, an outflow by rating, a tide at its foot and an open side, particles \
            split and merged, all at once for 300 s: what is there must be what was there and came, less what went.",
    slow: false,
    reduced: 3.0,
    run: |_| rows(LEDGER.name, ledger()),
};

/// m/s in a mm/h.
const MM_PER_H: f64 = 1e-3 / 3600.0;

fn rain(mm_per_h: f64, film_m: f64) -> Option<Rain> {
    Some(Rain { intensity_mm_per_h: Series::Constant(mm_per_h), raster: None, film_m })
}

fn gauge(flood: &Flood, quantity: &str) -> f64 {
    let column = flood.gauge_columns().iter().position(|column| column.gauge == "water" && column.quantity == quantity);
    column.map_or(f64::NAN, |column| flood.gauge_row()[column])
}

/// A dry plane in the rain, and what the kinematic wave says of it: q = alpha d^(5/3); d = i t until the wave from the top comes by,
/// alpha d^(5/3) = i x from then on.
pub(super) struct Plane {
    length: f64,
    width: f64,
    slope: f64,
    manning: f64,
    mm_per_h: f64,
    time: f64,
}

impl Plane {
    /// 50 mm/h for twice as long as it takes to be steady.
    pub const STEADY: Self =
        Self { length: 100.0, width: 14.0, slope: 0.02, manning: 0.1, mm_per_h: 50.0, time: 2400.0 };

    /// The plane at its end.
    pub fn run(&self, spacing: f64, refinement: Option<Refinement>) -> Result<Flood, ModelError> {
        let slope = self.slope;
        let bounds = Bounds { x_min: 0.0, x_max: self.length, y_min: 0.0, y_max: self.width };
        let terrain = Arc::new(Terrain::analytic(bounds, 1.0, move |x, _| (-slope * x, [-slope, 0.0])));
        let settings = Settings {
            manning: Manning::Number(self.manning),
            rain: rain(self.mm_per_h, 5e-4),
            refinement,
            ..settings(self.time, spacing, 0.01, Edges { west: Edge::Wall, ..strip(&Edge::Open) })
        };
        run(&settings, &terrain, &[], self.time)
    }

    fn intensity(&self) -> f64 {
        MM_PER_H * self.mm_per_h
    }

    fn alpha(&self) -> f64 {
        self.slope.sqrt() / self.manning
    }

    /// Depth once the flow is steady, m.
    fn steady(&self, x: f64) -> f64 {
        (self.intensity() * x / self.alpha()).powf(0.6)
    }

    /// Relative error of what has flowed out.
    pub fn error_of_outflow(&self, flood: &Flood) -> f64 {
        let intensity = self.intensity();
        let by_then = self.steady(self.length) / intensity;
        let rising = self.alpha() * intensity.powf(5.0 / 3.0) * by_then.powf(8.0 / 3.0) * 0.375;
        let gone = self.width * (rising + intensity * self.length * (self.time - by_then));
        flood.ledger().balances[0].outflow / gone - 1.0
    }

    /// mean |d - d_exact| / mean d_exact of pieces of 10 m: particles that grow in the rain are few.
    fn error_of_pieces(&self, flood: &Flood) -> f64 {
        let (mut wrong, mut right) = (0.0, 0.0);
        for piece in 0..10 {
            let from = 10.0 * f64::from(piece);
            let here = flood.particles().iter().filter(|particle| (from..from + 10.0).contains(&particle.x));
            let depth = here.map(|particle| particle.volume).sum::<f64>() / (10.0 * self.width);
            wrong += (depth - self.steady(from + 5.0)).abs();
            right += self.steady(from + 5.0);
        }
        wrong / right
    }

    /// mean |d - d_exact| / mean d_exact of 200 by 14 places.
    pub fn error_of_samples(&self, flood: &Flood) -> f64 {
        let (mut wrong, mut right) = (0.0, 0.0);
        for place in 0..200 {
            let x = self.length * (f64::from(place) + 0.5) / 200.0;
            for line in 0..14 {
                let y = self.width * (f64::from(line) + 0.5) / 14.0;
                wrong += (flood.sample(x, y).depth - self.steady(x)).abs();
                right += self.steady(x);
            }
        }
        wrong / right
    }
}

fn rain_on_a_plane() -> Result<Vec<Row>, ModelError> {
    let plane = Plane::STEADY;
    let flood = plane.run(1.0, None)?;
    let water = flood.ledger().balances[0].relative_error().abs();
    let at_most = |measure, value, bound| Row::at_most(RAIN_ON_A_PLANE.name, measure, value, "", bound);
    Ok(vec![
        at_most("relative_error_of_outflow", plane.error_of_outflow(&flood).abs(), 0.03),
        at_most("relative_l1_error_of_depth", plane.error_of_pieces(&flood), 0.15),
        at_most("water_relative_error", water, water_rounding()),
    ])
}

fn infiltration() -> Result<Vec<Row>, ModelError> {
    let hour = 0.5;
    let lost = |infiltration: Infiltration| {
        let bounds = Bounds { x_min: 0.0, x_max: 30.0, y_min: 0.0, y_max: 20.0 };
        let terrain = Arc::new(Terrain::analytic(bounds, 1.0, |_, _| (0.0, [0.0; 2])));
        let walls = Edges { west: Edge::Wall, east: Edge::Wall, south: Edge::Wall, north: Edge::Wall };
        let time = 3600.0 * hour;
        let settings = Settings { infiltration: Some(infiltration), ..settings(time, 1.0, 0.3, walls) };
        let flood = run(&settings, &terrain, &[water_everywhere(bounds, |_, _| 0.3, |_, _| [0.0; 2])], time)?;
        Ok::<f64, ModelError>(gauge(&flood, "total_infiltration") / 600.0)
    };
    let (first, last, decay) = (200.0, 20.0, 3.0);
    let horton = lost(Infiltration::Horton(Horton { first_mm_per_h: first, last_mm_per_h: last, decay_per_h: decay }))?;
    let integral = 1e-3 * (last * hour + (first - last) / decay * (1.0 - (-decay * hour).exp()));
    let ground = GreenAmpt { conductivity_mm_per_h: 30.0, suction_m: 0.11, deficit: 0.35 };
    let green_ampt = lost(Infiltration::GreenAmpt(ground))?;
    let head = ground.suction_m * ground.deficit;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let conducted = middle - head * (1.0 + middle / head).ln();
        if conducted < 1e-3 * ground.conductivity_mm_per_h * hour { low = middle } else { high = middle }
    }
    let row = |measure, found: f64, exact: f64| {
        Row::at_most(INFILTRATION.name, measure, (found / exact - 1.0).abs(), "", 5e-3)
    };
    Ok(vec![row("relative_error_horton", horton, integral), row("relative_error_green_ampt", green_ampt, low)])
}

fn ledger() -> Result<Vec<Row>, ModelError> {
    let bounds = Bounds { x_min: 0.0, x_max: 100.0, y_min: 0.0, y_max: 50.0 };
    let terrain = Arc::new(Terrain::analytic(bounds, 1.0, |x, _| (-0.01 * x, [-0.01, 0.0])));
    let tide = Series::Table(vec![[0.0, -0.8], [150.0, -0.6], [300.0, -0.9]]);
    let edges = Edges { west: Edge::Wall, east: Edge::Stage(tide), south: Edge::Open, north: Edge::Wall };
    let at = |x: f64, y: f64| Some([x, y]);
    let settings = Settings {
        manning: Manning::Number(0.03),
        rain: rain(200.0, 1e-3),
        infiltration: Some(Infiltration::GreenAmpt(GreenAmpt {
            conductivity_mm_per_h: 20.0,
            suction_m: 0.1,
            deficit: 0.3,
        })),
        inflow: vec![Inflow {
            name: "spring".into(),
            at: at(20.0, 25.0),
            line: None,
            discharge_m3_per_s: Series::Constant(0.2),
            velocity_m_per_s: [0.0; 2],
        }],
        outflow: vec![Outflow {
            name: "pump".into(),
            at: at(70.0, 40.0),
            line: None,
            polygon: None,
            rating: vec![[-0.7, 0.0], [-0.6, 0.1]],
        }],
        link: vec![Link {
            name: "weir".into(),
            from: [30.0, 25.0],
            to: [60.0, 25.0],
            both_ways: true,
            law: LinkLaw::Weir(Weir { crest_m: -0.29, width_m: 1.0, coefficient: 1.7 }),
        }],
        refinement: Some(Refinement { spacing_m: Some(2.5), ..Refinement::default() }),
        ..settings(300.0, 1.5, 0.05, edges)
    };
    let flood = run(&settings, &terrain, &[], 300.0)?;
    let water = &flood.ledger().balances[0];
    let fallen = 200.0 * MM_PER_H * 300.0 * 5000.0;
    let row = |measure, value: f64, bound| Row::at_most(LEDGER.name, measure, value, "", bound);
    Ok(vec![
        row("water_relative_error", water.relative_error().abs(), water_rounding()),
        // But for the rain since the last look, eight steps at most.
        row("relative_error_of_rain", (gauge(&flood, "total_rain") / fallen - 1.0).abs(), 0.02),
        Row::at_least(LEDGER.name, "infiltration", gauge(&flood, "total_infiltration"), "m3", 10.0),
        Row::at_least(LEDGER.name, "inflow_besides_rain", water.inflow - gauge(&flood, "total_rain"), "m3", 50.0),
        Row::at_least(LEDGER.name, "outflow", water.outflow - gauge(&flood, "total_infiltration"), "m3", 50.0),
    ])
}
