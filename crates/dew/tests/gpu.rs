//! Humid air on the GPU does what it does on the CPU.

mod common;

use common::{COLD, D, GLASS, WARM, advance, on_gpu, vapour};
use corpuscle_dew::air::{Particle, Properties, Role, TemperatureCoefficients};
use corpuscle_dew::humid_air::{HumidAir, ZERO_CELSIUS};
use corpuscle_dew::solids::{Body, Material};
use corpuscle_dew::{
    Condensation, Dew, Face, Fan, Humidity, Inflow, LiveChange, LowUtility, Mean, Room, Settings, Setup, SourceChange,
    WallTreatment,
};
use corpuscle_gpu::require_gpu;
use corpuscle_model::{GpuModel, Model, ModelError};
use corpuscle_scene::{KernelName, Scene};
use corpuscle_solids::{Pose, Shape, Solid};
use std::f64::consts::TAU;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

const SIZE: [f64; 3] = [12.0 * D, 8.0 * D, 10.0 * D];

fn room(faces: [[Face; 2]; 3]) -> Setup {
    Setup {
        settings: Settings::new(D, WARM, vapour(WARM, 0.8)),
        air: Properties::of(&HumidAir::with_relative_humidity(WARM, 101_325.0, 0.8), 0.5),
        // Far from where coordinates begin.
        room: Room { low: [3.0, -2.0, 5.0], high: [3.0 + SIZE[0], -2.0 + SIZE[1], 5.0 + SIZE[2]], faces },
        bodies: Vec::new(),
        fans: Vec::new(),
        seed: 1,
    }
}

fn part(setup: &Setup, position: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| (position[axis] - setup.room.low[axis]) / SIZE[axis])
}

/// Air that turns in the room, warmer and moister here than there.
fn stirred(setup: &Setup) -> Dew {
    nudged(setup, 0.0)
}

/// The same with every second particle or so faster along x by `nudge`, m/s.
fn nudged(setup: &Setup, nudge: f64) -> Dew {
    let start = |position| {
        let [x, y, z] = part(setup, position).map(|part| (TAU * part).sin());
        [WARM + 3.0 * x * y + z, vapour(WARM, 0.7 + 0.2 * y * z)]
    };
    let mut dew = Dew::new(setup, start).unwrap();
    dew.stir(|position| {
        let [x, y, z] = part(setup, position).map(|part| TAU * part);
        [0.05 * z.sin() + nudge * (1e5 * z).sin().signum().max(0.0), 0.03 * (x + z).sin(), 0.04 * x.sin() * y.cos()]
    });
    dew
}

/// A little more than a step, lest rounding take it for less.
fn step(dew: &mut Dew, count: usize) {
    for _ in 0..count {
        dew.advance_to(dew.time() + 1.000_001 * dew.time_step(), &AtomicBool::new(false)).unwrap();
    }
}

fn by_id(dew: &Dew) -> Vec<Particle> {
    let mut air = dew.air().to_vec();
    air.sort_unstable_by_key(|particle| particle.id);
    air
}

fn largest(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).abs()).fold(0.0, f64::max)
}

/// Largest differences over all particles: position over the spacing; velocity, m/s; acceleration, m/s2; temperature, K; vapour and fog, parts
/// of the mass; density, kg/m3.
fn differences(a: &Dew, b: &Dew) -> [f64; 7] {
    let (a, b) = (by_id(a), by_id(b));
    assert_eq!(a.len(), b.len(), "particles");
    let mut most = [0.0_f64; 7];
    for (a, b) in a.iter().zip(&b) {
        assert_eq!((a.id, a.role), (b.id, b.role));
        let apart = [
            largest(a.position, b.position) / D,
            largest(a.velocity, b.velocity),
            largest(a.acceleration, b.acceleration),
            (a.temperature - b.temperature).abs(),
            (a.vapour - b.vapour).abs(),
            (a.fog - b.fog).abs(),
            (a.density - b.density).abs(),
        ];
        most = std::array::from_fn(|k| most[k].max(apart[k]));
    }
    most
}

/// Bounds of the differences after one step, and after ten.
const ONE: [f64; 7] = [3e-6, 1e-6, 1e-3, 1e-5, 1e-8, 1e-8, 2e-6];
const TEN: [f64; 7] = [1e-5, 1e-5, 1e-2, 1e-4, 1e-7, 1e-7, 1e-5];

fn all_faces() -> [(&'static str, [[Face; 2]; 3]); 3] {
    [
        ("periodic", [[Face::Periodic; 2]; 3]),
        ("walls", [[Face::Wall; 2]; 3]),
        ("mixed", [[Face::Wall; 2], [Face::Periodic; 2], [Face::Wall; 2]]),
    ]
}

/// Goes one step and nine more with both, and compares every air particle and every particle of the solids.
fn assert_as_on_the_cpu(name: &str, both: [Dew; 2]) {
    assert_as_near(name, both, TEN);
}

/// The same with bounds of its own after ten steps.
fn assert_as_near(name: &str, [mut host, mut device]: [Dew; 2], ten: [f64; 7]) {
    for (steps, most) in [(1, ONE), (9, ten)] {
        step(&mut host, steps);
        step(&mut device, steps);
        let apart = differences(&host, &device);
        assert!((0..7).all(|k| apart[k] < most[k]), "{name} after {} steps: {apart:?}", host.steps());
        assert!((device.time_step() / host.time_step() - 1.0).abs() < 1e-5);
        let solids = differences_of_solids(&host, &device);
        let most = [if steps == 1 { 1e-7 } else { 1e-6 }, 5e-5];
        assert!((0..2).all(|k| solids[k] < most[k]), "{name} after {} steps: {solids:?}", host.steps());
    }
}

/// Largest differences over all particles of the solids: temperature, K; water over the most on any, or what condenses in a part of a step.
fn differences_of_solids(a: &Dew, b: &Dew) -> [f64; 2] {
    let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let most = a.water_on_solids().iter().copied().fold(1e-13, f64::max);
    [apart(a.temperatures(), b.temperatures()), apart(a.water_on_solids(), b.water_on_solids()) / most]
}

#[test]
fn air_in_a_box_goes_as_on_the_cpu() {
    let Some(gpu) = require_gpu("air on the GPU") else { return };
    for (name, faces) in all_faces() {
        let setup = room(faces);
        assert_as_on_the_cpu(name, [stirred(&setup), on_gpu(stirred(&setup), &gpu)]);
    }
}

/// A cold ball in the midst of the room.
fn ball(faces: [[Face; 2]; 3], held: bool) -> Setup {
    let mut setup = room(faces);
    let middle = [0, 1, 2].map(|axis| setup.room.low[axis] + 0.5 * SIZE[axis]);
    let solid = Solid::of_shape(Shape::sphere(2.4 * D).unwrap(), Pose::new(middle, [0.0; 3]));
    setup.bodies.push(Body::sampled(solid, D, GLASS, COLD, held).unwrap());
    setup
}

/// A ball and a floor of another material under it, at the sides of the room.
fn ball_on_floor(faces: [[Face; 2]; 3]) -> Setup {
    let mut setup = ball(faces, false);
    let low = setup.room.low;
    let position = [low[0] + 0.5 * SIZE[0], low[1] + 0.5 * SIZE[1], low[2] + D];
    let floor = Solid::of_shape(Shape::cuboid([SIZE[0], SIZE[1], 2.0 * D]).unwrap(), Pose::new(position, [0.0; 3]));
    let oak = Material { conductivity: 0.17, heat_capacity: 2000.0, density: 545.0 };
    setup.bodies.push(Body::sampled(floor, D, oak, WARM - 10.0, true).unwrap());
    setup
}

#[test]
fn air_and_solids_go_as_on_the_cpu() {
    let Some(gpu) = require_gpu("solids on the GPU") else { return };
    for (name, faces) in all_faces() {
        for setup in [ball(faces, false), ball_on_floor(faces)] {
            assert_as_on_the_cpu(name, [stirred(&setup), on_gpu(stirred(&setup), &gpu)]);
        }
    }
}

#[test]
fn every_kernel_goes_as_on_the_cpu() {
    let Some(gpu) = require_gpu("kernels on the GPU") else { return };
    for kernel in KernelName::ALL {
        let mut setup = ball_on_floor(all_faces()[2].1);
        setup.settings.kernel = kernel;
        assert_as_on_the_cpu(&format!("{kernel:?}"), [stirred(&setup), on_gpu(stirred(&setup), &gpu)]);
    }
}

#[test]
fn every_way_to_keep_air_out_goes_as_on_the_cpu() {
    let Some(gpu) = require_gpu("walls on the GPU") else { return };
    for walls in
        [WallTreatment::DensityCorrection, WallTreatment::VirtualForce, WallTreatment::Ghosts, WallTreatment::None]
    {
        let mut setup = ball(all_faces()[2].1, true);
        (setup.settings.walls, setup.settings.kappa) = (walls, 1.1);
        assert_as_on_the_cpu(&format!("{walls:?}"), [stirred(&setup), on_gpu(stirred(&setup), &gpu)]);
    }
}

#[test]
fn published_ways_go_as_on_the_cpu() {
    let Some(gpu) = require_gpu("published ways on the GPU") else { return };
    for mean in [Mean::Harmonic, Mean::Arithmetic, Mean::Diffusivity] {
        let mut setup = ball(all_faces()[2].1, false);
        setup.settings.mean = mean;
        setup.air.coefficients = TemperatureCoefficients::default();
        setup.settings.condensation = Condensation::Particle;
        setup.settings.humidity = Humidity::Relative;
        setup.settings.time_factor = 2.0;
        assert_as_on_the_cpu(&format!("{mean:?}"), [stirred(&setup), on_gpu(stirred(&setup), &gpu)]);
    }
}

/// Air beyond saturation, by solids and away from them; fog goes where the air is drier.
#[test]
fn fog_and_what_it_lays_go_as_on_the_cpu() {
    let Some(gpu) = require_gpu("fog on the GPU") else { return };
    let setup = ball(all_faces()[2].1, false);
    let start = |position| {
        let [x, _, z] = part(&setup, position).map(|part| (TAU * part).sin());
        [WARM + x, vapour(WARM, 1.0 + 0.1 * z)]
    };
    let open = || Dew::new(&setup, start).unwrap();
    assert_as_on_the_cpu("fog", [open(), on_gpu(open(), &gpu)]);
}

#[test]
fn water_that_lies_there_evaporates_as_on_the_cpu() {
    let Some(gpu) = require_gpu("evaporation on the GPU") else { return };
    let mut setup = ball(all_faces()[2].1, false);
    setup.bodies[0].temperature = WARM + 5.0;
    setup.settings.time_factor = 20.0;
    let open = || {
        let mut dew = stirred(&setup);
        // So little that some of it is gone after ten steps.
        dew.wet(0, 2e-6);
        dew
    };
    assert_as_on_the_cpu("evaporation", [open(), on_gpu(open(), &gpu)]);
}

/// Conductivities that are averaged arithmetically, and grow with the temperature, between air and a wall that conducts little.
#[test]
fn air_that_conducts_better_where_it_is_warm_does_so_as_on_the_cpu() {
    let Some(gpu) = require_gpu("properties on the GPU") else { return };
    for mean in [Mean::Harmonic, Mean::Arithmetic] {
        let mut setup = ball_on_floor(all_faces()[2].1);
        setup.settings.mean = mean;
        // Told far from the temperatures that there are.
        setup.air.reference_temperature += 40.0;
        setup.bodies[0].material = Material { conductivity: 0.03, heat_capacity: 1000.0, density: 2000.0 };
        assert_as_on_the_cpu(&format!("{mean:?}"), [stirred(&setup), on_gpu(stirred(&setup), &gpu)]);
    }
}

/// The speed is such that no particle stands in a face after a whole number of steps, where rounding would tell on which side.
fn through_flow() -> [[Face; 2]; 3] {
    let inflow = Inflow { velocity: [0.097, 0.0, 0.0], temperature: WARM + 2.0, vapour: vapour(WARM, 0.9) };
    [[Face::Inlet(inflow), Face::Outlet], [Face::Wall, Face::Outlet], [Face::Periodic; 2]]
}

#[test]
fn air_that_comes_and_goes_does_so_as_on_the_cpu() {
    let Some(gpu) = require_gpu("faces on the GPU") else { return };
    let mut setup = ball(through_flow(), false);
    let low = setup.room.low;
    let blow = |at: f64, velocity| {
        Fan::new([0, 1, 2].map(|axis| low[axis] + at * SIZE[axis]), [4.0 * D, 6.0 * D, 3.0 * D], velocity)
    };
    setup.fans = vec![blow(0.3, [0.1, 0.1, 0.0])];
    // More fans than a few, one within the other.
    setup.fans.extend((0..12).map(|number| blow(0.8, [0.0, 0.0, -0.02 * f64::from(number)])));
    assert_as_on_the_cpu("through", [stirred(&setup), on_gpu(stirred(&setup), &gpu)]);
}

/// Sides that are open: alone, round a room, and beside air that comes in and goes out.
fn open_sides() -> [(&'static str, [[Face; 2]; 3]); 3] {
    let [[inlet, outlet], ..] = through_flow();
    [
        ("chimney", [[Face::Wall; 2], [Face::Periodic; 2], [Face::Open; 2]]),
        ("open all round", [[Face::Open; 2], [Face::Open; 2], [Face::Wall, Face::Open]]),
        ("wind along", [[inlet, outlet], [Face::Open, Face::Wall], [Face::Periodic; 2]]),
    ]
}

#[test]
fn air_outside_open_sides_goes_as_on_the_cpu() {
    let Some(gpu) = require_gpu("open sides on the GPU") else { return };
    for (name, faces) in open_sides() {
        for setup in [room(faces), ball(faces, false)] {
            assert_as_on_the_cpu(name, [stirred(&setup), on_gpu(stirred(&setup), &gpu)]);
        }
    }
}

/// A pane whose temperature is told by rows of time, s, and °C.
fn pane_held_at(rows: &str) -> Dew {
    let text = format!(
        "run.until_s = 1\n[dew]\nsize_m = [0.012, 0.012, 0.018]\nspacing_m = 0.003\n\
         air = {{ temperature_c = 30.0, relative_humidity = 0.8 }}\ndrops = {{ smallest_radius_m = 1e-4 }}\n\
         [[dew.solid]]\nname = \"pane\"\nshape = {{ box = {{ size_m = [0.006, 0.012, 0.018] }} }}\n\
         position_m = [0.0, 0.006, 0.009]\ntemperature_c = {rows}\nheld = true\n\
         [[dew.solid]]\nname = \"plate\"\nshape = {{ box = {{ size_m = [0.006, 0.012, 0.006] }} }}\n\
         position_m = [0.009, 0.006, 0.0]\ntemperature_c = 20\nheld = true\n"
    );
    let scene = Scene::parse(&text, "test", &[]).unwrap();
    corpuscle_dew::open(scene.dew().unwrap(), 1, Path::new("")).unwrap()
}

/// A ramp, a jump and another ramp within ten steps, and a ramp that begins after hundred.
#[test]
fn temperatures_held_change_as_on_the_cpu() {
    let Some(gpu) = require_gpu("temperatures that change on the GPU") else { return };
    let step = pane_held_at("5").time_step();
    let rows = [[0.0, 20.0], [4.3, 10.0], [4.3, 15.0], [7.7, 2.0], [120.0, 2.0], [200.0, 30.0]];
    let rows = format!("{:?}", rows.map(|[steps, celsius]| [steps * step, celsius]));
    let open = || pane_held_at(&rows);
    assert_as_on_the_cpu("changing", [open(), on_gpu(open(), &gpu)]);
    let [mut host, seldom, often] = [(); 3].map(|()| open());
    let [mut seldom, mut often] = [seldom, often].map(|dew| on_gpu(dew, &gpu));
    let time = 160.0 * step;
    advance(&mut host, time);
    advance(&mut seldom, time);
    for look in 1..=7 {
        advance(&mut often, time * f64::from(look) / 7.0);
    }
    assert!(bits(&seldom) == bits(&often) && seldom.steps() == host.steps());
    assert!(differences_of_solids(&host, &seldom)[0] < 1e-5, "{:?}", differences_of_solids(&host, &seldom));
    let celsius = host.temperatures()[0] - ZERO_CELSIUS;
    assert!(celsius > 14.0 && celsius < 18.0, "{celsius}: amid the last ramp");
}

/// A wind, faster above, that leads over the edge between two open sides: what crosses both in one step is taken out.
/// A pane that is heated in turns, loses heat to changing air and sky outside, and radiates, beside a warm ball that radiates too; and a floor without.
fn heated(factor: f64) -> Dew {
    let text = format!(
        "run.until_s = 1\n[dew]\nsize_m = [0.018, 0.012, 0.016]\nspacing_m = 0.002\ntime_factor = {factor}\n\
         air = {{ temperature_c = 25, relative_humidity = 0.8 }}\ndrops.smallest_radius_m = 3e-4\n\
         [[dew.solid]]\nname = \"pane\"\nshape = {{ box = {{ size_m = [0.004, 0.012, 0.012] }} }}\nposition_m = [0.002, 0.006, 0.008]\ntemperature_c = 5\n\
         heater = {{ power_w = [[0, 3], [0.03, 3], [0.03, 0], [0.05, 1]] }}\n\
         outside = {{ side = \"x_min\", temperature_c = [[0, -10], [0.1, 0]], h_w_per_m2_k = 40, emissivity = 0.9, surroundings_c = -40, \
         layers = [{{ resistance_m2_k_per_w = 0.01 }}, {{ material = \"aluminium\", thickness_m = 0.001 }}, {{ material = \"polycarbonate\", thickness_m = 0.002 }}] }}\n\
         radiation = {{ emissivity = 0.8, surroundings_c = [[0, 60], [0.2, 20]] }}\n\
         [[dew.solid]]\nname = \"floor\"\nshape = {{ box = {{ size_m = [0.014, 0.012, 0.002] }} }}\nposition_m = [0.011, 0.006, 0.001]\ntemperature_c = 10\nheld = true\n\
         [[dew.solid]]\nname = \"ball\"\nmaterial = \"oak\"\nshape = {{ sphere = {{ radius_m = 0.003 }} }}\nposition_m = [0.0113, 0.0061, 0.0092]\ntemperature_c = 90\n\
         heater = {{ power_w_per_m2 = 500 }}\nradiation = {{ emissivity = 0.9, surroundings_c = 25 }}\n"
    );
    let scene = Scene::parse(&text, "test", &[]).unwrap();
    corpuscle_dew::open(scene.dew().unwrap(), 1, Path::new("")).unwrap()
}

#[test]
fn solids_are_heated_and_cooled_as_on_the_cpu() {
    let Some(gpu) = require_gpu("heaters on the GPU") else { return };
    for factor in [1.0, 5.0] {
        let [mut host, mut device] = [heated(factor), on_gpu(heated(factor), &gpu)];
        for (time, most) in [(0.01, 1e-5), (0.1, 1e-3), (0.15, 1.5e-3)] {
            for dew in [&mut host, &mut device] {
                advance(dew, time);
                if time == 0.1 {
                    for change in [
                        SourceChange::HeaterTimes { solid: 0, times: 3.0 },
                        SourceChange::OutsideTemperature { solid: 0, celsius: -20.0 },
                        SourceChange::Surroundings { solid: 2, celsius: 200.0 },
                    ] {
                        LiveChange::Source(change).change(dew).unwrap();
                    }
                }
            }
            let [temperature, _] = differences_of_solids(&host, &device);
            assert!(temperature < most, "after {time} s by {factor}: {temperature}");
            for body in 0..3 {
                let (host, device) = (host.heat_supplied(body), device.heat_supplied(body));
                assert!((0..3).all(|kind| near(host[kind], device[kind], 1e-4)), "{body}: {host:?} {device:?}");
            }
            for header in ["pane.outside.1.mean_temperature_K", "pane.outside.2.mean_temperature_K"] {
                let [host, device] = [&host, &device].map(|dew| {
                    let at = dew.gauge_columns().iter().position(|column| column.header() == header).unwrap();
                    dew.gauge_row()[at]
                });
                assert!((host - device).abs() < 40.0 * most, "{header}: {host} {device}");
            }
            for dew in [&host, &device] {
                assert!(dew.heat_supplied(0).iter().all(|heat| heat.abs() > 1e-4), "{:?}", dew.heat_supplied(0));
                for balance in dew.ledger().balances {
                    assert!(balance.relative_error().abs() < 2e-6, "{balance:?}");
                }
            }
        }
    }
}

#[test]
fn air_leaves_by_edges_as_on_the_cpu() {
    let Some(gpu) = require_gpu("edges on the GPU") else { return };
    let setup = room(open_sides()[1].1);
    let open = || {
        let mut dew = stirred(&setup);
        dew.stir(|position| [1.01, 1.0, 0.0].map(|along| along * (0.08 + 0.06 * part(&setup, position)[2])));
        dew
    };
    let mut host = open();
    let inside = by_id(&host).into_iter().filter(|particle| particle.role == Role::Inside);
    step(&mut host, 10);
    let after = by_id(&host);
    let gone = inside.filter(|before| after.iter().all(|particle| particle.id != before.id)).count();
    assert!(gone > 0, "none has left by an edge");
    assert_as_on_the_cpu("edges", [open(), on_gpu(open(), &gpu)]);
}

/// Air of low utility beyond one spacing from the solids, taken out soon after.
fn with_low_utility(mut setup: Setup) -> Setup {
    setup.settings.low_utility = Some(LowUtility { distance: 0.5, after: 0.02 });
    setup
}

/// A floor: the distance from it is the height above it, which is known exactly between nodes too.
fn floor(faces: [[Face; 2]; 3]) -> Setup {
    let mut setup = room(faces);
    let low = setup.room.low;
    let position = [low[0] + 0.5 * SIZE[0], low[1] + 0.5 * SIZE[1], low[2] + D];
    let solid = Solid::of_shape(Shape::cuboid([SIZE[0], SIZE[1], 2.0 * D]).unwrap(), Pose::new(position, [0.0; 3]));
    let mut body = Body::sampled(solid, D, GLASS, COLD, true).unwrap();
    body.surface = Some(Arc::new(move |position: [f64; 3]| position[2] - low[2] - 2.0 * D));
    setup.bodies.push(body);
    setup
}

fn idle(dew: &Dew) -> usize {
    dew.air().iter().filter(|particle| particle.role == Role::Idle).count()
}

#[test]
fn air_of_low_utility_goes_as_on_the_cpu() {
    let Some(gpu) = require_gpu("air of low utility on the GPU") else { return };
    for (name, faces) in [all_faces()[2], ("through", through_flow())] {
        let setup = with_low_utility(floor(faces));
        let mut host = stirred(&setup);
        step(&mut host, 1);
        assert!(idle(&host) > 50 && 2 * idle(&host) < host.air().len(), "{name}: {}", idle(&host));
        // Beside air that only moves on, what rounding leaves grows tenfold within ten steps: as far as on the CPU, where velocities change by as much
        // as moves particles by what single precision leaves after a step.
        let (mut plain, mut moved) = (stirred(&setup), nudged(&setup, 1e-6));
        step(&mut plain, 10);
        step(&mut moved, 10);
        let grown = differences(&plain, &moved);
        let ten = std::array::from_fn(|k| TEN[k].max(grown[k]));
        assert_as_near(name, [stirred(&setup), on_gpu(stirred(&setup), &gpu)], ten);
        // It is looked for a second time, when air is driven too.
        let (mut host, mut device) = (stirred(&setup), on_gpu(stirred(&setup), &gpu));
        step(&mut host, 12);
        step(&mut device, 12);
        assert!(differences(&host, &device)[0] < 2e-5, "{name}: {:?}", differences(&host, &device));
    }
}

/// Round a ball the distance between nodes is not exact: of some hundred particles one may be found useless that is not.
#[test]
fn air_of_low_utility_is_found_round_a_ball_and_taken_out() {
    let Some(gpu) = require_gpu("air of low utility on the GPU") else { return };
    let setup = with_low_utility(ball([[Face::Wall; 2]; 3], true));
    let (mut host, mut device) = (stirred(&setup), on_gpu(stirred(&setup), &gpu));
    let before = host.air().len();
    step(&mut host, 1);
    step(&mut device, 1);
    let differ = by_id(&host).iter().zip(by_id(&device)).filter(|(a, b)| a.role != b.role).count();
    assert!(idle(&host) > 100 && differ <= 2, "{differ} of {}", idle(&host));
    step(&mut host, 60);
    let time = host.time() + 0.5 * host.time_step();
    advance(&mut device, time);
    let [out, on_gpu] = [&host, &device].map(|dew| before - dew.air().len());
    assert!(out > 20 && out.abs_diff(on_gpu) <= 2, "{out} and {on_gpu} of {before} taken out");
    for balance in device.ledger().balances {
        assert!(balance.outflow > 0.0 && balance.relative_error().abs() < 1e-7, "{balance:?}");
    }
}

#[test]
fn live_changes_act_on_the_gpu() {
    let Some(gpu) = require_gpu("live changes on the GPU") else { return };
    let setup = ball(through_flow(), true);
    let changed = |mut dew: Dew| {
        step(&mut dew, 3);
        for change in [
            LiveChange::SolidTemperature { solid: 0, celsius: 1.0 },
            LiveChange::Wind { face: [0, 0], axis: 0, velocity: 0.2 },
            LiveChange::InletTemperature { face: [0, 0], celsius: 30.0 },
        ] {
            change.change(&mut dew).unwrap();
        }
        dew
    };
    assert_as_on_the_cpu("changed", [changed(stirred(&setup)), changed(on_gpu(stirred(&setup), &gpu))]);
}

fn near(a: f64, b: f64, relative: f64) -> bool {
    (a - b).abs() <= relative * a.abs().max(b.abs())
}

/// Totals after hundred steps, layers of air that come in among them, and what the GPU itself keeps.
#[test]
fn totals_go_as_on_the_cpu() {
    let Some(gpu) = require_gpu("totals on the GPU") else { return };
    let [_, round, along] = open_sides();
    for (name, faces) in [("walls", [[Face::Wall; 2]; 3]), ("through", through_flow()), round, along] {
        for (held, time_factor) in [(false, 1.0), (true, 1.0), (false, 5.0)] {
            let mut setup = ball(faces, held);
            setup.settings.time_factor = time_factor;
            let (mut host, mut device) = (stirred(&setup), on_gpu(stirred(&setup), &gpu));
            step(&mut host, 100);
            let time = host.time() + 0.5 * host.time_step();
            advance(&mut device, time);
            assert_eq!(host.steps(), device.steps());
            let newest = |dew: &Dew| dew.air().iter().map(|particle| particle.id).max();
            assert_eq!(newest(&host), newest(&device), "{name}");
            assert!(differences(&host, &device)[0] < 1e-3, "{name}: {:?}", differences(&host, &device));
            let columns = host.gauge_columns();
            for ((column, a), b) in columns.iter().zip(host.gauge_row()).zip(device.gauge_row()) {
                assert!(near(a, b, 2e-5), "{name}, {}.{}: {a} and {b}", column.gauge, column.quantity);
            }
            for (host, device) in host.ledger().balances.iter().zip(device.ledger().balances) {
                assert!(device.relative_error().abs() < 1e-7, "{name} {device:?}: {:e}", device.relative_error());
                let both = [(host.inflow, device.inflow), (host.outflow, device.outflow), (host.now, device.now)];
                assert!(both.iter().all(|&(a, b)| near(a, b, 1e-6)), "{name}: {host:?} and {device:?}");
            }
        }
    }
}

/// Air that comes in ever warmer and with a jump of its humidity, in three steps of the GPU's batches and more.
#[test]
fn air_that_comes_in_over_time_does_so_as_on_the_cpu() {
    let Some(gpu) = require_gpu("air that changes with time on the GPU") else { return };
    let open = || {
        let text = "run.until_s = 1\n[dew]\nsize_m = [0.03, 0.012, 0.012]\nspacing_m = 0.003\n\
            air = { temperature_c = 20, relative_humidity = 0.4, velocity_m_per_s = [0.097, 0, 0] }\n\
            [dew.faces]\ny_min = \"periodic\"\ny_max = \"periodic\"\nx_max = \"outflow\"\n\
            [dew.faces.x_min.inflow]\nvelocity_m_per_s = [0.097, 0, 0]\ntemperature_c = [[0, 20], [0.5, 30]]\n\
            relative_humidity = [[0, 0.4], [0.22, 0.4], [0.22, 0.7], [0.5, 0.5]]\n";
        let scene = Scene::parse(text, "test", &[]).unwrap();
        corpuscle_dew::open(scene.dew().unwrap(), 1, Path::new("")).unwrap()
    };
    let (mut host, mut device) = (open(), on_gpu(open(), &gpu));
    step(&mut host, 220);
    assert!((0.28..0.35).contains(&host.time()), "{}", host.time());
    let time = host.time() + 0.5 * host.time_step();
    advance(&mut device, time);
    assert_eq!(host.steps(), device.steps());
    for balance in device.ledger().balances {
        assert!(balance.relative_error().abs() < 1e-7, "{balance:?}: {:e}", balance.relative_error());
    }
    let (host, device) = (by_id(&host), by_id(&device));
    assert_eq!(host.len(), device.len());
    // As they came in: what they exchange with the room later on is the subject of other tests.
    let mut warmest: f64 = 0.0;
    for (a, b) in host.iter().zip(&device).filter(|(a, _)| matches!(a.role, Role::Coming(..))) {
        assert!((a.temperature - b.temperature).abs() < 1e-5, "{a:?} and {b:?}");
        assert!((a.vapour - b.vapour).abs() < 1e-8, "{a:?} and {b:?}");
        warmest = warmest.max(a.temperature);
    }
    assert!(warmest > 20.0 + ZERO_CELSIUS + 5.0, "{warmest}");
}

/// The bits of the air and of the solids, and the time.
fn bits(dew: &Dew) -> Vec<u64> {
    let air = by_id(dew);
    let of_air = air.iter().flat_map(|p| [p.position, p.velocity, [p.temperature, p.vapour, p.fog]]).flatten();
    let of_solids = dew.temperatures().iter().chain(dew.water_on_solids()).copied();
    of_air.chain(of_solids).chain([dew.time(), dew.time_step()]).map(f64::to_bits).collect()
}

#[test]
fn looking_more_often_changes_nothing() {
    let Some(gpu) = require_gpu("looks at the GPU") else { return };
    let setup = ball(through_flow(), false);
    let [mut seldom, mut often] = [(); 2].map(|()| on_gpu(stirred(&setup), &gpu));
    advance(&mut seldom, 0.15);
    for look in 1..=30 {
        advance(&mut often, 0.15 * f64::from(look) / 30.0);
        often.frame();
    }
    assert!(seldom.steps() > 70 && bits(&seldom) == bits(&often));
}

#[test]
fn a_state_of_the_gpu_goes_on_on_the_cpu_and_back() {
    let Some(gpu) = require_gpu("checkpoints of the GPU") else { return };
    let setup = ball(through_flow(), false);
    let [mut host, mut device, mut other] =
        [stirred(&setup), on_gpu(stirred(&setup), &gpu), on_gpu(stirred(&setup), &gpu)];
    step(&mut device, 5);
    let saved = device.save();
    host.restore(&saved).unwrap();
    other.restore(&saved).unwrap();
    assert_eq!((host.backend(), other.backend()), ("cpu", "gpu"));
    assert_eq!((host.time(), host.steps(), by_id(&host)), (device.time(), device.steps(), by_id(&device)));
    for dew in [&mut device, &mut host, &mut other] {
        step(dew, 5);
    }
    for dew in [&host, &other] {
        let apart = differences(dew, &device);
        assert!((0..7).all(|k| apart[k] < TEN[k]), "{apart:?}");
        assert!(differences_of_solids(dew, &device)[0] < 1e-6);
    }
}

#[test]
fn what_the_gpu_cannot_compute_is_refused_by_name() {
    let Some(gpu) = require_gpu("refusals by the GPU") else { return };
    let mut setup = ball([[Face::Wall; 2]; 3], false);
    setup.fans = vec![Fan::new([0.0; 3], [1.0; 3], [1.0, 0.0, 0.0]); 1025];
    let mut dew = stirred(&setup);
    let error = dew.use_gpu(gpu).unwrap_err();
    assert!(matches!(error, ModelError::Setup(_)) && dew.backend() == "cpu");
    for what in ["[[dew.fan]]", "--backend cpu"] {
        assert!(error.to_string().contains(what), "{error}");
    }
}

#[test]
fn a_lost_gpu_leaves_the_state_of_before() {
    let Some(gpu) = require_gpu("a GPU that is lost") else { return };
    let mut dew = on_gpu(built_in("dew/pane"), &gpu);
    advance(&mut dew, 0.05);
    let saved = dew.save();
    gpu.device.destroy();
    let error = dew.advance_to(0.1, &AtomicBool::new(false)).unwrap_err();
    assert!(matches!(error, ModelError::Device(_)), "{error}");
    assert!(dew.save() == saved && dew.time() == 0.05);
}

#[test]
fn air_that_cannot_go_on_breaks_down_with_an_error() {
    let Some(gpu) = require_gpu("a breakdown on the GPU") else { return };
    let setup = ball([[Face::Wall; 2]; 3], false);
    let mut dew = Dew::new(&setup, |_| [WARM, vapour(WARM, 0.8)]).unwrap();
    dew.stir(
        |position| if position[0] > setup.room.low[0] + 0.5 * SIZE[0] { [1e20, 0.0, 0.0] } else { [-1e20, 0.0, 0.0] },
    );
    let mut dew = on_gpu(dew, &gpu);
    let error = dew.advance_to(1.0, &AtomicBool::new(false)).unwrap_err();
    assert!(matches!(error, ModelError::Breakdown { .. }), "{error}");
}

/// A built-in scene with drops that are soon seen; its seed is 1. In the pane's a layer of air that comes in stands in the side of the box to rounding after ten steps.
fn built_in(name: &str) -> Dew {
    let changes = [("dew.drops.smallest_radius_m", "5e-6"), ("dew.drops.sites_per_m2", "1e8")];
    common::built_in(name, &changes)
}

/// Drops as frames show them: number, mass, the largest, and where they are on average.
fn drops(dew: &Dew) -> [f64; 6] {
    let set = dew.frame().sets.into_iter().find(|set| set.name == "drops").unwrap();
    let mean =
        |axis: usize| set.position.iter().map(|position| position[axis]).sum::<f64>() / set.position.len() as f64;
    let largest = set.mass.iter().copied().fold(0.0, f64::max);
    [set.id.len() as f64, set.mass.iter().sum(), largest, mean(0), mean(1), mean(2)]
}

/// Drops are the host's, on a held pane and on a lens that warms; it makes no difference how often something looks.
#[test]
fn drops_beside_the_gpu_go_as_on_the_cpu() {
    let Some(gpu) = require_gpu("drops beside the GPU") else { return };
    for (name, time) in [("dew/pane", 0.1), ("dew/lens", 0.1)] {
        let [mut host, seldom, often] = [(); 3].map(|()| built_in(name));
        let [mut seldom, mut often] = [seldom, often].map(|dew| on_gpu(dew, &gpu));
        advance(&mut host, time);
        advance(&mut seldom, time);
        for look in 1..=7 {
            advance(&mut often, time * f64::from(look) / 7.0);
        }
        assert!(drops(&host)[0] > 100.0 && host.steps() == seldom.steps(), "{name}");
        assert!((0..6).all(|k| near(drops(&host)[k], drops(&seldom)[k], 1e-4)), "{name}");
        assert!(bits(&seldom) == bits(&often) && drops(&seldom) == drops(&often), "{name}");
        assert!(seldom.ledger().balances.iter().all(|balance| balance.relative_error().abs() < 1e-6));
    }
}
