//! A scene is run for some steps, and what must hold is checked on the way.

use super::{Kind, scene};
use corpuscle::Simulation;
use corpuscle_model::{Column, Frame, GaugeColumn, Model, ModelError, Values};
use corpuscle_scene::{Method, Scene};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// Steps that a scene is run for.
const STEPS: u64 = 200;

/// Wall-clock time after which a scene is left as it is.
const LONGEST: Duration = Duration::from_secs(6);

/// Largest error of a ledger, over the magnitudes of what it accounts for.
const LEDGER: f64 = 1e-8;

/// Fastest water in a lake that began at rest, m/s.
const AT_REST: f64 = 1e-6;

/// Deepest overlap of two balls, over the sum of their radii.
const OVERLAP: f64 = 1e-9;

/// What came of a scene.
#[derive(Debug, Clone, PartialEq)]
pub enum Trial {
    /// All held, over so many steps.
    Sound(u64),
    /// It was refused, or broke down and said so.
    Refused(String),
    /// Something did not hold.
    Finding(Finding),
}

/// What did not hold.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// What findings are told apart by.
    pub kind: String,
    /// What was found, with numbers.
    pub what: String,
}

fn finding(kind: &str, what: impl Into<String>) -> Trial {
    Trial::Finding(Finding { kind: kind.into(), what: what.into() })
}

/// What holds of a scene, by what it says.
#[derive(Debug, Clone, Copy)]
struct Expected {
    kind: Kind,
    /// Balls do not overlap, and their energy is exact: not by fixed steps.
    exact: bool,
    /// Heat and vapour that one gives the other takes: not as published (scheme `particle-condensation`).
    gives_what_is_taken: bool,
    /// Of a lake: it began without motion.
    at_rest: bool,
    /// Of a lake: its energy at the start, J.
    energy: f64,
}

/// Runs a scene, given as text.
pub fn try_scene(kind: Kind, text: &str) -> Trial {
    match catch_unwind(AssertUnwindSafe(|| run(kind, text))) {
        Ok(trial) => trial,
        Err(panic) => {
            let words = panic.downcast_ref::<String>().cloned();
            let words =
                words.or_else(|| panic.downcast_ref::<&str>().map(|words| (*words).to_owned())).unwrap_or_default();
            finding("panic", words)
        }
    }
}

fn run(kind: Kind, text: &str) -> Trial {
    let scene = match Scene::parse(text, "scene.toml", &[]) {
        Ok(scene) => scene,
        Err(error) => return Trial::Refused(error.to_string()),
    };
    let mut expected = Expected {
        kind,
        exact: scene.gas().is_none_or(|gas| !matches!(gas.method, Method::FixedStep { .. })),
        gives_what_is_taken: scene.dew().is_none_or(|dew| dew.scheme == corpuscle_scene::dew::Scheme::Physical),
        at_rest: false,
        energy: 0.0,
    };
    let until = scene.run.until_s;
    let mut simulation = match Simulation::open(scene, Path::new("")) {
        Ok(simulation) => simulation,
        Err(error) => return Trial::Refused(error.to_string()),
    };
    let stop = Arc::new(AtomicBool::new(false));
    let model = simulation.model_mut();
    expected.energy = if kind == Kind::Lake { energy(model) } else { 0.0 };
    expected.at_rest = fastest(&model.frame()) == 0.0;
    let start = Instant::now();
    let mut period = 1e-5 * until;
    let (mut after, mut is_restored) = (None, false);
    while model.steps() < STEPS && model.time() < until && start.elapsed() < LONGEST {
        let time = (model.time() + period).min(until);
        if let Err(error) = advance(model, time, &stop) {
            after = Some(error);
            break;
        }
        if model.steps() < STEPS / 10 {
            period *= 2.0;
        }
        if !is_restored && model.steps() >= STEPS / 2 {
            is_restored = true;
            if let Err(trial) = restore(model) {
                return trial;
            }
        }
        if let Err(trial) = check(&expected, model) {
            return trial;
        }
    }
    match after {
        // The state before a breakdown stays readable, and has no value that is not a number.
        Some(error) => check(&expected, model).err().unwrap_or_else(|| Trial::Refused(error.to_string())),
        None => Trial::Sound(model.steps()),
    }
}

/// Takes a state back amid a run, which then is the same to the bit.
fn restore(model: &mut dyn Model) -> Result<(), Trial> {
    let at = format!("t = {} s, step {}", model.time(), model.steps());
    let state = model.save();
    model.restore(&state).map_err(|error| finding("own state is refused", format!("{at}: {error}")))?;
    if model.save() == state { Ok(()) } else { Err(finding("another state when taken back", at)) }
}

/// Advances; told to return after a while, and noticed where it does not.
fn advance(model: &mut dyn Model, time: f64, stop: &Arc<AtomicBool>) -> Result<(), ModelError> {
    stop.store(false, Ordering::Relaxed);
    let (done, waits) = std::sync::mpsc::channel::<()>();
    let flag = stop.clone();
    let watch = thread::spawn(move || {
        if waits.recv_timeout(LONGEST).is_err_and(|error| error == std::sync::mpsc::RecvTimeoutError::Timeout) {
            flag.store(true, Ordering::Relaxed);
        }
    });
    let result = model.advance_to(time, stop);
    drop(done);
    _ = watch.join();
    result
}

fn check(expected: &Expected, model: &dyn Model) -> Result<(), Trial> {
    let frame = model.frame();
    let at = format!("t = {} s, step {}", model.time(), model.steps());
    if let Some(what) = not_a_number(&frame) {
        return Err(finding("not a number", format!("{at}: {what}")));
    }
    if let Some(what) = not_a_number_beside(expected.kind, model) {
        return Err(finding("not a number", format!("{at}: {what}")));
    }
    for mut balance in model.ledger().balances {
        if balance.quantity == "momentum" && expected.kind != Kind::Gas {
            // Water at rest has none: what pressure gives and takes is rounded. Set against all water at 1 m/s.
            balance.least = balance.least.max(volume(&frame));
        }
        let is_exact = match balance.quantity {
            "energy" => expected.exact,
            "energy_J" | "water_kg" => expected.gives_what_is_taken,
            _ => true,
        };
        let error = if is_exact { balance.relative_error() } else { 0.0 };
        if error.is_nan() || error.abs() > LEDGER {
            return Err(finding(&format!("ledger of {}", balance.quantity), format!("{at}: {balance:?}, {error:.3e}")));
        }
    }
    if expected.kind == Kind::Gas && expected.exact {
        overlap(&frame).map_or(Ok(()), |what| Err(finding("overlap", format!("{at}: {what}"))))?;
    }
    if expected.kind == Kind::Lake {
        let (fastest, energy, first) = (fastest(&frame), energy(model), expected.energy);
        if expected.at_rest && fastest > AT_REST {
            return Err(finding("lake moves", format!("{at}: {fastest:.3e} m/s")));
        }
        if !expected.at_rest && energy > first + 1e-6 * first.abs() {
            return Err(finding("energy grows", format!("{at}: from {first} to {energy}")));
        }
    }
    Ok(())
}

/// The first value of a frame that is not finite.
fn not_a_number(frame: &Frame) -> Option<String> {
    for set in &frame.sets {
        let scalars = [("radius", &set.radius), ("mass", &set.mass)];
        for (name, values) in scalars {
            if let Some(at) = values.iter().position(|value| !value.is_finite()) {
                return Some(format!("{name} of {} {}", set.name, set.id[at]));
            }
        }
        for (name, vectors) in [("position", &set.position), ("velocity", &set.velocity)] {
            if let Some(at) = vectors.iter().position(|vector| vector.iter().any(|value| !value.is_finite())) {
                return Some(format!("{name} of {} {}", set.name, set.id[at]));
            }
        }
        for column in &set.columns {
            if let Some(at) = first_bad(column, f64::is_finite) {
                return Some(format!("{} of {} {}", column.name, set.name, set.id[at]));
            }
        }
    }
    None
}

/// The first entry of a column that is refused.
fn first_bad(column: &Column, is_allowed: impl Fn(f64) -> bool) -> Option<usize> {
    match &column.values {
        Values::Scalar(values) => values.iter().position(|value| !is_allowed(*value)),
        Values::Vector(vectors) => vectors.iter().position(|vector| !vector.iter().all(|value| is_allowed(*value))),
    }
}

/// Whether a gauge of a model has no value, NaN, where there is nothing to measure: a gas before its first samples, the surface of a solid before
/// its first drop.
fn may_have_no_value(kind: Kind, column: &GaugeColumn) -> bool {
    match kind {
        Kind::Gas => true,
        Kind::Dew => column.unit == "s" || ["mean_radius", "drop_radius", "polydispersity"].contains(&column.quantity),
        _ => column.quantity.contains("arrival"),
    }
}

/// The first value of gauges, maps and surfaces that is not a number where there must be one.
fn not_a_number_beside(kind: Kind, model: &dyn Model) -> Option<String> {
    let columns = model.gauge_columns();
    let gauge = columns.iter().zip(model.gauge_row()).find(|(column, value)| {
        if may_have_no_value(kind, column) { kind != Kind::Gas && value.is_infinite() } else { !value.is_finite() }
    });
    if let Some((column, value)) = gauge {
        return Some(format!("gauge {} is {value}", column.header()));
    }
    // NaN where a map has nothing.
    if let Some(map) = model.maps().iter().find(|map| map.values.iter().any(|value| value.is_infinite())) {
        return Some(format!("map {} is infinite", map.name));
    }
    for surface in model.surfaces() {
        // Times of what has not happened are NaN.
        let is_allowed =
            |column: &Column| if column.unit == "s" { |value: f64| !value.is_infinite() } else { f64::is_finite };
        let bad = surface.columns.iter().find(|column| first_bad(column, is_allowed(column)).is_some());
        if let Some(column) = bad {
            return Some(format!("{} of surface {}", column.name, surface.name));
        }
    }
    None
}

/// Two balls that overlap.
fn overlap(frame: &Frame) -> Option<String> {
    let balls: Vec<_> = frame
        .sets
        .iter()
        .flat_map(|set| (0..set.len()).map(move |k| (set.id[k], set.position[k], set.radius[k])))
        .collect();
    for (number, (id, at, radius)) in balls.iter().enumerate() {
        for (other, position, other_radius) in &balls[number + 1..] {
            let distance = (0..3).map(|axis| (at[axis] - position[axis]).powi(2)).sum::<f64>().sqrt();
            let sum = radius + other_radius;
            if distance < sum * (1.0 - OVERLAP) {
                return Some(format!("balls {id} and {other}: distance {distance}, radii {sum}"));
            }
        }
    }
    None
}

fn fastest(frame: &Frame) -> f64 {
    let speeds = frame.sets.iter().flat_map(|set| &set.velocity).map(|v| v.iter().map(|u| u * u).sum::<f64>().sqrt());
    speeds.fold(0.0, f64::max)
}

/// Volume of the water, m3.
fn volume(frame: &Frame) -> f64 {
    frame.sets.iter().flat_map(|set| &set.mass).sum::<f64>() / 1000.0
}

/// Kinetic and potential energy of the water of a flood, J; frames have no ground within cells, of which its potential energy depends
/// with `storage = "level-volume"`.
fn energy(model: &dyn Model) -> f64 {
    let columns = model.gauge_columns();
    let energy = columns.iter().zip(model.gauge_row()).find(|(column, _)| column.header() == "water.energy_J");
    energy.expect("a flood by scheme voronoi has its energy as a gauge").1
}

/// Features of a scene that can be left out so that the same is found: numbers for [`super::scene`].
pub fn shorter(kind: Kind, seed: u64, found: &Finding) -> Vec<usize> {
    let mut off = Vec::new();
    let (_, asked) = scene(kind, seed, &off);
    let start = Instant::now();
    for number in 0..asked {
        if start.elapsed() > Duration::from_secs(60) {
            break;
        }
        let mut more = off.clone();
        more.push(number);
        let (text, _) = scene(kind, seed, &more);
        if text != scene(kind, seed, &off).0
            && matches!(try_scene(kind, &text), Trial::Finding(other) if other.kind == found.kind)
        {
            off = more;
        }
    }
    off
}
