//! What is drawn on the card is what the frame has.

use corpuscle_flood::Flood;
use corpuscle_gpu::{DeviceParticle, Gpu, require_gpu};
use corpuscle_model::{Model, Values};
use corpuscle_scene::Scene;
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Water runs fast against a house, over the eastern side, and a block of it falls.
const FALL: &str = r#"
run.until_s = 60
terrain.rough-hills = { extent = { length_m = 60, width_m = 40, cell_m = 1 }, relief_m = 2, hill_size_m = 30 }
[flood]
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

/// Scheme paper, whose particles are all drawn with one radius.
const PAPER: &str = r#"
run.until_s = 60
terrain.plane = { extent = { length_m = 30, width_m = 20, cell_m = 1 }, slope_east = -0.02 }
[flood]
scheme = "paper"
spacing_m = 1
spacing_depth_m = 1
edges = { west = "wall", east = "wall", south = "wall", north = "wall" }
water = [{ depth_m = 1, velocity_m_per_s = [1, 0.5] }]
paper = { radius_m = 0.3 }
"#;

fn open(text: &str) -> Flood {
    let mut scene = Scene::parse(text, "test", &[]).unwrap();
    scene.resolve_defaults();
    let scene = scene.flood().unwrap();
    let terrain = Terrain::open(&scene.terrain, 1, Path::new(".")).unwrap();
    Flood::new(&scene.flood, 1, Path::new("."), Arc::new(terrain)).unwrap()
}

fn on_card(text: &str, gpu: &Gpu) -> Flood {
    let mut flood = open(text);
    flood.use_card(gpu.clone()).unwrap();
    flood
}

/// The particles as they lie on the card, by ids, and where they are counted from.
fn seen(flood: &Flood, gpu: &Gpu) -> (Vec<DeviceParticle>, [f64; 3]) {
    let particles = flood.on_device().unwrap().unwrap();
    let mut all = particles.read(gpu).unwrap();
    all.sort_unstable_by_key(|particle| particle.id);
    (all, particles.origin)
}

/// Compares them with the frame, which must have `in_air` of them in the air.
fn compare(flood: &Flood, gpu: &Gpu, in_air: bool) {
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
        let same = axes.clone().all(|axis| near(particle.place[axis], set.position[index][axis] - origin[axis]))
            && axes.clone().all(|axis| near(particle.velocity[axis], set.velocity[index][axis]))
            && near(particle.spacing, 2.0 * set.radius[index])
            && near(particle.depth, depths[index])
            && near(particle.volume, set.mass[index] / 1000.0);
        let frame = (set.position[index], set.velocity[index], set.radius[index], depths[index], set.mass[index]);
        assert!(same, "{particle:?} from {origin:?}, {frame:?}");
    }
}

#[test]
fn particles_on_the_card_are_those_of_the_frame() {
    let Some(gpu) = require_gpu("a flood drawn where it lies") else { return };
    for (text, in_air) in [(FALL, true), (PAPER, false)] {
        let mut flood = on_card(text, &gpu);
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
    let Some(gpu) = require_gpu("a flood shown on the card") else { return };
    let [mut shown, mut plain] = [(); 2].map(|()| on_card(FALL, &gpu));
    let stop = AtomicBool::new(false);
    let (mut last, mut times) = (Vec::new(), Vec::new());
    let mut show = |time: f64, particles: &corpuscle_gpu::DeviceParticles| {
        times.push(time);
        last = particles.read(&gpu).unwrap();
        stop.store(times.len() == 90, Ordering::Relaxed);
    };
    shown.advance_shown(60.0, &stop, &mut show).unwrap();
    assert_eq!((times.len(), shown.steps()), (90, 90));
    assert!(times.is_sorted() && (times[89] / shown.time() - 1.0).abs() < 0.1, "{times:?} {}", shown.time());
    last.sort_unstable_by_key(|particle| particle.id);
    assert!(last == seen(&shown, &gpu).0);
    // Looking does not change what the water does. A little more, lest rounding take the last step for less.
    plain.advance_to(shown.time() + 1e-3 * shown.time_step(), &AtomicBool::new(false)).unwrap();
    assert_eq!(plain.steps(), 90);
    assert!(plain.particles() == shown.particles());
}

#[test]
fn without_a_card_nobody_is_shown_anything() {
    let Some(gpu) = require_gpu("a flood without a card") else { return };
    assert!(on_card(PAPER, &gpu).card().is_some_and(|card| card.device == gpu.device));
    let mut flood = open(PAPER);
    assert!(flood.card().is_none() && flood.on_device().unwrap().is_none());
    flood.advance_shown(0.5, &AtomicBool::new(false), &mut |_, _| panic!("there is no card")).unwrap();
    assert!(flood.time() == 0.5 && flood.steps() > 0);
}
