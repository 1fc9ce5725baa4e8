//! A simulation: an open scene, and its run.

use crate::models::{self, COLLISIONS};
use crate::parameters::Change;
use crate::run_observer::{CheckpointTimer, Glances, Meter, RunObserver, SharedRunObserver};
use crate::schedule::Schedule;
use crate::{Error, LiveChange, Progress, Sink};
use corpuscle_flood::{Sample, as_flood, as_flood_mut};
use corpuscle_model::{Model, ModelError};
use corpuscle_output::{Clock, Status, Summary, ledger_entries};
use corpuscle_scene::Scene;
use corpuscle_terrain::Terrain;
use std::any::Any;
use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use web_time::Instant;

/// Longest time between two reports of progress or checkpoints.
const PAUSES: f64 = 1000.0;

/// A scene that is open, ready to run.
pub struct Simulation {
    scene: Scene,
    terrain: Option<Arc<Terrain>>,
    model: Box<dyn Model>,
    /// Wall-clock time spent before this part of the run, s.
    wall_before: f64,
    /// True where the run resumes from a checkpoint: output due at its time is written already.
    resumed: bool,
    notes: Vec<String>,
}

impl Simulation {
    /// A simulation of a scene with all defaults filled in, its terrain, if it has one, and its model.
    pub fn new(scene: Scene, terrain: Option<Arc<Terrain>>, model: Box<dyn Model>) -> Self {
        Self { scene, terrain, model, wall_before: 0.0, resumed: false, notes: Vec::new() }
    }

    pub(crate) fn with_notes(self, notes: Vec<String>) -> Self {
        Self { notes, ..self }
    }

    /// Keys of the scene that have an old name, then values chosen from the terrain where the scene leaves them open, in sentences.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The scene as run, with all defaults filled in and paths absolute.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The terrain, if there is one.
    pub fn terrain(&self) -> Option<&Arc<Terrain>> {
        self.terrain.as_ref()
    }

    /// The model.
    pub fn model(&self) -> &dyn Model {
        &*self.model
    }

    /// The model, for live changes.
    pub fn model_mut(&mut self) -> &mut dyn Model {
        &mut *self.model
    }

    /// Makes a live change of the model. It is not part of the scene: the scene as written does not reproduce this run.
    ///
    /// # Errors
    /// [`corpuscle_model::ModelError::Setup`] where the scene is of another model, or cannot be changed so: nothing has changed then.
    pub fn change_live(&mut self, change: impl Into<LiveChange>) -> Result<(), Error> {
        Ok(change.into().change(self.model_mut())?)
    }

    /// Makes a change of a parameter.
    ///
    /// # Errors
    /// Those of [`Simulation::change_live`] and [`Simulation::place_gauge`].
    pub fn make_change(&mut self, change: Change) -> Result<(), Error> {
        match change {
            Change::Model(changes) => changes.into_iter().try_for_each(|change| self.change_live(change)),
            Change::Gauge { name, at } => self.place_gauge(&name, at),
        }
    }

    /// The water at a position of a flood, in model coordinates; none for other models.
    pub fn water_at(&self, [x, y]: [f64; 2]) -> Option<Sample> {
        let model: &dyn Any = &*self.model;
        as_flood(model).map(|flood| flood.sample(x, y))
    }

    /// Estimated number of particles that inflows, rain and prescribed levels add from now to the end of the run; in scheme voronoi, how many
    /// more become wet. Outflow is not subtracted. 0 for models without inflow of water.
    pub fn particles_to_come(&self) -> f64 {
        self.particles_to_come_until(self.scene.run.until_s)
    }

    /// [`Simulation::particles_to_come`] up to a time, s.
    pub fn particles_to_come_until(&self, time: f64) -> f64 {
        let model: &dyn Any = &*self.model;
        as_flood(model).map_or(0.0, |flood| flood.particles_to_come(self.model.time(), time))
    }

    /// Places a gauge in a flood while it runs, at a position in model coordinates. Its columns come after all others.
    ///
    /// # Errors
    /// [`corpuscle_model::ModelError::Setup`] where the scene is no flood, the name is taken, or the position lies outside the terrain.
    pub fn place_gauge(&mut self, name: &str, at: [f64; 2]) -> Result<(), Error> {
        let model: &mut dyn Any = &mut *self.model;
        let none = || ModelError::Setup("gauges are placed in floods only".into());
        let flood = as_flood_mut(model).ok_or_else(none)?;
        Ok(flood.place_gauge(name, at)?)
    }

    /// Warnings to the user, in sentences: of the terrain, then of the model.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = self.terrain.as_ref().map_or_else(Vec::new, |terrain| terrain.warnings().to_vec());
        for warning in self.model.warnings() {
            if !warnings.contains(&warning) {
                warnings.push(warning);
            }
        }
        warnings
    }

    /// Restores a state that [`Model::save`] wrote.
    ///
    /// # Errors
    /// [`corpuscle_model::ModelError::Checkpoint`] where the state does not fit.
    pub fn restore(&mut self, clock: Clock, state: &[u8]) -> Result<(), Error> {
        self.model.restore(state)?;
        self.wall_before = clock.wall_time_s;
        self.resumed = true;
        Ok(())
    }

    /// Runs to the end of the scene, or until `stop` becomes true; then a checkpoint is written and the summary says so.
    ///
    /// # Errors
    /// Where the model breaks down or a sink fails. The sinks are then finished with the output so far.
    pub fn run(
        &mut self,
        sinks: &mut [&mut dyn Sink],
        stop: &AtomicBool,
        on_progress: &mut dyn FnMut(&Progress),
    ) -> Result<Summary, Error> {
        let start = Instant::now();
        let ended = self.advance_to_end(sinks, stop, on_progress, start);
        let status = match ended {
            Ok(status) => status,
            Err(_) => Status::Failed,
        };
        let mut summary = self.summary(status, start);
        // All sinks are finished even if one fails; the first error is returned.
        let finished: Vec<_> = sinks.iter_mut().map(|sink| sink.finish(&*self.model, &mut summary)).collect();
        ended?;
        finished.into_iter().collect::<Result<(), Error>>()?;
        Ok(summary)
    }

    /// Advances to a time, s, with no other output than rows of gauges, which `sink` takes as they fall due, and the progress towards that time.
    /// Returns early when `stop` becomes true.
    ///
    /// # Errors
    /// Where the model breaks down or the sink fails.
    pub fn advance_to(
        &mut self,
        time: f64,
        stop: &AtomicBool,
        sink: &mut dyn Sink,
        on_progress: &mut dyn FnMut(&Progress),
    ) -> Result<(), Error> {
        let (start, now) = (Instant::now(), self.model.time());
        let run = &self.scene.run;
        let gauges = Schedule::new(run.gauge_period_s(), run.until_s);
        let pauses = Schedule::new(run.until_s / PAUSES, run.until_s);
        let meter = self.meter(start)?;
        let observer = RunObserver {
            sinks: &mut [sink],
            gauges,
            pauses,
            until: time,
            meter: &meter,
            on_progress,
            checkpoints: CheckpointTimer { kept: start, every: f64::INFINITY },
            glances: Glances { due: &[], seen: now },
            failed: None,
        };
        self.advance(time, stop, observer).map(|_| ())
    }

    /// Advances as [`Model::advance_to`] does, for a browser, where no thread may wait for a GPU: see
    /// [`GpuModel::advance_later`](corpuscle_model::GpuModel::advance_later).
    ///
    /// # Errors
    /// Where the model breaks down.
    #[cfg(feature = "gpu")]
    pub async fn advance_later(&mut self, time: f64, stop: &AtomicBool) -> Result<(), Error> {
        if let Some(model) = self.model.on_gpu_mut() {
            return Ok(model.advance_later(time, stop).await?);
        }
        Ok(self.model.advance_to(time, stop)?)
    }

    /// The state at the start of a part of the run, to measure its rate.
    fn meter(&self, start: Instant) -> Result<Meter, Error> {
        let counted = models::of(&self.scene)?.work();
        Ok(Meter { start, time: self.model.time(), particle_steps: self.model.particle_steps(), counted })
    }

    fn advance_to_end(
        &mut self,
        sinks: &mut [&mut dyn Sink],
        stop: &AtomicBool,
        on_progress: &mut dyn FnMut(&Progress),
        start: Instant,
    ) -> Result<Status, Error> {
        let run = &self.scene.run;
        let (until, keep_every) = (run.until_s, run.checkpoint_every_wall_s);
        let [gauges, pauses] = [run.gauge_period_s(), until / PAUSES].map(|period| Schedule::new(period, until));
        let frames = Schedule::new(run.frame_period_s(), until);
        let [mut pictures, mut glances] = [(); 2].map(|()| vec![None; sinks.len()]);
        for (number, sink) in sinks.iter().enumerate() {
            let schedules = if self.glances(&**sink) { &mut glances } else { &mut pictures };
            schedules[number] = sink.picture_period().map(|period| Schedule::new(period, until));
        }
        let meter = self.meter(start)?;
        if !self.resumed {
            for sink in &mut *sinks {
                sink.gauges(self.model.time(), &self.model.gauge_row())?;
                sink.frame(&*self.model)?;
                sink.picture(&*self.model)?;
            }
            // From here on the run can be resumed, whatever ends it.
            self.keep(sinks, start)?;
        }
        let (mut kept, mut seen) = (start, self.model.time());
        loop {
            let now = self.model.time();
            let frame = frames.after(now);
            let picture: Vec<_> =
                pictures.iter().map(|due: &Option<Schedule>| due.and_then(|due| due.after(now))).collect();
            let due = picture.iter().copied().chain([frame]).flatten();
            let Some(next) = due.min_by(f64::total_cmp) else {
                return Ok(Status::Done);
            };
            let checkpoints = CheckpointTimer { kept, every: keep_every };
            let glances = Glances { due: &glances, seen };
            let observer = RunObserver {
                sinks,
                gauges,
                pauses,
                until,
                meter: &meter,
                on_progress,
                checkpoints,
                glances,
                failed: None,
            };
            seen = self.advance(next, stop, observer)?.max(self.model.time());
            let has_arrived = self.model.time() >= next;
            for (sink, picture) in sinks.iter_mut().zip(picture) {
                if has_arrived && picture == Some(next) {
                    sink.picture(&*self.model)?;
                }
                if has_arrived && frame == Some(next) {
                    sink.frame(&*self.model)?;
                }
            }
            let stopped = self.model.time() < until && stop.load(Ordering::Relaxed);
            if stopped || checkpoints.is_due() {
                self.keep(sinks, start)?;
                kept = Instant::now();
            }
            if stopped {
                return Ok(Status::Stopped);
            }
        }
    }

    /// True where a sink accepts glances of this model for its pictures.
    #[cfg(feature = "pictures")]
    fn glances(&self, sink: &dyn Sink) -> bool {
        sink.glances_on().is_some_and(|gpu| self.is_seen_on(gpu))
    }

    #[cfg(not(feature = "pictures"))]
    fn glances(&self, _: &dyn Sink) -> bool {
        false
    }

    /// Advances to a time, s; returns the time of the last glance.
    #[cfg(feature = "pictures")]
    fn advance(&mut self, time: f64, stop: &AtomicBool, observer: RunObserver<'_, '_>) -> Result<f64, Error> {
        let first = observer.glances.next();
        let observer = RefCell::new(observer);
        let mut show = |glance| observer.borrow_mut().show(&glance);
        self.advance_shown(time, stop, &mut SharedRunObserver(&observer), first, &mut show)?;
        let RunObserver { glances, failed, .. } = observer.into_inner();
        // A model that was told to return may be a little before its last glance.
        failed.map_or(Ok(glances.seen), Err)
    }

    #[cfg(not(feature = "pictures"))]
    fn advance(&mut self, time: f64, stop: &AtomicBool, observer: RunObserver<'_, '_>) -> Result<f64, Error> {
        let observer = RefCell::new(observer);
        self.model.advance_with(time, stop, &mut SharedRunObserver(&observer))?;
        let RunObserver { glances, failed, .. } = observer.into_inner();
        failed.map_or(Ok(glances.seen), Err)
    }

    /// Has the sinks write a checkpoint.
    fn keep(&self, sinks: &mut [&mut dyn Sink], start: Instant) -> Result<(), Error> {
        let clock = Clock { time_s: self.model.time(), wall_time_s: self.wall_time(start) };
        sinks.iter_mut().try_for_each(|sink| sink.checkpoint(&*self.model, clock))
    }

    fn wall_time(&self, start: Instant) -> f64 {
        self.wall_before + start.elapsed().as_secs_f64()
    }

    fn summary(&self, status: Status, start: Instant) -> Summary {
        let model = &*self.model;
        let wall_time_s = self.wall_time(start);
        let rate = model.particle_steps() as f64 / wall_time_s;
        let collides = models::of(&self.scene).is_ok_and(|kind| kind.work() == COLLISIONS);
        Summary {
            model: model.name().into(),
            backend: model.backend().into(),
            version: env!("CARGO_PKG_VERSION").into(),
            status,
            particles: model.particles(),
            steps: model.steps(),
            simulated_time_s: model.time(),
            wall_time_s,
            particle_steps_per_s: (!collides).then_some(rate),
            collisions: collides.then(|| model.steps()),
            collisions_per_s: collides.then(|| model.steps() as f64 / wall_time_s),
            warnings: self.warnings(),
            ledger: ledger_entries(&model.ledger()),
            extent: None,
        }
    }
}
