//! Pictures a second of a flood that is stepped and drawn on one card: a picture a step, and nothing comes back in between.

use corpuscle::gpu::{Gpu, wgpu};
use corpuscle::model::Frame;
use corpuscle::pictures::{Hand, Look, Moment, PictureSettings, Pictures};
use corpuscle_validate::{Rate, bench_water};
use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Seconds of wall-clock time measured, and the same for a quick look.
const MEASURED: f64 = 10.0;
const QUICK: f64 = 2.0;

/// Pictures before the clock starts.
const WARMING: u32 = 3;

/// Pictures that are ordered before the first of them is done, at most.
const AHEAD: usize = 3;

/// Longer than any bench runs, s of the flood.
const LONG: f64 = 1e5;

/// Draws the water of a bench; none where it is no bench of a flood.
pub(super) fn drawn(name: &str, gpu: &Gpu, is_quick: bool) -> anyhow::Result<Option<Rate>> {
    draw_for(name, gpu, if is_quick { QUICK } else { MEASURED })
}

/// The same for so many seconds.
fn draw_for(name: &str, gpu: &Gpu, seconds: f64) -> anyhow::Result<Option<Rate>> {
    let Some((mut flood, ground)) = bench_water(name)? else { return Ok(None) };
    flood.use_card(gpu.clone())?;
    let settings = PictureSettings { samples: 1, ..PictureSettings::default() };
    let mut pictures = Pictures::of_flood(gpu, flood.settings(), &ground, settings)?;
    let stop = AtomicBool::new(false);
    let mut pace = Pace::new(gpu, seconds);
    let mut failed = Ok(());
    flood.advance_shown(LONG, &stop, &mut |time, particles| {
        let frame = Frame { time, sets: Vec::new() };
        let moment = Moment { frame: &frame, on_device: Some(particles), paths: &[], container: None };
        let shown = pictures.show(&moment, &Hand::default(), Look::Full, [1.0; 3]);
        failed = shown.map_err(anyhow::Error::from).and_then(|_| pace.step());
        stop.store(failed.is_err() || pace.rate.is_some(), Ordering::Relaxed);
    })?;
    failed?;
    let particles = flood.particles().len();
    Ok(Some(Rate {
        name: name.into(),
        particles,
        dimensions: 2,
        packing: None,
        threads: 0,
        device: Some(gpu.name.clone()),
        rate: pace.rate.unwrap_or(0.0),
        rate_unit: "pictures_per_s".into(),
        bytes_per_particle: flood.bytes_on_card().unwrap_or(0) as f64 / particles as f64,
        passes: Vec::new(),
    }))
}

/// Keeps the host from running away from the device, and counts until the time is over.
struct Pace<'a> {
    gpu: &'a Gpu,
    seconds: f64,
    ordered: VecDeque<wgpu::SubmissionIndex>,
    pictures: u32,
    /// When those before the clock starts were done.
    began: Instant,
    /// Pictures a second, once all are done.
    rate: Option<f64>,
}

impl<'a> Pace<'a> {
    fn new(gpu: &'a Gpu, seconds: f64) -> Self {
        Self { gpu, seconds, ordered: VecDeque::new(), pictures: 0, began: Instant::now(), rate: None }
    }

    /// A picture more was ordered.
    fn step(&mut self) -> anyhow::Result<()> {
        self.ordered.push_back(self.gpu.queue.submit([]));
        self.pictures += 1;
        if self.pictures <= WARMING {
            self.wait(0)?;
            self.began = Instant::now();
            return Ok(());
        }
        self.wait(AHEAD)?;
        if self.began.elapsed().as_secs_f64() >= self.seconds {
            self.wait(0)?;
            self.rate = Some(f64::from(self.pictures - WARMING) / self.began.elapsed().as_secs_f64());
        }
        Ok(())
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
        let rate = draw_for("flood/paper-60k", &gpu, 0.0).unwrap().unwrap();
        assert!(rate.rate > 0.0 && rate.particles > 50_000 && rate.device == Some(gpu.name.clone()), "{rate:?}");
        assert_eq!(rate.rate_unit, "pictures_per_s");
        assert!(draw_for("gas/equilibrium", &gpu, 0.0).unwrap().is_none());
    }
}
