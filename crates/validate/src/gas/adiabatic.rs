//! Slow pistons.

use super::{SEED, advance, rows, theory};
use crate::{Case, Options, Row};
use corpuscle_gas::{Amount, Setup, Side, Species};
use corpuscle_model::ModelError;

pub(super) const ADIABATIC: Case = Case {
    name: "gas/adiabatic",
    about: "A slow piston compresses a gas: d ln T = (2/d) Z d ln packing, dilute (T V^(2/d) stays) and at packing 0.3; its work is the \
            energy gained. A moving wall sends a ball back at exactly 2 vw - v.",
    slow: true,
    reduced: 1.0,
    run: adiabatic,
};

fn adiabatic(_: &Options) -> Vec<Row> {
    let measure = || {
        let mut rows = Compression { size: [1000.0, 500.0], packing: 0.001, to: 0.5, speed: 0.02 }.rows("dilute")?;
        rows.extend(Compression { size: [300.0, 20.0, 20.0], packing: 0.001, to: 0.5, speed: 0.005 }.rows("dilute")?);
        rows.extend(Compression { size: [300.0, 20.0], packing: 0.3, to: 0.8, speed: 0.05 }.rows("30")?);
        rows.extend(Compression { size: [300.0, 5.0, 5.0], packing: 0.3, to: 0.85, speed: 0.2 }.rows("30")?);
        rows.push(reflection()?);
        Ok(rows)
    };
    rows(ADIABATIC.name, measure())
}

/// A piston along x; the box repeats along the other axes.
struct Compression<const D: usize> {
    size: [f64; D],
    packing: f64,
    /// Length at the end over that at the start.
    to: f64,
    speed: f64,
}

/// Time for which the piston rests before and after.
const REST: f64 = 20.0;

impl<const D: usize> Compression<D> {
    fn rows(&self, named: &str) -> Result<Vec<Row>, ModelError> {
        let mut gas = self.setup().build()?;
        let (energy, temperature) = (gas.energy(), gas.temperature());
        advance(&mut gas, self.way() / self.speed + 2.0 * REST)?;
        let found = gas.temperature() / temperature;
        let gained = gas.energy() - energy;
        let row = |measure: &str, value: f64, bound: f64| {
            Row::at_most(ADIABATIC.name, &format!("{measure}_{D}d_{named}"), value, "", bound)
        };
        Ok(vec![
            row("relative_temperature_error", (found / self.known() - 1.0).abs(), 0.01),
            row("work_less_energy_gained", (gas.work() / gained - 1.0).abs(), 1e-10),
        ])
    }

    fn way(&self) -> f64 {
        (1.0 - self.to) * self.size[0]
    }

    /// At rest for a while, then at a constant speed to the end of its way.
    fn setup(&self) -> Setup<D> {
        let end = REST + self.way() / self.speed;
        let mut setup = Setup::new(self.size).periodic().seed(SEED);
        setup.sides[0] = [Side::Fixed, Side::Displaced(vec![[REST, 0.0], [end, -self.way()]])];
        setup.species(Species::new("balls", Amount::Packing(self.packing)))
    }

    /// T at the end over T at the start: d ln T = (2/d) Z d ln packing, with the volume open to centres (Simpson's rule).
    fn known(&self) -> f64 {
        let volume = |length: f64| (length - 1.0) * self.size[1..].iter().product::<f64>();
        let (from, to) = (volume(self.size[0]), volume(self.to * self.size[0]));
        let filled = self.packing * self.size.iter().product::<f64>();
        let steps = 100;
        let step = (from / to).ln() / f64::from(steps);
        let z = |at: f64| theory::compressibility::<D>(filled / from * (at * step).exp());
        let sum: f64 = (0..steps).map(f64::from).map(|at| z(at) + 4.0 * z(at + 0.5) + z(at + 1.0)).sum();
        (2.0 / D as f64 * sum * step / 6.0).exp()
    }
}

/// Largest |v' - (2 vw - v)| over some balls and walls: 0 to the bit.
fn reflection() -> Result<Row, ModelError> {
    let mut worst = 0.0_f64;
    for (speed, wall) in [(1.234_567, -0.321), (0.1, -1.0 / 3.0), (7.7, 0.123_456_789), (0.9, 0.899)] {
        let setup = Setup::new([10.0, 10.0]).side(0, 1, Side::Moving { velocity: wall, until: None });
        let mut gas = setup.ball([8.9, 5.0], [speed, 0.25], 1.0, 1.7).build()?;
        advance(&mut gas, 0.1 / (speed - wall) * 1.5 + 1e-3)?;
        worst = worst.max((gas.states()[0].1[0] - (2.0 * wall - speed)).abs());
    }
    Ok(Row::at_most(ADIABATIC.name, "reflected_speed_error", worst, "", 0.0))
}
