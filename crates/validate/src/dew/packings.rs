//! Heat and vapour through air with disordered particles: settled, stirred, or at random.

use super::{advance, ledger_rounding, ready, rows};
use crate::device::{is_reduced, reduced};
use crate::{Case, Options, Row};
use corpuscle_dew::air::Properties;
use corpuscle_dew::humid_air::{HumidAir, ZERO_CELSIUS};
use corpuscle_dew::solids::{Body, Material};
use corpuscle_dew::{Dew, Face, Room, Scatter, Settings, Setup};
use corpuscle_model::{Model, ModelError};
use statrs::function::erf::erfc;
use std::f64::consts::{PI, TAU};

pub(super) const PACKINGS: Case = Case {
    name: "dew/packings",
    about: "Air whose particles are settled, stirred or at random, at three spacings: heat between plates at 5 and 25 °C from air at one \
            temperature, k dT / L; vapour from a wet plate to a cold one, rho D dY / L; moist air beside dry from 0.5 s to 1.5 s, \
            erfc(x / (2 sqrt(D t))) / 2 (Crank 1975, equation 2.14). Water and energy balance.",
    slow: false,
    reduced: 2.0,
    run: packings,
};

/// Distance of plates, m, and particles between them.
pub(super) const GAP: f64 = 0.025;
pub(super) const LAYERS: [usize; 3] = [16, 20, 25];
/// Layers of plates, and particles across.
const PLATE: usize = 2;
const ACROSS: usize = 4;

/// Largest relative error.
const BOUND: f64 = 0.005;

/// Conducts so well that it is at one temperature up to its surface.
const PERFECT: Material = Material { conductivity: 1e9, heat_capacity: 1000.0, density: 1000.0 };

/// How the particles of the air stand at the start.
#[derive(Clone, Copy)]
pub(super) enum Packing {
    /// Hardly off a lattice, then evened out: into layers, which is how air at rest settles in time.
    Settled,
    /// Swirled off a lattice for some time.
    Stirred,
    /// At random positions within a spacing of those of a lattice, but for some sweeps that part those that stand on each other. Air that is
    /// random over longer distances is not at rest: it flows from where there is more of it.
    Random,
}

pub(super) const ALL: [(&str, Packing); 3] =
    [("random", Packing::Random), ("settled", Packing::Settled), ("stirred", Packing::Stirred)];

/// For how long air is stirred, s, and how fast, m/s.
const STIRRED: f64 = 0.5;
const SPEED: f64 = 0.02;

impl Packing {
    /// Arranges the air of a column, periodic across over a `width`; `start` gives temperature, K, and vapour at a position.
    pub(super) fn arrange(
        self,
        dew: &mut Dew,
        width: f64,
        start: impl Fn([f64; 3]) -> [f64; 2],
    ) -> Result<(), ModelError> {
        let scatter = |reach, sweeps| Scatter { reach, sweeps, seed: 1 };
        match self {
            Self::Settled => dew.scatter(scatter(0.02, 400), start),
            Self::Random => dew.scatter(scatter(1.0, 15), start),
            Self::Stirred => {
                let turn = TAU / width;
                dew.stir(|[x, y, z]| {
                    let swirl = |along: f64, across: f64| SPEED * (turn * across + 3.0 * turn * along).sin();
                    [0.0, swirl(x, z), swirl(x, y)]
                });
                advance(dew, STIRRED)?;
                dew.scatter(scatter(0.0, 0), start);
            }
        }
        Ok(())
    }
}

/// Still air in a column of so many particles along x, periodic across, with bodies in it.
fn still(
    air: Properties,
    spacing: f64,
    along: usize,
    bodies: Vec<Body>,
    start: impl Fn([f64; 3]) -> [f64; 2],
) -> Result<Dew, ModelError> {
    let width = ACROSS as f64 * spacing;
    let periodic = [Face::Periodic; 2];
    let room = Room {
        low: [0.0; 3],
        high: [along as f64 * spacing, width, width],
        faces: [[Face::Wall; 2], periodic, periodic],
    };
    let settings = Settings { gravity: [0.0; 3], fog: false, ..Settings::new(spacing, ZERO_CELSIUS + 25.0, 0.0) };
    Dew::new(&Setup { settings, air, room, bodies, fans: Vec::new(), seed: 1 }, start)
}

fn air() -> Properties {
    Properties::at_room_temperature(0.05)
}

/// A plate held at a temperature, K, across a column, `from` so many layers on.
fn plate(from: usize, spacing: f64, temperature: f64) -> Body {
    super::slab_across(ACROSS, from, PLATE, spacing, PERFECT, temperature, true)
}

fn packings(_: &Options) -> Vec<Row> {
    rows(PACKINGS.name, measure())
}

/// What is measured, or its relative error, and the larger of the errors of water and energy.
pub(super) type Found = [f64; 2];

/// A scene in air of such a packing, of so many layers.
type Scene = fn(Packing, usize) -> Result<Found, ModelError>;

fn measure() -> Result<Vec<Row>, ModelError> {
    let mut rows = Vec::new();
    let mut balance = 0.0_f64;
    let scenes: [(&str, Scene); 3] =
        [("heat", heat_between_plates), ("film", film_on_plate), ("fick", moist_beside_dry)];
    for (scene, run) in scenes {
        let mut sums = [0.0; 3];
        for &(name, packing) in reduced(&ALL) {
            for (sum, &layers) in sums.iter_mut().zip(reduced(&LAYERS)) {
                let [error, unbalanced] = run(packing, layers)?;
                balance = balance.max(unbalanced);
                *sum += error.abs();
                let measure = format!("{scene}_error_{name}_{layers}");
                rows.push(Row::at_most(PACKINGS.name, &measure, error.abs(), "", BOUND));
            }
        }
        if is_reduced() {
            continue;
        }
        let order = (sums[0] / sums[2]).ln() / (LAYERS[2] as f64 / LAYERS[0] as f64).ln();
        let measure = format!("{scene}_order");
        // Between plates the error is that at their surfaces. Amid the air it is but the noise of the packing.
        let why = "amid the air what is left is the noise of how the particles stand";
        let is_at_plates = scene != "fick";
        let at_least = Row::at_least(PACKINGS.name, &measure, order, "", 0.5);
        let beside = Row::beside(PACKINGS.name, &measure, order, "", 0.5, why);
        rows.push(if is_at_plates { at_least } else { beside });
    }
    rows.push(Row::at_most(PACKINGS.name, "water_and_energy_error", balance, "", ledger_rounding()));
    Ok(rows)
}

fn balance_error(dew: &Dew) -> f64 {
    dew.ledger().balances.iter().map(|balance| balance.relative_error().abs()).fold(0.0, f64::max)
}

/// Two plates with air between them.
pub(super) struct Gap {
    pub air: Properties,
    /// Temperatures of the plates, K: of the cold one and the warm one.
    pub plates: [f64; 2],
    /// When what passes begins and ceases to be measured, in times of relaxation, GAP^2 / (pi^2 D).
    pub measured: [f64; 2],
}

impl Gap {
    /// Plates in air of constant properties. From air in the middle of both plates all but the even modes are gone after the first time of relaxation.
    fn of_constant(celsius: [f64; 2]) -> Self {
        Self { air: air(), plates: celsius.map(|celsius| ZERO_CELSIUS + celsius), measured: [2.5, 4.0] }
    }

    /// Vapour at the wet surfaces of the plates, part of the mass.
    pub fn saturated(&self) -> [f64; 2] {
        self.plates.map(|kelvin| HumidAir::with_relative_humidity(kelvin, self.air.pressure, 1.0).mass_fraction())
    }

    /// Heat per area and time, W/m2, and the balance's error.
    pub fn heat_flux(&self, packing: Packing, layers: usize) -> Result<Found, ModelError> {
        let [cold, warm] = self.plates;
        let start = |_: [f64; 3]| [0.5 * (cold + warm), 0.0];
        let given = |dew: &Dew| 0.5 * (dew.heat_from(1) - dew.heat_from(0));
        self.flux(packing, layers, self.air.heat_diffusivity(), start, |_| (), given)
    }

    /// Water per area and time, kg/(m2 s), from the warm plate, which is wet, to the cold one, and the balance's error.
    pub fn vapour_flux(&self, packing: Packing, layers: usize) -> Result<Found, ModelError> {
        let ([cold, warm], [least, most]) = (self.plates, self.saturated());
        let start = |_: [f64; 3]| [0.5 * (cold + warm), 0.5 * (least + most)];
        let taken = |dew: &Dew| 0.5 * (dew.water_on_body(0) - dew.water_on_body(1));
        self.flux(packing, layers, self.air.vapour_diffusivity, start, |dew| dew.wet(1, 1.0), taken)
    }

    fn flux(
        &self,
        packing: Packing,
        layers: usize,
        diffusivity: f64,
        start: impl Fn([f64; 3]) -> [f64; 2],
        prepare: impl Fn(&mut Dew),
        passed: impl Fn(&Dew) -> f64,
    ) -> Result<Found, ModelError> {
        let spacing = GAP / layers as f64;
        let [cold, warm] = self.plates;
        let bodies = vec![plate(0, spacing, cold), plate(PLATE + layers, spacing, warm)];
        let mut dew = still(self.air, spacing, 2 * PLATE + layers, bodies, &start)?;
        let width = ACROSS as f64 * spacing;
        prepare(&mut dew);
        packing.arrange(&mut dew, width, &start)?;
        let mut dew = ready(dew)?;
        let begin = dew.time();
        let [mut time, mut sum] = [[0.0; 2]; 2];
        for (k, relaxations) in self.measured.into_iter().enumerate() {
            advance(&mut dew, begin + relaxations * GAP * GAP / (PI * PI * diffusivity))?;
            (time[k], sum[k]) = (dew.stepped_until(), passed(&dew));
        }
        Ok([(sum[1] - sum[0]) / ((time[1] - time[0]) * width * width), balance_error(&dew)])
    }
}

fn heat_between_plates(packing: Packing, layers: usize) -> Result<Found, ModelError> {
    let gap = Gap::of_constant([5.0, 25.0]);
    let [flux, unbalanced] = gap.heat_flux(packing, layers)?;
    Ok([flux / (gap.air.conductivity * (gap.plates[1] - gap.plates[0]) / GAP) - 1.0, unbalanced])
}

fn film_on_plate(packing: Packing, layers: usize) -> Result<Found, ModelError> {
    let gap = Gap::of_constant([10.0, 25.0]);
    let [flux, unbalanced] = gap.vapour_flux(packing, layers)?;
    let [least, most] = gap.saturated();
    Ok([flux / (gap.air.density * gap.air.vapour_diffusivity * (most - least) / GAP) - 1.0, unbalanced])
}

/// For how long moist and dry air have been side by side at the start, s.
const BEGUN: f64 = 0.5;

/// Moist air from x = 0 to 0.04 m beside dry: the mean of the errors over the particles in layers as thick as the kernel, the largest of all layers.
fn moist_beside_dry(packing: Packing, layers: usize) -> Result<Found, ModelError> {
    let spacing = GAP / layers as f64;
    let along = (0.08 / spacing).round() as usize;
    let half = 0.5 * along as f64 * spacing;
    let moist = 0.01;
    // Not from a jump, which would stand between particles wherever they happen to be.
    let exact = |x: f64, time: f64| 0.5 * erfc((x - half) / (2.0 * (air().vapour_diffusivity * time).sqrt()));
    let start = |[x, ..]: [f64; 3]| [ZERO_CELSIUS + 25.0, moist * exact(x, BEGUN)];
    let mut dew = still(air(), spacing, along, Vec::new(), start)?;
    packing.arrange(&mut dew, ACROSS as f64 * spacing, start)?;
    let mut dew = ready(dew)?;
    let begin = dew.stepped_until();
    let until = dew.time() + 1.0;
    advance(&mut dew, until)?;
    let time = BEGUN + dew.stepped_until() - begin;
    let count = (along / 2) as f64;
    let mut sums = vec![[0.0; 2]; along / 2];
    for particle in dew.air() {
        let x = particle.position[0];
        let sum = &mut sums[((x / (2.0 * half) * count) as usize).min(along / 2 - 1)];
        *sum = [sum[0] + particle.vapour / moist - exact(x, time), sum[1] + 1.0];
    }
    let worst = sums.iter().map(|[error, number]| (error / number).abs()).fold(0.0, f64::max);
    Ok([worst, balance_error(&dew)])
}
