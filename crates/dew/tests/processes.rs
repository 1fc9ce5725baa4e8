//! Several processes give what one gives, bit for bit. Threads stand for processes.

use corpuscle_dew::{Dew, LiveChange, open_on};
use corpuscle_model::{Frame, Ledger, Model, ModelError, Surface};
use corpuscle_processes::{Processes, on_threads};
use corpuscle_scene::{Scene, builtin};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Air flows past a heated glass with the outside behind it, with drops, round a ball that warms.
const FLOWN: &str = r#"
run.until_s = 1
[dew]
size_m = [0.026, 0.012, 0.024]
spacing_m = 0.002
time_factor = 50
air = { temperature_c = 25, relative_humidity = 0.8 }
drops = { smallest_radius_m = 5e-5, sites_per_m2 = 3e7, friction = 1e-7 }
output = { air = true, solids = true }
[dew.faces]
y_min = "periodic"
y_max = "periodic"
x_max = { inflow = { velocity_m_per_s = [-0.06, 0.0, 0.01] } }
z_min = "outflow"
[[dew.solid]]
name = "glass"
shape = { box = { size_m = [0.004, 0.012, 0.024] } }
position_m = [0.002, 0.006, 0.012]
temperature_c = 5
outside = { side = "x_min", temperature_c = -5.0, h_w_per_m2_k = 25.0 }
radiation = { emissivity = 0.9, surroundings_c = 20.0 }
heater = { power_w_per_m2 = [[0, 0], [0.05, 0], [0.05, 1000]] }
[[dew.solid]]
name = "ball"
shape = { sphere = { radius_m = 0.004 } }
position_m = [0.014, 0.006, 0.011]
temperature_c = 8
"#;

/// Warm air rises and leaves by open sides, driven by a fan past a cold held bar; far air is of low utility.
const OPEN: &str = r#"
run.until_s = 1
[dew]
size_m = [0.030, 0.012, 0.028]
spacing_m = 0.002
air = { temperature_c = 30, relative_humidity = 0.95, velocity_m_per_s = [0.02, 0.0, 0.05] }
drops = { smallest_radius_m = 1e-4, sites_per_m2 = 1e6 }
output = { air = true, solids = false }
low_utility = { distance = 2.0, after_s = 0.005 }
fan = [{ position_m = [0.007, 0.006, 0.007], size_m = [0.006, 0.008, 0.006], velocity_m_per_s = [0.0, 0.0, 0.3] }]
[dew.faces]
x_min = "open"
x_max = "open"
z_max = "open"
[[dew.solid]]
name = "bar"
shape = { cylinder = { radius_m = 0.003, height_m = 0.012 } }
position_m = [0.006, 0.006, 0.015]
rotation_deg = [90.0, 0.0, 0.0]
temperature_c = 2
held = true
"#;

/// A closed room as in the patent: relative humidity diffuses, and the water of single particles is deposited.
const CLOSED: &str = r#"
run.until_s = 1
[dew]
size_m = [0.018, 0.016, 0.020]
spacing_m = 0.002
scheme = "particle-condensation"
time_factor = 2
air = { temperature_c = 25, relative_humidity = 0.8 }
drops = { smallest_radius_m = 1e-4, sites_per_m2 = 1e6 }
output = { air = true, solids = true }
[[dew.solid]]
name = "block"
shape = { box = { size_m = [0.006, 0.006, 0.006] } }
position_m = [0.008, 0.009, 0.011]
rotation_deg = [20.0, 30.0, 0.0]
temperature_c = 2
[[dew.solid]]
name = "floor"
shape = { box = { size_m = [0.018, 0.016, 0.004] } }
position_m = [0.009, 0.008, 0.002]
temperature_c = 6
held = true
"#;

fn scene(text: &str) -> corpuscle_scene::Dew {
    Scene::parse(text, "test", &[]).unwrap().dew().unwrap().clone()
}

/// All that is seen of dew.
#[derive(Debug, PartialEq)]
struct Seen {
    frames: Vec<Frame>,
    rows: Vec<Vec<u64>>,
    surfaces: Vec<Vec<Vec<u64>>>,
    ledger: Ledger,
    particles: usize,
    particle_steps: u64,
    warnings: Vec<String>,
    states: Vec<Vec<u8>>,
}

fn surfaces(dew: &Dew) -> Vec<Vec<Vec<u64>>> {
    let columns = |surface: Surface| surface.columns.into_iter().map(|column| bits(&column.values)).collect();
    dew.surfaces().into_iter().map(columns).collect()
}

fn bits(values: &corpuscle_model::Values) -> Vec<u64> {
    match values {
        corpuscle_model::Values::Scalar(values) => values.iter().map(|value| value.to_bits()).collect(),
        corpuscle_model::Values::Vector(values) => values.as_flattened().iter().map(|value| value.to_bits()).collect(),
    }
}

fn look(dew: &mut Dew, times: &[f64]) -> Seen {
    let (mut frames, mut rows, mut states) = (Vec::new(), Vec::new(), Vec::new());
    for time in times {
        dew.advance_to(*time, &AtomicBool::new(false)).unwrap();
        frames.push(dew.frame());
        rows.push(dew.gauge_row().into_iter().map(f64::to_bits).collect());
        states.push(dew.save());
    }
    Seen {
        frames,
        rows,
        surfaces: surfaces(dew),
        ledger: dew.ledger(),
        particles: dew.particles(),
        particle_steps: dew.particle_steps(),
        warnings: dew.warnings(),
        states,
    }
}

/// What the first of some processes, each with some threads, makes of a scene that each opens; the others follow.
fn on<T: Send>(
    processes: usize,
    threads_each: usize,
    text: &str,
    first: impl Fn(Result<Dew, ModelError>) -> T + Sync,
) -> T {
    let run = |process: Processes| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads_each).build().unwrap();
        pool.install(|| {
            let opened = open_on(&process, &scene(text), 1, Path::new("."));
            if process.is_first() {
                return Some(first(opened));
            }
            if let Ok(mut dew) = opened {
                process.follow(&mut dew);
            }
            None
        })
    };
    on_threads(processes, run).unwrap()
}

/// Compares what some processes make of a scene with what one does, part by part.
fn compare(text: &str, times: &[f64], counts: &[usize]) -> Seen {
    let one = on(1, 2, text, |dew| look(&mut dew.unwrap(), times));
    // The scheme of the patent does not keep water and energy.
    let is_kept = one.ledger.balances.iter().all(|balance| balance.relative_error().abs() < 1e-10);
    assert!((is_kept || text == CLOSED) && one.particle_steps > 3000, "{:?} {}", one.ledger, one.particle_steps);
    for (number, count) in counts.iter().enumerate() {
        let several = on(*count, 1 + number % 2, text, |dew| look(&mut dew.unwrap(), times));
        assert_eq!(several.particle_steps, one.particle_steps, "{count} processes");
        for (k, frame) in one.frames.iter().enumerate() {
            assert!(several.frames[k] == *frame, "frame {k} of {count} processes");
        }
        assert_eq!(several.rows, one.rows, "{count} processes");
        assert!(several.surfaces == one.surfaces, "surfaces of {count} processes");
        assert_eq!(several.ledger, one.ledger, "{count} processes");
        assert!(several == one, "{count} processes");
    }
    one
}

#[test]
fn a_stream_past_glass_has_the_same_bits() {
    let seen = compare(FLOWN, &[0.1, 0.21], &[2, 4]);
    assert!(seen.frames[1].sets.iter().any(|set| set.name == "drops" && !set.id.is_empty()), "there are no drops");
}

#[test]
fn open_sides_have_the_same_bits() {
    compare(OPEN, &[0.03, 0.06], &[2, 3]);
}

#[test]
fn a_closed_room_has_the_same_bits() {
    compare(CLOSED, &[0.01, 0.04], &[2, 3, 4]);
}

#[test]
fn three_ways_to_keep_air_out_have_the_same_bits() {
    compare(
        &builtin("dew/three-boundaries")
            .unwrap()
            .text
            .replace("[dew.faces]", "drops = { smallest_radius_m = 1e-4, sites_per_m2 = 1e6 }\n[dew.faces]"),
        &[0.002, 0.006],
        &[2, 3],
    );
}

#[test]
fn many_processes_have_the_same_bits() {
    compare(FLOWN, &[0.02], &[7, 12]);
    compare(CLOSED, &[0.005], &[9]);
}

/// Saved by three, restored by two and by one, which go on to what one process makes of it.
#[test]
fn a_state_is_restored_by_another_number_of_processes() {
    for (text, times) in [(FLOWN, [0.05, 0.1]), (OPEN, [0.02, 0.05]), (CLOSED, [0.01, 0.02])] {
        let one = on(1, 2, text, |dew| look(&mut dew.unwrap(), &times));
        let saved = on(3, 1, text, |dew| look(&mut dew.unwrap(), &times[..1]).states.remove(0));
        assert!(saved == one.states[0]);
        for count in [1, 2, 4] {
            let resumed = on(count, 1, text, |dew| {
                let mut dew = dew.unwrap();
                dew.restore(&saved).unwrap();
                assert!(dew.save() == saved, "{count} processes");
                look(&mut dew, &times[1..])
            });
            assert!(resumed.states[0] == one.states[1], "{count} processes");
            assert!(resumed.frames[0] == one.frames[1] && resumed.rows[0] == one.rows[1]);
            assert_eq!(resumed.ledger, one.ledger, "{count} processes");
        }
    }
}

/// A damaged state is refused by all, and so are changes while it runs.
#[test]
fn what_cannot_be_is_refused() {
    let error = on(3, 1, CLOSED, |dew| dew.unwrap().restore(&[1, 2, 3]).unwrap_err().to_string());
    assert!(error.contains("damaged"), "{error}");
    let change = LiveChange::TimeFactor(2.0);
    let error = on(2, 1, CLOSED, |dew| change.change(&mut dew.unwrap()).unwrap_err().to_string());
    assert!(error.contains("several processes"), "{error}");
    // A state with a change is resumed by one process only: nothing of it is taken.
    let changed = on(1, 1, CLOSED, |dew| {
        let mut dew = dew.unwrap();
        change.change(&mut dew).unwrap();
        dew.save()
    });
    let (error, is_kept) = on(2, 1, CLOSED, |dew| {
        let mut dew = dew.unwrap();
        let before = dew.save();
        (dew.restore(&changed).unwrap_err().to_string(), dew.save() == before)
    });
    assert!(error.contains("changed while it ran") && is_kept, "{error}");
}
