//! The subject of the physics thread: a scene that is computed, or a finished run that is replayed.

use super::{Backend, Change};
use crate::snapshot::Measures;
use corpuscle::gpu::{DeviceParticles, Gpu, GpuKind};
use corpuscle::model::{Container, Frame, GaugeColumn, Path as Trajectory};
use corpuscle::output::{FrameFiles, GaugeTable, WallPositions, followed_paths};
use corpuscle::scene::Scene;
use corpuscle::{Choice, Cpu, Error, Sample, Simulation};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// A scene that is computed, or a finished run.
pub(super) enum Subject {
    Live(Box<Simulation>, Choice),
    Recorded(Box<Recorded>),
}

/// A finished run.
pub(super) struct Recorded {
    /// The scene at its start: terrain, solids and box.
    simulation: Simulation,
    files: FrameFiles,
    paths: Vec<Trajectory>,
    walls: WallPositions,
    gauges: GaugeTable,
    /// Number of the frame that is shown, and the frame.
    shown: (usize, Frame),
    time: f64,
    end: f64,
}

impl Subject {
    /// A scene at its start, on a backend: on `gpu` or on a CPU.
    pub fn live(mut simulation: Simulation, backend: Backend, (gpu, cpu): (Option<&Gpu>, Cpu)) -> Result<Self, Error> {
        let choice = |is_gpu, why: &str| Choice { is_gpu, why: why.into() };
        let choice = match (backend, gpu) {
            (Backend::Cpu, _) => choice(false, "as requested"),
            (Backend::Auto, Some(gpu)) => simulation.use_best_on(gpu, cpu),
            (Backend::Auto, None) => {
                choice(false, simulation.why_on_cpu(cpu).as_deref().unwrap_or("there is no GPU to choose"))
            }
            (Backend::Gpu, _) if simulation.model().on_gpu().is_none() => {
                choice(false, "this model runs on the CPU only")
            }
            (Backend::Gpu, Some(gpu)) => {
                simulation.use_this_gpu(gpu.clone())?;
                choice(true, &gpu.name)
            }
            (Backend::Gpu, None) => choice(false, "there is no GPU"),
        };
        Ok(Self::Live(Box::new(simulation), choice))
    }

    /// The simulation, where it is computed on the GPU that draws it; elsewhere the host needs the particles for every picture.
    pub fn drawn_in_place(&mut self, gpu: &Gpu) -> Option<&mut Simulation> {
        match self {
            Self::Live(simulation, _) if gpu.kind == GpuKind::Hardware && simulation.is_seen_on(gpu) => {
                Some(simulation)
            }
            Self::Live(..) | Self::Recorded(_) => None,
        }
    }

    /// The particles in GPU memory, where they are drawn from there.
    pub fn on_device(&self, gpu: &Gpu) -> Result<Option<DeviceParticles>, Error> {
        match self {
            Self::Live(simulation, _) if gpu.kind == GpuKind::Hardware => simulation.seen_on(gpu),
            Self::Live(..) | Self::Recorded(_) => Ok(None),
        }
    }

    /// Opens a finished run at its start.
    pub fn recorded(folder: &Path) -> Result<Self, Error> {
        let scene = Scene::read(&folder.join("scene.toml"), &[])?;
        let (period, until) = (scene.run.frame_period_s(), scene.run.until_s);
        let files = FrameFiles::list(folder, |index| (index as f64 * period).min(until))?;
        let shown = (0, files.read(0)?);
        let end = files.times().fold(0.0, f64::max);
        let gauges = GaugeTable::read(&folder.join("gauges.csv"))?;
        let (paths, walls) = (followed_paths(folder)?, WallPositions::read(folder)?);
        let simulation = Simulation::open_to_restore(scene, folder)?;
        let time = shown.1.time;
        Ok(Self::Recorded(Box::new(Recorded { simulation, files, paths, walls, gauges, shown, time, end })))
    }

    /// The scene as it stood at its start; of one that is computed, as it stands.
    pub fn simulation(&self) -> &Simulation {
        match self {
            Self::Live(simulation, _) => simulation,
            Self::Recorded(run) => &run.simulation,
        }
    }

    /// The backend and why it was chosen, as text.
    pub fn computed_on(&self) -> Option<String> {
        match self {
            Self::Live(_, Choice { is_gpu, why }) => {
                let on = if *is_gpu { "GPU" } else { "CPU" };
                Some(if why.is_empty() {
                    format!("Computed on the {on}")
                } else {
                    format!("Computed on the {on}: {why}")
                })
            }
            Self::Recorded(_) => None,
        }
    }

    /// The time shown, s.
    pub fn time(&self) -> f64 {
        match self {
            Self::Live(simulation, _) => simulation.model().time(),
            Self::Recorded(run) => run.time,
        }
    }

    /// End time, s.
    pub fn end(&self) -> f64 {
        match self {
            Self::Live(simulation, _) => simulation.scene().run.until_s,
            Self::Recorded(run) => run.end,
        }
    }

    /// The time of the next pause: beyond the end, where a scene is played on from there.
    pub fn next_end(&self) -> f64 {
        match self {
            Self::Live(..) if self.time() >= self.end() => f64::INFINITY,
            Self::Live(..) | Self::Recorded(_) => self.end(),
        }
    }

    /// Advances to a time, or until it is stopped. To be awaited to its end.
    pub async fn advance_to(&mut self, time: f64, stop: &AtomicBool) -> Result<(), Error> {
        match self {
            Self::Live(simulation, _) => simulation.advance_later(time, stop).await,
            Self::Recorded(run) => run.show(time),
        }
    }

    /// Shows another time of a finished run; nothing happens to a scene that is computed.
    pub fn seek(&mut self, time: f64) -> Result<(), Error> {
        match self {
            Self::Live(..) => Ok(()),
            Self::Recorded(run) => run.show(time),
        }
    }

    /// Changes what is computed; a finished run stays as it is.
    pub fn change(&mut self, change: Change) -> Result<(), Error> {
        match self {
            Self::Live(simulation, _) => simulation.make_change(change),
            Self::Recorded(_) => Ok(()),
        }
    }

    /// Work done so far.
    pub fn work(&self) -> u64 {
        match self {
            Self::Live(simulation, _) => simulation.model().particle_steps(),
            Self::Recorded(_) => 0,
        }
    }

    /// Particles that are computed now; of a finished run those that are shown.
    pub fn particles(&self) -> usize {
        match self {
            Self::Live(simulation, _) => simulation.model().particles(),
            Self::Recorded(run) => run.shown.1.sets.iter().map(|set| set.len()).sum(),
        }
    }

    /// Names of the gauges.
    pub fn gauge_names(&self) -> Vec<String> {
        match self {
            Self::Live(simulation, _) => simulation.model().gauge_columns().iter().map(GaugeColumn::header).collect(),
            Self::Recorded(run) => run.gauges.columns.clone(),
        }
    }

    /// Of a finished run its gauges over time.
    pub fn history(&self) -> Option<Vec<(f64, Vec<f64>)>> {
        match self {
            Self::Live(..) => None,
            Self::Recorded(run) => {
                let rows = run.gauges.times.iter().copied().zip(run.gauges.rows.iter().cloned());
                Some(rows.collect())
            }
        }
    }

    /// The current frame, trajectories and box.
    pub fn current(&self) -> (Frame, Vec<Trajectory>, Option<Container>) {
        match self {
            Self::Live(simulation, _) => {
                let model = simulation.model();
                (model.frame(), model.paths(), model.container())
            }
            Self::Recorded(run) => {
                let start = run.simulation.model().container();
                let container = start.map(|start| run.walls.container(start, run.shown.1.time));
                (run.shown.1.clone(), run.paths.clone(), container)
            }
        }
    }

    /// The water at a position of a flood that is computed.
    pub fn water_at(&self, position: [f64; 2]) -> Option<Sample> {
        match self {
            Self::Live(simulation, _) => simulation.water_at(position),
            Self::Recorded(_) => None,
        }
    }

    /// The current measurements.
    pub fn measures(&self) -> Measures {
        match self {
            Self::Live(simulation, _) => Measures::of(simulation.model()),
            Self::Recorded(run) => {
                let row = run.gauges.times.partition_point(|time| *time <= run.time).saturating_sub(1);
                let gauges = run.gauges.rows.get(row).cloned().unwrap_or_default();
                Measures { time: run.time, names: run.gauges.columns.clone(), gauges, ..Measures::default() }
            }
        }
    }
}

impl Recorded {
    /// Shows the frame nearest to a time, s.
    fn show(&mut self, time: f64) -> Result<(), Error> {
        self.time = time.clamp(0.0, self.end);
        let index = self.files.nearest(self.time);
        if index != self.shown.0 {
            self.shown = (index, self.files.read(index)?);
        }
        Ok(())
    }
}
