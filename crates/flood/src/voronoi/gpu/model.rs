//! A flood whose steps a GPU takes.

use super::{Downloaded, GpuSolver, Input, Totals};
use crate::voronoi::model::SHOWN;
use crate::voronoi::rain::Intensity;
use crate::voronoi::rain::Weather;
use crate::voronoi::structures::upload::set_flows;
use crate::voronoi::{DENSITY, VoronoiFlood};
use corpuscle_gpu::{DeviceParticles, Gpu, GpuError, Halt, PassTiming, wait_for};
use corpuscle_model::{
    Account, Advance, AdvanceObserver, CpuOnly, ExactSum, Frame, Glance, GpuModel, Model, ModelError, ModelProgress,
};
use std::sync::atomic::{AtomicBool, Ordering};

/// A GPU that takes the steps.
pub(crate) struct OnGpu {
    solver: GpuSolver,
    start: Start,
    /// Whether water, time or what acts on it was changed on the CPU since it was uploaded.
    is_stale: bool,
    /// Whether it has taken steps whose state is not downloaded yet.
    is_ahead: bool,
    /// The step before which the cells' resolution was last checked.
    checked_before: Option<u64>,
}

/// The accounts when the flood was uploaded.
struct Start {
    /// Accounts of water, momentum and energy.
    accounts: [Account; 3],
    /// Rain and infiltration.
    soaked: [ExactSum; 2],
    cell_steps: u64,
    /// Impulse on each obstacle over density, m4/s.
    impulses: Vec<[f64; 2]>,
    /// s.
    time: f64,
}

fn device(error: &GpuError) -> ModelError {
    ModelError::Device(error.to_string())
}

impl GpuModel for VoronoiFlood {
    fn use_gpu(&mut self, gpu: Gpu) -> Result<(), ModelError> {
        if let Some(CpuOnly { what, remedy }) = self.on_cpu_only() {
            return Err(ModelError::Setup(format!("{what}: {remedy}")));
        }
        let solver = GpuSolver::new(gpu, &self.input()).map_err(|error| ModelError::Setup(error.to_string()))?;
        self.on_gpu = Some(Box::new(OnGpu {
            solver,
            start: self.start(),
            is_stale: false,
            is_ahead: false,
            checked_before: None,
        }));
        Ok(())
    }

    fn gpu(&self) -> Option<Gpu> {
        self.on_gpu.as_ref().map(|on_gpu| on_gpu.solver.batches.gpu().clone())
    }

    fn particles_on_gpu(&self) -> Result<Option<DeviceParticles>, ModelError> {
        let is_there = |on_gpu: &&OnGpu| !on_gpu.is_stale && self.state.falling.is_empty();
        let Some(on_gpu) = self.on_gpu.as_deref().filter(is_there) else { return Ok(None) };
        let least = SHOWN * self.settings.wet_depth_m;
        on_gpu.solver.seen(&self.solver.mesh, self.shown, least).map(Some).map_err(|error| device(&error))
    }

    fn advance_shown(
        &mut self,
        time: f64,
        stop: &AtomicBool,
        observer: &mut dyn AdvanceObserver,
        (mut next, _): (f64, bool),
        show: &mut dyn FnMut(Glance) -> f64,
    ) -> Result<(), ModelError> {
        while self.on_gpu.is_some() && !stop.load(Ordering::Relaxed) {
            // A past time stands for the end of the next step.
            let is_step = next <= self.shown;
            let until = if is_step { self.end_of_next_step() } else { next };
            if until > time {
                break;
            }
            if observer.gauges_after(self.shown).is_some_and(|due| due <= until) {
                self.advance_with(until, stop, observer)?;
                if self.shown < until {
                    return Ok(());
                }
                next = show(self.glance()?);
                continue;
            }
            wait_for(self.with_gpu(async |flood, on_gpu| match is_step {
                true => flood.step_once(on_gpu).await,
                false => flood.step_to(on_gpu, until, stop).await,
            }))?;
            if !is_step && self.shown < until {
                return wait_for(self.with_gpu(Self::download));
            }
            next = show(self.glance()?);
            if !observer.progressed(self.progress()) {
                return wait_for(self.with_gpu(Self::download));
            }
        }
        wait_for(self.with_gpu(Self::download))?;
        self.advance_with(time, stop, observer)
    }

    fn advance_later<'a>(&'a mut self, time: f64, stop: &'a AtomicBool) -> Advance<'a> {
        Box::pin(async move {
            if self.on_gpu.is_none() {
                return self.advance_to(time, stop);
            }
            self.advance_on_gpu(time, stop).await
        })
    }

    fn gpu_seconds(&self) -> Option<f64> {
        self.on_gpu.as_ref().map(|on_gpu| on_gpu.solver.batches.seconds())
    }

    fn gpu_bytes(&self) -> Option<u64> {
        self.on_gpu.as_ref().map(|on_gpu| on_gpu.solver.bytes())
    }

    fn time_passes(&mut self) {
        if let Some(on_gpu) = &mut self.on_gpu {
            on_gpu.solver.batches.time_passes();
        }
    }

    fn pass_times(&self) -> Vec<(&'static str, PassTiming)> {
        self.on_gpu.iter().flat_map(|on_gpu| on_gpu.solver.batches.pass_times()).collect()
    }
}

impl VoronoiFlood {
    /// The part of the scene that the GPU does not compute, and the remedy; none where it computes all.
    pub(in crate::voronoi) fn on_cpu_only(&self) -> Option<CpuOnly> {
        if self.solver.domain.is_some() {
            return Some(CpuOnly {
                what: "several processes compute on CPUs only",
                remedy: "leave `--backend gpu` out",
            });
        }
        let weather = self.weather.as_ref();
        let falls_by_function = weather.is_some_and(|weather| matches!(weather.intensity, Intensity::Function(_)));
        falls_by_function.then_some(CpuOnly {
            what: "rain by a function falls on the CPU only",
            remedy: "leave `--backend gpu` out",
        })
    }

    /// Marks the state on the GPU as stale: it is uploaded before the next step.
    pub(in crate::voronoi) fn mark_stale_on_gpu(&mut self) {
        if let Some(on_gpu) = &mut self.on_gpu {
            (on_gpu.is_stale, on_gpu.is_ahead, on_gpu.checked_before) = (true, false, None);
        }
    }

    /// Advances on the GPU, and downloads the state.
    pub(in crate::voronoi) async fn advance_on_gpu(&mut self, time: f64, stop: &AtomicBool) -> Result<(), ModelError> {
        self.with_gpu(async |flood, on_gpu| {
            flood.step_to(on_gpu, time, stop).await?;
            flood.download(on_gpu).await
        })
        .await
    }

    /// Calls `work` with the GPU where there is one.
    async fn with_gpu(
        &mut self,
        work: impl AsyncFnOnce(&mut Self, &mut OnGpu) -> Result<(), ModelError>,
    ) -> Result<(), ModelError> {
        let Some(mut on_gpu) = self.on_gpu.take() else { return Ok(()) };
        let done = work(self, &mut on_gpu).await;
        self.on_gpu = Some(on_gpu);
        done
    }

    /// Takes steps up to a time, s. The new state stays on the GPU: see [`VoronoiFlood::download`].
    async fn step_to(&mut self, on_gpu: &mut OnGpu, time: f64, stop: &AtomicBool) -> Result<(), ModelError> {
        // Water in the air falls on the CPU.
        while !self.state.falling.is_empty() && self.state.time < time && !stop.load(Ordering::Relaxed) {
            self.step()?;
            on_gpu.is_stale = true;
        }
        let mut is_arrived = self.clock(on_gpu) >= time;
        while !is_arrived {
            if stop.load(Ordering::Relaxed) {
                self.download(on_gpu).await?;
                self.shown = self.shown.max(self.state.time);
                return Ok(());
            }
            is_arrived = self.take_steps(on_gpu, time, u64::MAX).await?;
        }
        self.shown = time;
        Ok(())
    }

    /// Takes a step, and shows its end.
    async fn step_once(&mut self, on_gpu: &mut OnGpu) -> Result<(), ModelError> {
        if self.state.falling.is_empty() {
            let later = self.clock(on_gpu) + 2.0 * self.solver.longest;
            self.take_steps(on_gpu, later, 1).await?;
        } else {
            self.step()?;
            on_gpu.is_stale = true;
        }
        self.shown = self.clock(on_gpu);
        Ok(())
    }

    /// Takes steps up to a time, s, or some of them, `most` at most; whether it arrived there.
    async fn take_steps(&mut self, on_gpu: &mut OnGpu, time: f64, most: u64) -> Result<bool, ModelError> {
        if std::mem::take(&mut on_gpu.is_stale) {
            self.upload(on_gpu)?;
        }
        let most = self.adapt_cells(on_gpu).await?.min(most);
        let (steps, halt) = on_gpu.solver.advance(time, most).await.map_err(|error| device(&error))?;
        on_gpu.is_ahead = true;
        self.state.steps += steps;
        match halt {
            Halt::Full => Ok(false),
            Halt::Arrived => Ok(true),
            Halt::NeedsHost => self.go_beyond_rim(on_gpu).await.map(|()| false),
            Halt::Broken => Err(self.broken_on_gpu(on_gpu).await),
        }
    }

    /// Downloads the state of the GPU, where it is ahead.
    async fn download(&mut self, on_gpu: &mut OnGpu) -> Result<(), ModelError> {
        if on_gpu.is_ahead { self.download_state(on_gpu).await } else { Ok(()) }
    }

    /// Time at the end of the last step, s.
    fn clock(&self, on_gpu: &OnGpu) -> f64 {
        if on_gpu.is_ahead { on_gpu.solver.totals().time } else { self.state.time }
    }

    fn end_of_next_step(&self) -> f64 {
        let ahead = self.on_gpu.as_ref().filter(|on_gpu| on_gpu.is_ahead).map(|on_gpu| on_gpu.solver.totals());
        ahead.map_or(self.state.time + self.state.time_step, |totals| totals.time + totals.step)
    }

    /// Progress, by the totals of the GPU where it is ahead.
    fn progress(&self) -> ModelProgress {
        let here = (self.particles(), self.particle_steps());
        let ahead = self.on_gpu.as_ref().filter(|on_gpu| on_gpu.is_ahead);
        let (particles, particle_steps) = ahead.map_or(here, |on_gpu| {
            let totals = on_gpu.solver.totals();
            (totals.wet, on_gpu.start.cell_steps + totals.cell_steps)
        });
        ModelProgress { time: self.shown, particles, particle_steps }
    }

    /// What is shown while the GPU goes on: its own buffer of particles, or the frame while water is in the air.
    fn glance(&mut self) -> Result<Glance, ModelError> {
        if let Some(particles) = self.particles_on_gpu()? {
            return Ok(Glance { frame: Frame { time: self.shown, sets: Vec::new() }, on_device: Some(particles) });
        }
        wait_for(self.with_gpu(Self::download))?;
        Ok(Glance { frame: self.frame(), on_device: None })
    }

    /// Refines and coarsens the cells, where a check is due. Returns the number of steps to the next check.
    async fn adapt_cells(&mut self, on_gpu: &mut OnGpu) -> Result<u64, ModelError> {
        let Some(every) = self.steps_between_checks() else { return Ok(u64::MAX) };
        let steps = self.state.steps;
        if steps.is_multiple_of(every) && on_gpu.checked_before != Some(steps) {
            on_gpu.checked_before = Some(steps);
            self.download_state(on_gpu).await?;
            let remakes = self.state.remakes;
            self.adapt()?;
            if self.state.remakes > remakes {
                self.upload(on_gpu)?;
            }
        }
        Ok(every - steps % every)
    }

    /// Makes the missing tiles beside wet cells.
    async fn go_beyond_rim(&mut self, on_gpu: &mut OnGpu) -> Result<(), ModelError> {
        self.download_state(on_gpu).await?;
        let missing = self.solver.missing_tiles();
        self.make_tiles(missing)?;
        if self.solver.local.is_some() {
            // Tiles that are made end the steps of cells: the CPU plans them anew as well.
            self.state.time_step = self.solver.plan();
        }
        self.upload(on_gpu)
    }

    fn upload(&self, on_gpu: &mut OnGpu) -> Result<(), ModelError> {
        on_gpu.start = self.start();
        on_gpu.solver.upload_again(&self.input()).map_err(|error| device(&error))
    }

    /// Downloads the state of the GPU: water, records, time and accounts.
    async fn download_state(&mut self, on_gpu: &mut OnGpu) -> Result<(), ModelError> {
        let Downloaded { columns: [now, before], records, soaked, pushes, beyond, discharges } =
            on_gpu.solver.download().await.map_err(|error| device(&error))?;
        on_gpu.is_ahead = false;
        let totals = on_gpu.solver.totals();
        let Totals { time, step, last_step, cell_steps, .. } = totals;
        let is_new = time > self.state.time;
        self.solver.columns = now;
        *self.solver.before_mut() = before;
        self.solver.refresh_water();
        self.state.records = records;
        set_flows(&discharges, &self.structures, &mut self.state.flows);
        self.boundaries.set_beyond(&beyond, &mut self.state.beyond);
        if is_new {
            (self.state.before, self.state.time) = (time - last_step, time);
        }
        // The CPU plans the steps of cells itself, where it goes on.
        self.state.time_step = if self.solver.local.is_some() { step.min(self.solver.plan()) } else { step };
        self.state.particle_steps = on_gpu.start.cell_steps + cell_steps;
        if self.weather.as_ref().is_some_and(Weather::soaks) {
            self.state.soaked.depth = soaked;
            self.state.soaked.until = time - totals.since_draught;
        }
        if time > on_gpu.start.time {
            self.book_pushes(&on_gpu.start, &pushes, last_step);
        }
        self.book(on_gpu, &totals);
        if is_new {
            self.book_before(&totals.last);
        }
        Ok(())
    }

    /// Books the exchange since the flood was uploaded.
    fn book(&mut self, on_gpu: &OnGpu, totals: &Totals) {
        let state = &mut self.state;
        [state.water, state.momentum, state.energy] = on_gpu.start.accounts;
        [state.soaked.rained, state.soaked.infiltrated] = on_gpu.start.soaked;
        let Totals { rained, infiltrated, .. } = *totals;
        state.soaked.rained.add(rained);
        state.soaked.infiltrated.add(infiltrated);
        state.water.inflow.add(rained);
        state.water.outflow.add(infiltrated);
        let water = (&mut state.water, totals.water, 1.0);
        let momentum = (&mut state.momentum, totals.momentum, DENSITY);
        let energy = (&mut state.energy, totals.energy, DENSITY);
        for (account, [came, went], factor) in [water, momentum, energy] {
            account.inflow.add(factor * came);
            account.outflow.add(factor * went);
        }
    }

    /// Finds what was booked before the last step, by what that brought and took.
    fn book_before(&mut self, [came, went, energy_in, energy_out, rained, infiltrated]: &[f64; 6]) {
        let last =
            [came + rained, went + infiltrated, DENSITY * energy_in, DENSITY * energy_out, *rained, *infiltrated];
        self.state.booked_before = self.state.booked();
        for (sum, last) in self.state.booked_before.iter_mut().zip(last) {
            sum.add(-last);
        }
    }

    /// The error that says where a value is not finite; goes back to the state before.
    async fn broken_on_gpu(&mut self, on_gpu: &mut OnGpu) -> ModelError {
        if let Err(error) = self.download_state(on_gpu).await {
            return error;
        }
        let is_broken = |column: &crate::voronoi::water::Column| {
            !(column.volume + column.momentum[0] + column.momentum[1]).is_finite()
        };
        let cell = self.solver.columns.iter().position(is_broken);
        let position = cell.map(|cell| self.terrain.to_own(self.solver.mesh.centroid[cell]));
        self.solver.take_back();
        let position = position.map_or(String::new(), |[x, y]| format!(" at [{x:.6}, {y:.6}]"));
        ModelError::Breakdown {
            time: self.state.before,
            step: self.state.steps,
            what: format!("a flux{position} is no longer a number; look in the last frame at the water there"),
        }
    }

    fn start(&self) -> Start {
        let state = &self.state;
        Start {
            accounts: [state.water, state.momentum, state.energy],
            soaked: [state.soaked.rained, state.soaked.infiltrated],
            cell_steps: state.particle_steps,
            impulses: state.impulses.clone(),
            time: state.time,
        }
    }

    /// Books the forces of the water on obstacles, by the impulse at each border face since the upload and in the last step.
    fn book_pushes(&mut self, start: &Start, pushes: &[[[f64; 2]; 2]], last_step: f64) {
        self.state.impulses.clone_from(&start.impulses);
        self.state.forces.fill([0.0; 2]);
        for (&obstacle, [all, last]) in self.obstacle_of.iter().zip(pushes) {
            let Some(impulse) = self.state.impulses.get_mut(obstacle as usize) else { continue };
            let force = &mut self.state.forces[obstacle as usize];
            for axis in 0..2 {
                impulse[axis] += all[axis];
                force[axis] += last[axis] / last_step;
            }
        }
    }

    fn input(&self) -> Input<'_> {
        Input {
            solver: &self.solver,
            boundaries: &self.boundaries,
            beyond: &self.state.beyond,
            records: &self.state.records,
            time: self.state.time,
            step: self.state.time_step,
            last_step: self.state.time - self.state.before,
            wet_depth: self.settings.wet_depth_m,
            steps: self.state.steps,
            inflows: &self.inflows,
            weather: self.weather.as_ref(),
            structures: &self.structures,
            patches: &self.patches,
            flows: &self.state.flows,
            obstacle_of: &self.obstacle_of,
            soaked: &self.state.soaked,
        }
    }
}
