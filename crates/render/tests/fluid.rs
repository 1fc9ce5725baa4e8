//! Fluids in screen space: how good the surface is, and that every pass matters.

mod surface;

use corpuscle_gpu::require_gpu;
use corpuscle_render::Smoothing;
use surface::Scene;

/// The bounds are 2.5 degrees and 1 % for the narrow-range filter; what is measured is about half of the first.
#[test]
fn the_smoothed_surface_is_the_exact_one() {
    let Some(gpu) = require_gpu("the surface of a fluid") else { return };
    let scene = Scene::wavy_plane_and_ball();
    println!("{} particles", scene.droplets.len());
    let measure = |name: &str, smoothing, ranges: f64| {
        let quality = scene.measure(&gpu, smoothing, ranges);
        println!("{name:28} normals {:5.2} degrees, bleed {:5.2} %", quality.normal_error, 100.0 * quality.bleed);
        quality
    };
    let none = measure("none", Smoothing::None, 1.0);
    let once = measure("bilateral 1x", Smoothing::Bilateral(1), 1.0);
    let thrice = measure("bilateral 3x", Smoothing::Bilateral(3), 1.0);
    let narrow = measure("narrow-range", Smoothing::NarrowRange, 1.0);
    // What a filter does that knows no edges: the measure sees it.
    let blind = measure("bilateral 3x, 20 times range", Smoothing::Bilateral(3), 20.0);
    assert!(narrow.normal_error <= 1.5 && narrow.bleed <= 0.01);
    assert!(none.normal_error > 10.0 && none.bleed == 0.0);
    assert!(once.normal_error < none.normal_error && thrice.normal_error < none.normal_error);
    assert!(blind.bleed > 0.2);
}
