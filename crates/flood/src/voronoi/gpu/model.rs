//! A flood whose steps a GPU takes.

use super::{Downloaded, GpuSolver, Halt, Input, Totals};
use crate::flood::ByHand;
use crate::voronoi::boundaries::Boundary;
use crate::voronoi::{DENSITY, VoronoiFlood};
use corpuscle_gpu::{Gpu, GpuError, Stopwatch, Taken};
use corpuscle_model::{Account, ModelError};
use corpuscle_scene::{Storage, TimeSteps};
use std::sync::atomic::{AtomicBool, Ordering};

/// A GPU that takes the steps, and what the books said when it took over.
pub(crate) struct OnGpu {
    solver: GpuSolver,
    /// Accounts of water, momentum and energy when the flood was uploaded.
    accounts: [Account; 3],
    cell_steps: u64,
    /// Whether water, time or what acts on it was changed on the CPU since.
    is_stale: bool,
}

fn device(error: &GpuError) -> ModelError {
    ModelError::Device(error.to_string())
}

impl VoronoiFlood {
    /// Lets a GPU take the steps from here on, in single precision.
    ///
    /// # Errors
    /// [`ModelError::Setup`] where the GPU has too little memory, or the scene asks for what the CPU alone computes: nothing has changed then.
    pub fn use_gpu(&mut self, gpu: Gpu) -> Result<(), ModelError> {
        self.check_gpu()?;
        let solver = GpuSolver::new(gpu, &self.input()).map_err(|error| ModelError::Setup(error.to_string()))?;
        self.on_gpu = Some(Box::new(OnGpu {
            solver,
            accounts: self.accounts(),
            cell_steps: self.state.particle_steps,
            is_stale: false,
        }));
        Ok(())
    }

    /// Whether a GPU can compute the flood.
    ///
    /// # Errors
    /// [`ModelError::Setup`] with what it cannot compute yet, and what to do.
    pub(crate) fn check_gpu(&self) -> Result<(), ModelError> {
        let Some((what, instead)) = self.on_cpu_only() else { return Ok(()) };
        let remedy = instead.map_or(String::new(), |instead| format!(", or {instead}"));
        let text = format!("{what} runs on the CPU only in scheme voronoi: leave `--backend gpu` out{remedy}");
        Err(ModelError::Setup(text))
    }

    /// What of the scene the GPU does not compute yet, and what a scene could have instead.
    pub(crate) fn on_cpu_only(&self) -> Option<(&'static str, Option<&'static str>)> {
        let settings = &self.settings;
        let has_edge = |is: fn(&Boundary) -> bool| self.boundaries.rules.iter().any(is);
        let first = [
            (settings.adaptive.is_some(), "flood.adaptive", Some("leave [flood.adaptive] out")),
            (settings.time_steps == TimeSteps::Local, "flood.time_steps = \"local\"", Some("take \"global\"")),
            (settings.storage == Storage::LevelVolume, "flood.storage = \"level-volume\"", Some("take \"mean\"")),
            (!self.state.falling.is_empty(), "water in the air (a block of [[flood.water]])", None),
            (!self.inflows.is_empty(), "[[flood.inflow]]", None),
            (self.weather.is_some(), "rain or infiltration", None),
            (!self.structures.is_empty(), "[[flood.outflow]], [[flood.stage]] or [[flood.link]]", None),
            (!settings.obstacle.is_empty(), "[[flood.obstacle]]", None),
            (!self.solver.crests.is_empty(), "a line over whose crest water flows", None),
            (has_edge(|rule| matches!(rule, Boundary::Level(_))), "an edge with a stage", None),
            (has_edge(|rule| matches!(rule, Boundary::Discharge(_))), "an edge with a discharge", None),
            (has_edge(|rule| matches!(rule, Boundary::Wave { .. })), "an edge with a wave", None),
            (has_edge(|rule| matches!(rule, Boundary::Paddle(_))), "an edge with a paddle", None),
            (has_edge(|rule| matches!(rule, Boundary::Rating(_))), "an edge with a rating", None),
        ];
        first.into_iter().find(|(is_there, ..)| *is_there).map(|(_, what, instead)| (what, instead))
    }

    /// Whether a GPU that takes the steps can go on with a change.
    ///
    /// # Errors
    /// [`ModelError::Device`] where it cannot.
    pub(in crate::voronoi) fn check_change(&self, change: &ByHand) -> Result<(), ModelError> {
        let is_rain = matches!(change, ByHand::Rain(_) | ByHand::RainTimes(_));
        if self.on_gpu.is_none() || !is_rain {
            return Ok(());
        }
        Err(ModelError::Device("rain runs on the CPU only in scheme voronoi: run it with `--backend cpu`".into()))
    }

    /// Wall-clock time that the GPU has spent on steps, s.
    pub fn seconds_on_gpu(&self) -> Option<f64> {
        self.on_gpu.as_ref().map(|on_gpu| on_gpu.solver.busy())
    }

    /// From now on the GPU times its passes, which makes them wait for one another. Nothing changes where it has no clock.
    pub fn time_passes(&mut self) {
        if let Some(on_gpu) = &mut self.on_gpu {
            on_gpu.solver.stopwatch = Stopwatch::new(on_gpu.solver.gpu());
        }
    }

    /// What each pass has taken on the GPU since [`VoronoiFlood::time_passes`].
    pub fn pass_times(&self) -> Vec<(&'static str, Taken)> {
        let stopwatch = self.on_gpu.iter().filter_map(|on_gpu| on_gpu.solver.stopwatch.as_ref());
        stopwatch.flat_map(Stopwatch::taken).collect()
    }

    /// Bytes held on the GPU.
    pub fn bytes_on_gpu(&self) -> Option<u64> {
        self.on_gpu.as_ref().map(|on_gpu| on_gpu.solver.bytes())
    }

    /// The GPU takes the state anew before its next step.
    pub(in crate::voronoi) fn tell_gpu(&mut self) {
        self.on_gpu.iter_mut().for_each(|on_gpu| on_gpu.is_stale = true);
    }

    /// Advances on the GPU, and takes over what it came to.
    pub(in crate::voronoi) fn advance_on_gpu(&mut self, time: f64, stop: &AtomicBool) -> Result<(), ModelError> {
        let Some(mut on_gpu) = self.on_gpu.take() else { return Ok(()) };
        let done = self.advance_with(&mut on_gpu, time, stop);
        self.on_gpu = Some(on_gpu);
        done
    }

    fn advance_with(&mut self, on_gpu: &mut OnGpu, time: f64, stop: &AtomicBool) -> Result<(), ModelError> {
        if std::mem::take(&mut on_gpu.is_stale) {
            self.upload(on_gpu)?;
        }
        let mut is_arrived = self.state.time >= time;
        while !is_arrived {
            if stop.load(Ordering::Relaxed) {
                self.take_over(on_gpu)?;
                self.shown = self.shown.max(self.state.time);
                return Ok(());
            }
            let (steps, halt) = on_gpu.solver.advance(time).map_err(|error| device(&error))?;
            self.state.steps += steps;
            match halt {
                Halt::Full => {}
                Halt::Arrived => is_arrived = true,
                Halt::AtRim => self.go_beyond_rim(on_gpu)?,
                Halt::Broken => return Err(self.broken_on_gpu(on_gpu)),
            }
        }
        self.take_over(on_gpu)?;
        self.shown = time;
        Ok(())
    }

    /// Makes the tiles that water stands beside.
    fn go_beyond_rim(&mut self, on_gpu: &mut OnGpu) -> Result<(), ModelError> {
        self.take_over(on_gpu)?;
        let missing = self.solver.missing_tiles();
        self.make_tiles(missing)?;
        self.upload(on_gpu)
    }

    fn upload(&self, on_gpu: &mut OnGpu) -> Result<(), ModelError> {
        on_gpu.accounts = self.accounts();
        on_gpu.cell_steps = self.state.particle_steps;
        on_gpu.solver.renew(&self.input()).map_err(|error| device(&error))
    }

    /// Takes the state of the GPU over: water, records, time and books.
    fn take_over(&mut self, on_gpu: &OnGpu) -> Result<(), ModelError> {
        let Downloaded { columns: [now, before], records } =
            on_gpu.solver.download().map_err(|error| device(&error))?;
        let Totals { time, step, last_step, cell_steps, water, energy, momentum } = on_gpu.solver.totals();
        let is_new = time > self.state.time;
        self.solver.columns = now;
        *self.solver.before_mut() = before;
        self.solver.renew_as_they_are();
        self.state.records = records;
        if is_new {
            (self.state.before, self.state.time) = (time - last_step, time);
        }
        self.state.time_step = step;
        self.state.particle_steps = on_gpu.cell_steps + cell_steps;
        [self.state.water, self.state.momentum, self.state.energy] = on_gpu.accounts;
        let state = &mut self.state;
        let booked = [(&mut state.water, water, 1.0), (&mut state.momentum, momentum, DENSITY)];
        for (account, [came, went], factor) in booked.into_iter().chain([(&mut state.energy, energy, DENSITY)]) {
            account.inflow.add(factor * came);
            account.outflow.add(factor * went);
        }
        Ok(())
    }

    /// Says where the computation came to no number, and goes back to the state before.
    fn broken_on_gpu(&mut self, on_gpu: &OnGpu) -> ModelError {
        if let Err(error) = self.take_over(on_gpu) {
            return error;
        }
        let is_broken = |column: &crate::voronoi::water::Column| {
            !(column.volume + column.momentum[0] + column.momentum[1]).is_finite()
        };
        let cell = self.solver.columns.iter().position(is_broken);
        let place = cell.map(|cell| self.terrain.to_own(self.solver.mesh.centroid[cell]));
        self.solver.take_back();
        let place = place.map_or(String::new(), |[x, y]| format!(" at [{x:.6}, {y:.6}]"));
        ModelError::Breakdown {
            time: self.state.before,
            step: self.state.steps,
            what: format!("a flux{place} is no longer a number; look in the last frame at the water there"),
        }
    }

    fn accounts(&self) -> [Account; 3] {
        [self.state.water, self.state.momentum, self.state.energy]
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
        }
    }
}
