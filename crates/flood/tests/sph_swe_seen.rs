//! What is drawn of scheme sph-swe on the GPU is what the frame has.

mod common;

use common::on_gpu::{assert_gauges_alike, assert_shown_as_plain, assert_shows_nothing, in_order, on_gpu, seen};
use corpuscle_flood::SphSweFlood;
use corpuscle_gpu::{Gpu, require_gpu};
use corpuscle_model::{Glance, GpuModel, Model, Values};
use std::sync::atomic::{AtomicBool, Ordering};

/// Water runs fast against a house, over the eastern side, and a block of it falls.
const FALL: &str = r#"
run.until_s = 60
terrain.rough-hills = { extent = { length_m = 60, width_m = 40, cell_m = 1 }, relief_m = 2, hill_size_m = 30 }
[flood]
scheme = "sph-swe"
spacing_m = 1
spacing_depth_m = 1
map_every_s = 60
manning = 0.03
edges = { west = "wall", east = "open", south = "wall", north = "wall" }
[[flood.water]]
depth_m = 0.8
polygon = [[0, 0], [60, 0], [60, 40], [0, 40]]
velocity_m_per_s = [6, 0.5]
[[flood.water]]
block = { from = [10, 8], to = [30, 22], height_m = 2.5, layers = 2 }
[[flood.obstacle]]
name = "house"
polygon = [[40, 15], [46, 17], [44, 25], [38, 23]]
"#;

/// Particles that are drawn with a radius of their own.
const SMALL: &str = r#"
run.until_s = 60
terrain.plane = { extent = { length_m = 30, width_m = 20, cell_m = 1 }, slope_east = -0.02 }
[flood]
scheme = "sph-swe"
spacing_m = 1
spacing_depth_m = 1
edges = { west = "wall", east = "wall", south = "wall", north = "wall" }
water = [{ depth_m = 1, velocity_m_per_s = [1, 0.5] }]
sph_swe = { radius_m = 0.3 }
"#;

fn flood(text: &str, gpu: &Gpu) -> SphSweFlood {
    on_gpu(common::sph_swe(&common::scene(text)), gpu)
}

/// Compares them with the frame, which must have `in_air` of them in the air.
fn compare(flood: &SphSweFlood, gpu: &Gpu, in_air: bool) {
    let (device, origin) = seen(flood, gpu);
    let set = &flood.frame().sets[0];
    let Values::Scalar(depths) = &set.columns[0].values else { panic!("depths are numbers") };
    let mut order: Vec<usize> = (0..set.len()).collect();
    order.sort_unstable_by_key(|&index| set.id[index]);
    assert_eq!(device.len(), set.len());
    assert_eq!(depths.contains(&0.0), in_air);
    let near = |one: f32, other: f64| (f64::from(one) - other).abs() < 1e-4;
    for (particle, &index) in device.iter().zip(&order) {
        assert_eq!(u64::from(particle.id), set.id[index]);
        let axes = 0..3;
        let same = axes.clone().all(|axis| near(particle.position[axis], set.position[index][axis] - origin[axis]))
            && axes.clone().all(|axis| near(particle.velocity[axis], set.velocity[index][axis]))
            && near(particle.spacing, 2.0 * set.radius[index])
            && near(particle.depth, depths[index])
            && near(particle.volume, set.mass[index] / 1000.0);
        let frame = (set.position[index], set.velocity[index], set.radius[index], depths[index], set.mass[index]);
        assert!(same, "{particle:?} from {origin:?}, {frame:?}");
    }
}

#[test]
fn particles_on_the_gpu_are_those_of_the_frame() {
    let Some(gpu) = require_gpu("a flood drawn where it lies") else { return };
    for (text, in_air) in [(FALL, true), (SMALL, false)] {
        let mut flood = flood(text, &gpu);
        compare(&flood, &gpu, in_air);
        // Between two steps, and after the block has come down.
        for (time, in_air) in [(0.3, in_air), (4.0, false)] {
            flood.advance_to(time, &AtomicBool::new(false)).unwrap();
            assert!(flood.frame().sets[0].len() > 400);
            compare(&flood, &gpu, in_air);
        }
    }
}

#[test]
fn who_is_shown_every_step_sees_the_water_that_comes_back() {
    let Some(gpu) = require_gpu("a flood shown on the GPU") else { return };
    let [mut shown, mut plain] = [(); 2].map(|()| flood(FALL, &gpu));
    let stop = AtomicBool::new(false);
    let (mut last, mut times) = (Vec::new(), Vec::new());
    let mut show = |Glance { frame, on_device }: Glance| {
        let (time, particles) = (frame.time, on_device.unwrap());
        times.push(time);
        last = particles.read(&gpu).unwrap();
        stop.store(times.len() == 91, Ordering::Relaxed);
        0.0
    };
    // Whoever plays a scene on goes on without end.
    shown.advance_shown(f64::INFINITY, &stop, &mut (), (0.0, true), &mut show).unwrap();
    // The start, and 90 steps.
    assert_eq!((times.len(), shown.steps()), (91, 90));
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]) && times[90] == shown.time(), "{times:?} {}", shown.time());
    assert!(in_order(last) == seen(&shown, &gpu).0);
    // Looking does not change what the water does. A little more, lest rounding take the last step for less.
    plain.advance_to(shown.time() + 1e-3 * shown.time_step(), &AtomicBool::new(false)).unwrap();
    assert_eq!(plain.steps(), 90);
    assert!(plain.particles() == shown.particles());
}

#[test]
fn who_asks_for_times_sees_the_water_of_these_times() {
    let Some(gpu) = require_gpu("water at times") else { return };
    let [mut shown, mut plain] = [(); 2].map(|()| flood(FALL, &gpu));
    // Some fall between two steps; one at the end.
    assert_shown_as_plain(&mut shown, &mut plain, 0.9, &gpu);
    assert!(shown.steps() == plain.steps() && shown.steps() % 30 != 0, "{} steps", shown.steps());
    assert!(shown.particles() == plain.particles());
}

#[test]
fn who_is_shown_has_the_gauges_of_who_is_not() {
    let Some(gpu) = require_gpu("gauges beside a flood that is shown") else { return };
    let [mut shown, mut plain] = [(); 2].map(|()| flood(FALL, &gpu));
    assert_gauges_alike(&mut shown, &mut plain, 1e-7);
}

#[test]
fn without_a_gpu_nobody_is_shown_anything() {
    let Some(gpu) = require_gpu("a flood without a GPU") else { return };
    assert!(flood(SMALL, &gpu).gpu().is_some_and(|device| device.is_same(&gpu)));
    assert_shows_nothing(&mut common::sph_swe(&common::scene(SMALL)));
}
