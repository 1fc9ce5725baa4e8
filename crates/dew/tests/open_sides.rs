//! Air that comes and goes: open sides, slanting wind, fans.

mod common;

use common::{D, GLASS, WARM, advance, vapour};
use corpuscle_dew::air::{Particle, Properties, Role};
use corpuscle_dew::solids::{Body, Material};
use corpuscle_dew::{Dew, Face, Fan, Inflow, Room, Scatter, Settings, Setup};
use corpuscle_model::Model;
use corpuscle_solids::{Pose, Shape, Solid};

fn inside(dew: &Dew) -> impl Iterator<Item = &Particle> {
    dew.air().iter().filter(|particle| particle.role == Role::Inside)
}

/// Mean velocity along an axis, m/s.
fn mean(dew: &Dew, axis: usize) -> f64 {
    inside(dew).map(|particle| particle.velocity[axis]).sum::<f64>() / inside(dew).count() as f64
}

fn setup(size: [f64; 3], faces: [[Face; 2]; 3], sound: f64) -> Setup {
    Setup {
        settings: Settings::new(D, WARM, 0.0),
        air: Properties { conductivity: 0.0, vapour_diffusivity: 0.0, ..Properties::at_room_temperature(sound) },
        room: Room { low: [0.0; 3], high: size, faces },
        bodies: Vec::new(),
        fans: Vec::new(),
        seed: 1,
    }
}

/// Warm air in a chimney: it rises, and ambient air follows from below. With the height H, the way x of the air, its speed u and its
/// lightness b, H du/dt = g b (H - x) - u^2 / 2: the air that comes in was at rest.
#[test]
fn warm_air_leaves_a_chimney_as_fast_as_it_should() {
    let height = 40.0 * D;
    let lightness = 0.05;
    let faces = [[Face::Wall; 2], [Face::Periodic; 2], [Face::Open; 2]];
    let fastest = (2.0 * 9.81 * lightness * height).sqrt();
    let setup = setup([6.0 * D, 6.0 * D, height], faces, 10.0 * fastest);
    let mut dew = Dew::new(&setup, |_| [WARM * (1.0 + lightness), 0.0]).unwrap();
    let [mut time, mut way, mut speed] = [0.0; 3];
    for look in 1..=8 {
        let until = f64::from(look) * 0.25 * height / fastest;
        advance(&mut dew, until);
        let step = 1e-5;
        while time < until {
            speed += step * (9.81 * lightness * (height - way).max(0.0) / height - 0.5 * speed * speed / height);
            way += step * speed;
            time += step;
        }
        let rising = mean(&dew, 2);
        assert!((rising - speed).abs() < 0.08 * 0.155, "{rising} of {speed} m/s at {until} s");
        let count = inside(&dew).count();
        assert!((1411..1470).contains(&count), "{count} of 1440 particles at {until} s");
    }
    // Without the drop of pressure of air that comes in it would be 0.2 m/s.
    assert!((speed - 0.155).abs() < 0.001);
}

/// Wind along a side behind which the air is at rest: it draws some of it in, and neither bursts nor stops.
#[test]
fn a_wind_along_an_open_side_stays_even() {
    let speed = 0.2;
    let inflow = Inflow { velocity: [speed, 0.0, 0.0], temperature: WARM, vapour: 0.0 };
    let faces = [[Face::Inlet(inflow), Face::Outlet], [Face::Periodic; 2], [Face::Wall, Face::Open]];
    let setup = setup([20.0 * D, 6.0 * D, 10.0 * D], faces, 10.0 * speed);
    let mut dew = Dew::new(&setup, |_| [WARM, 0.0]).unwrap();
    dew.stir(|_| [speed, 0.0, 0.0]);
    for look in 1..=6 {
        advance(&mut dew, f64::from(look) * 20.0 * D / speed);
        let count = inside(&dew).count();
        assert!((1164..1236).contains(&count), "{count} of 1200 particles at {look}");
        let along = mean(&dew, 0);
        assert!((along / speed - 1.0).abs() < 0.15, "{along} m/s at {look}");
        for axis in 1..3 {
            let squares: f64 = inside(&dew).map(|particle| particle.velocity[axis].powi(2)).sum();
            let across = (squares / count as f64).sqrt();
            assert!(across < 0.25 * speed, "{across} m/s along axis {axis} at {look}");
        }
    }
}

#[test]
fn wind_may_come_in_aslant() {
    let inflow = Inflow { velocity: [0.1, 0.05, 0.0], temperature: WARM, vapour: 0.0 };
    let faces = [[Face::Inlet(inflow), Face::Outlet], [Face::Periodic; 2], [Face::Wall; 2]];
    let mut dew = Dew::new(&setup([20.0 * D, 6.0 * D, 6.0 * D], faces, 1.5), |_| [WARM, 0.0]).unwrap();
    dew.stir(|_| [0.1, 0.0, 0.0]);
    // From when all air has come from the inlet, over some periods of the sound that the start made.
    let mut means = [0.0; 2];
    for look in 0..10 {
        advance(&mut dew, (25.0 + f64::from(look)) * D / 0.1);
        (0..2).for_each(|axis| means[axis] += 0.1 * mean(&dew, axis));
        let count = inside(&dew).count();
        assert!((698..742).contains(&count), "{count} of 720 particles");
    }
    let [along, aside] = means;
    assert!((along / 0.1 - 1.0).abs() < 0.03 && (aside / 0.05 - 1.0).abs() < 0.03, "{along} {aside} m/s");
}

/// Air that starts too fast makes sound, which leaves by the outlet and does not go to and fro for ever: an outlet at rest would reflect all of it. The air starts
/// at random: a lattice breaks up by rounding, and leaves 2.7 to 3.0 % of the speed.
#[test]
fn an_outlet_lets_sound_out() {
    let (speed, sound, length) = (0.1, 1.5, 20.0 * D);
    for (side, seed) in [(0, 5), (1, 6), (0, 7), (1, 8)] {
        let velocity = [[speed, -speed][side], 0.0, 0.0];
        let mut along = [Face::Outlet; 2];
        along[side] = Face::Inlet(Inflow { velocity, temperature: WARM, vapour: 0.0 });
        let faces = [along, [Face::Periodic; 2], [Face::Wall; 2]];
        let mut dew = Dew::new(&setup([length, 6.0 * D, 6.0 * D], faces, sound), |_| [WARM, 0.0]).unwrap();
        dew.scatter(Scatter { reach: 0.5, sweeps: 15, seed }, |_| [WARM, 0.0]);
        dew.stir(|_| velocity.map(|along| 1.3 * along));
        let mut most = 0.0_f64;
        // After four periods of the slowest sound between an inlet and an outlet, over two of them.
        for look in 0..=32 {
            advance(&mut dew, (16.0 + 0.25 * f64::from(look)) * length / sound);
            most = most.max((mean(&dew, 0) / velocity[0] - 1.0).abs());
        }
        assert!(most < 0.025, "inlet at side {side}, seed {seed}: off by {most} of the speed");
    }
}

/// Air that turns a corner on its way out is faster the nearer it is to the outlet: that is not sound, and must not hold it back.
#[test]
fn air_that_speeds_up_towards_an_outlet_leaves_at_the_ambient_pressure() {
    let sound = 0.6;
    let inflow = Inflow { velocity: [-0.1, 0.0, 0.0], temperature: WARM, vapour: 0.0 };
    let faces = [[Face::Wall, Face::Inlet(inflow)], [Face::Periodic; 2], [Face::Outlet, Face::Wall]];
    let mut dew = Dew::new(&setup([6.0 * D, 6.0 * D, 12.0 * D], faces, sound), |_| [WARM, 0.0]).unwrap();
    let mut count = 0;
    for look in 0..40 {
        advance(&mut dew, 0.4 + 0.01 * f64::from(look));
        count += inside(&dew).count();
    }
    // It leaves at 0.2 m/s, and by Bernoulli's equation is up to u^2 / (2 c^2) denser far from the outlet.
    let denser = f64::from(count as u32) / (40.0 * 432.0) - 1.0;
    let most = 0.5 * (0.2 / sound).powi(2);
    assert!((0.0..1.2 * most).contains(&denser), "denser by {denser}, at most {most}");
}

/// What evens out the positions of air in the room must not go on for ever once it has left: beyond the outlet it goes as its velocity says along the side.
#[test]
fn air_that_has_left_does_not_drift_aside() {
    let inflow = Inflow { velocity: [0.1, 0.0, 0.0], temperature: WARM, vapour: 0.0 };
    let faces = [[Face::Inlet(inflow), Face::Outlet], [Face::Periodic; 2], [Face::Wall; 2]];
    let mut dew = Dew::new(&setup([10.0 * D, 6.0 * D, 6.0 * D], faces, 1.5), |_| [WARM, 0.0]).unwrap();
    dew.scatter(Scatter { reach: 0.5, sweeps: 5, seed: 3 }, |_| [WARM, 0.0]);
    dew.stir(|_| [0.1, 0.0, 0.0]);
    advance(&mut dew, 5.0 * D / 0.1);
    let left = |dew: &Dew| {
        dew.air().iter().filter(|particle| matches!(particle.role, Role::Leaving(..))).copied().collect::<Vec<_>>()
    };
    let (before, from) = (left(&dew), dew.stepped_until());
    assert!(before.len() > 36, "{} particles have left", before.len());
    advance(&mut dew, from + 0.5 * D / 0.1);
    let (after, time) = (left(&dew), dew.stepped_until() - from);
    let mut seen = 0;
    for (now, was) in after.iter().filter_map(|now| Some((now, before.iter().find(|was| was.id == now.id)?))) {
        // The height; air does not cross the walls by its velocity alone.
        let drift = now.position[2] - was.position[2] - time * was.velocity[2];
        let bounced = now.velocity[2] != was.velocity[2];
        assert!(bounced || drift.abs() < 1e-9 * D, "the particle {} drifted by {drift} m", now.id);
        seen += usize::from(!bounced);
    }
    assert!(seen > 36, "{seen} particles were looked at");
}

/// What evens out the positions of air pushes some of it back to the inlet that it came by, most where a solid stands before it: none of it goes out there.
#[test]
fn as_much_comes_in_as_an_inlet_says() {
    let (size, speed) = ([20.0 * D, 6.0 * D, 12.0 * D], 0.1);
    let shape = Shape::sphere(2.5 * D).unwrap();
    let solid = Solid::of_shape(shape, Pose::new([5.0 * D, 3.0 * D, 6.0 * D], [0.0; 3]));
    let material = Material { conductivity: 1.0, heat_capacity: 1000.0, density: 2000.0 };
    for side in 0..2 {
        let velocity = [[speed, -speed][side], 0.02, 0.0];
        let mut along = [Face::Outlet; 2];
        along[side] = Face::Inlet(Inflow { velocity, temperature: WARM, vapour: 0.01 });
        let mut setup = setup(size, [along, [Face::Periodic; 2], [Face::Wall; 2]], 1.5);
        setup.bodies = vec![Body::sampled(solid.clone(), D, material, WARM, true).unwrap()];
        let mut dew = Dew::new(&setup, |_| [WARM, 0.0]).unwrap();
        // None of it has come to the outlet yet.
        advance(&mut dew, 12.0 * D / speed);
        // The first layer stands half a spacing before the inlet.
        let layers = (speed * dew.stepped_until() / D + 0.5).floor();
        let expected = layers * 6.0 * 12.0 * dew.particle_mass() * 0.01;
        let water = dew.ledger().balances.swap_remove(0);
        assert!((water.inflow / expected - 1.0).abs() < 1e-9, "{water:?}, {expected} kg in by side {side}");
        assert!(water.outflow == 0.0, "{water:?}: out by side {side}");
    }
}

#[test]
fn a_fan_drives_air_round() {
    let size = [20.0 * D, 6.0 * D, 6.0 * D];
    let mut setup = setup(size, [[Face::Periodic; 2], [Face::Wall; 2], [Face::Wall; 2]], 1.0);
    setup.fans = vec![Fan::new(size.map(|side| 0.5 * side), [4.0 * D, 1.0, 1.0], [0.1, 0.0, 0.0])];
    let mut dew = Dew::new(&setup, |_| [WARM, 0.0]).unwrap();
    // A fifth of the air is in the fan: d(mean)/dt = (0.1 - mean) * 4 * 0.1 / (4 D) / 5.
    let rate = 4.0 * 0.1 / (4.0 * D) / 5.0;
    for look in 1..=4 {
        let until = f64::from(look) * 0.5 / rate;
        advance(&mut dew, until);
        let expected = 0.1 * (1.0 - (-rate * until).exp());
        let along = mean(&dew, 0);
        assert!((along - expected).abs() < 0.005, "{along} of {expected} m/s at {until} s");
    }
}

/// A cold ball in warm humid air that all sides but the floor let in.
fn cold_ball() -> Setup {
    let size = [12.0 * D, 12.0 * D, 12.0 * D];
    let shape = Shape::sphere(3.0 * D).unwrap();
    let solid = Solid::of_shape(shape, Pose::new(size.map(|side| 0.5 * side), [0.0; 3]));
    let humid = vapour(WARM, 0.8);
    Setup {
        settings: Settings::new(D, WARM, humid),
        air: Properties::at_room_temperature(1.0),
        bodies: vec![Body::sampled(solid, D, GLASS, WARM - 20.0, true).unwrap()],
        ..setup(size, [[Face::Open; 2], [Face::Open; 2], [Face::Wall, Face::Open]], 1.0)
    }
}

#[test]
fn cold_air_that_sinks_off_a_ball_is_replaced_and_nothing_is_lost() {
    let setup = cold_ball();
    let [warm, humid] = [WARM, setup.settings.ambient_vapour];
    let mut dew = Dew::new(&setup, |_| [warm, humid]).unwrap();
    let start = inside(&dew).count() as f64;
    for look in 1..=4 {
        advance(&mut dew, 0.3 * f64::from(look));
        let count = inside(&dew).count() as f64;
        assert!((count / start - 1.0).abs() < 0.03, "{count} of {start} particles at {look}");
        // sqrt(2 g H dT/T) over the height of the box: all that the fall can give.
        let fastest = inside(&dew).map(|particle| particle.speed_squared()).fold(0.0, f64::max).sqrt();
        assert!(fastest < (2.0_f64 * 9.81 * 12.0 * D * 20.0 / WARM).sqrt(), "{fastest} m/s at {look}");
    }
    assert!(dew.water_on_body(0) > 0.0);
    for balance in dew.ledger().balances {
        assert!(balance.inflow > 0.0 && balance.outflow > 0.0, "{balance:?}");
        assert!(balance.relative_error().abs() < 1e-10, "{balance:?}: {:e}", balance.relative_error());
    }
}

#[test]
fn what_is_saved_between_open_sides_goes_on_to_the_same_bits() {
    let setup = cold_ball();
    let start = |_| [WARM, setup.settings.ambient_vapour];
    let mut dew = Dew::new(&setup, start).unwrap();
    advance(&mut dew, 0.1);
    let saved = dew.save();
    advance(&mut dew, 0.2);
    let mut resumed = Dew::new(&setup, start).unwrap();
    resumed.restore(&saved).unwrap();
    advance(&mut resumed, 0.2);
    assert_eq!(dew.save(), resumed.save());
}

/// A cold wall along an open box, which ends so far beyond its lower and upper sides, m.
fn wall(beyond: f64) -> String {
    let long = 0.05 + 2.0 * beyond;
    format!(
        "run.until_s = 1\n[dew]\nsize_m = [0.02, 0.0125, 0.05]\nspacing_m = 0.0025\nair = {{ temperature_c = 25, relative_humidity = 0.7 }}\n\
         drops.smallest_radius_m = 5e-4\n[dew.faces]\nx_max = \"open\"\ny_min = \"periodic\"\ny_max = \"periodic\"\nz_min = \"open\"\nz_max = \"open\"\n\
         [[dew.solid]]\nname = \"wall\"\nshape = {{ box = {{ size_m = [0.005, 0.0125, {long}] }} }}\nposition_m = [0.0025, 0.00625, 0.025]\n\
         temperature_c = 5\nheld = true\n"
    )
}

fn opened(text: &str) -> Result<Dew, String> {
    let scene = corpuscle_scene::Scene::parse(text, "test.toml", &[]).unwrap();
    corpuscle_dew::open(scene.dew().unwrap(), 3, std::path::Path::new(".")).map_err(|error| error.to_string())
}

/// Boundary layer at an upright plate (Ostrach, NACA Report 1111, 1953): with Pr 0.7 the fastest air has 0.55 sqrt(g x dT/T), x from where it begins.
#[test]
fn air_sinks_along_a_cold_wall_as_fast_as_it_should() {
    let mut dew = opened(&wall(0.02)).unwrap();
    advance(&mut dew, 1.5);
    // Layers along the wall, 0.9 of the way down.
    let mut layers = [[0.0_f64; 2]; 6];
    for particle in inside(&dew).filter(|particle| particle.position[2] < 0.0125) {
        let layer = ((particle.position[0] - 0.005) / 0.0025) as usize;
        let [sum, count] = &mut layers[layer.min(5)];
        (*sum, *count) = (*sum - particle.velocity[2], *count + 1.0);
    }
    let fastest = layers.iter().map(|[sum, count]| sum / count).fold(0.0, f64::max);
    let expected = 0.55 * (9.81_f64 * 0.044 * 20.0 / 298.0).sqrt();
    // Layers are as thick as a sixth of the boundary layer, and the box is open just beyond it.
    assert!((0.75..1.1).contains(&(fastest / expected)), "{fastest} of {expected} m/s");
}

/// A solid that reaches an open side goes on beyond it, whether the scene makes it longer or not.
#[test]
fn a_solid_at_an_open_side_is_the_same_however_long_it_is() {
    let [mut ends, mut goes_on] = [0.0, 0.02].map(|beyond| opened(&wall(beyond)).unwrap());
    assert_eq!(ends.solids().particles.len(), goes_on.solids().particles.len());
    for dew in [&mut ends, &mut goes_on] {
        advance(dew, 0.1);
        let beyond = dew.air().iter().filter(|particle| particle.role != Role::Inside);
        assert!(beyond.clone().count() > 100);
        assert!(beyond.clone().all(|particle| particle.position[0] > 0.005), "air stands behind the wall");
        for balance in dew.ledger().balances {
            assert!(balance.relative_error().abs() < 1e-12, "{balance:?}: {:e}", balance.relative_error());
        }
    }
    let [one, other] = [&ends, &goes_on].map(|dew| dew.water_on_body(0));
    assert!(one > 0.0 && (one / other - 1.0).abs() < 1e-6, "{one} {other}");
}
