//! Drops on an upright pane: onset of sliding, conservation in merging, and distribution of sizes.

use super::rows;
use crate::device::refuse_on_gpu;
use crate::{Case, Options, Row};
use corpuscle_dew::drops::{Cap, Drop, DropLaws, Drops, Patch, Retention, SurfaceWater, Surfaces, WATER_DENSITY};
use corpuscle_model::{CompensatedSum, ModelError};
use corpuscle_solids::{Pose, Shape, Solid};
use std::f64::consts::PI;
use std::sync::Arc;

pub(super) const SLIDE: Case = Case {
    name: "dew/slide",
    about: "Drops on inclined panes with a prescribed condensation: a growing drop slides when its weight passes what its receding and advancing angle hold \
            (Furmidge 1962), or the bound of friction; it comes to the speed at which the wedge at its contact line brakes it (Huh & Scriven 1971; de Gennes \
            1985), whatever the steps; merging keeps mass and momentum, and the spread of sizes stands beside that of Le Fevre & Rose.",
    slow: true,
    reduced: 1.0,
    run: slide,
};

const GRAVITY: f64 = 9.81;
const PRESSURE: f64 = 101_325.0;

fn slide(_: &Options) -> Vec<Row> {
    rows(SLIDE.name, measure())
}

fn measure() -> Result<Vec<Row>, ModelError> {
    let name = SLIDE.name;
    refuse_on_gpu("drops, which stay with the CPU")?;
    let [left, mass, momentum] = merging_errors();
    let exponent = size_exponent();
    Ok(vec![
        Row::at_most(name, "largest_relative_error_of_sliding_radius", largest_sliding_error(), "", 0.05),
        Row::at_most(name, "relative_error_of_2_mm", (sliding_radius(1.288e-4, 90.0) / 2e-3 - 1.0).abs(), "", 0.05),
        Row::at_most(name, "largest_relative_error_of_held_radius", largest_held_error(), "", 0.005),
        Row::at_most(name, "largest_relative_error_of_final_speed", largest_speed_error(), "", 1e-6),
        Row::at_most(name, "largest_relative_error_of_way_by_steps", largest_way_error(), "", 0.01),
        Row::at_most(name, "angle_at_which_it_recedes_error", receding_error(), "", 0.005),
        Row::at_most(name, "drops_left_of_2000", left, "", 1000.0),
        Row::at_most(name, "relative_mass_error_of_merging", mass, "", 1e-13),
        Row::at_most(name, "relative_momentum_error_of_merging", momentum, "", 1e-13),
        Row::beside(
            name,
            "exponent_of_size_distribution",
            exponent,
            "",
            -8.0 / 3.0,
            "shown beside Le Fevre & Rose (1966)",
        ),
    ])
}

pub(super) fn laws(friction: f64, contact_angle: f64, smallest_radius: f64) -> DropLaws {
    DropLaws {
        contact_angle,
        retention: Retention::Friction(friction),
        viscosity: 0.0,
        pressure: PRESSURE,
        surface_tension: 0.0728,
        gravity: [0.0, 0.0, -GRAVITY],
        smallest_radius,
        density: WATER_DENSITY,
        time_factor: 1.0,
    }
}

/// A pane in the plane x = 0, with drops and patches on its side at larger x.
fn pane(laws: DropLaws, side: f64, patches: Vec<Patch>) -> Drops {
    with_sites(laws, side, patches, 1e10, 1)
}

/// The same with so many nucleation sites, 1/m2, by a seed.
fn with_sites(laws: DropLaws, side: f64, patches: Vec<Patch>, sites_per_area: f64, seed: u64) -> Drops {
    let shape = Shape::Box { size: [0.01, side, side] };
    let solid = Solid::of_shape(shape, Pose::new([-0.005, 0.0, 0.0], [0.0; 3]));
    let surfaces = Surfaces {
        solids: Arc::from([solid]),
        water: vec![SurfaceWater::Drops { sites_per_area }],
        patches,
        room: [[-1.0; 3], [1.0; 3]],
    };
    Drops::new(laws, surfaces, seed)
}

/// A pane all of which is patches, so many along each side.
pub(super) fn on_patches(laws: DropLaws, side: f64, count: u32, sites_per_area: f64, seed: u64) -> Drops {
    let width = side / f64::from(count);
    let at = |index: u32| width * (f64::from(index) + 0.5) - 0.5 * side;
    let patches = (0..count).flat_map(|y| (0..count).map(move |z| patch(at(y), at(z), 0.5 * width))).collect();
    with_sites(laws, side, patches, sites_per_area, seed)
}

fn patch(y: f64, z: f64, half_width: f64) -> Patch {
    Patch { solid: 0, position: [0.0, y, z], normal: [1.0, 0.0, 0.0], half_width }
}

/// Covered radius with which a drop that grows by a thousandth of its mass at a time begins to slide, m.
fn sliding_radius(friction: f64, degrees: f64) -> f64 {
    let mut drops = pane(laws(friction, degrees.to_radians(), 5e-5), 0.02, vec![patch(0.0, 0.0, 1e-4)]);
    drops.add(0, [0.0; 3], [0.0; 3], WATER_DENSITY * Cap::new(degrees.to_radians()).volume(4e-4));
    loop {
        drops.advance(1e-3);
        let drop = drops.drops()[0];
        if drop.velocity != [0.0; 3] {
            return drop.radius;
        }
        drops.condense(&[1e-3 * drop.mass]);
    }
}

/// The bound worked out from the law: m g = mu p pi a^2, m of a cap, solved for a. With a = R sin and
/// V = pi/3 R^3 (2 + cos)(1 - cos)^2, a = 3 mu p sin^3 / (rho g (2 + cos)(1 - cos)^2).
fn bound(friction: f64, degrees: f64) -> f64 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    3.0 * friction * PRESSURE * sin.powi(3) / (WATER_DENSITY * GRAVITY * (2.0 + cos) * (1.0 - cos).powi(2))
}

fn largest_sliding_error() -> f64 {
    let cases =
        [5e-5, 1.3e-4, 3e-4].into_iter().flat_map(|friction| [60.0, 90.0, 110.0].map(|angle| (friction, angle)));
    let errors = cases.map(|(friction, angle)| (sliding_radius(friction, angle) / bound(friction, angle) - 1.0).abs());
    errors.fold(0.0, f64::max)
}

/// Contact angle, receding and advancing angle, degrees, and inclination of the pane.
const HELD: [[f64; 4]; 5] = [
    [60.0, 50.0, 70.0, 90.0],
    [60.0, 45.0, 72.0, 30.0],
    [90.0, 74.0, 106.0, 90.0],
    [90.0, 85.0, 95.0, 10.0],
    [110.0, 95.0, 120.0, 60.0],
];

/// Drops that are held by angles and braked, on a pane that is inclined; see [`HELD`].
fn held([angle, receding, advancing, inclination]: [f64; 4]) -> DropLaws {
    let [receding, advancing] = [receding, advancing].map(f64::to_radians);
    let (sin, cos) = inclination.to_radians().sin_cos();
    DropLaws {
        retention: Retention::Hysteresis { receding, advancing },
        viscosity: 1.0016e-3,
        gravity: [-GRAVITY * cos, 0.0, -GRAVITY * sin],
        ..laws(0.0, angle.to_radians(), 5e-5)
    }
}

/// Volume of a cap over the cube of the radius that it covers.
fn volume(degrees: f64) -> f64 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    PI / 3.0 * (2.0 + cos) * (1.0 - cos).powi(2) / sin.powi(3)
}

/// A growing drop has its advancing angle: it slides where rho V g sin = 2 a gamma (cos receding - cos advancing).
fn largest_held_error() -> f64 {
    let error = |case: [f64; 4]| {
        let [angle, receding, advancing, inclination] = case.map(f64::to_radians);
        let difference = receding.cos() - advancing.cos();
        let held_radius =
            (2.0 * 0.0728 * difference / (WATER_DENSITY * GRAVITY * inclination.sin() * volume(case[2]))).sqrt();
        let mut drops = pane(held(case), 0.02, vec![patch(0.0, 0.0, 1e-4)]);
        drops.add(0, [0.0; 3], [0.0; 3], WATER_DENSITY * Cap::new(angle).volume(0.5 * held_radius));
        loop {
            drops.advance(1e-4);
            let drop = drops.drops()[0];
            if drop.velocity != [0.0; 3] {
                return (drop.radius / held_radius - 1.0).abs();
            }
            drops.condense(&[1e-3 * drop.mass]);
        }
    };
    HELD.into_iter().map(error).fold(0.0, f64::max)
}

/// Speed at which the contact line brakes a drop as much as its weight outdoes what holds it: pi a mu U 2 sin^2 / (angle - sin cos) ln(a / 1 nm).
fn final_speed(case: [f64; 4], radius: f64) -> f64 {
    let [angle, receding, advancing, inclination] = case.map(f64::to_radians);
    let weight = WATER_DENSITY * volume(case[0]) * radius.powi(3) * GRAVITY * inclination.sin();
    let holds = 2.0 * radius * 0.0728 * (receding.cos() - advancing.cos());
    let wedge = 2.0 * angle.sin().powi(2) / (angle - angle.sin() * angle.cos());
    (weight - holds) / (PI * radius * 1.0016e-3 * wedge * (radius / 1e-9).ln())
}

/// Weight of a drop that slides over that which is held.
const HEAVIER: f64 = 1.05;

/// A drop that is heavier than what is held, on a long pane.
fn heavy(case: [f64; 4]) -> (Drops, f64) {
    let [angle, receding, advancing, inclination] = case.map(f64::to_radians);
    let square = HEAVIER * 2.0 * 0.0728 * (receding.cos() - advancing.cos())
        / (WATER_DENSITY * GRAVITY * inclination.sin() * volume(case[0]));
    let mut drops = pane(held(case), 2.0, Vec::new());
    drops.add(0, [0.0, 0.0, 0.9], [0.0; 3], WATER_DENSITY * Cap::new(angle).volume(square.sqrt()));
    (drops, square.sqrt())
}

fn speed(drops: &Drops) -> f64 {
    drops.drops()[0].velocity.iter().map(|along| along * along).sum::<f64>().sqrt()
}

fn largest_speed_error() -> f64 {
    let error = |case: [f64; 4]| {
        let (mut drops, radius) = heavy(case);
        let last = final_speed(case, radius);
        // It comes to it as 1 - exp(-t / relaxation).
        let relaxation = last / (GRAVITY * case[3].to_radians().sin() * (1.0 - 1.0 / HEAVIER));
        (0..20).for_each(|_| drops.advance(relaxation));
        (speed(&drops) / last - 1.0).abs()
    };
    HELD.into_iter().map(error).fold(0.0, f64::max)
}

/// Difference of the distance in 0.1 s between one call and a thousand.
fn largest_way_error() -> f64 {
    let way = |case, calls: u32| {
        let (mut drops, _) = heavy(case);
        (0..calls).for_each(|_| drops.advance(0.1 / f64::from(calls)));
        0.9 - drops.drops()[0].position[2]
    };
    HELD.into_iter().map(|case| (way(case, 1) / way(case, 1000) - 1.0).abs()).fold(0.0, f64::max)
}

/// A drop that evaporates keeps the disk that it covers until its angle is the receding one: its volume is then less by as much as the caps' are.
fn receding_error() -> f64 {
    let error = |case: [f64; 4]| {
        let mut drops = pane(DropLaws { gravity: [0.0; 3], ..held(case) }, 0.02, vec![patch(0.0, 0.0, 1e-4)]);
        drops.add(0, [0.0; 3], [0.0; 3], WATER_DENSITY * Cap::new(case[0].to_radians()).volume(1e-3));
        let begin = drops.drops()[0];
        loop {
            let (portions, shares) = (drops.portions(), drops.shares());
            drops.evaporate(&portions, &shares, &[-1e-3 * shares[0].water]);
            drops.advance(1e-3);
            let drop = drops.drops()[0];
            if drop.radius < begin.radius * (1.0 - 1e-9) {
                return (drop.mass / begin.mass / (volume(case[1]) / volume(case[0])) - 1.0).abs();
            }
        }
    };
    HELD.into_iter().map(error).fold(0.0, f64::max)
}

/// Number of drops that are left of 2000 at the positions of a spiral when they have merged, and relative errors of mass and momentum.
fn merging_errors() -> [f64; 3] {
    let mut drops = pane(DropLaws { gravity: [0.0; 3], ..laws(0.0, 0.5 * PI, 1e-5) }, 0.1, Vec::new());
    for at in 0..2000 {
        // The golden angle spreads them evenly.
        let (part, angle) = (f64::from(at) / 2000.0, 2.399_963 * f64::from(at));
        let away = 0.045 * part.sqrt();
        let radius = 1e-4 * (1.0 + 20.0 * (0.37 * f64::from(at)).sin().powi(4));
        let mass = WATER_DENSITY * Cap::new(0.5 * PI).volume(radius);
        drops.add(0, [0.0, away * angle.cos(), away * angle.sin()], [0.0, angle.sin(), part], mass);
    }
    let sums = |drops: &[Drop]| -> [f64; 3] {
        let sum = |of: &dyn Fn(&Drop) -> f64| drops.iter().map(of).collect::<CompensatedSum>().value();
        [sum(&|drop| drop.mass), sum(&|drop| drop.mass * drop.velocity[1]), sum(&|drop| drop.mass * drop.velocity[2])]
    };
    let before = sums(drops.drops());
    drops.advance(0.0);
    let after = sums(drops.drops());
    let momentum = (before[1] - after[1]).hypot(before[2] - after[2]) / before[1].hypot(before[2]);
    [drops.drops().len() as f64, (after[0] / before[0] - 1.0).abs(), momentum]
}

/// Side of the pane, patches along it, radius of the smallest drop, water for a patch and step as a thickness, m.
const SIDE: f64 = 0.02;
const PATCHES: u32 = 200;
const SMALLEST: f64 = 3e-5;
const THICKNESS: f64 = 3e-6;

/// Steps until drops have run off, and all.
const SETTLED: u32 = 180;
const STEPS: u32 = 300;

/// Exponent n of the number of drops by radius, N ~ r^n, from 2 smallest radii to 0.4 mm, a fifth of the radius that slides, over
/// many times of a pane on which water condenses evenly.
fn size_exponent() -> f64 {
    let width = SIDE / f64::from(PATCHES);
    let water = vec![WATER_DENSITY * THICKNESS * width * width; (PATCHES * PATCHES) as usize];
    let mut drops = on_patches(laws(1.288e-4, 0.5 * PI, SMALLEST), SIDE, PATCHES, 1e10, 1);
    let mut radii = Vec::new();
    for step in 1..=STEPS {
        drops.condense(&water);
        drops.advance(0.01);
        if step > SETTLED && step % 10 == 0 {
            radii.extend(drops.drops().iter().map(|drop| drop.radius));
        }
    }
    fitted_exponent(&radii, 2.0 * SMALLEST, 4e-4)
}

/// Slope of log N over log r by least squares, in classes each half as wide again as the one before.
fn fitted_exponent(radii: &[f64], from: f64, to: f64) -> f64 {
    let edges: Vec<f64> =
        std::iter::successors(Some(from), |edge| Some(1.5 * edge)).take_while(|&edge| edge <= to).collect();
    let points: Vec<[f64; 2]> = edges
        .windows(2)
        .map(|class| {
            let count = radii.iter().filter(|&&radius| radius >= class[0] && radius < class[1]).count() as f64;
            [(class[0] * class[1]).sqrt().ln(), (count.max(0.5) / (class[1] - class[0])).ln()]
        })
        .collect();
    fitted_slope(&points)
}

/// Slope of a line through points by least squares.
pub(super) fn fitted_slope(points: &[[f64; 2]]) -> f64 {
    let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / points.len() as f64;
    let [x, y] = [mean(0), mean(1)];
    let (across, along) =
        points.iter().fold((0.0, 0.0), |(xy, xx), p| (xy + (p[0] - x) * (p[1] - y), xx + (p[0] - x).powi(2)));
    across / along
}
