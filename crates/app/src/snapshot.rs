//! What the physics shows at one time.

use corpuscle::Sample;
use corpuscle::gpu::DeviceParticles;
use corpuscle::model::{Chart, Container, Frame, GaugeColumn, Ledger, Model, Path};
use std::sync::Arc;

/// Tells the window that there is something new to show; called from any thread.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// The physics at one time.
#[derive(Debug, Clone)]
pub struct Snapshot {
    /// Number of the scene that it is of.
    pub number: u64,
    /// The time, and the particles; of a scene that goes on on the device that draws only those that are elsewhere.
    pub frame: Arc<Frame>,
    /// Particles that are drawn from where they lie.
    pub on_device: Option<DeviceParticles>,
    /// All particles as they last came to the host.
    pub known: Arc<Frame>,
    /// The ways of those that are followed.
    pub paths: Vec<Path>,
    /// The box round them.
    pub container: Option<Container>,
    /// Particles now.
    pub particles: usize,
    /// True while it goes on.
    pub playing: bool,
    /// Simulated seconds in a second of the wall clock, as it goes; 0 while it waits.
    pub pace: f64,
    /// True where it cannot keep the pace that was asked for.
    pub behind: bool,
    /// Particles moved (of a gas: collisions) in a second of the wall clock.
    pub rate: f64,
    /// The water at the place that was asked for; none of a finished run.
    pub probed: Option<Sample>,
    /// What was measured, not later than a moment ago.
    pub measures: Arc<Measures>,
}

/// What was measured, which costs more than a look.
#[derive(Debug, Clone, Default)]
pub struct Measures {
    /// When, s.
    pub time: f64,
    /// Names of the gauges, as in files.
    pub names: Vec<String>,
    /// Values of the gauges.
    pub gauges: Vec<f64>,
    /// Charts of the model.
    pub charts: Vec<Chart>,
    /// What should be conserved.
    pub ledger: Ledger,
    /// What a user should know of the run.
    pub warnings: Vec<String>,
}

impl Measures {
    /// What a model measures now.
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
