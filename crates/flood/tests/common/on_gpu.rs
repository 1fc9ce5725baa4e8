//! Floods whose steps a GPU takes, and what is drawn of them.

use corpuscle_gpu::{DeviceParticle, Gpu};
use corpuscle_model::{AdvanceObserver, Glance, GpuModel, Model, ModelProgress};
use std::sync::atomic::AtomicBool;

/// A flood whose steps the GPU takes.
pub fn on_gpu<F: GpuModel>(mut flood: F, gpu: &Gpu) -> F {
    flood.use_gpu(gpu.clone()).unwrap();
    flood
}

/// Particles in the order of their ids.
pub fn in_order(mut particles: Vec<DeviceParticle>) -> Vec<DeviceParticle> {
    particles.sort_unstable_by_key(|particle| particle.id);
    particles
}

/// The particles as they lie on the GPU, by ids, and the origin of their positions.
pub fn seen(flood: &impl GpuModel, gpu: &Gpu) -> (Vec<DeviceParticle>, [f64; 3]) {
    let particles = flood.particles_on_gpu().unwrap().unwrap();
    (in_order(particles.read(gpu).unwrap()), particles.origin)
}

/// Shows `shown` 30 times until a time, s; each time it must have the particles that `plain` has there.
pub fn assert_shown_as_plain<F: Model + GpuModel>(shown: &mut F, plain: &mut F, until: f64, gpu: &Gpu) {
    let stop = AtomicBool::new(false);
    let mut looks = Vec::new();
    let times: Vec<f64> = (1..=30).map(|look| until * f64::from(look) / 30.0).collect();
    let mut show = |Glance { frame, on_device }: Glance| {
        looks.push((frame.time, in_order(on_device.unwrap().read(gpu).unwrap())));
        times.iter().copied().find(|later| *later > frame.time).unwrap_or(f64::INFINITY)
    };
    shown.advance_shown(until, &stop, &mut (), (times[0], true), &mut show).unwrap();
    assert!(looks.iter().map(|(time, _)| *time).eq(times.iter().copied()));
    for (time, look) in looks {
        plain.advance_to(time, &stop).unwrap();
        assert!(look == seen(plain, gpu).0, "{time} s");
    }
}

/// An observer that takes gauges every tenth of a second, and has the flood return at a time, s.
pub struct Rows {
    pub rows: Vec<(f64, Vec<f64>)>,
    pub until: f64,
}

impl Rows {
    pub fn until(until: f64) -> Self {
        Self { rows: Vec::new(), until }
    }
}

impl AdvanceObserver for Rows {
    fn gauges_after(&self, time: f64) -> Option<f64> {
        Some(((time / 0.1 + 1e-9).floor() + 1.0) * 0.1)
    }

    fn gauges(&mut self, time: f64, row: &[f64]) {
        self.rows.push((time, row.to_vec()));
    }

    fn progressed(&mut self, progress: ModelProgress) -> bool {
        assert!(progress.particles > 0 && progress.particle_steps > 0);
        progress.time < self.until
    }
}

/// The gauges of `shown` while it is shown must be those of `plain` to `within`, relatively: what comes and goes is summed up batch by batch, and
/// batches differ.
pub fn assert_gauges_alike<F: Model + GpuModel>(shown: &mut F, plain: &mut F, within: f64) {
    let stop = AtomicBool::new(false);
    let [mut of_shown, mut of_plain] = [(); 2].map(|()| Rows::until(f64::INFINITY));
    let mut show = |glance: Glance| glance.frame.time + 0.03;
    shown.advance_shown(1.05, &stop, &mut of_shown, (0.0, true), &mut show).unwrap();
    plain.advance_with(1.05, &stop, &mut of_plain).unwrap();
    assert_eq!([of_shown.rows.len(), of_plain.rows.len()], [10, 10]);
    for ((time, one), (same_time, other)) in of_shown.rows.iter().zip(&of_plain.rows) {
        let is_near = one.iter().zip(other).all(|(one, other)| (one - other).abs() <= within * one.abs());
        assert!(time == same_time && is_near, "{time} s: {one:?} {other:?}");
    }
}

/// A flood without a GPU shows nothing, and advances all the same.
pub fn assert_shows_nothing<F: Model + GpuModel>(flood: &mut F) {
    assert!(flood.gpu().is_none() && flood.particles_on_gpu().unwrap().is_none());
    let mut show = |_: Glance| panic!("there is no GPU");
    flood.advance_shown(0.5, &AtomicBool::new(false), &mut (), (0.0, true), &mut show).unwrap();
    assert!(flood.time() == 0.5 && flood.steps() > 0);
}
