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

mod along;
#[cfg(feature = "gpu")]
mod backend;
mod by_hand;
mod error;
#[cfg(feature = "film")]
mod filming;
mod ground;
mod open;
#[cfg(feature = "pictures")]
pub mod pictures;
mod progress;
mod recorder;
mod schedule;
mod simulation;
mod sink;

pub use corpuscle_dew::{ByHand as DewByHand, SourceByHand as DewSourceByHand};
#[cfg(feature = "fetch")]
pub use corpuscle_fetch as fetch;
#[cfg(feature = "film")]
pub use corpuscle_film as film;
pub use corpuscle_flood::{ByHand as FloodByHand, Sample};
pub use corpuscle_gas::ByHand as GasByHand;
#[cfg(any(feature = "gpu", feature = "pictures"))]
pub use corpuscle_gpu as gpu;
pub use corpuscle_model as model;
pub use corpuscle_record as record;
pub use corpuscle_scene as scene;
pub use corpuscle_terrain as terrain;

#[cfg(feature = "gpu")]
pub use backend::{Choice, FEWEST_ON_GPU};
pub use by_hand::ByHand;
pub use error::Error;
#[cfg(feature = "film")]
pub use filming::Filming;
#[cfg(feature = "fetch")]
pub use ground::fetch_terrain;
pub use progress::Progress;
pub use recorder::Recorder;
pub use simulation::Simulation;
pub use sink::Sink;
