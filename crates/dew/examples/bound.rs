//! Scratch.
use corpuscle_dew::air::*;
use corpuscle_dew::solids::*;
use corpuscle_dew::*;
use corpuscle_model::Model;
use corpuscle_solids::{Pose, Shape, Solid};
use std::sync::atomic::AtomicBool;
use std::time::Instant;
const GLASS: corpuscle_dew::solids::Material =
    corpuscle_dew::solids::Material { conductivity: 1.4, heat_capacity: 750.0, density: 2500.0 };

fn measure(name: &str, treatment: WallTreatment) {
    let d = 0.001;
    let c = 1.0;
    let (size, solid, drive, speed, area): ([f64; 3], Solid, [f64; 3], [f64; 3], Box<dyn Fn(f64) -> f64>) = match name {
        "plane" | "column" => {
            let s = [10.0 * d, 10.0 * d, 26.0 * d];
            // wider than the room and symmetric: slab
            let slab = Solid::of_shape(
                Shape::cuboid([10.0 * d, 10.0 * d, 4.0 * d]).unwrap(),
                Pose::new([5.0 * d, 5.0 * d, 2.0 * d], [0.0; 3]),
            );
            let g = 0.03 * c * c / (22.0 * d);
            (
                s,
                slab,
                [0.0, 0.0, -g],
                [0.0, 0.0, if name == "plane" { -0.05 * c } else { 0.0 }],
                Box::new(move |s| 100.0 * d * d * s),
            )
        }
        "cylinder" => {
            let s = [24.0 * d, 8.0 * d, 24.0 * d];
            let cyl = Solid::of_shape(
                Shape::cylinder(5.0 * d, 8.0 * d).unwrap(),
                Pose::new([12.0 * d, 4.0 * d, 12.0 * d], [90.0, 0.0, 0.0]),
            );
            (
                s,
                cyl,
                [0.0005 * c * c / (24.0 * d), 0.0, 0.0],
                [0.05 * c, 0.0, 0.0],
                Box::new(move |s| std::f64::consts::PI * 8.0 * d * ((5.0 * d + s).powi(2) - 25.0 * d * d)),
            )
        }
        _ => {
            let s = [20.0 * d; 3];
            let b = Solid::of_shape(Shape::sphere(5.0 * d).unwrap(), Pose::new([10.0 * d; 3], [0.0; 3]));
            (
                s,
                b,
                [0.0005 * c * c / (24.0 * d), 0.0, 0.0],
                [0.05 * c, 0.0, 0.0],
                Box::new(move |s| 4.0 / 3.0 * std::f64::consts::PI * ((5.0 * d + s).powi(3) - (5.0 * d).powi(3))),
            )
        }
    };
    let z = if name == "plane" || name == "column" { Face::Wall } else { Face::Periodic };
    let room = Room { low: [0.0; 3], high: size, faces: [[Face::Periodic; 2], [Face::Periodic; 2], [z; 2]] };
    let air = Properties { viscosity: 1e-5, ..Properties::at_room_temperature(c) };
    let mut settings = Settings::new(d, 293.0, 0.0);
    settings.walls = treatment;
    settings.kappa = std::env::var("K").map_or(1.0, |k| k.parse().unwrap());
    settings.body_acceleration = drive;
    settings.gravity = [0.0; 3];
    settings.fog = false;
    // The slab's sides and bottom lie in faces of the room: distance to its top counts.
    let flat = name == "plane" || name == "column";
    let probe = solid.clone();
    let sd = move |p: [f64; 3]| {
        if flat {
            p[2] - 4.0 * d
        } else {
            if true {
                let mut best = probe.signed_distance(p);
                if !flat {
                    best = match probe_kind(&probe) {
                        _ => best,
                    };
                }
                best
            } else {
                0.0
            }
        }
    };
    let mut body = Body::sampled(solid.clone(), d, GLASS, 293.0, true).unwrap();
    // a cylinder through the room: its ends are not surface
    let cyl = name == "cylinder";
    let sd2 = move |p: [f64; 3]| {
        if cyl { ((p[0] - 12.0 * d).powi(2) + (p[2] - 12.0 * d).powi(2)).sqrt() - 5.0 * d } else { sd(p) }
    };
    let sd3 = std::sync::Arc::new(sd2);
    let s4 = sd3.clone();
    body.surface = Some(std::sync::Arc::new(move |p| s4(p)));
    let t0 = Instant::now();
    let mut dew = Dew::new(&Setup { settings, air, room, bodies: vec![body], seed: 1 }, |_| [293.0, 0.0]).unwrap();
    let setup = t0.elapsed().as_secs_f64();
    dew.stir(|_| speed);
    let mut deepest = f64::INFINITY;
    println!("start deepest {:.3} ", dew.air().iter().map(|p| sd3(p.position)).fold(9.0, f64::min) / d);
    let n_air = dew.air().len();
    let end = 400.0 * d / c;
    let t0 = Instant::now();
    let mut t = 0.0;
    let (mut gaps, mut layers, mut looks) = (0.0, 0.0, 0.0);
    while t < end {
        t += 2.0 * d / c;
        dew.advance_to(t, &AtomicBool::new(false)).unwrap();
        let s: Vec<f64> = dew.air().iter().map(|p| sd3(p.position)).collect();
        deepest = s.iter().cloned().fold(deepest, f64::min);
        if std::env::args().count() > 3 && (t / (20.0 * d / c)).fract() < 0.09 {
            let mut v: Vec<(f64, [f64; 3])> =
                dew.air().iter().zip(&s).map(|(p, s)| (s / d, p.position.map(|x| x / d))).collect();
            v.sort_by(|a, b| a.0.total_cmp(&b.0));
            println!("{:.0} {:.3?}", t * c / d, &v[..3]);
        }
        if t > 0.5 * end {
            // bulk number density: between 3 and 5 spacings
            let count = |a: f64, b: f64| s.iter().filter(|&&x| x >= a * d && x < b * d).count() as f64;
            let bulk = if flat {
                count(3.0, 9.0) / (area(9.0 * d) - area(3.0 * d))
            } else {
                (n_air as f64 - s.iter().filter(|&&x| x < 3.0 * d).count() as f64)
                    / (size.iter().product::<f64>()
                        - dew.solids().particles.iter().map(|p| p.volume).sum::<f64>()
                        - area(3.0 * d))
            };
            let mut gap = 0.0;
            for k in 0..20 {
                let s0 = 2.0 + 0.1 * k as f64 + 0.05;
                gap +=
                    (area(s0 * d) - count(-9.0, s0) / bulk) / (area(1.001 * s0 * d) - area(s0 * d)) * 0.001 * s0 / 20.0;
            }
            // crude: divide by local shell area
            gaps += gap;
            let near: Vec<&Particle> =
                dew.air().iter().zip(&s).filter(|(_, s)| **s < 1.0 * d).map(|(p, _)| p).collect();
            let far: Vec<&Particle> =
                dew.air().iter().zip(&s).filter(|(_, s)| **s > 2.0 * d && **s < 4.0 * d).map(|(p, _)| p).collect();
            let mean = |v: &Vec<&Particle>| v.iter().map(|p| p.density).sum::<f64>() / v.len() as f64;
            layers += mean(&near) / mean(&far);
            looks += 1.0;
        }
    }
    let wall = t0.elapsed().as_secs_f64();
    let umax = dew.air().iter().map(|p| p.speed_squared()).fold(0.0, f64::max).sqrt();
    let rates = dew.particle_steps() as f64 / wall;
    println!(
        "{name} {treatment:?} n={} steps {} deepest/d {:.3} gap/d {:.3} layer {:.4} umax {:.3} setup {setup:.2}s rate {:.2}M/s",
        dew.air().len(),
        dew.steps(),
        deepest / d,
        gaps / looks,
        layers / looks,
        umax,
        rates / 1e6
    );
}
fn probe_kind(_: &Solid) -> u8 {
    0
}
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let t = match args[2].as_str() {
        "d" => WallTreatment::DensityCorrection,
        "g" => WallTreatment::Ghosts,
        "v" => WallTreatment::VirtualForce,
        _ => WallTreatment::None,
    };
    measure(&args[1], t);
}
