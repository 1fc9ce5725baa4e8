//! What is drawn on the GPU is what the frame has, and nothing comes back for it.

mod common;

use common::{built_in, on_gpu};
use corpuscle_dew::humid_air::ZERO_CELSIUS;
use corpuscle_gpu::{DeviceParticles, Gpu, require_gpu};
use corpuscle_model::{AdvanceObserver, Frame, Glance, GpuModel, Model, ModelProgress, ParticleSet, Values};
use std::sync::atomic::{AtomicBool, Ordering};

fn set<'a>(frame: &'a Frame, name: &str) -> &'a ParticleSet {
    frame.sets.iter().find(|set| set.name == name).unwrap()
}

fn compare(seen: &DeviceParticles, frame: &Frame, gpu: &Gpu) {
    let mut device = seen.read(gpu).unwrap();
    device.sort_unstable_by_key(|particle| particle.id);
    let air = set(frame, "air");
    let Values::Scalar(temperatures) = &air.columns[0].values else { panic!("temperatures are numbers") };
    assert!(device.len() == air.len() && air.len() > 200, "{} {}", device.len(), air.len());
    for (index, particle) in device.iter().enumerate() {
        let near = |one: f32, other: f64, bound: f64| (f64::from(one) - other).abs() < bound;
        let same = u64::from(particle.id) == air.id[index]
            && (0..3).all(|k| near(particle.position[k], air.position[index][k] - seen.origin[k], 1e-6))
            && (0..3).all(|k| near(particle.velocity[k], air.velocity[index][k], 1e-5))
            && near(particle.temperature, temperatures[index] - ZERO_CELSIUS, 1e-4)
            && near(particle.spacing, 2.0 * air.radius[index], 1e-8);
        assert!(same, "{particle:?} {:?} {}", air.position[index], temperatures[index]);
    }
}

#[test]
fn air_on_the_gpu_is_that_of_the_frame() {
    let Some(gpu) = require_gpu("air drawn where it lies") else { return };
    let mut dew = on_gpu(built_in("dew/three-boundaries", &[]), &gpu);
    for time in [0.0, 0.000_77, 0.0015] {
        dew.advance_to(time, &AtomicBool::new(false)).unwrap();
        compare(&dew.particles_on_gpu().unwrap().unwrap(), &dew.frame(), &gpu);
    }
    assert!(dew.steps() > 5, "{} steps", dew.steps());
}

/// Is told how far it is.
#[derive(Default)]
struct Told {
    rows: usize,
    reports: usize,
}

impl AdvanceObserver for Told {
    fn gauges_after(&self, time: f64) -> Option<f64> {
        Some(((time / 0.005 + 1e-9).floor() + 1.0) * 0.005)
    }

    fn gauges(&mut self, _time: f64, _row: &[f64]) {
        self.rows += 1;
    }

    fn progressed(&mut self, _progress: ModelProgress) -> bool {
        self.reports += 1;
        true
    }
}

#[test]
fn who_watches_sees_the_drops_and_the_air_and_changes_neither() {
    let Some(gpu) = require_gpu("dew that is watched on the GPU") else { return };
    let [mut watched, mut plain] = [(); 2].map(|()| on_gpu(built_in("dew/pane", &[]), &gpu));
    let (stop, mut told) = (AtomicBool::new(false), Told::default());
    let mut looks = Vec::new();
    let mut show = |Glance { frame, on_device: air }: Glance| {
        let next = frame.time + 0.0037;
        assert!(frame.sets.iter().all(|set| ["drops", "unseen"].contains(&set.name.as_str())));
        looks.push((frame, air.unwrap().read(&gpu).unwrap()));
        stop.store(looks.len() == 12, Ordering::Relaxed);
        next
    };
    watched.advance_shown(f64::INFINITY, &stop, &mut told, (0.0, true), &mut show).unwrap();
    assert!(looks.len() == 12 && told.rows == 8 && told.rows < told.reports, "{} {}", looks.len(), told.rows);
    let by_ids = |mut air: Vec<corpuscle_gpu::DeviceParticle>| {
        air.sort_unstable_by_key(|particle| particle.id);
        air
    };
    for (number, (frame, air)) in looks.into_iter().enumerate() {
        assert!((frame.time - 0.0037 * number as f64).abs() < 1e-12, "{}", frame.time);
        plain.advance_to(frame.time, &AtomicBool::new(false)).unwrap();
        assert!(set(&plain.frame(), "drops").position == set(&frame, "drops").position);
        assert!(
            by_ids(plain.particles_on_gpu().unwrap().unwrap().read(&gpu).unwrap()) == by_ids(air),
            "{}",
            frame.time
        );
    }
    compare(&plain.particles_on_gpu().unwrap().unwrap(), &plain.frame(), &gpu);
    assert!(plain.steps() == watched.steps() && plain.air() == watched.air());
    // Where only drops are seen, the air is not even looked at.
    stop.store(false, Ordering::Relaxed);
    let mut show = |Glance { on_device: air, .. }: Glance| {
        assert!(air.is_none());
        stop.store(true, Ordering::Relaxed);
        0.0
    };
    watched.advance_shown(60.0, &stop, &mut (), (0.0, false), &mut show).unwrap();
}

#[test]
fn without_a_gpu_nobody_is_shown_any_air() {
    let mut dew = built_in("dew/pane", &[]);
    assert!(dew.gpu().is_none() && dew.particles_on_gpu().unwrap().is_none());
    let mut show = |_: Glance| panic!("there is no GPU");
    dew.advance_shown(0.005, &AtomicBool::new(false), &mut (), (0.0, true), &mut show).unwrap();
    assert!(dew.time() == 0.005 && dew.steps() > 0);
}
