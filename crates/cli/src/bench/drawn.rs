//! Pictures per second of a flood that is stepped and drawn on one GPU: one per step, and only a few numbers are read back in between.

use crate::args::BenchOptions;
use corpuscle::gpu::{Gpu, PassTiming, wgpu};
use corpuscle::model::{Glance, GpuModel};
use corpuscle::pictures::{CameraOffset, Moment, PictureSettings, Pictures, Quality};
use corpuscle_validate::{FloodModel, PassTime, Rate, bench_water};
use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Seconds of wall-clock time measured, and the same with `--quick`.
const MEASURED: f64 = 10.0;
const QUICK: f64 = 2.0;

/// Pictures whose passes are timed, where they are.
const TIMED: u32 = 16;

/// Pictures before the clock starts.
const WARM_UP: u32 = 3;

/// Pictures submitted before the first of them is done, at most.
const AHEAD: usize = 3;

/// Simulated time beyond the end of any bench, s.
const LONG: f64 = 1e5;

/// Draws the water of a bench; none where it is no bench of a flood.
pub(super) fn drawn(name: &str, gpu: &Gpu, options: &BenchOptions) -> anyhow::Result<Option<Rate>> {
    let (seconds, timed) = (if options.quick { QUICK } else { MEASURED }, if options.passes { TIMED } else { 0 });
    draw_for(name, gpu, seconds, timed, options.splats)
}

/// The same for so many seconds; then so many pictures whose passes are timed.
fn draw_for(name: &str, gpu: &Gpu, seconds: f64, timed: u32, splats: bool) -> anyhow::Result<Option<Rate>> {
    let Some((mut flood, ground)) = bench_water(name)? else { return Ok(None) };
    on_gpu(&mut *flood)?.use_gpu(gpu.clone())?;
    let settings = PictureSettings { samples: 1, ..PictureSettings::default() };
    let mut drawn = Drawn { pictures: Pictures::of_flood(gpu, flood.settings(), &ground, settings)?, flood };
    if splats {
        drawn.pictures.splat();
    }
    let mut pace = Pace::new(gpu, seconds);
    drawn.go_on(|| pace.step())?;
    let Drawn { flood, .. } = &drawn;
    let particles = flood.particles();
    let rate = Rate {
        name: name.into(),
        particles,
        dimensions: 2,
        packing: None,
        threads: 0,
        device: Some(gpu.name.clone()),
        rate: pace.rate,
        rate_unit: "pictures_per_s".into(),
        processes: None,
        bytes_per_particle: flood.on_gpu().and_then(GpuModel::gpu_bytes).unwrap_or(0) as f64 / particles as f64,
        passes: Vec::new(),
    };
    Ok(Some(if timed > 0 { Rate { passes: drawn.passes(timed)?, ..rate } } else { rate }))
}

/// A flood as a model whose steps a GPU takes.
fn on_gpu(flood: &mut dyn FloodModel) -> anyhow::Result<&mut dyn GpuModel> {
    flood.on_gpu_mut().ok_or_else(|| anyhow::anyhow!("this flood is computed on the CPU only"))
}

/// A flood and its pictures.
struct Drawn {
    flood: Box<dyn FloodModel>,
    pictures: Pictures,
}

impl Drawn {
    /// Draws every step until `is_over` says so after a picture.
    fn go_on(&mut self, mut is_over: impl FnMut() -> anyhow::Result<bool>) -> anyhow::Result<()> {
        let stop = AtomicBool::new(false);
        let mut ended = Ok(());
        let pictures = &mut self.pictures;
        // After each step.
        let always = 0.0;
        on_gpu(&mut *self.flood)?.advance_shown(
            LONG,
            &stop,
            &mut (),
            (always, true),
            &mut |Glance { frame, on_device }| {
                let moment = Moment { frame: &frame, on_device: on_device.as_ref(), paths: &[], container: None };
                let shown = pictures.show(&moment, &CameraOffset::default(), Quality::Full, [1.0; 3]);
                let over = shown.map_err(anyhow::Error::from).and_then(|_| is_over());
                stop.store(!matches!(over, Ok(false)), Ordering::Relaxed);
                ended = over.map(|_| ());
                always
            },
        )?;
        ended
    }

    /// Time of the passes that draw the water per picture, the longest first, from so many pictures.
    fn passes(&mut self, pictures: u32) -> anyhow::Result<Vec<PassTime>> {
        self.pictures.measure();
        let mut left = pictures;
        self.go_on(|| {
            left -= 1;
            Ok(left == 0)
        })?;
        let a_picture = |(name, taken): (&'static str, PassTiming)| PassTime {
            name,
            times_a_step: f64::from(taken.times) / f64::from(pictures),
            seconds_a_step: taken.total.as_secs_f64() / f64::from(pictures),
        };
        let mut passes: Vec<_> = self.pictures.taken().into_iter().map(a_picture).collect();
        passes.sort_by(|a, b| b.seconds_a_step.total_cmp(&a.seconds_a_step));
        Ok(passes)
    }
}

/// Limits how many pictures the host submits ahead of the GPU, and counts them until the time is over.
struct Pace<'a> {
    gpu: &'a Gpu,
    seconds: f64,
    ordered: VecDeque<wgpu::SubmissionIndex>,
    pictures: u32,
    /// When the warm-up pictures were done.
    began: Instant,
    /// Pictures a second, once all are done.
    rate: f64,
}

impl<'a> Pace<'a> {
    fn new(gpu: &'a Gpu, seconds: f64) -> Self {
        Self { gpu, seconds, ordered: VecDeque::new(), pictures: 0, began: Instant::now(), rate: 0.0 }
    }

    /// Counts a submitted picture; true for the last.
    fn step(&mut self) -> anyhow::Result<bool> {
        self.ordered.push_back(self.gpu.queue.submit([]));
        self.pictures += 1;
        if self.pictures <= WARM_UP {
            self.wait(0)?;
            self.began = Instant::now();
            return Ok(false);
        }
        self.wait(AHEAD)?;
        if self.began.elapsed().as_secs_f64() < self.seconds {
            return Ok(false);
        }
        self.wait(0)?;
        self.rate = f64::from(self.pictures - WARM_UP) / self.began.elapsed().as_secs_f64();
        Ok(true)
    }

    /// Waits until no more than `ahead` pictures are still to be done.
    fn wait(&mut self, ahead: usize) -> anyhow::Result<()> {
        while self.ordered.len() > ahead {
            let submission_index = self.ordered.pop_front();
            self.gpu.device.poll(wgpu::PollType::Wait { submission_index, timeout: None })?;
        }
        Ok(self.gpu.check()?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle::gpu::require_gpu;

    #[test]
    fn a_flood_is_drawn_and_nothing_else_is() {
        let Some(gpu) = require_gpu("a flood stepped and drawn") else { return };
        let rate = draw_for("flood/sph-swe-60k", &gpu, 0.0, 1, true).unwrap().unwrap();
        let once = |name: &str| rate.passes.iter().any(|pass| pass.name == name && pass.times_a_step == 1.0);
        assert!(once("composing") && (gpu.device.features().is_empty() || once("water_discs")), "{rate:?}");
        assert!(rate.rate > 0.0 && rate.particles > 50_000 && rate.device == Some(gpu.name.clone()), "{rate:?}");
        assert_eq!(rate.rate_unit, "pictures_per_s");
        assert!(draw_for("gas/equilibrium", &gpu, 0.0, 0, false).unwrap().is_none());
    }
}
