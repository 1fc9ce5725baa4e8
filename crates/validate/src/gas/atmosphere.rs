//! A gas that comes to rest in gravity.

use super::{advance, rows, standard_errors_off};
use crate::{Case, Options, Row};
use corpuscle_gas::{Amount, Estimate, Setup, Species, Speeds, ball_volume};
use corpuscle_model::ModelError;
use std::f64::consts::PI;

pub(super) const ATMOSPHERE: Case = Case {
    name: "gas/atmosphere",
    about: "1000 balls, spread evenly with equal speeds, fall in gravity and come to rest: mean height and layers after the barometric \
            law (with the pressure of Carnahan & Starling 1969, and more balls at floor and ceiling), the same temperature and Maxwell's \
            speeds above and below.",
    slow: true,
    reduced: 1.0,
    run: atmosphere,
};

const COUNT: usize = 1000;
const SIDE: f64 = 50.0;
const HEIGHT: f64 = 40.0;
const GRAVITY: f64 = 0.05;

/// Each seed is a measurement of its own. Of a dozen the standard error itself was off by a third now and then.
const SEEDS: u64 = 48;

const SETTLED: f64 = 600.0;
const MEASURED: f64 = 1500.0;

/// Time in which a ball crosses the box, about: earlier states are much the same.
const STEP: f64 = 30.0;

const LAYERS: usize = 8;

/// What one gas shows, on average over time.
struct Seen {
    temperature: f64,
    height: f64,
    /// Part of the balls in each layer.
    layers: [f64; LAYERS],
    /// Temperature of the upper half of the balls' range of heights over that of the lower.
    above_over_below: f64,
    /// Mean fourth power of a component of velocity over the mean square squared, above and below: 3 after Maxwell.
    kurtosis: [f64; 2],
}

fn atmosphere(_: &Options) -> Vec<Row> {
    rows(ATMOSPHERE.name, measure())
}

fn measure() -> Result<Vec<Row>, ModelError> {
    let seen = (1..=SEEDS).map(see).collect::<Result<Vec<_>, _>>()?;
    let of = |value: &dyn Fn(&Seen) -> f64| Estimate::of(&seen.iter().map(value).collect::<Vec<_>>());
    // Each gas beside the law at its own temperature, which depends on how high its balls were at the start.
    let laws: Vec<Law> = seen.iter().map(|seen| barometric(seen.temperature)).collect();
    let off = |value: &dyn Fn(&Seen, &Law) -> f64| {
        let each = seen.iter().zip(&laws).map(|(seen, law)| value(seen, law));
        standard_errors_off(Estimate::of(&each.collect::<Vec<_>>()), 0.0)
    };
    let row = |measure: &str, value: f64, bound: f64| Row::at_most(ATMOSPHERE.name, measure, value, "", bound);
    let height = of(&|seen| seen.height);
    let layers = (0..LAYERS).map(|layer| off(&|seen, law| seen.layers[layer] - law.layers[layer]));
    // 47 degrees of freedom: 3.1 standard errors have a chance of one in three hundred; 4.0 in one of eight layers, one in six hundred.
    Ok(vec![
        row("height_off_by_standard_errors", off(&|seen, law| seen.height - law.height), 3.1),
        row("height_standard_error", height.error / height.mean, 3e-3),
        row("layers_off_by_standard_errors", layers.fold(0.0, f64::max), 4.0),
        row(
            "temperature_above_and_below_apart_by_standard_errors",
            standard_errors_off(of(&|seen| seen.above_over_below), 1.0),
            3.1,
        ),
        row("kurtosis_above_off_by_standard_errors", standard_errors_off(of(&|seen| seen.kurtosis[0]), 3.0), 3.1),
        row("kurtosis_below_off_by_standard_errors", standard_errors_off(of(&|seen| seen.kurtosis[1]), 3.0), 3.1),
    ])
}

fn see(seed: u64) -> Result<Seen, ModelError> {
    let balls = Species { speeds: Speeds::Equal, ..Species::new("balls", Amount::Count(COUNT)) };
    let mut setup = Setup::<3>::new([SIDE, SIDE, HEIGHT]).periodic().gravity([0.0, 0.0, -GRAVITY]).species(balls);
    setup.sides[2] = Default::default();
    let mut gas = setup.seed(seed).build()?;
    let mut sums = Sums::default();
    let samples = (MEASURED / STEP) as u64;
    for sample in 0..samples {
        advance(&mut gas, SETTLED + sample as f64 * STEP)?;
        gas.states().iter().for_each(|(position, velocity)| sums.add(position[2], velocity));
    }
    let balls = samples as f64 * COUNT as f64;
    let [above, below] =
        sums.halves.map(|[count, second, fourth]| (second / count, fourth * count / (second * second)));
    Ok(Seen {
        temperature: (sums.halves[0][1] + sums.halves[1][1]) / (3.0 * balls),
        height: sums.height / balls,
        layers: sums.layers.map(|count| count / balls),
        above_over_below: above.0 / below.0,
        kurtosis: [above.1, below.1],
    })
}

/// Sums over balls and times.
#[derive(Default)]
struct Sums {
    height: f64,
    layers: [f64; LAYERS],
    /// Above and below: number of components of velocity, and sums of their second and fourth powers.
    halves: [[f64; 3]; 2],
}

impl Sums {
    fn add(&mut self, height: f64, velocity: &[f64; 3]) {
        self.height += height;
        self.layers[((height / HEIGHT * LAYERS as f64) as usize).min(LAYERS - 1)] += 1.0;
        let half = &mut self.halves[usize::from(height < 0.5 * HEIGHT)];
        for v in velocity {
            (half[0], half[1], half[2]) = (half[0] + 1.0, half[1] + v * v, half[2] + v.powi(4));
        }
    }
}

/// Mean height of balls, and the part of them in each layer.
struct Law {
    height: f64,
    layers: [f64; LAYERS],
}

/// Steps in which the law is integrated; centres are a radius away from floor and ceiling at least.
const STEPS: usize = 4000;

/// Hydrostatic balance dP/dz = -m g n of balls at rest, P = n T Z, Z after Carnahan & Starling, and what floor and ceiling add: within a
/// diameter of them there are more balls, as fewer are in each other's way.
fn barometric(temperature: f64) -> Law {
    let step = (HEIGHT - 1.0) / STEPS as f64;
    let column = |ground: f64| {
        let mut packing = ground;
        let mut packings = Vec::with_capacity(STEPS);
        for _ in 0..STEPS {
            let half = packing - 0.5 * step * GRAVITY / temperature * packing / stiffness(packing);
            packings.push(half);
            packing -= step * GRAVITY / temperature * half / stiffness(half);
        }
        packings
    };
    let placed = |ground: f64| {
        column(ground).into_iter().enumerate().map(move |(number, packing)| {
            let height = 0.5 + (number as f64 + 0.5) * step;
            (height, packing * (1.0 + packing / ball_volume::<3>(0.5) * unreached(height)))
        })
    };
    let whole = COUNT as f64 * ball_volume::<3>(0.5) / (SIDE * SIDE);
    let (mut low, mut high) = (0.0, 0.3);
    for _ in 0..60 {
        let ground = 0.5 * (low + high);
        if placed(ground).map(|(_, packing)| packing).sum::<f64>() * step < whole {
            low = ground
        } else {
            high = ground
        }
    }
    let mut law = Law { height: 0.0, layers: [0.0; LAYERS] };
    for (height, packing) in placed(low) {
        law.height += packing * step * height / whole;
        law.layers[(height / HEIGHT * LAYERS as f64) as usize] += packing * step / whole;
    }
    law
}

/// The part of the volume round a ball that others are kept out of (radius 1) in which no other could be anyway: beyond the first and last
/// heights of centres. To the first order in the density there are more balls by this volume times their number in a volume (the second
/// virial term of the profile at a hard wall; at the wall the contact theorem P = n T).
fn unreached(height: f64) -> f64 {
    let beyond = |distance: f64| match distance < 1.0 {
        true => 2.0 / 3.0 * PI * (1.0 - 1.5 * distance + 0.5 * distance.powi(3)),
        false => 0.0,
    };
    beyond(height - 0.5) + beyond(HEIGHT - 0.5 - height)
}

/// d(packing Z)/d(packing), Z after Carnahan & Starling.
fn stiffness(x: f64) -> f64 {
    (1.0 + 4.0 * x + 4.0 * x * x - 4.0 * x.powi(3) + x.powi(4)) / (1.0 - x).powi(4)
}

#[cfg(test)]
mod tests {
    use super::super::theory;
    use super::*;

    #[test]
    fn stiffness_is_the_slope_of_the_pressure() {
        let pressure = |x: f64| x * theory::carnahan_starling(x);
        for x in [0.01, 0.2, 0.45] {
            let slope = (pressure(x + 1e-5) - pressure(x - 1e-5)) / 2e-5;
            assert!((stiffness(x) / slope - 1.0).abs() < 1e-7);
        }
    }

    /// At the floor the pressure is that of what comes to it: n T there is P of the gas above (contact theorem, Lebowitz 1960).
    #[test]
    fn at_the_wall_the_density_is_the_pressure_over_the_temperature() {
        let (packing, ball) = (0.01, ball_volume::<3>(0.5));
        let at_wall = 1.0 + packing / ball * unreached(0.5);
        assert!((at_wall / theory::carnahan_starling(packing) - 1.0).abs() < 2e-3, "{at_wall}");
    }

    #[test]
    fn the_law_holds_all_balls() {
        assert!((barometric(1.2).layers.iter().sum::<f64>() - 1.0).abs() < 1e-9);
    }
}
