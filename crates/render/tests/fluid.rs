//! Fluids in screen space: how good the surface is, and that every pass matters.

mod surface;

use corpuscle_gpu::require_gpu;
use corpuscle_render::Smoothing;
use surface::{Quality, Scene};

#[test]
fn the_smoothed_surface_is_the_exact_one() {
    let Some(gpu) = require_gpu("the surface of a fluid") else { return };
    let scene = Scene::wavy_plane_and_ball();
    println!("{} particles", scene.droplets.len());
    let measure = |name: &str, smoothing| {
        let quality = scene.measure(&gpu, smoothing);
        println!("{name:15} normals {:5.2} degrees, bleed {:5.2} %", quality.normal_error, 100.0 * quality.bleed);
        quality
    };
    let none = measure("none", Smoothing::None);
    let once: Quality = measure("bilateral 1x", Smoothing::Bilateral(1));
    let thrice = measure("bilateral 3x", Smoothing::Bilateral(3));
    let narrow = measure("narrow-range", Smoothing::NarrowRange);
    assert!(narrow.normal_error <= 2.5 && narrow.bleed <= 0.01);
    assert!(none.normal_error > 10.0 && none.bleed == 0.0);
    assert!(once.normal_error < none.normal_error && thrice.normal_error < once.normal_error);
}
