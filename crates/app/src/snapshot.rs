//! Snapshots of the physics.

use corpuscle::Sample;
use corpuscle::gpu::DeviceParticles;
use corpuscle::model::{Chart, Container, Frame, GaugeColumn, Ledger, Model, Path};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Wakes the window to show a new snapshot; called from any thread.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// A snapshot: the physics at one time.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Snapshot {
    /// Number of its scene.
    pub number: u64,
    /// The time, and the particles in host memory.
    pub frame: Arc<Frame>,
    /// Particles in GPU memory that are drawn from there.
    #[serde(skip)]
    pub on_device: Option<DeviceParticles>,
    /// All particles as last read back to the host.
    #[serde(skip)]
    pub known: Arc<Frame>,
    /// Trajectories of followed particles.
    pub paths: Vec<Path>,
    /// The box round them.
    pub container: Option<Container>,
    /// Number of particles.
    pub particles: usize,
    /// True while playing.
    pub playing: bool,
    /// Simulated seconds per second of the wall clock; 0 while paused.
    pub pace: f64,
    /// True where it cannot keep the requested pace.
    pub behind: bool,
    /// Particles moved (of a gas: collisions) in a second of the wall clock.
    pub rate: f64,
    /// The water at the sampled position; none for a finished run.
    pub probed: Option<Sample>,
    /// Recent measurements.
    pub measures: Arc<Measures>,
}

/// Measurements of a model, which cost more than a frame.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Measures {
    /// Time, s.
    pub time: f64,
    /// Names of the gauges, as in files.
    pub names: Vec<String>,
    /// Values of the gauges.
    pub gauges: Vec<f64>,
    /// Charts of the model.
    pub charts: Vec<Chart>,
    /// The ledger of conserved quantities.
    pub ledger: Ledger,
    /// Warnings to the user.
    pub warnings: Vec<String>,
}

impl Measures {
    /// The current measurements of a model.
    pub(crate) fn of(model: &dyn Model) -> Self {
        Self {
            time: model.time(),
            names: model.gauge_columns().iter().map(GaugeColumn::header).collect(),
            gauges: model.gauge_row(),
            charts: model.charts(),
            ledger: model.ledger(),
            warnings: model.warnings(),
        }
    }
}
