//! What is drawn of scheme voronoi on a GPU is what the frame has.

mod common;

use common::on_gpu::{Rows, assert_gauges_alike, assert_shown_as_plain, assert_shows_nothing, in_order, on_gpu, seen};
use corpuscle_flood::VoronoiFlood;
use corpuscle_gpu::{Gpu, require_gpu};
use corpuscle_model::{Glance, GpuModel, Model, Values};
use std::sync::atomic::{AtomicBool, Ordering};

/// Water runs fast against a house, over the eastern side, and onto dry ground far away.
const RUN: &str = r#"
run.until_s = 60
terrain.rough-hills = { extent = { length_m = 200, width_m = 40, cell_m = 1 }, relief_m = 2, hill_size_m = 30 }
[flood]
spacing_m = 1
map_every_s = 60
manning = 0.03
edges = { west = "wall", east = "open", south = "wall", north = "wall" }
[[flood.water]]
depth_m = 0.8
polygon = [[0, 0], [60, 0], [60, 40], [0, 40]]
velocity_m_per_s = [6, 0.5]
[[flood.obstacle]]
name = "house"
polygon = [[40, 15], [46, 17], [44, 25], [38, 23]]
[[flood.gauge]]
name = "before"
at = [30, 20]
"#;

const BLOCK: &str = "[[flood.water]]\nblock = { from = [10, 8], to = [30, 22], height_m = 2.5, layers = 2 }\n";

fn flood(text: &str, gpu: &Gpu) -> VoronoiFlood {
    on_gpu(common::voronoi(&common::scene(text)), gpu)
}

fn compare(flood: &VoronoiFlood, gpu: &Gpu) {
    let (device, origin) = seen(flood, gpu);
    let set = &flood.frame().sets[0];
    let Values::Scalar(depths) = &set.columns[0].values else { panic!("depths are numbers") };
    let mut order: Vec<usize> = (0..set.len()).collect();
    order.sort_unstable_by_key(|&index| set.id[index] as u32);
    assert!(device.len().abs_diff(set.len()) <= 1 && set.len() > 400, "{} {}", device.len(), set.len());
    let near = |one: f32, other: f64| (f64::from(one) - other).abs() < 1e-4;
    let mut device = device.iter().peekable();
    for index in order {
        // At the depth from which water is shown rounding decides.
        let Some(particle) = device.next_if(|particle| particle.id == set.id[index] as u32) else { continue };
        let axes = 0..3;
        let same = axes.clone().all(|axis| near(particle.position[axis], set.position[index][axis] - origin[axis]))
            && axes.clone().all(|axis| near(particle.velocity[axis], set.velocity[index][axis]))
            && near(particle.spacing, 2.0 * set.radius[index])
            && near(particle.depth, depths[index])
            && near(particle.volume, set.mass[index] / 1000.0);
        let frame = (set.position[index], set.velocity[index], set.radius[index], depths[index], set.mass[index]);
        assert!(same, "{particle:?} from {origin:?}, {frame:?}");
    }
    assert!(device.count() <= 1);
}

#[test]
fn particles_on_the_gpu_are_those_of_the_frame() {
    let Some(gpu) = require_gpu("a flood drawn where it lies") else { return };
    let mut stored = flood(&RUN.replace("spacing_m = 1\n", "spacing_m = 2\nstorage = \"level-volume\"\n"), &gpu);
    stored.advance_to(1.0, &AtomicBool::new(false)).unwrap();
    compare(&stored, &gpu);
    let mut flood = flood(RUN, &gpu);
    compare(&flood, &gpu);
    // Between two steps, and after cells were added.
    let cells = flood.cells();
    for time in [0.3, 4.0] {
        flood.advance_to(time, &AtomicBool::new(false)).unwrap();
        compare(&flood, &gpu);
    }
    assert!(flood.cells() > cells);
}

/// While water falls it is drawn from the frame, then from where it lies.
#[test]
fn water_in_the_air_is_shown() {
    let Some(gpu) = require_gpu("a falling block beside a GPU") else { return };
    let mut flood = flood(&format!("{RUN}{BLOCK}"), &gpu);
    let mut kinds = Vec::new();
    let mut show = |Glance { frame, on_device }: Glance| {
        assert!(on_device.is_some() != frame.sets.iter().any(|set| set.len() > 400));
        kinds.push(on_device.is_some());
        frame.time + 0.1
    };
    flood.advance_shown(2.0, &AtomicBool::new(false), &mut (), (0.1, true), &mut show).unwrap();
    assert!(!kinds[0] && *kinds.last().unwrap() && kinds.is_sorted(), "{kinds:?}");
}

#[test]
fn who_is_shown_every_step_sees_the_water_that_comes_back() {
    let Some(gpu) = require_gpu("a flood shown on the GPU") else { return };
    let [mut shown, mut plain] = [(); 2].map(|()| flood(RUN, &gpu));
    let stop = AtomicBool::new(false);
    let (mut last, mut times) = (Vec::new(), Vec::new());
    let mut show = |Glance { frame, on_device }: Glance| {
        times.push(frame.time);
        last = on_device.unwrap().read(&gpu).unwrap();
        stop.store(times.len() == 50, Ordering::Relaxed);
        0.0
    };
    // Whoever plays a scene on goes on without end.
    shown.advance_shown(f64::INFINITY, &stop, &mut (), (0.0, true), &mut show).unwrap();
    assert_eq!((times.len(), shown.steps()), (50, 50));
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]) && times[49] == shown.time(), "{times:?} {}", shown.time());
    assert!(in_order(last) == seen(&shown, &gpu).0);
    // Looking does not change what the water does.
    plain.advance_to(shown.time(), &AtomicBool::new(false)).unwrap();
    assert!(plain.steps() == 50 && plain.save() == shown.save());
}

#[test]
fn who_asks_for_times_sees_the_water_of_these_times() {
    let Some(gpu) = require_gpu("water at times") else { return };
    let [mut shown, mut plain] = [(); 2].map(|()| flood(RUN, &gpu));
    // Some fall between two steps; one at the end.
    assert_shown_as_plain(&mut shown, &mut plain, 0.9, &gpu);
    assert!(shown.save() == plain.save());
}

#[test]
fn who_is_shown_has_the_gauges_of_who_is_not() {
    let Some(gpu) = require_gpu("gauges beside a flood that is shown") else { return };
    let [mut shown, mut plain] = [(); 2].map(|()| flood(RUN, &gpu));
    assert_gauges_alike(&mut shown, &mut plain, 1e-9);
}

/// Called back between two steps of the GPU, it has what the GPU came to.
#[test]
fn who_is_called_back_has_a_sound_state() {
    let Some(gpu) = require_gpu("a flood that is called back") else { return };
    let [mut shown, mut plain] = [(); 2].map(|()| flood(RUN, &gpu));
    let mut rows = Rows::until(0.55);
    let stop = AtomicBool::new(false);
    shown.advance_shown(5.0, &stop, &mut rows, (0.0, true), &mut |glance| glance.frame.time + 0.03).unwrap();
    assert!((0.55..0.65).contains(&shown.time()), "{}", shown.time());
    plain.advance_to(shown.time(), &stop).unwrap();
    assert!(shown.save() == plain.save());
}

#[test]
fn without_a_gpu_nobody_is_shown_anything() {
    assert_shows_nothing(&mut common::voronoi(&common::scene(RUN)));
}
