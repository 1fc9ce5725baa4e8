//! Corpuscle as a library: open a scene, run it, attach sinks.
//!
//! ```no_run
//! use corpuscle::{Recorder, Simulation};
//! use std::path::Path;
//! use std::sync::atomic::AtomicBool;
//!
//! # fn main() -> Result<(), corpuscle::Error> {
//! let scene = corpuscle::scene::Scene::read(Path::new("flood.toml"), &[])?;
//! let mut simulation = Simulation::open(scene, Path::new("."))?;
//! let mut recorder = Recorder::create(Path::new("runs/flood-1"), &simulation, Default::default())?;
//! let summary = simulation.run(&mut [&mut recorder], &AtomicBool::new(false), &mut |_| {})?;
//! println!("{} particles", summary.particles);
//! # Ok(())
//! # }
//! ```

#[cfg(feature = "gpu")]
mod backend;
mod camera_path;
mod error;
#[cfg(feature = "film")]
mod filming;
mod ground;
mod live_change;
mod memory;
pub mod models;
mod open;
#[cfg(feature = "pictures")]
mod open_pictures;
pub mod parameters;
#[cfg(feature = "pictures")]
pub mod pictures;
mod progress;
mod recorder;
mod run_observer;
mod schedule;
#[cfg(feature = "pictures")]
mod seen_on_gpu;
mod simulation;
mod sink;

pub use corpuscle_dew::{LiveChange as DewLiveChange, SourceChange as DewSourceChange};
#[cfg(feature = "fetch")]
pub use corpuscle_fetch as fetch;
pub use corpuscle_flood::{LiveChange as FloodLiveChange, Sample};
pub use corpuscle_gas::LiveChange as GasLiveChange;
#[cfg(any(feature = "gpu", feature = "pictures"))]
pub use corpuscle_gpu as gpu;
pub use corpuscle_model as model;
pub use corpuscle_output as output;
pub use corpuscle_processes as processes;
pub use corpuscle_scene as scene;
pub use corpuscle_terrain as terrain;
#[cfg(feature = "film")]
pub use corpuscle_video as video;

#[cfg(feature = "gpu")]
pub use backend::{Choice, Cpu, FEWEST_ON_GPU};
pub use camera_path::{CameraStation, camera_path};
pub use error::Error;
#[cfg(feature = "film")]
pub use filming::Filming;
#[cfg(feature = "fetch")]
pub use ground::fetch_terrain;
pub use live_change::LiveChange;
pub use models::register;
pub use progress::Progress;
pub use recorder::Recorder;
pub use simulation::Simulation;
pub use sink::Sink;
