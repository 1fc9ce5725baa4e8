//! A scene that is stepped and drawn on one GPU: while it plays its particles stay there, and only rows of gauges are read back.

use super::Shared;
use super::filming::Filming;
use super::pace::Pace;
use super::runner::{MEASURE, PICTURES, Rate, Running};
use crate::snapshot::{Measures, Snapshot};
use corpuscle::gpu::Gpu;
use corpuscle::model::{AdvanceObserver, Container, Frame, ModelProgress};
use corpuscle::pictures::{Glance, Moment};
use corpuscle::{Error, Sample};
use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;
use web_time::Instant;

/// An error of the model or of the film.
pub(super) enum Fault {
    OfModel(Error),
    OfFilm(Error),
}

/// Advances until it is stopped, reaches the next pause, or its particles are needed on the host; returns when they were requested,
/// if they were.
pub(super) fn advance(
    running: &mut Running,
    shared: &Shared,
    gpu: &Gpu,
    number: u64,
) -> Result<Option<Instant>, Fault> {
    let Running { subject, until, pace, measured, measure_at, rate, probe, probed, filming, known, .. } = running;
    let (from, container) = (subject.time(), subject.simulation().model().container());
    let Some(simulation) = subject.drawn_in_place(gpu) else { return Ok(None) };
    let state = RefCell::new(GpuAdvance {
        shared,
        number,
        container,
        known: known.clone(),
        probed: *probed,
        particles: simulation.model().particles(),
        work: simulation.model().particle_steps(),
        release_at: (*measure_at, probe.is_some()),
        slice: Slice { from, began: Instant::now(), before: Duration::ZERO, has_stepped: false },
        pace,
        measured,
        rate,
        filming: filming.as_mut(),
        film_fault: None,
        recalled: None,
    });
    let mut show = |glance| state.borrow_mut().show(glance);
    let gone = simulation.advance_shown(*until, &shared.stop, &mut GpuAdvanceObserver(&state), from, &mut show);
    let GpuAdvance { film_fault, recalled, .. } = state.into_inner();
    gone.map_err(Fault::OfModel)?;
    film_fault.map_or(Ok(recalled), |error| Err(Fault::OfFilm(error)))
}

/// From one picture to the next.
struct Slice {
    /// The time of the last picture, s, and when the steps since began.
    from: f64,
    began: Instant,
    /// The duration of the slice before.
    before: Duration,
    /// Whether any of them is done.
    has_stepped: bool,
}

struct GpuAdvance<'a> {
    shared: &'a Shared,
    number: u64,
    container: Option<Container>,
    known: Arc<Frame>,
    /// The water sampled when the particles were last read back.
    probed: Option<Sample>,
    particles: usize,
    /// Particles moved so far.
    work: u64,
    /// When particles may be read back next, and whether the water is sampled.
    release_at: (Instant, bool),
    slice: Slice,
    pace: &'a mut Pace,
    measured: &'a mut Arc<Measures>,
    rate: &'a mut Rate,
    filming: Option<&'a mut Filming>,
    film_fault: Option<Error>,
    /// When the particles were requested.
    recalled: Option<Instant>,
}

impl GpuAdvance<'_> {
    /// Publishes a snapshot and waits until the next slice is due; returns up to what time, s.
    fn show(&mut self, glance: Glance) -> f64 {
        let Slice { from, began, before, has_stepped } = self.slice;
        let (time, worked) = (glance.frame.time, began.elapsed());
        self.pace.went(time - from, worked, before.max(worked));
        self.film(&glance);
        self.shared.publish(self.snapshot(glance));
        std::thread::sleep(Duration::from_secs_f64(1.0 / PICTURES).saturating_sub(began.elapsed()));
        let since = began.elapsed();
        self.slice = Slice { from: time, began: Instant::now(), before: since, has_stepped: false };
        let next = time + self.pace.next_beside_pictures(since, time - from, worked, has_stepped);
        self.filming.as_ref().map_or(next, |filming| next.min(filming.next))
    }

    fn snapshot(&self, glance: Glance) -> Snapshot {
        Snapshot {
            number: self.number,
            frame: Arc::new(glance.frame),
            on_device: glance.on_device,
            known: self.known.clone(),
            paths: Vec::new(),
            container: self.container,
            particles: self.particles,
            playing: true,
            pace: self.pace.real,
            behind: self.pace.is_behind(),
            rate: self.rate.now,
            probed: self.probed,
            measures: self.measured.clone(),
        }
    }

    /// Adds a picture to the film, if one is due. Where it fails, it is over.
    fn film(&mut self, glance: &Glance) {
        let Some(filming) = self.filming.as_mut().filter(|filming| filming.next <= glance.frame.time) else { return };
        let Glance { frame, on_device } = glance;
        let moment = Moment { frame, on_device: on_device.as_ref(), paths: &[], container: self.container };
        if let Err(error) = filming.add(&moment, &self.shared.view_state()) {
            (self.filming, self.film_fault) = (None, Some(error));
            self.shared.stop.store(true, Ordering::Relaxed);
        }
    }

    /// Simulated time between two rows of gauges, s.
    fn every(&self) -> f64 {
        let pace = if self.pace.is_behind() { self.pace.real } else { self.pace.requested };
        pace * MEASURE.as_secs_f64()
    }
}

/// The observer of the advance.
struct GpuAdvanceObserver<'a, 'b>(&'a RefCell<GpuAdvance<'b>>);

impl AdvanceObserver for GpuAdvanceObserver<'_, '_> {
    fn gauges_after(&self, time: f64) -> Option<f64> {
        let every = self.0.borrow().every();
        (every > 0.0).then(|| ((time / every).floor() + 1.0) * every).filter(|next| *next > time)
    }

    fn gauges(&mut self, time: f64, row: &[f64]) {
        let mut state = self.0.borrow_mut();
        let measured = Measures { time, gauges: row.to_vec(), ..(**state.measured).clone() };
        *state.measured = Arc::new(measured);
    }

    fn progressed(&mut self, progress: ModelProgress) -> bool {
        let mut state = self.0.borrow_mut();
        state.particles = progress.particles;
        state.slice.has_stepped |= progress.particle_steps > state.work;
        state.work = progress.particle_steps;
        state.rate.note(progress.particle_steps);
        let (from, probes) = state.release_at;
        let is_needed = probes || state.shared.follows.load(Ordering::Relaxed);
        if is_needed && Instant::now() >= from {
            state.recalled = Some(Instant::now());
        }
        state.recalled.is_none()
    }
}
