//! A fourth model, added from outside: ions in a uniform magnetic field.
//!
//! ```text
//! cargo run --release -p corpuscle-window --example ions -- run ions/gyration
//! cargo run --release -p corpuscle-window --example ions -- view ions/gyration
//! ```
//!
//! What the model says of itself stands here and in `scene.toml` beside it; nothing else in the program knows it. It is run, recorded, resumed,
//! checked, drawn, filmed, changed in the window and validated as the others are.

use corpuscle::model::{Balance, Container, Frame, GaugeColumn, Ledger, Map, Model, ModelError, ParticleSet};
use corpuscle::models::{ModelKind, Opened, Opening};
use corpuscle::scene::{Builtin, Check, Checked, ModelScene, Scene, SceneKind};
use corpuscle_validate::{Case, Row};
use rand::{RngExt, SeedableRng};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

/// Boltzmann's constant, J/K.
const BOLTZMANN: f64 = 1.380_649e-23;

/// Steps in a gyration.
const STEPS_A_TURN: f64 = 40.0;

/// The `[ions]` table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ions {
    count: usize,
    size_m: [f64; 3],
    charge_c: f64,
    mass_kg: f64,
    temperature_k: f64,
    /// Along z.
    field_t: f64,
}

impl ModelScene for Ions {
    const NAME: &'static str = "ions";

    fn check(&self, check: &Check) -> Checked {
        let sides = ["ions.size_m.0", "ions.size_m.1", "ions.size_m.2"];
        let above = sides.into_iter().zip(self.size_m).chain([
            ("ions.charge_c", self.charge_c),
            ("ions.mass_kg", self.mass_kg),
            ("ions.temperature_k", self.temperature_k),
            ("ions.field_t", self.field_t),
        ]);
        check.require("ions.count", (1..=10_000_000).contains(&self.count), || "must be 1 to 10000000".into())?;
        above.into_iter().try_for_each(|(key, value)| check.above(key, value, 0.0))
    }
}

/// Positions and velocities at the end of the last step, and positions before it: what is shown lies between.
#[derive(Clone, Serialize, Deserialize)]
struct State {
    steps: u64,
    before: Vec<[f64; 3]>,
    position: Vec<[f64; 3]>,
    velocity: Vec<[f64; 3]>,
}

/// Ions that gyrate, and that the walls of a box reflect.
struct Gyration {
    ions: Ions,
    state: State,
    shown: f64,
    step: f64,
    energy_at_start: f64,
}

impl Gyration {
    fn new(ions: &Ions, seed: u64) -> Self {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        let thermal = (BOLTZMANN * ions.temperature_k / ions.mass_kg).sqrt();
        let (mut position, mut velocity) = (Vec::new(), Vec::new());
        for _ in 0..ions.count {
            position.push(ions.size_m.map(|side| side * random.random::<f64>()));
            // Box & Muller 1958.
            let mut normal =
                || (-2.0 * (1.0 - random.random::<f64>()).ln()).sqrt() * (TAU * random.random::<f64>()).cos();
            velocity.push(std::array::from_fn(|_| thermal * normal()));
        }
        let step = TAU / (ions.charge_c * ions.field_t / ions.mass_kg) / STEPS_A_TURN;
        let state = State { steps: 0, before: position.clone(), position, velocity };
        let mut model = Self { ions: ions.clone(), state, shown: 0.0, step, energy_at_start: 0.0 };
        model.energy_at_start = model.energy();
        model
    }

    /// Time at the end of the last step, s.
    fn clock(&self) -> f64 {
        self.state.steps as f64 * self.step
    }

    /// One step: velocities are turned by the exact angle (Boris 1970; Birdsall & Langdon 1985, section 15-4), which keeps the energy, and places follow.
    fn advance(&mut self) {
        let State { steps, before, position, velocity } = &mut self.state;
        let half = (0.5 * self.ions.charge_c * self.ions.field_t / self.ions.mass_kg * self.step).tan();
        let [sine, cosine] = [2.0 * half / (1.0 + half * half), (1.0 - half * half) / (1.0 + half * half)];
        before.clone_from(position);
        for (at, [u, v, w]) in position.iter_mut().zip(velocity) {
            (*u, *v) = (cosine * *u + sine * *v, cosine * *v - sine * *u);
            for ((x, along), side) in at.iter_mut().zip([u, v, w]).zip(self.ions.size_m) {
                *x += self.step * *along;
                if *x < 0.0 || *x > side {
                    *along = -*along;
                    *x = if *x < 0.0 { -*x } else { 2.0 * side - *x }.clamp(0.0, side);
                }
            }
        }
        *steps += 1;
    }

    /// Kinetic energy, J.
    fn energy(&self) -> f64 {
        let squares = self.state.velocity.iter().flatten().map(|along| along * along).sum::<f64>();
        0.5 * self.ions.mass_kg * squares
    }
}

impl Model for Gyration {
    fn name(&self) -> &'static str {
        Ions::NAME
    }

    fn time(&self) -> f64 {
        self.shown
    }

    fn steps(&self) -> u64 {
        self.state.steps
    }

    fn particle_steps(&self) -> u64 {
        self.state.steps * self.ions.count as u64
    }

    fn particles(&self) -> usize {
        self.ions.count
    }

    fn advance_to(&mut self, time: f64, stop: &AtomicBool) -> Result<(), ModelError> {
        while self.clock() < time {
            if stop.load(Ordering::Relaxed) {
                self.shown = self.shown.max(self.clock());
                return Ok(());
            }
            self.advance();
        }
        self.shown = time;
        Ok(())
    }

    fn frame(&self) -> Frame {
        let State { before, position, velocity, .. } = &self.state;
        let part = ((self.clock() - self.shown) / self.step).clamp(0.0, 1.0);
        let between = |(a, b): (&[f64; 3], &[f64; 3])| std::array::from_fn(|k| b[k] + part * (a[k] - b[k]));
        let count = self.ions.count;
        let ions = ParticleSet {
            name: "ions".into(),
            id: (0..count as u64).collect(),
            position: before.iter().zip(position).map(between).collect(),
            velocity: velocity.clone(),
            radius: vec![0.004 * self.ions.size_m[0]; count],
            mass: vec![self.ions.mass_kg; count],
            columns: Vec::new(),
        };
        Frame { time: self.shown, sets: vec![ions] }
    }

    fn gauge_columns(&self) -> Vec<GaugeColumn> {
        let column = |quantity, unit| GaugeColumn { gauge: "ions".into(), quantity, unit };
        vec![column("mean_velocity_x", "m_per_s"), column("mean_velocity_y", "m_per_s"), column("kinetic_energy", "J")]
    }

    fn gauge_row(&self) -> Vec<f64> {
        let mean = |axis: usize| self.state.velocity.iter().map(|v| v[axis]).sum::<f64>() / self.ions.count as f64;
        vec![mean(0), mean(1), self.energy()]
    }

    fn maps(&self) -> Vec<Map> {
        Vec::new()
    }

    fn container(&self) -> Option<Container> {
        Some(Container { from: [0.0; 3], to: self.ions.size_m })
    }

    fn ledger(&self) -> Ledger {
        let [initial, now] = [self.energy_at_start, self.energy()];
        let energy = Balance { quantity: "energy_J", initial, inflow: 0.0, outflow: 0.0, now, least: 0.0 };
        Ledger { balances: vec![energy] }
    }

    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }

    fn save(&self) -> Vec<u8> {
        postcard::to_stdvec(&(self.shown, &self.state)).expect("a state in memory can be written")
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ModelError> {
        let wrong = |error: postcard::Error| ModelError::Checkpoint(error.to_string());
        let (shown, state): (f64, State) = postcard::from_bytes(state).map_err(wrong)?;
        if state.position.len() != self.ions.count {
            return Err(ModelError::Checkpoint(format!("it has {} ions", state.position.len())));
        }
        (self.shown, self.state) = (shown, state);
        Ok(())
    }
}

/// The model as the workbench knows it; for all that is left out here the defaults are right.
struct Kind;

impl ModelKind for Kind {
    fn scene(&self) -> SceneKind {
        SceneKind::of::<Ions>(&[Builtin { name: "ions/gyration", text: include_str!("scene.toml") }])
    }

    fn open(&self, opening: Opening<'_>) -> Result<Opened, corpuscle::Error> {
        let ions = opening.scene.model.get::<Ions>().expect("scenes of this kind have these tables");
        Ok(Opened::plain(Box::new(Gyration::new(ions, opening.scene.seed))))
    }

    fn particles(&self) -> &'static str {
        "ions"
    }
}

/// Whether the mean velocity of ions far from walls turns once in 2 pi m / (q B), the period of gyration.
fn turns(_: &corpuscle_validate::Options) -> Vec<Row> {
    let ions =
        Ions { count: 100, size_m: [1e3; 3], charge_c: 1.6e-19, mass_kg: 6.6e-26, temperature_k: 300.0, field_t: 0.01 };
    let turn = TAU * ions.mass_kg / (ions.charge_c * ions.field_t);
    let mut model = Gyration::new(&ions, 1);
    let angle = |row: Vec<f64>| row[1].atan2(row[0]);
    let before = angle(model.gauge_row());
    let done = model.advance_to(10.0 * turn, &AtomicBool::new(false)).is_ok();
    let off = (angle(model.gauge_row()) - before + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
    let error = model.ledger().balances[0].relative_error().abs();
    assert!(done);
    vec![
        Row::at_most("ions/turns", "angle_off_in_ten_turns", off.abs(), "", 1e-9),
        Row::at_most("ions/turns", "energy_error", error, "", 1e-12),
    ]
}

/// Adds the model to the workbench.
pub fn register() {
    corpuscle::register(&Kind);
    corpuscle_validate::register_case(Case {
        name: "ions/turns",
        about: "Ions gyrate once in 2 pi m / (q B), and keep their energy.",
        slow: false,
        reduced: 1.0,
        run: turns,
    });
}

/// The scene that comes with it, as it is read.
#[allow(dead_code)]
pub fn scene(changes: &[(String, String)]) -> Scene {
    register();
    Scene::parse(include_str!("scene.toml"), "ions/gyration", changes)
        .expect("the scene that comes with the model is sound")
}

#[allow(dead_code)]
fn main() -> ExitCode {
    register();
    corpuscle_cli::run_command_line(corpuscle_window::view)
}
