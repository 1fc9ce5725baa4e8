//! Checkpoints: the file, and the states of the models in it.

use super::path_of;
use crate::Target;
use corpuscle::Simulation;
use corpuscle_model::Model;
use corpuscle_output::RunFolder;
use corpuscle_scene::Scene;
use sha2::{Digest, Sha256};
use std::cell::RefCell;
use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

pub(super) const TARGETS: &[Target] = &[
    Target {
        name: "checkpoint",
        about: "checkpoints, with a checksum that fits",
        corpus: "checkpoint",
        read: file,
        more: files,
    },
    Target { name: "state-gas", about: "states of gases", corpus: "state-gas", read: gas, more: gases },
    Target { name: "state-dew", about: "states of dew", corpus: "state-dew", read: dew, more: dews },
    Target {
        name: "state-gas-walls",
        about: "states of gases with walls, wells and regions",
        corpus: "state-gas-walls",
        read: gas_walls,
        more: gases_walls,
    },
    Target {
        name: "state-gas-shear",
        about: "states of sheared gases",
        corpus: "state-gas-shear",
        read: gas_shear,
        more: gases_shear,
    },
    Target {
        name: "state-dew-open",
        about: "states of dew with air that comes and goes",
        corpus: "state-dew-open",
        read: dew_open,
        more: dews_open,
    },
    Target {
        name: "state-voronoi-local",
        about: "states of floods with obstacles and local time steps",
        corpus: "state-voronoi-local",
        read: voronoi_local,
        more: voronois_local,
    },
    Target {
        name: "state-voronoi",
        about: "states of floods, scheme voronoi",
        corpus: "state-voronoi",
        read: voronoi,
        more: voronois,
    },
    Target {
        name: "state-adaptive",
        about: "states of floods with adaptive cells",
        corpus: "state-adaptive",
        read: adaptive,
        more: adaptives,
    },
    Target {
        name: "state-sph-swe",
        about: "states of floods, scheme sph-swe",
        corpus: "state-sph-swe",
        read: sph_swe,
        more: sph_swes,
    },
];

const GAS: &str = "run.until_s = 1\n[gas]\nsize = [20.0, 20.0, 20.0]\nspecies = [{ name = \"light\", count = 20, radius = 0.5, mass = 1.0, temperature = 1.0 }]\n";

const GAS_WALLS: &str = "run.until_s = 1\n[gas]\nsize = [20.0, 20.0, 20.0]\nfollow = 1\nwell = { depth = 0.5, width = 1.5 }\n\
    partition = { axis = \"x\", at = 10.0, lifted_at_s = 0.5, hole = { from = [8.0, 8.0], to = [12.0, 12.0] } }\n\
    measure = { region = [{ name = \"corner\", from = [0.0, 0.0, 0.0], to = [8.0, 8.0, 8.0] }] }\n\
    walls = { y_min = { thermal = { temperature = 2.0 } }, y_max = { thermal = { temperature = 1.0 } }, z_max = { piston = { mass = 50.0, pressure = 0.05, velocity = 0.0 } } }\n\
    species = [{ name = \"light\", count = 16, radius = 0.5, mass = 1.0, temperature = 1.0 }, { name = \"heavy\", count = 4, radius = 0.8, mass = 5.0, temperature = 1.0 }]\n";

const GAS_SHEAR: &str = "run.until_s = 1\n[gas]\nsize = [20.0, 20.0, 20.0]\nfollow = 0\nshear = { rate_per_s = 0.2, temperature = 1.0 }\n\
    walls = { x_min = \"periodic\", x_max = \"periodic\", y_min = \"periodic\", y_max = \"periodic\", z_min = \"periodic\", z_max = \"periodic\" }\n\
    species = [{ name = \"light\", count = 20, radius = 0.5, mass = 1.0, temperature = 1.0 }]\n";

const DEW_OPEN: &str = "run.until_s = 0.01\n[dew]\nsize_m = [0.03, 0.02, 0.02]\nspacing_m = 0.005\n\
    air = { temperature_c = 25.0, relative_humidity = 0.9 }\ndrops = { sites_per_m2 = 1e5 }\n\
    faces = { x_max = { inflow = { velocity_m_per_s = [-0.05, 0.0, 0.0] } }, y_min = \"open\", y_max = \"outflow\" }\n\
    fan = [{ position_m = [0.02, 0.01, 0.01], size_m = [0.01, 0.01, 0.01], velocity_m_per_s = [0.0, 0.1, 0.0] }]\n\
    solid = [{ name = \"pane\", shape = { box = { size_m = [0.005, 0.02, 0.02] } }, position_m = [0.0025, 0.01, 0.01], temperature_c = 5.0, \
    outside = { side = \"x_min\", temperature_c = -5.0, h_w_per_m2_k = 25.0 }, heater = { power_w = 0.01 } }]\n";

const VORONOI_LOCAL: &str = "run.until_s = 1\nterrain.bump = { extent = { length_m = 20.0, width_m = 20.0, cell_m = 1.0 }, height_m = 1.0, width_m = 5.0 }\n\
    [flood]\nspacing_m = 2.5\ntime_steps = \"local\"\nwater = [{ level_m = 0.8, velocity_m_per_s = [0.5, 0.0] }]\n\
    obstacle = [{ name = \"house\", polygon = [[4, 4], [8, 4], [8, 8], [4, 8]] }]\ngauge = [{ name = \"P 1\", at = [14, 14] }]\n\
    section = [{ name = \"S\", line = [[10, 1], [10, 19]] }]\n\
    outflow = [{ name = \"drain\", at = [15, 5], rating = [[0, 0], [1, 0.5]] }]\n";

const DEW: &str = "run.until_s = 0.01\n[dew]\nsize_m = [0.02, 0.02, 0.02]\nspacing_m = 0.005\n\
    air = { temperature_c = 25.0, relative_humidity = 0.9 }\ndrops = { sites_per_m2 = 1e6 }\n\
    solid = [{ name = \"pane\", shape = { box = { size_m = [0.005, 0.02, 0.02] } }, position_m = [0.0025, 0.01, 0.01], temperature_c = 5.0, held = true }]\n";

const VORONOI: &str = "run.until_s = 1\nterrain.bump = { extent = { length_m = 20.0, width_m = 20.0, cell_m = 1.0 }, height_m = 1.0, width_m = 5.0 }\n\
    [flood]\nspacing_m = 2.5\nwater = [{ level_m = 0.8, velocity_m_per_s = [0.5, 0.0] }]\nlink = [{ name = \"pipe\", from = [3, 3], to = [17, 17], law = { rating = [[0, 0], [1, 1]] } }]\n\
    rain = { intensity_mm_per_h = 20 }\ninfiltration = { constant = { rate_mm_per_h = 1 } }\n";

const ADAPTIVE: &str = "run.until_s = 1\nterrain.bump = { extent = { length_m = 20.0, width_m = 20.0, cell_m = 1.0 }, height_m = 1.0, width_m = 5.0 }\n\
    [flood]\nspacing_m = 4.0\nwater = [{ level_m = 0.8 }]\nadaptive = { finest_m = 2.0 }\n";

const SPH_SWE: &str = "run.until_s = 1\nterrain.bump = { extent = { length_m = 20.0, width_m = 20.0, cell_m = 1.0 }, height_m = 1.0, width_m = 5.0 }\n\
    [flood]\nscheme = \"sph-swe\"\nspacing_m = 5.0\nspacing_depth_m = 1.0\nwater = [{ level_m = 2.0 }]\n";

fn open(text: &str, is_restored: bool) -> Simulation {
    let scene = Scene::parse(text, "scene.toml", &[]).expect("the scene of a target is valid");
    let opened = if is_restored {
        Simulation::open_to_restore(scene, Path::new(""))
    } else {
        Simulation::open(scene, Path::new(""))
    };
    opened.expect("the scene of a target opens")
}

/// States at the start and a little later.
fn states(text: &str) -> Vec<Vec<u8>> {
    let mut simulation = open(text, false);
    let until = simulation.scene().run.until_s;
    let model = simulation.model_mut();
    let first = model.save();
    model.advance_to(0.3 * until, &AtomicBool::new(false)).expect("the scene of a target runs");
    vec![first, model.save()]
}

/// Advances after a state was taken back.
const ADVANCES: u32 = 3;

/// Longest time that these take, s.
const LONGEST: f64 = 2.0;

/// A state that is taken back can be shown, kept and gone on with, or the run says why not.
fn restore(text: &str, state: &[u8]) -> Result<String, String> {
    restore_into(&mut open(text, true), state)
}

fn restore_into(simulation: &mut Simulation, state: &[u8]) -> Result<String, String> {
    let until = simulation.scene().run.until_s;
    let model = simulation.model_mut();
    model.restore(state).map_err(|error| error.to_string())?;
    show(model);
    let frame = model.frame();
    let went_on = go_on(model, 1e-4 * until);
    show(model);
    let what = if frame.sets.iter().all(corpuscle_model::ParticleSet::is_empty) { "nothing" } else { "a state" };
    Ok(format!("{what}, {}", if went_on { "gone on with" } else { "not gone on with" }))
}

fn show(model: &dyn Model) {
    model.frame();
    model.gauge_row();
    model.ledger();
    model.warnings();
    model.maps();
    model.save();
}

/// Takes some steps; told to return after a while. True where none broke down.
fn go_on(model: &mut dyn Model, period: f64) -> bool {
    let stop = Arc::new(AtomicBool::new(false));
    let (done, waits) = mpsc::channel::<()>();
    let flag = stop.clone();
    let watch = thread::spawn(move || {
        if waits.recv_timeout(Duration::from_secs_f64(LONGEST)).is_err_and(|error| error == RecvTimeoutError::Timeout) {
            flag.store(true, Ordering::Relaxed);
        }
    });
    let went_on = (0..ADVANCES).all(|_| model.advance_to(model.time() + period, &stop).is_ok());
    drop(done);
    _ = watch.join();
    went_on
}

fn gas(bytes: &[u8]) -> Result<String, String> {
    restore(GAS, bytes)
}

fn gases() -> Vec<Vec<u8>> {
    states(GAS)
}

thread_local! {
    /// Opened once: it takes half a second. A state replaces all of the one before.
    static OPEN_DEW: RefCell<Option<Simulation>> = const { RefCell::new(None) };
}

fn dew(bytes: &[u8]) -> Result<String, String> {
    OPEN_DEW.with_borrow_mut(|dew| restore_into(dew.get_or_insert_with(|| open(DEW, true)), bytes))
}

fn dews() -> Vec<Vec<u8>> {
    states(DEW)
}

fn gas_walls(bytes: &[u8]) -> Result<String, String> {
    restore(GAS_WALLS, bytes)
}

fn gases_walls() -> Vec<Vec<u8>> {
    states(GAS_WALLS)
}

fn gas_shear(bytes: &[u8]) -> Result<String, String> {
    restore(GAS_SHEAR, bytes)
}

fn gases_shear() -> Vec<Vec<u8>> {
    states(GAS_SHEAR)
}

thread_local! {
    static OPEN_DEW_WITH_SIDES: RefCell<Option<Simulation>> = const { RefCell::new(None) };
}

fn dew_open(bytes: &[u8]) -> Result<String, String> {
    OPEN_DEW_WITH_SIDES.with_borrow_mut(|dew| restore_into(dew.get_or_insert_with(|| open(DEW_OPEN, true)), bytes))
}

fn dews_open() -> Vec<Vec<u8>> {
    states(DEW_OPEN)
}

fn voronoi_local(bytes: &[u8]) -> Result<String, String> {
    restore(VORONOI_LOCAL, bytes)
}

fn voronois_local() -> Vec<Vec<u8>> {
    states(VORONOI_LOCAL)
}

fn voronoi(bytes: &[u8]) -> Result<String, String> {
    restore(VORONOI, bytes)
}

fn voronois() -> Vec<Vec<u8>> {
    states(VORONOI)
}

fn adaptive(bytes: &[u8]) -> Result<String, String> {
    restore(ADAPTIVE, bytes)
}

fn adaptives() -> Vec<Vec<u8>> {
    states(ADAPTIVE)
}

fn sph_swe(bytes: &[u8]) -> Result<String, String> {
    restore(SPH_SWE, bytes)
}

fn sph_swes() -> Vec<Vec<u8>> {
    states(SPH_SWE)
}

const MAGIC: &str = "corpuscle checkpoint 1 sha256:";

/// What of a checkpoint its checksum is of.
fn files() -> Vec<Vec<u8>> {
    let scene = Sha256::digest(GAS.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect::<String>();
    let version = env!("CARGO_PKG_VERSION");
    let head = format!(
        "{{\"version\":\"{version}\",\"scene_sha256\":\"{scene}\",\"clock\":{{\"time_s\":0.25,\"wall_time_s\":1.5}},\"frame_format\":\"csv\",\
         \"frame_times\":[0.0,0.05],\"map_times\":[0.0],\"gauge_rows\":1}}\n"
    );
    vec![[head.as_bytes(), b"the state"].concat()]
}

/// A run's folder with a checkpoint of these bytes, below a checksum of them unless they begin with one.
fn file(bytes: &[u8]) -> Result<String, String> {
    let run = path_of("run");
    let write = |name: &str, content: &[u8]| fs::write(run.join(name), content).map_err(|error| error.to_string());
    for folder in ["frames", "checkpoint"] {
        fs::create_dir_all(run.join(folder)).map_err(|error| error.to_string())?;
    }
    write("scene.toml", GAS.as_bytes())?;
    write("gauges.csv", b"time_s,gas.pressure\n0,1\n0.1,2\n")?;
    let sum: String = Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect();
    let whole = if bytes.starts_with(MAGIC.as_bytes()) {
        bytes.to_vec()
    } else {
        [format!("{MAGIC}{sum}\n").as_bytes(), bytes].concat()
    };
    write("checkpoint/state", &whole)?;
    let (_, clock, state) =
        RunFolder::resume(&run).map_err(|error| error.to_string().replace(&run.display().to_string(), ""))?;
    Ok(format!("{} {}", state.is_empty(), clock.time_s > 0.0))
}
