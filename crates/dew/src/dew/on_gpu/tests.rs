//! Room on the GPU, and its loss.

use super::*;
use crate::air::{Particle, Properties};
use crate::dew::Setup;
use crate::gpu::FINE_CELLS_MIN_PARTICLES;
use crate::room::{Inflow, Room};
use crate::settings::Settings;
use crate::solids::Body;
use crate::testing::block;
use corpuscle_gpu::{require_gpu, wait_for};
use corpuscle_model::{GpuModel, Model};
use corpuscle_scene::{Scene, builtin};
use std::path::Path;

const WARM: f64 = 300.0;

fn duct_round(bodies: Vec<Body>) -> Setup {
    let inlet = Face::Inlet(Inflow { velocity: [0.097, 0.0, 0.0], temperature: WARM + 1.0, vapour: 0.01 });
    let faces = [[inlet, Face::Outlet], [Face::Wall; 2], [Face::Periodic; 2]];
    let room = Room { low: [0.0; 3], high: [0.02, 0.012, 0.01], faces };
    let (settings, air) = (Settings::new(0.002, WARM, 0.01), Properties::at_room_temperature(0.5));
    Setup { settings, air, room, bodies, fans: Vec::new(), seed: 1 }
}

fn duct() -> Dew {
    Dew::new(&duct_round(Vec::new()), |_| [WARM, 0.01]).unwrap()
}

/// The scene dew/pane.
fn pane() -> Dew {
    let mut scene = Scene::parse(builtin("dew/pane").unwrap().text, "dew/pane", &[]).unwrap();
    scene.resolve_defaults();
    crate::open(scene.dew().unwrap(), 1, Path::new("")).unwrap()
}

#[test]
fn more_room_is_taken_where_air_that_comes_might_find_none() {
    let Some(gpu) = require_gpu("room on the GPU") else { return };
    let mut both = [(); 2].map(|()| duct());
    let come = both[0].most_in_a_step();
    let scarce = both[0].state.air.len() + come - 1;
    both[0].open_gpu_with(gpu.clone(), scarce).unwrap();
    both[1].use_gpu(gpu).unwrap();
    for dew in &mut both {
        dew.advance_to(0.05, &AtomicBool::new(false)).unwrap();
    }
    let [with_more, plain] = &both;
    assert!(come > 0 && with_more.gpu_solver.as_ref().unwrap().filling()[1] > scarce);
    assert!(with_more.state.next_id > with_more.state.air.len() as u64, "some have come");
    assert!(with_more.state.air == plain.state.air && with_more.state.water == plain.state.water);
}

/// An upload amid a run rounds all values again.
#[test]
fn more_room_is_taken_amid_a_run() {
    let Some(gpu) = require_gpu("more room on the GPU") else { return };
    let mut both = [(); 2].map(|()| duct());
    let scarce = both[0].state.air.len() + both[0].most_in_a_step();
    both[0].open_gpu_with(gpu.clone(), scarce).unwrap();
    both[1].use_gpu(gpu).unwrap();
    for dew in &mut both {
        dew.advance_to(0.1, &AtomicBool::new(false)).unwrap();
        dew.state.air.sort_unstable_by_key(|particle| particle.id);
    }
    let [with_more, plain] = &both;
    assert!(with_more.gpu_solver.as_ref().unwrap().filling()[1] > scarce);
    assert!(with_more.state.steps == plain.state.steps && with_more.state.next_id == plain.state.next_id);
    assert_eq!(with_more.state.air.len(), plain.state.air.len());
    for (a, b) in with_more.state.air.iter().zip(&plain.state.air) {
        let apart = (0..3).map(|axis| (a.position[axis] - b.position[axis]).abs()).fold(0.0, f64::max);
        assert!(a.id == b.id && a.role == b.role && apart < 1e-4 * 0.002, "{apart} m");
    }
    let balances = with_more.ledger().balances;
    assert!(balances.iter().all(|balance| balance.relative_error().abs() < 1e-7));
}

/// Batches of steps, and drops, have come back by then.
#[test]
fn a_gpu_lost_amid_a_run_leaves_the_state_of_before() {
    let Some(gpu) = require_gpu("a GPU that is lost") else { return };
    let stop = AtomicBool::new(false);
    let mut dew = pane();
    dew.use_gpu(gpu).unwrap();
    dew.advance_to(0.05, &stop).unwrap();
    let saved = dew.save();
    dew.gpu_solver.as_mut().unwrap().lost_after = Some(3);
    let error = dew.advance_to(0.15, &stop).unwrap_err();
    assert!(matches!(error, ModelError::Device(_)), "{error}");
    assert_eq!(dew.gpu_solver.take().unwrap().lost_after, Some(0));
    assert!(dew.save() == saved && dew.time() == 0.05);
    // The run goes on where there is no GPU.
    let mut other = pane();
    other.restore(&saved).unwrap();
    for dew in [&mut dew, &mut other] {
        dew.advance_to(0.06, &stop).unwrap();
    }
    assert!(dew.save() == other.save());
}

/// A row that is due between the state that a run goes on from and its next step.
#[test]
fn a_row_before_the_first_step_is_that_of_the_state() {
    let Some(gpu) = require_gpu("a row of gauges on the GPU") else { return };
    let mut dew = pane();
    dew.use_gpu(gpu.clone()).unwrap();
    dew.advance_to(0.05, &AtomicBool::new(false)).unwrap();
    let mut other = pane();
    other.restore(&dew.save()).unwrap();
    other.use_gpu(gpu).unwrap();
    let [row, same] = [&mut dew, &mut other].map(|dew| wait_for(dew.row_of_gpu()).unwrap());
    // As text: columns without a value are no numbers.
    assert_eq!(format!("{row:?}"), format!("{same:?}"));
}

/// The duct with a cold block in it, and air that turns.
fn duct_round_a_block() -> Dew {
    let setup = duct_round(vec![block([0.008, 0.004, 0.002], [2, 2, 3], 0.002)]);
    let start = |[x, y, z]: [f64; 3]| [WARM + (300.0 * x).sin() * (500.0 * y).cos(), 0.01 + 0.002 * (600.0 * z).sin()];
    let mut dew = Dew::new(&setup, start).unwrap();
    dew.stir(|[x, y, z]| [0.097 + 0.03 * (500.0 * y).sin(), 0.02 * (600.0 * z).cos(), 0.02 * (300.0 * x).sin()]);
    dew
}

fn air_by_id(dew: &Dew) -> Vec<Particle> {
    let mut air = dew.state.air.clone();
    air.sort_unstable_by_key(|particle| particle.id);
    air
}

/// Largest differences: of particles, position over the spacing, velocity (m/s), temperature (K), vapour and fog (parts of the mass); of
/// particles of solids, temperature (K) and water over the most on any.
fn differences(a: &Dew, b: &Dew) -> [f64; 7] {
    let most = |numbers: &mut dyn Iterator<Item = f64>| numbers.fold(0.0, f64::max);
    let [air, other] = [air_by_id(a), air_by_id(b)];
    assert!(air.len() == other.len() && air.iter().zip(&other).all(|(a, b)| a.id == b.id && a.role == b.role));
    let of_vector = |get: fn(&Particle) -> [f64; 3]| {
        let apart = |(a, b)| (0..3).map(|axis| (get(a)[axis] - get(b)[axis]).abs()).fold(0.0, f64::max);
        most(&mut air.iter().zip(&other).map(apart))
    };
    let of = |get: fn(&Particle) -> f64| most(&mut air.iter().zip(&other).map(|(a, b)| (get(a) - get(b)).abs()));
    let of_solids = |a: &[f64], b: &[f64]| most(&mut a.iter().zip(b).map(|(a, b)| (a - b).abs()));
    let water = a.state.water_on.iter().copied().fold(1e-13, f64::max);
    [
        of_vector(|particle| particle.position) / a.scale.spacing,
        of_vector(|particle| particle.velocity),
        of(|particle| particle.temperature),
        of(|particle| particle.vapour),
        of(|particle| particle.fog),
        of_solids(&a.state.temperatures, &b.state.temperatures),
        of_solids(&a.state.water_on, &b.state.water_on) / water,
    ]
}

/// Room for many particles makes cells half as large as the reach, however few there are. The bounds are those of cells as large as it
/// (`tests/gpu.rs`).
#[test]
fn air_in_cells_of_half_the_reach_goes_as_on_the_cpu() {
    let Some(gpu) = require_gpu("small cells on the GPU") else { return };
    let [mut host, mut device, mut plain] = [(); 3].map(|()| duct_round_a_block());
    device.open_gpu_with(gpu.clone(), FINE_CELLS_MIN_PARTICLES).unwrap();
    plain.use_gpu(gpu).unwrap();
    let cells = |dew: &Dew| dew.gpu_solver.as_ref().unwrap().cells();
    assert!(cells(&device) > 4 * cells(&plain), "{} and {} cells", cells(&device), cells(&plain));
    let one = [3e-6, 1e-6, 1e-5, 1e-8, 1e-8, 1e-7, 5e-5];
    let ten = [1e-5, 1e-5, 1e-4, 1e-7, 1e-7, 1e-6, 5e-5];
    for (steps, most) in [(1, one), (9, ten)] {
        for dew in [&mut host, &mut device] {
            for _ in 0..steps {
                // A little more than a step, lest rounding take it for less.
                dew.advance_to(dew.time() + 1.000_001 * dew.time_step(), &AtomicBool::new(false)).unwrap();
            }
        }
        assert_eq!(host.state.steps, device.state.steps);
        let apart = differences(&host, &device);
        assert!((0..7).all(|k| apart[k] < most[k]), "after {} steps: {apart:?}", host.state.steps);
    }
}
