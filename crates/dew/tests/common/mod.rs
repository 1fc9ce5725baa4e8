//! Humid air as tests set it up.
#![allow(dead_code, reason = "each test takes what it needs")]

use corpuscle_dew::air::Properties;
use corpuscle_dew::humid_air::{HumidAir, ZERO_CELSIUS};
use corpuscle_dew::solids::{Body, Material};
use corpuscle_dew::{Dew, Face, Inflow, Room, Settings, Setup};
use corpuscle_model::Model;
use corpuscle_scene::{Scene, builtin};
use corpuscle_solids::{Pose, Shape, Solid};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Distance of particles, m.
pub const D: f64 = 2e-3;
/// Temperature of the air, K.
pub const WARM: f64 = ZERO_CELSIUS + 25.0;
/// Temperature of solids on which its vapour condenses, K.
pub const COLD: f64 = ZERO_CELSIUS + 5.0;
pub const GLASS: Material = Material { conductivity: 1.4, heat_capacity: 750.0, density: 2500.0 };

/// Mass fraction of vapour at a temperature, K, and a relative humidity.
pub fn vapour(temperature: f64, humidity: f64) -> f64 {
    HumidAir::with_relative_humidity(temperature, 101_325.0, humidity).mass_fraction()
}

/// A box of 12 x 8 x 12 particles with a cold ball in its midst, and an artificial speed of sound, m/s.
pub fn ball(faces: [[Face; 2]; 3], held: bool, sound: f64) -> Setup {
    let size = [12.0 * D, 8.0 * D, 12.0 * D];
    let solid = Solid::of_shape(Shape::sphere(3.0 * D).unwrap(), Pose::new(size.map(|side| 0.5 * side), [0.0; 3]));
    Setup {
        settings: Settings::new(D, WARM, vapour(WARM, 0.8)),
        air: Properties::at_room_temperature(sound),
        room: Room { low: [0.0; 3], high: size, faces },
        bodies: vec![Body::sampled(solid, D, GLASS, COLD, held).unwrap()],
        fans: Vec::new(),
        seed: 1,
    }
}

/// Air of a relative humidity comes in along x with a speed, m/s.
pub fn through_flow(speed: f64, humidity: f64) -> [[Face; 2]; 3] {
    let inflow = Inflow { velocity: [speed, 0.0, 0.0], temperature: WARM, vapour: vapour(WARM, humidity) };
    [[Face::Inlet(inflow), Face::Outlet], [Face::Periodic; 2], [Face::Wall; 2]]
}

/// A built-in scene of seed 1, with values changed as by `--set` and its defaults filled in.
pub fn built_in(name: &str, changes: &[(&str, &str)]) -> Dew {
    let changes: Vec<_> = changes.iter().map(|(path, value)| ((*path).to_owned(), (*value).to_owned())).collect();
    let mut scene = Scene::parse(builtin(name).unwrap().text, name, &changes).unwrap();
    scene.resolve_defaults();
    corpuscle_dew::open(scene.dew().unwrap(), 1, Path::new("")).unwrap()
}

/// Advances to a time, s.
pub fn advance(dew: &mut Dew, time: f64) {
    dew.advance_to(time, &AtomicBool::new(false)).unwrap();
}

/// The value of the gauge's column with a header.
pub fn gauge(dew: &Dew, header: &str) -> f64 {
    let at = dew.gauge_columns().iter().position(|column| column.header() == header).expect(header);
    dew.gauge_row()[at]
}

/// The same dew, stepping on a GPU.
#[cfg(feature = "gpu")]
pub fn on_gpu(mut dew: Dew, gpu: &corpuscle_gpu::Gpu) -> Dew {
    corpuscle_model::GpuModel::use_gpu(&mut dew, gpu.clone()).unwrap();
    dew
}
