//! A flood whose steps a GPU takes.

use super::batch::{BatchRequest, BatchResult, SpawnRequest};
use super::frame_request::FrameRequest;
use super::observers::Observers;
use super::state::Water;
use super::upload::GpuInputs;
use super::{MAX_SPAWN_REQUESTS, OnGpu};
use crate::sph_swe::gauges::Reading;
use crate::sph_swe::gauges::on_gpu::MOST_ROWS;
use crate::sph_swe::maps::on_gpu::MAX_MAP_TIMES;
use crate::sph_swe::particle::Particle;
use crate::sph_swe::step::CELL_OVER_H;
use crate::sph_swe::{DENSITY, SphSweFlood, State};
use crate::zone::Source;
use corpuscle_gpu::{DeviceParticles, Gpu, GpuError, PassTiming, wait_for};
use corpuscle_model::{
    Advance, AdvanceObserver, CompensatedSum, CpuOnly, Glance, GpuModel, Model, ModelError, ModelProgress,
};
use corpuscle_scene::{SmoothingForm, Table};
use std::sync::atomic::{AtomicBool, Ordering};

/// Spawn requests are computed so many steps beyond the next sample of the maps: the step that passes it may be longer than the last.
const LONGEST_AHEAD: f64 = 10.0;

pub(in crate::sph_swe) fn failed(error: &GpuError) -> ModelError {
    ModelError::Device(error.to_string())
}

impl SphSweFlood {
    /// Why this flood runs on the CPU only, where it does.
    pub(in crate::sph_swe) fn on_cpu_only(&self) -> Option<CpuOnly> {
        (self.settings.sph_swe.smoothing == SmoothingForm::Rate).then_some(CpuOnly {
            what: "flood.sph_swe.smoothing = \"rate\" computes on the CPU only",
            remedy: "leave `--backend gpu` out, or take \"density\"",
        })
    }
}

impl GpuModel for SphSweFlood {
    fn use_gpu(&mut self, gpu: Gpu) -> Result<(), ModelError> {
        if let Some(CpuOnly { what, remedy }) = self.on_cpu_only() {
            return Err(ModelError::Setup(format!("{what}: {remedy}")));
        }
        self.open_gpu(gpu).map_err(|error| ModelError::Setup(error.to_string()))
    }

    fn advance_later<'a>(&'a mut self, time: f64, stop: &'a AtomicBool) -> Advance<'a> {
        Box::pin(async move {
            if self.on_gpu.is_none() {
                return self.advance_to(time, stop);
            }
            self.advance_on_gpu(time, stop, &mut Observers::default()).await
        })
    }

    fn gpu_seconds(&self) -> Option<f64> {
        self.on_gpu.as_ref().map(|on_gpu| on_gpu.batches.seconds())
    }

    fn time_passes(&mut self) {
        if let Some(on_gpu) = &mut self.on_gpu {
            on_gpu.batches.time_passes();
        }
    }

    fn pass_times(&self) -> Vec<(&'static str, PassTiming)> {
        self.on_gpu.iter().flat_map(|on_gpu| on_gpu.batches.pass_times()).collect()
    }

    fn gpu_bytes(&self) -> Option<u64> {
        self.on_gpu.as_ref().map(OnGpu::bytes)
    }

    fn gpu(&self) -> Option<Gpu> {
        self.on_gpu.as_ref().map(|on_gpu| on_gpu.gpu().clone())
    }

    fn particles_on_gpu(&self) -> Result<Option<DeviceParticles>, ModelError> {
        let of = |on_gpu: &OnGpu| on_gpu.seen(self.since(), self.spacing_shown(), self.spacing);
        let seen = self.on_gpu.as_ref().map(of);
        seen.transpose().map_err(|error| failed(&error))
    }

    fn advance_shown(
        &mut self,
        time: f64,
        stop: &AtomicBool,
        observer: &mut dyn AdvanceObserver,
        (first, _): (f64, bool),
        show: &mut dyn FnMut(Glance) -> f64,
    ) -> Result<(), ModelError> {
        if self.on_gpu.is_none() {
            return self.advance_with(time, stop, observer);
        }
        let frame_request = Some(FrameRequest { wanted: first, show });
        wait_for(self.advance_measured(time, stop, Observers { frame_request, ..Observers::of(observer) }))
    }
}

impl SphSweFlood {
    /// Allocates buffers on a GPU for all particles, and for more where there are inflows, and uploads the state.
    pub(in crate::sph_swe) fn open_gpu(&mut self, gpu: Gpu) -> Result<(), GpuError> {
        let (count, falling) = (self.state.particles.len(), self.state.falling.len());
        let room = falling + if self.sources.is_empty() { count } else { 2 * count + MAX_SPAWN_REQUESTS };
        self.open_gpu_with(gpu, room)
    }

    /// The same with room for `room` particles.
    pub(super) fn open_gpu_with(&mut self, gpu: Gpu, room: usize) -> Result<(), GpuError> {
        let scheme = self.parameters();
        let inputs = GpuInputs {
            surroundings: &self.surroundings,
            scheme: &scheme,
            falling: self.state.falling.len(),
            fall_step: self.fall_step(),
            gravity: self.settings.gravity_m_per_s2,
            roughness: &self.roughness,
            sources: &self.sources,
            seed: self.seed,
            volume: self.volume,
            h: self.h,
            spacing: self.spacing,
        };
        let mut on_gpu = OnGpu::new(gpu, room, &inputs)?;
        if !self.detects_overtopping() {
            on_gpu.keep_maps(&self.surroundings.terrain, &self.surroundings.obstacles, &self.state.maps)?;
        }
        on_gpu.batches = on_gpu.batches.after(self.on_gpu.take().map(|before| before.batches));
        self.on_gpu = Some(on_gpu);
        self.upload_to_gpu()
    }

    /// Uploads the state to the GPU, and enlarges the buffers there if they are too small.
    pub(in crate::sph_swe) fn upload_to_gpu(&mut self) -> Result<(), GpuError> {
        let State { particles, on_obstacles, impulses, .. } = &self.state;
        let water = Water {
            particles,
            step: self.state.time_step,
            external: self.state.external,
            on_obstacles,
            impulses,
            put_back: self.state.put_back,
            time: self.state.time,
            next_id: self.state.next_id,
            maps: &self.state.maps,
            falling: &self.state.falling,
        };
        match &mut self.on_gpu {
            Some(on_gpu) if on_gpu.room() < particles.len() || on_gpu.room_in_air() < water.falling.len() => {
                let gpu = on_gpu.gpu().clone();
                self.open_gpu(gpu)
            }
            Some(on_gpu) => {
                on_gpu.upload(&water);
                Ok(())
            }
            None => Ok(()),
        }
    }

    /// Upper bound on the particles spawned within `horizon` s from `now` on; `residual_volume` is that of each source.
    fn max_spawned(&self, residual_volume: &[CompensatedSum], now: f64, horizon: f64) -> usize {
        let of_one = |(source, residual_volume): (&Source, &CompensatedSum)| {
            residual_volume.value() + source.discharge.integral(now, now + horizon)
        };
        let of_sources = self
            .sources
            .iter()
            .zip(residual_volume)
            .map(of_one)
            .map(|inflow| (inflow / self.volume).max(0.0) as usize + 1);
        of_sources.sum()
    }

    /// Enlarges the buffers on the GPU where particles of inflows might not find room.
    fn make_room(&mut self) -> Result<(), GpuError> {
        let Some(on_gpu) = &self.on_gpu else { return Ok(()) };
        if on_gpu.lacks_room(|horizon| self.max_spawned(&self.state.residual_volume, self.state.time, horizon)) {
            let gpu = on_gpu.gpu().clone();
            self.open_gpu(gpu)?;
        }
        Ok(())
    }

    pub(in crate::sph_swe) async fn advance_on_gpu(
        &mut self,
        time: f64,
        stop: &AtomicBool,
        observers: &mut Observers<'_>,
    ) -> Result<(), ModelError> {
        observers.gauged_until = self.shown;
        while self.state.time + self.state.time_step <= time {
            if stop.load(Ordering::Relaxed) || observers.call_back {
                // No row of gauges is recorded twice.
                self.shown = observers.gauged_until.max(self.state.time);
                return Ok(());
            }
            let keeps_maps = self.on_gpu.as_ref().is_some_and(OnGpu::keeps_maps);
            let host_sample = if keeps_maps { f64::INFINITY } else { self.state.next_sample as f64 * self.map_period };
            let before = (self.state.steps, observers.gauged_until);
            self.make_room().map_err(|error| failed(&error))?;
            if observers.measure() {
                self.measure_on_gpu()?;
            }
            let done = self.advance_to_sample(time, host_sample, stop, observers).await?;
            if done.broken {
                return Err(self.breakdown());
            }
            if self.state.time >= host_sample {
                self.sample_maps();
            }
            // In the GPU's coarser rounding a step that ends at that time may end after it.
            let is_stopped = stop.load(Ordering::Relaxed) || observers.call_back;
            if (self.state.steps, observers.gauged_until) == before && !is_stopped {
                break;
            }
        }
        self.show_to(observers, self.state.time, time.next_up()).map_err(|error| failed(&error))?;
        self.shown = time;
        Ok(())
    }

    /// Advances to `time`, or to the first step that ends at `host_sample` or after. The host's state changes only when the download is complete.
    async fn advance_to_sample(
        &mut self,
        time: f64,
        host_sample: f64,
        stop: &AtomicBool,
        observers: &mut Observers<'_>,
    ) -> Result<BatchResult, ModelError> {
        let mut done = BatchResult::none(self.state.time, self.state.time_step);
        let mut residual_volume = self.state.residual_volume.clone();
        let mut last_sample = self.state.maps.last();
        while done.time + done.step <= time && done.time < host_sample {
            let now = done.time;
            self.show_to(observers, now, now + done.step).map_err(|error| failed(&error))?;
            if stop.load(Ordering::Relaxed) || observers.call_back {
                break;
            }
            let longest = self.on_gpu.as_ref().map_or(0.0, OnGpu::longest_batch);
            let spawn_requests = self.spawn_requests(
                &residual_volume,
                now,
                time.min(host_sample + LONGEST_AHEAD * done.step).min(now + longest),
            );
            let map_times = self.map_times(done.map_samples);
            let due = observers.due(time);
            let until = if due.len() == MOST_ROWS { due[MOST_ROWS - 1] } else { time };
            let (target, most) = observers.steps_to_frame(now, until);
            let Some(on_gpu) = &mut self.on_gpu else { break };
            let host_sample = map_times.last().copied().unwrap_or(host_sample);
            let request = BatchRequest {
                until: target,
                most,
                host_sample,
                map_times: &map_times,
                last_sample,
                spawn_requests: &spawn_requests,
                due: &due,
            };
            let (mut progress, mut readings) = on_gpu.advance(request).await.map_err(|error| failed(&error))?;
            let particles = on_gpu.particles();
            if !readings.iter().all(Reading::is_sound) {
                progress.broken = true;
                readings.clear();
            }
            for (due, reading) in due.iter().zip(&readings) {
                observers.record_gauges(*due, &self.row_of_gpu(reading, &done));
            }
            for (source, residual_volume) in self.sources.iter().zip(&mut residual_volume) {
                residual_volume.add(source.discharge.integral(now, progress.time));
            }
            spawn_requests[..progress.spawned]
                .iter()
                .for_each(|request| residual_volume[request.source].add(-self.volume));
            if progress.map_samples > 0 {
                last_sample = progress.last_sample;
            }
            done = done.and(progress);
            let particle_steps = self.state.particle_steps + done.particle_steps;
            observers.report_progress(ModelProgress { time: done.time, particles, particle_steps });
            let lacks_room =
                |on_gpu: &OnGpu| on_gpu.lacks_room(|horizon| self.max_spawned(&residual_volume, now, horizon));
            let is_held = progress.steps == 0 && readings.is_empty();
            if is_held && target < until && !done.broken {
                // In the GPU's coarser rounding a step that ends at the time of a frame may end after it.
                self.show_to(observers, now, target.next_up()).map_err(|error| failed(&error))?;
            } else if is_held || done.broken || self.on_gpu.as_ref().is_some_and(lacks_room) {
                break;
            }
        }
        if done.steps > 0 {
            let particles = self.downloaded().await.map_err(|error| failed(&error))?;
            let steps = self.state.steps + done.steps;
            if let Some(error) = self.defect_among(&particles, done.time, steps) {
                return Err(error);
            }
            self.download_rest(&done, particles, residual_volume, last_sample).await.map_err(|error| failed(&error))?;
        }
        Ok(done)
    }

    /// The particles on the GPU.
    async fn downloaded(&mut self) -> Result<Vec<Particle>, GpuError> {
        let mut particles = Vec::new();
        if let Some(on_gpu) = &mut self.on_gpu {
            on_gpu.download(&mut particles, &self.surroundings.terrain).await?;
        }
        Ok(particles)
    }

    /// Downloads the rest of the GPU's state after the steps of `done`, which led to `particles`: `residual_volume` is that of each source, and the
    /// maps were last sampled at `last_sample` s.
    async fn download_rest(
        &mut self,
        done: &BatchResult,
        particles: Vec<Particle>,
        residual_volume: Vec<CompensatedSum>,
        last_sample: f64,
    ) -> Result<(), GpuError> {
        let Some(on_gpu) = &self.on_gpu else { return Ok(()) };
        let falling = on_gpu.falling().await?;
        let mut maps = (done.map_samples > 0).then(|| self.state.maps.clone());
        if let Some(maps) = &mut maps {
            on_gpu.download_maps(maps).await?;
            maps.set_last(last_sample);
        }
        let pushed = on_gpu.on_obstacles().await?;
        // All is here: nothing of it is kept where the GPU was lost amid it.
        let state = &mut self.state;
        (state.particles, state.falling, state.residual_volume) = (particles, falling, residual_volume);
        if let Some(maps) = maps {
            state.maps = maps;
            state.next_sample += done.map_samples as u64;
        }
        (state.on_obstacles, state.impulses, state.put_back) = (pushed.forces, pushed.impulses, pushed.put_back);
        state.next_id = done.next_id;
        self.book(done);
        self.arrange();
        Ok(())
    }

    /// The next times at which the GPU samples the maps, s, after `taken` of them; none where the host does.
    fn map_times(&self, taken: usize) -> Vec<f64> {
        let numbers = self.state.next_sample + taken as u64..;
        let keeps_maps = self.on_gpu.as_ref().is_some_and(OnGpu::keeps_maps);
        let count = if keeps_maps { MAX_MAP_TIMES } else { 0 };
        numbers.take(count).map(|number| number as f64 * self.map_period).collect()
    }

    /// The particles that the sources release from `now` to `until`, the earliest first.
    fn spawn_requests(&self, residual_volume: &[CompensatedSum], now: f64, until: f64) -> Vec<SpawnRequest> {
        let sources = self.sources.iter().zip(residual_volume).enumerate();
        let spawn_requests = sources.flat_map(|(number, (source, residual_volume))| {
            let times = times(&source.discharge, residual_volume.value(), self.volume, now, until);
            times.into_iter().map(move |time| SpawnRequest { time, source: number, velocity: source.velocity })
        });
        let mut spawn_requests: Vec<SpawnRequest> = spawn_requests.collect();
        spawn_requests.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.source.cmp(&b.source)));
        spawn_requests.truncate(MAX_SPAWN_REQUESTS);
        spawn_requests
    }

    fn book(&mut self, progress: &BatchResult) {
        let state = &mut self.state;
        state.time = progress.time;
        state.steps += progress.steps;
        state.particle_steps += progress.particle_steps;
        state.time_step = progress.step;
        state.external = progress.external;
        if progress.mean_h > 0.0 {
            // Not while all water is in the air.
            state.cell = CELL_OVER_H * progress.mean_h;
        }
        state.water.inflow.add(progress.inflow);
        state.water.outflow.add(progress.outflow);
        state.momentum.inflow.add(DENSITY * progress.momentum_gained);
        state.momentum.outflow.add(DENSITY * progress.momentum_lost);
    }
}

/// The times from `from` to `until` at which a discharge completes another `volume` m3, with `residual_volume` m3 at the start.
fn times(discharge: &Table, residual_volume: f64, volume: f64, from: f64, until: f64) -> Vec<f64> {
    let inflow = |time: f64| residual_volume + discharge.integral(from, time);
    let count = (inflow(until) / volume).floor().max(0.0) as usize;
    let mut earliest = from;
    let time = |number: usize| {
        let (mut low, mut high) = (earliest, until);
        // To a billionth of the request.
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            *if inflow(middle) >= number as f64 * volume { &mut high } else { &mut low } = middle;
        }
        earliest = low;
        high
    };
    (1..=count).map(time).collect()
}
