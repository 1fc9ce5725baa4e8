//! A flood whose steps a GPU takes.

use super::{Downloaded, GpuSolver, Halt, Input, Totals};
use crate::rain::Intensity;
use crate::voronoi::rain::Weather;
use crate::voronoi::{DENSITY, VoronoiFlood};
use corpuscle_gpu::{DeviceParticles, Gpu, GpuError, Stopwatch, Taken};
use corpuscle_model::{Account, Companion, CpuOnly, ExactSum, Glance, GpuModel, Model, ModelError};
use corpuscle_scene::{Storage, TimeSteps};
use std::sync::atomic::{AtomicBool, Ordering};

/// A GPU that takes the steps.
pub(crate) struct OnGpu {
    solver: GpuSolver,
    start: Start,
    /// Whether water, time or what acts on it was changed on the CPU since it was uploaded.
    is_stale: bool,
}

/// What the books said when the flood was uploaded.
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

/// What to do where the GPU does not compute a scene yet.
const WITHOUT: &str = "leave `--backend gpu` out";

fn device(error: &GpuError) -> ModelError {
    ModelError::Device(error.to_string())
}

impl GpuModel for VoronoiFlood {
    fn use_gpu(&mut self, gpu: Gpu) -> Result<(), ModelError> {
        if let Some(CpuOnly { what, remedy }) = self.on_cpu_only() {
            return Err(ModelError::Setup(format!("{what}: {remedy}")));
        }
        let solver = GpuSolver::new(gpu, &self.input()).map_err(|error| ModelError::Setup(error.to_string()))?;
        self.on_gpu = Some(Box::new(OnGpu { solver, start: self.start(), is_stale: false }));
        Ok(())
    }

    fn gpu(&self) -> Option<Gpu> {
        self.on_gpu.as_ref().map(|on_gpu| on_gpu.solver.gpu().clone())
    }

    fn particles_on_gpu(&self) -> Result<Option<DeviceParticles>, ModelError> {
        Ok(None)
    }

    fn advance_shown(
        &mut self,
        time: f64,
        stop: &AtomicBool,
        companion: &mut dyn Companion,
        (mut next, _): (f64, bool),
        show: &mut dyn FnMut(Glance) -> f64,
    ) -> Result<(), ModelError> {
        while self.on_gpu.is_some() && !stop.load(Ordering::Relaxed) {
            // A time that has passed stands for the end of the next step.
            let until = if next > self.shown { next } else { self.state.time + self.state.time_step };
            if until >= time {
                break;
            }
            self.advance_with(until, stop, companion)?;
            if self.shown < until {
                return Ok(());
            }
            next = show(Glance { frame: self.frame(), on_device: None });
        }
        self.advance_with(time, stop, companion)
    }

    fn gpu_seconds(&self) -> Option<f64> {
        self.on_gpu.as_ref().map(|on_gpu| on_gpu.solver.busy())
    }

    fn gpu_bytes(&self) -> Option<u64> {
        self.on_gpu.as_ref().map(|on_gpu| on_gpu.solver.bytes())
    }

    fn time_passes(&mut self) {
        if let Some(on_gpu) = &mut self.on_gpu {
            on_gpu.solver.stopwatch = Stopwatch::new(on_gpu.solver.gpu());
        }
    }

    fn pass_times(&self) -> Vec<(&'static str, Taken)> {
        let stopwatch = self.on_gpu.iter().filter_map(|on_gpu| on_gpu.solver.stopwatch.as_ref());
        stopwatch.flat_map(Stopwatch::taken).collect()
    }
}

impl VoronoiFlood {
    /// What of the scene the GPU does not compute yet, and what to do; none where it computes all.
    pub(in crate::voronoi) fn on_cpu_only(&self) -> Option<CpuOnly> {
        let settings = &self.settings;
        let rain = self.weather.as_ref().map(|weather| &weather.intensity);
        let missing = [
            (settings.adaptive.is_some(), "flood.adaptive runs on the CPU only", "leave [flood.adaptive] out"),
            (
                settings.time_steps == TimeSteps::Local,
                "local time steps run on the CPU only",
                "take flood.time_steps = \"global\"",
            ),
            (
                settings.storage == Storage::LevelVolume,
                "flood.storage = \"level-volume\" runs on the CPU only",
                "take \"mean\"",
            ),
            (!self.state.falling.is_empty(), "water in the air (a block of [[flood.water]]) falls on the CPU only", ""),
            (
                rain.is_some_and(|rain| matches!(rain, Intensity::Function(_))),
                "rain by a function falls on the CPU only",
                "",
            ),
            (!self.structures.is_empty(), "flood.outflow, flood.stage and flood.link work on the CPU only", ""),
            (self.solver.mesh.has_crests(), "walls over which water flows (height_m) work on the CPU only", ""),
        ];
        let (_, what, instead) = missing.into_iter().find(|(is_there, ..)| *is_there)?;
        let remedy = if instead.is_empty() { WITHOUT } else { instead };
        Some(CpuOnly { what, remedy })
    }

    /// The GPU takes the state anew before its next step.
    pub(in crate::voronoi) fn tell_gpu(&mut self) {
        self.on_gpu.iter_mut().for_each(|on_gpu| on_gpu.is_stale = true);
    }

    /// Advances on the GPU, and takes over what it came to.
    pub(in crate::voronoi) fn advance_on_gpu(&mut self, time: f64, stop: &AtomicBool) -> Result<(), ModelError> {
        let Some(mut on_gpu) = self.on_gpu.take() else { return Ok(()) };
        let done = self.step_on(&mut on_gpu, time, stop);
        self.on_gpu = Some(on_gpu);
        done
    }

    fn step_on(&mut self, on_gpu: &mut OnGpu, time: f64, stop: &AtomicBool) -> Result<(), ModelError> {
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
        on_gpu.start = self.start();
        on_gpu.solver.renew(&self.input()).map_err(|error| device(&error))
    }

    /// Takes the state of the GPU over: water, records, time and books.
    fn take_over(&mut self, on_gpu: &OnGpu) -> Result<(), ModelError> {
        let Downloaded { columns: [now, before], records, soaked, pushes, beyond } =
            on_gpu.solver.download().map_err(|error| device(&error))?;
        let totals = on_gpu.solver.totals();
        let Totals { time, step, last_step, cell_steps, .. } = totals;
        let is_new = time > self.state.time;
        self.solver.columns = now;
        *self.solver.before_mut() = before;
        self.solver.renew_as_they_are();
        self.state.records = records;
        self.boundaries.take_over(&beyond, &mut self.state.beyond);
        if is_new {
            (self.state.before, self.state.time) = (time - last_step, time);
        }
        self.state.time_step = step;
        self.state.particle_steps = on_gpu.start.cell_steps + cell_steps;
        if self.weather.as_ref().is_some_and(Weather::soaks) {
            self.state.soaked.depth = soaked;
            self.state.soaked.until = time - totals.since_draught;
        }
        if time > on_gpu.start.time {
            self.book_pushes(&on_gpu.start, &pushes, last_step);
        }
        self.book(on_gpu, &totals);
        Ok(())
    }

    /// Books what passed since the flood was uploaded.
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

    /// Books what the water pushed obstacles with, by the impulse at each border face since the upload and in the last step.
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
            obstacle_of: &self.obstacle_of,
            soaked: &self.state.soaked,
        }
    }
}
