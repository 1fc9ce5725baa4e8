//! Humid air whose steps the GPU takes.

mod measured;
mod on_device;

use super::Dew;
use crate::faces::deepest_outside;
use crate::gpu::{BatchResult, Crossed, GpuInputs, GpuSolver};
use crate::room::Face;
use crate::shared::MOST_FANS;
use crate::solids::upload::SolidInputs;
use crate::state::State;
use corpuscle_gpu::{DeviceParticles, Gpu, GpuError, PassTiming, wait_for};
use corpuscle_model::{Advance, AdvanceObserver, CpuOnly, Glance, GpuModel, Model, ModelError};
use on_device::FrameRequest;
use std::sync::atomic::{AtomicBool, Ordering};

/// Spare room for particles that enter.
const SPARE_ROOM: usize = 1024;

fn failed(error: &GpuError) -> ModelError {
    ModelError::Device(error.to_string())
}

impl GpuModel for Dew {
    fn use_gpu(&mut self, gpu: Gpu) -> Result<(), ModelError> {
        if let Some(CpuOnly { what, remedy }) = self.on_cpu_only() {
            return Err(ModelError::Setup(format!("{what}: {remedy}")));
        }
        let missing = self.missing_on_gpu();
        if !missing.is_empty() {
            let what = missing.join(", ");
            return Err(ModelError::Setup(format!(
                "the GPU cannot yet compute this dew: it has {what}. Run it with `--backend cpu`"
            )));
        }
        self.open_gpu(gpu).map_err(|error| ModelError::Setup(error.to_string()))
    }

    fn advance_later<'a>(&'a mut self, time: f64, stop: &'a AtomicBool) -> Advance<'a> {
        Box::pin(async move {
            if self.gpu_solver.is_none() {
                return self.advance_to(time, stop);
            }
            self.advance_on_gpu(time, stop).await
        })
    }

    fn gpu_seconds(&self) -> Option<f64> {
        self.gpu_solver.as_ref().map(|solver| solver.batches.seconds())
    }

    fn time_passes(&mut self) {
        if let Some(solver) = &mut self.gpu_solver {
            solver.batches.time_passes();
        }
    }

    fn pass_times(&self) -> Vec<(&'static str, PassTiming)> {
        self.gpu_solver.iter().flat_map(|solver| solver.batches.pass_times()).collect()
    }

    fn gpu_bytes(&self) -> Option<u64> {
        self.gpu_solver.as_ref().map(GpuSolver::bytes)
    }

    fn gpu(&self) -> Option<Gpu> {
        self.gpu_solver.as_ref().map(|solver| solver.batches.gpu().clone())
    }

    fn particles_on_gpu(&self) -> Result<Option<DeviceParticles>, ModelError> {
        let seen = self.gpu_solver.as_ref().map(|solver| solver.seen(self.scale().spacing, self.since()));
        seen.transpose().map_err(|error| failed(&error))
    }

    fn advance_shown(
        &mut self,
        time: f64,
        stop: &AtomicBool,
        observer: &mut dyn AdvanceObserver,
        (first, sees_air): (f64, bool),
        show: &mut dyn FnMut(Glance) -> f64,
    ) -> Result<(), ModelError> {
        if self.gpu_solver.is_none() {
            return self.advance_with(time, stop, observer);
        }
        let frame_request = Some(FrameRequest { wanted: first, sees_air, show });
        wait_for(self.advance_measured(time, stop, observer, frame_request))
    }
}

impl Dew {
    /// Why this dew runs on the CPU only, where it does.
    pub(crate) fn on_cpu_only(&self) -> Option<CpuOnly> {
        self.domain
            .as_ref()
            .map(|_| CpuOnly { what: "several processes compute on CPUs only", remedy: "leave `--backend gpu` out" })
    }

    /// What this model has that there is no twin of on the GPU.
    fn missing_on_gpu(&self) -> Vec<&'static str> {
        let all = [(self.fans.len() > MOST_FANS as usize, "more than 1024 fans ([[dew.fan]])")];
        all.into_iter().filter_map(|(is_there, what)| is_there.then_some(what)).collect()
    }

    /// Allocates buffers on a GPU for the air, and for more where there are inlets, and uploads the state.
    fn open_gpu(&mut self, gpu: Gpu) -> Result<(), GpuError> {
        let (count, come) = (self.state.air.len(), self.most_in_a_step());
        self.open_gpu_with(gpu, if come == 0 { count } else { count + count / 2 + come + SPARE_ROOM })
    }

    /// What the GPU needs of the model.
    fn gpu_inputs(&self) -> GpuInputs<'_> {
        let solids = SolidInputs {
            solids: &self.solids,
            conduction: &self.conduction,
            contact: &self.contact,
            ghosts: &self.ghosts,
            held_to: &self.held_to,
            air: &self.air,
            scale: &self.scale,
            mean: self.settings.mean,
        };
        GpuInputs {
            settings: &self.settings,
            air: &self.air,
            room: &self.room,
            inflows: &self.inflows,
            scale: &self.scale,
            solids,
            sources: &self.sources,
            surfaces: &self.surfaces,
            fans: &self.fans,
            open_sides: &self.open_sides,
            rest_density: self.rest_density,
            latent_heat: self.latent_heat,
            shortest_step: self.shortest_step(),
            most_in_a_step: self.most_in_a_step(),
            refuses_fast: self.wetting.is_some(),
            is_closed: self.is_closed(),
        }
    }

    fn open_gpu_with(&mut self, gpu: Gpu, room: usize) -> Result<(), GpuError> {
        let mut solver = GpuSolver::new(gpu, room, &self.gpu_inputs())?;
        solver.upload(&self.state, &self.evaporation);
        solver.batches = solver.batches.after(self.gpu_solver.take().map(|before| before.batches));
        self.gpu_solver = Some(solver);
        Ok(())
    }

    /// Uploads the state to the GPU, where there is one. It is set up again, its shaders compiled again, where settings have changed or there is
    /// too little room.
    pub(crate) fn upload_to_gpu(&mut self, anew: bool) -> Result<(), ModelError> {
        let needed = self.state.air.len() + self.most_in_a_step();
        match &mut self.gpu_solver {
            None => Ok(()),
            Some(solver) if !anew && solver.filling()[1] >= needed => {
                solver.upload(&self.state, &self.evaporation);
                Ok(())
            }
            Some(solver) => {
                let gpu = solver.batches.gpu().clone();
                self.open_gpu(gpu).map_err(|error| failed(&error))
            }
        }
    }

    /// Particles that can come in a step: a layer before each inlet, and outside open sides as many as stand there in all.
    fn most_in_a_step(&self) -> usize {
        let counts = self.room.counts(self.scale.spacing);
        let apart = self.room.apart(self.scale.spacing);
        let of_face = |(number, face): (usize, &Face)| {
            let axis = number / 2;
            let layers = match face {
                Face::Inlet(_) => 1,
                Face::Open => (deepest_outside(self.scale.h(), apart[axis]) / apart[axis]).ceil() as usize,
                _ => 0,
            };
            layers * counts[(axis + 1) % 3] * counts[(axis + 2) % 3]
        };
        self.room.faces.as_flattened().iter().enumerate().map(of_face).sum()
    }

    pub(crate) async fn advance_on_gpu(&mut self, time: f64, stop: &AtomicBool) -> Result<(), ModelError> {
        if self.state.time + self.state.time_step > time {
            self.shown = time;
            return Ok(());
        }
        self.advance_and_download(async |dew| dew.go_on_gpu(time, stop).await).await
    }

    /// Brings the state back after steps that may break down. Where they do, or the GPU fails, it is that of before.
    async fn advance_and_download(
        &mut self,
        advance: impl AsyncFnOnce(&mut Self) -> Result<Option<ModelError>, GpuError>,
    ) -> Result<(), ModelError> {
        let before = self.before();
        let broken = match advance(self).await {
            Ok(broken) => self.download_from_gpu().await.map(|()| broken),
            Err(error) => Err(error),
        };
        match broken.map(|broken| broken.or_else(|| self.check_finite().err())) {
            Ok(None) => Ok(()),
            Ok(Some(broken)) => {
                self.go_back_to(before);
                self.upload_to_gpu(false)?;
                Err(broken)
            }
            Err(error) => {
                self.go_back_to(before);
                Err(failed(&error))
            }
        }
    }

    /// Goes on to `time`, batch by batch; gives what broke down.
    async fn go_on_gpu(&mut self, time: f64, stop: &AtomicBool) -> Result<Option<ModelError>, GpuError> {
        while self.state.time + self.state.time_step <= time {
            if stop.load(Ordering::Relaxed) {
                self.shown = self.shown.max(self.state.time);
                return Ok(None);
            }
            let most = self.steps_to_drops();
            let Some(solver) = &mut self.gpu_solver else { break };
            let progress = solver.advance(time, most).await?;
            self.book_batch(&progress);
            self.update_drops_beside_gpu().await?;
            if progress.broken {
                self.download_from_gpu().await?;
                let last = if progress.steps > 0 { progress.last_step } else { progress.step };
                return Ok(self.check_step(progress.fastest, last, progress.step).err());
            }
            if progress.full {
                self.make_room().await?;
                continue;
            }
            // To the GPU, which rounds more coarsely, a step that ends at that time may end after it.
            if progress.steps == 0 {
                break;
            }
        }
        self.shown = time;
        Ok(None)
    }

    /// Steps until the next update of the drops. They are updated at the same steps however often the state is read.
    fn steps_to_drops(&self) -> u64 {
        match &self.wetting {
            Some(wetting) => wetting.steps() - wetting.steps_since(self.state.steps) % wetting.steps(),
            None => u64::MAX,
        }
    }

    /// Takes more room on the GPU where the air that is to come might not find any.
    async fn make_room(&mut self) -> Result<(), GpuError> {
        self.download_from_gpu().await?;
        match self.gpu_solver.as_ref().map(|solver| solver.batches.gpu().clone()) {
            Some(gpu) => self.open_gpu(gpu),
            None => Ok(()),
        }
    }

    /// Transfers condensed water to the drops, where their update is due, and uploads the water.
    async fn update_drops_beside_gpu(&mut self) -> Result<(), GpuError> {
        let Some(solver) = &mut self.gpu_solver else { return Ok(()) };
        let [air, _] = solver.filling();
        let is_due = |wetting: &crate::wetting::Wetting| {
            wetting.steps_since(self.state.steps).is_multiple_of(wetting.steps())
                && wetting.is_due(self.state.steps, air)
        };
        if !self.wetting.as_ref().is_some_and(is_due) {
            return Ok(());
        }
        solver.download_water(&mut self.state.water_on).await?;
        self.update_drops(air);
        if let Some(solver) = &mut self.gpu_solver {
            solver.upload_water(&self.state.water_on, &self.evaporation);
        }
        Ok(())
    }

    /// Brings the state back.
    async fn download_from_gpu(&mut self) -> Result<(), GpuError> {
        let Some(solver) = &mut self.gpu_solver else { return Ok(()) };
        solver.download(&mut self.state).await?;
        self.find_pairs_for_layers();
        Ok(())
    }

    fn book_batch(&mut self, progress: &BatchResult) {
        let mass = self.particle_mass();
        let (heat_capacity, latent_heat) = (self.air.heat_capacity, self.latent_heat);
        let State { water, energy, held_heat, supplied, .. } = &mut self.state;
        let mut book = |crossed: &Crossed, sign: f64| {
            water.book(sign * mass * (crossed.vapour + crossed.fog));
            energy.book(sign * mass * (heat_capacity * crossed.temperature + latent_heat * crossed.vapour));
        };
        book(&progress.came, 1.0);
        book(&progress.went, -1.0);
        let [water_in, water_out, energy_in, energy_out] = progress.diffused.map(|part| mass * part);
        water.book(water_in);
        water.book(-water_out);
        energy.book(energy_in);
        energy.book(-energy_out);
        for (held, &heat) in held_heat.iter_mut().zip(&progress.held_heat) {
            held.add(heat);
            energy.book(heat);
        }
        for (sum, &heat) in supplied.as_flattened_mut().iter_mut().zip(progress.supplied.as_flattened()) {
            sum.add(heat);
            energy.book(heat);
        }
        let state = &mut self.state;
        state.fogged.add(mass * progress.fogged);
        state.time = progress.time;
        state.steps += progress.steps;
        state.particle_steps += progress.particle_steps;
        state.time_step = progress.step;
        state.next_id = progress.next_id;
        state.inlet_phase = progress.inlet_phase;
        state.density_excess_beyond = progress.density_excess_beyond;
        state.running_mean_before = progress.running_mean_before;
        state.drift = progress.drift;
        if self.settings.low_utility.is_some() {
            state.utility_seen = progress.utility_seen;
        }
    }
}

#[cfg(test)]
mod tests;
