//! Drops: nothing of them is lost, what touches is one, and friction holds them up to its bound.

use corpuscle_dew::drops::{Drop, DropLaws, Drops, Patch, Retention, SurfaceWater, Surfaces, WATER_DENSITY};
use corpuscle_model::CompensatedSum;
use corpuscle_solids::{Pose, Shape, Solid};
use proptest::prelude::*;
use std::f64::consts::PI;
use std::sync::Arc;

fn laws() -> DropLaws {
    DropLaws {
        contact_angle: 0.5 * PI,
        retention: Retention::Friction(1.3e-4),
        viscosity: 0.0,
        pressure: 101_325.0,
        surface_tension: 0.0728,
        gravity: [0.0, 0.0, -9.81],
        smallest_radius: 5e-5,
        density: WATER_DENSITY,
        time_factor: 1.0,
    }
}

const ROOM: [[f64; 3]; 2] = [[-1.0; 3], [1.0; 3]];

/// Drops on a pane in the plane x = 0, from y, z = -5 cm to 5 cm, upright.
fn on_pane(laws: DropLaws, patches: Vec<Patch>) -> Drops {
    with_sites(laws, patches, 1e10, 1)
}

/// With so many nucleation sites, 1/m2, at random by a seed.
fn with_sites(laws: DropLaws, patches: Vec<Patch>, sites_per_area: f64, seed: u64) -> Drops {
    let pane = Shape::cuboid([0.01, 0.1, 0.1]).unwrap();
    let solid = Solid::of_shape(pane, Pose::new([-0.005, 0.0, 0.0], [0.0; 3]));
    let surfaces = Surfaces {
        solids: Arc::from([solid]),
        water: vec![SurfaceWater::Drops { sites_per_area }],
        patches,
        room: ROOM,
    };
    Drops::new(laws, surfaces, seed)
}

/// Patches of a pane, so many along each side.
fn patches(count: u32, side: f64) -> Vec<Patch> {
    let at = |index: u32| side * ((f64::from(index) + 0.5) / f64::from(count) - 0.5);
    let patch = |y: u32, z: u32| Patch {
        solid: 0,
        position: [0.0, at(y), at(z)],
        normal: [1.0, 0.0, 0.0],
        half_width: 0.5 * side / f64::from(count),
    };
    (0..count).flat_map(|y| (0..count).map(move |z| patch(y, z))).collect()
}

/// Mass of a hemisphere.
fn half_ball(radius: f64) -> f64 {
    WATER_DENSITY * 2.0 / 3.0 * PI * radius.powi(3)
}

fn sum(drops: &[Drop], of: impl Fn(&Drop) -> f64) -> f64 {
    drops.iter().map(of).sum()
}

fn assert_apart(drops: &Drops) {
    let all = drops.drops();
    for (at, one) in all.iter().enumerate() {
        for other in &all[..at] {
            let away: f64 = (0..3).map(|axis| (one.position[axis] - other.position[axis]).powi(2)).sum();
            let touch = one.radius + other.radius;
            assert!(away.sqrt() >= touch, "{one:?} touches {other:?}");
        }
    }
}

/// A pane on which water is a film.
fn wetted(laws: DropLaws, patches: Vec<Patch>) -> Drops {
    let pane = Shape::cuboid([0.01, 0.1, 0.1]).unwrap();
    let solid = Solid::of_shape(pane, Pose::new([-0.005, 0.0, 0.0], [0.0; 3]));
    Drops::new(laws, Surfaces { solids: Arc::from([solid]), water: vec![SurfaceWater::Film], patches, room: ROOM }, 1)
}

#[test]
fn a_drop_becomes_part_of_the_film_that_flows_down_and_off() {
    let laws = DropLaws { viscosity: 1e-3, ..laws() };
    let mut drops = wetted(laws, patches(20, 0.1));
    drops.add(0, [0.0, 0.0, 0.03], [0.0; 3], half_ball(2e-3));
    drops.advance(1e-3);
    assert!(drops.drops().is_empty());
    // The mean height of the water falls, and nothing is lost on the way.
    let height = |drops: &Drops| {
        let shares = drops.shares();
        let heights = shares.iter().zip(drops.patches()).map(|(share, patch)| share.water * patch.position[2]);
        heights.sum::<f64>() / drops.water()
    };
    let mut before = height(&drops);
    for _ in 0..5 {
        let state = drops.state();
        drops.advance(0.1);
        let after = height(&drops);
        assert!(after < before, "{before} {after}");
        assert!(((drops.water() + drops.dripped()) / half_ball(2e-3) - 1.0).abs() < 1e-14);
        // What is saved goes on to the same bits.
        let mut again = wetted(laws, patches(20, 0.1));
        again.restore(state);
        again.advance(0.1);
        assert_eq!(again.state(), drops.state());
        before = after;
    }
    (0..100).for_each(|_| drops.advance(100.0));
    assert!(drops.dripped() > 0.9 * half_ball(2e-3), "{}", drops.dripped() / half_ball(2e-3));
}

#[test]
fn a_film_stays_on_a_level_surface_and_hangs_up_to_the_capillary_length() {
    let level = DropLaws { viscosity: 1e-3, gravity: [-9.81, 0.0, 0.0], ..laws() };
    let hanging = DropLaws { gravity: [9.81, 0.0, 0.0], ..level };
    let all = patches(10, 0.1);
    let thick = vec![WATER_DENSITY * all[0].area() * 5e-3; all.len()];
    for (laws, expected) in [(level, 5e-3), (hanging, (0.0728 / (WATER_DENSITY * 9.81)).sqrt())] {
        let mut drops = wetted(laws, all.clone());
        drops.condense(&thick);
        drops.advance(10.0);
        for (share, patch) in drops.shares().iter().zip(&all) {
            let thickness = share.water / (WATER_DENSITY * patch.area());
            assert!((thickness / expected - 1.0).abs() < 1e-12, "{thickness} for {expected}");
        }
    }
}

#[test]
fn a_drop_stays_up_to_the_bound_of_friction_and_slides_beyond() {
    // m g = mu p pi r^2 for a hemisphere: r = 3 mu p / (2 rho g).
    let bound = 1.5 * 1.3e-4 * 101_325.0 / (WATER_DENSITY * 9.81);
    assert!((bound - 2.02e-3).abs() < 1e-5, "{bound}");
    for (part, moves) in [(0.5, false), (0.999, false), (1.001, true), (1.5, true)] {
        let mut drops = on_pane(laws(), Vec::new());
        drops.add(0, [0.0; 3], [0.0; 3], half_ball(part * bound));
        drops.advance(0.05);
        let drop = drops.drops()[0];
        assert_eq!(drop.velocity != [0.0; 3], moves, "{part}");
        // Constant force: friction per mass falls as 1 / r.
        let expected = if moves { -9.81 * (1.0 - 1.0 / part) * 0.05 } else { 0.0 };
        assert!((drop.velocity[2] - expected).abs() < 1e-9, "{part}: {} {expected}", drop.velocity[2]);
        assert!((drop.position[2] - 0.5 * expected * 0.05).abs() < 1e-9 && drop.position[0].abs() < 1e-15);
    }
}

#[test]
fn a_moving_drop_that_friction_outdoes_comes_to_rest() {
    let mut drops = on_pane(laws(), Vec::new());
    drops.add(0, [0.0; 3], [0.0, 0.1, 0.0], half_ball(1e-3));
    drops.advance(1.0);
    assert_eq!(drops.drops()[0].velocity, [0.0; 3]);
    assert!(drops.drops()[0].position[1] > 0.0);
}

#[test]
fn a_sliding_drop_sweeps_up_what_it_rolls_over_and_nothing_else() {
    let mut drops = on_pane(laws(), Vec::new());
    let large = half_ball(3e-3);
    drops.add(0, [0.0, 0.0, 0.03], [0.0; 3], large);
    let below: Vec<f64> = (0..5).map(|at| 0.02 - 0.01 * f64::from(at)).collect();
    below.iter().for_each(|&z| drops.add(0, [0.0, 1e-3, z], [0.0; 3], half_ball(1e-4)));
    drops.add(0, [0.0, 0.01, 0.0], [0.0; 3], half_ball(1e-4));
    while drops.drops().iter().any(|drop| drop.position[2] > -0.04 && drop.velocity != [0.0; 3])
        || drops.drops().len() > 2
    {
        drops.advance(0.01);
        assert!(drops.dripped() == 0.0, "it left before it had swept up all");
    }
    let masses: Vec<f64> = drops.drops().iter().map(|drop| drop.mass).collect();
    assert!((masses[0] - large - 5.0 * half_ball(1e-4)).abs() < 1e-18 && masses[1] == half_ball(1e-4), "{masses:?}");
}

#[test]
fn what_slides_over_an_edge_has_dripped() {
    let mut drops = on_pane(laws(), Vec::new());
    let mass = half_ball(3e-3);
    drops.add(0, [0.0, 0.0, -0.04], [0.0; 3], mass);
    drops.add(0, [0.0, 0.03, 0.0], [0.0; 3], half_ball(1e-3));
    drops.advance(1.0);
    assert_eq!((drops.drops().len(), drops.dripped(), drops.state().dripped_count), (1, mass, 1));
}

#[test]
fn drops_fall_from_a_ceiling_when_surface_tension_cannot_hold_them() {
    // rho g 2 pi / 3 r^3 = 2 pi r gamma: r = sqrt(3 gamma / (rho g)).
    let bound = (3.0 * 0.0728 / (WATER_DENSITY * 9.81)).sqrt();
    for (part, stays) in [(0.99, 1), (1.01, 0)] {
        let mut drops = on_pane(DropLaws { gravity: [9.81, 0.0, 0.0], ..laws() }, Vec::new());
        drops.add(0, [0.0; 3], [0.0; 3], half_ball(part * bound));
        drops.advance(0.1);
        assert_eq!(drops.drops().len(), stays, "{part}");
    }
}

#[test]
fn a_drop_runs_down_a_ball_and_leaves_where_it_overhangs() {
    let ball = Solid::of_shape(Shape::sphere(0.05).unwrap(), Pose::default());
    let surfaces = Surfaces {
        solids: Arc::from([ball.clone()]),
        water: vec![SurfaceWater::Drops { sites_per_area: 1e10 }],
        patches: Vec::new(),
        room: ROOM,
    };
    let mut drops = Drops::new(DropLaws { retention: Retention::Friction(1e-5), ..laws() }, surfaces, 1);
    let mass = half_ball(5e-3);
    drops.add(0, [0.01, 0.0, 0.1], [0.0; 3], mass);
    while let Some(drop) = drops.drops().first() {
        assert!(ball.signed_distance(drop.position).abs() < 1e-12);
        assert!((0..3).map(|axis| drop.velocity[axis] * drop.normal[axis]).sum::<f64>().abs() < 1e-12);
        drops.advance(1e-3);
    }
    assert_eq!(drops.dripped(), mass);
}

#[test]
fn what_condenses_is_on_the_pane_or_has_dripped() {
    let mut drops = on_pane(laws(), patches(40, 0.02));
    let (mut condensed, count) = (CompensatedSum::default(), 1600);
    // Thickness of 10 micrometres on each patch of half a millimetre.
    let mass = WATER_DENSITY * 1e-5 * 0.25e-6;
    for _ in 0..200 {
        drops.condense(&vec![mass; count]);
        (0..count).for_each(|_| condensed.add(mass));
        drops.advance(1e-2);
    }
    assert_apart(&drops);
    assert!(drops.dripped() > 0.0, "some drops have run off");
    let condensed = condensed.value();
    let error = (drops.water() + drops.dripped()) / condensed - 1.0;
    assert!(error.abs() < 1e-13, "{error}");
    let mut evaporated = CompensatedSum::default();
    for _ in 0..200 {
        let (portions, shares) = (drops.portions(), drops.shares());
        let gained: Vec<f64> = shares.iter().map(|share| -share.water.min(2e-8)).collect();
        drops.evaporate(&portions, &shares, &gained);
        gained.iter().for_each(|&gained| evaporated.add(-gained));
        drops.advance(1e-2);
    }
    let error = (drops.water() + drops.dripped() + evaporated.value()) / condensed - 1.0;
    assert!(error.abs() < 1e-12, "{error}");
    assert!(drops.water() < 0.01 * condensed, "it dries: {} of {condensed}", drops.water());
}

#[test]
fn sites_do_not_depend_on_patches_and_gather_the_water_of_their_area() {
    // The same water on patches of 1 mm and of 0.4 mm.
    let laws = DropLaws { smallest_radius: 2e-4, gravity: [0.0; 3], ..laws() };
    let of = |count: u32| with_sites(laws, patches(count, 0.02), 1e10, 7);
    let (coarse, fine) = (of(20), of(50));
    let positions = |drops: &Drops| -> Vec<[f64; 3]> { drops.sites().iter().map(|site| site.position).collect() };
    // Beyond the patches the pane goes on: which sites take part there depends on them.
    let of_inside = |drops: &Drops| -> Vec<[f64; 3]> {
        let is_inside = |site: &[f64; 3]| site[1].abs() < 9e-3 && site[2].abs() < 9e-3;
        positions(drops).into_iter().filter(is_inside).collect()
    };
    let (one, other) = (of_inside(&coarse), of_inside(&fine));
    let shared = one.iter().filter(|site| other.contains(site)).count();
    assert!(one.len() > 1100 && shared as f64 > 0.99 * one.len().max(other.len()) as f64, "{shared} of {}", one.len());
    for (at, a) in one.iter().enumerate() {
        for b in &one[..at] {
            let away2: f64 = (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum();
            assert!(away2.sqrt() >= 4e-4);
        }
    }
    // The same water, evenly, makes the same drops.
    let grown = |mut drops: Drops, count: u32| {
        let thickness = 0.5e-6;
        let mass = WATER_DENSITY * thickness * (0.02 / f64::from(count)).powi(2);
        let mut first = None;
        for step in 0..160 {
            if !drops.condense(&vec![mass; (count * count) as usize]).is_empty() {
                first = first.or(Some(f64::from(step) * thickness));
            }
            drops.advance(1e-2);
        }
        let is_inside = |drop: &&Drop| drop.position[1].abs() < 9e-3 && drop.position[2].abs() < 9e-3;
        let inside = drops.drops().iter().filter(is_inside);
        let radii: Vec<f64> = inside.map(|drop| drop.radius).collect();
        (first.unwrap(), radii.len() as f64, radii.iter().sum::<f64>() / radii.len() as f64)
    };
    let (a, b) = (grown(coarse, 20), grown(fine, 50));
    assert!((a.0 / b.0 - 1.0).abs() < 0.1, "the first drop: {a:?} {b:?}");
    assert!((a.1 / b.1 - 1.0).abs() < 0.1 && (a.2 / b.2 - 1.0).abs() < 0.05, "number, mean radius: {a:?} {b:?}");
}

#[test]
fn a_sliding_drop_takes_up_what_is_not_seen_below_it() {
    let mut drops = with_sites(DropLaws { smallest_radius: 3e-4, ..laws() }, patches(20, 0.02), 1e10, 1);
    drops.condense(&[1e-9; 400]);
    let before = drops.state().unseen;
    drops.add(0, [0.0, 0.0, 0.008], [0.0; 3], half_ball(3e-3));
    drops.advance(0.15);
    let after = drops.state().unseen;
    let drop = drops.drops()[0];
    assert!(drop.velocity[2] < 0.0 && drop.position[2] > -0.04);
    for (site, (before, after)) in drops.sites().iter().zip(before.iter().zip(&after)) {
        let [_, y, z] = site.position;
        let is_passed = y.abs() < 2.9e-3 && z < 0.008 && z > drop.position[2];
        assert!(!is_passed || *after == 0.0, "{site:?}");
        assert!(y.abs() < 3.2e-3 || after == before, "{site:?}");
    }
    assert!(after.iter().any(|unseen| *unseen > 0.0));
}

#[test]
fn shares_of_patches_sum_to_all_water_and_lie_where_it_is() {
    let mut drops = on_pane(laws(), patches(40, 0.02));
    for _ in 0..100 {
        drops.condense(&[WATER_DENSITY * 5e-6 * 0.25e-6; 1600]);
        drops.advance(1e-2);
    }
    drops.add(0, [0.0, 0.03, 0.0], [0.0; 3], half_ball(1e-3));
    let shares = drops.shares();
    let (water, covered) = shares.iter().fold((0.0, 0.0), |(w, c), share| (w + share.water, c + share.covered));
    assert!((water / drops.water() - 1.0).abs() < 1e-12 && (covered / drops.covered_area() - 1.0).abs() < 1e-12);
    // A drop beside all patches is that of the nearest, at y = 9.75 mm, z = -0.25 or 0.25 mm.
    let (wettest, _) = shares.iter().enumerate().max_by(|a, b| a.1.water.total_cmp(&b.1.water)).unwrap();
    assert!([39 * 40 + 19, 39 * 40 + 20].contains(&wettest), "{wettest}");
}

#[test]
fn the_two_sides_of_a_pane_do_not_see_each_other() {
    let mut drops = on_pane(laws(), Vec::new());
    drops.add(0, [0.0; 3], [0.0; 3], half_ball(6e-3));
    drops.add(0, [-0.01, 0.0, 0.0], [0.0; 3], half_ball(6e-3));
    drops.advance(0.0);
    assert_eq!(drops.drops().len(), 2);
}

#[test]
fn saved_and_restored_or_not_the_same_bits() {
    let run = |drops: &mut Drops, steps: u32| {
        for _ in 0..steps {
            drops.condense(&[WATER_DENSITY * 5e-6 * 0.25e-6; 1600]);
            drops.advance(1e-2);
        }
    };
    let mut through = on_pane(laws(), patches(40, 0.02));
    run(&mut through, 80);
    let mut other = on_pane(laws(), patches(40, 0.02));
    run(&mut other, 40);
    let mut resumed = on_pane(laws(), patches(40, 0.02));
    resumed.restore(other.state());
    run(&mut resumed, 40);
    assert_eq!(through.state(), resumed.state());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn merging_keeps_mass_momentum_and_centre_and_leaves_none_that_touch(
        parts in prop::collection::vec(([-0.04..0.04, -0.04..0.04], [-1.0..1.0, -1.0..1.0], -4.0..-2.3), 1..300),
    ) {
        // No gravity and no time: all that happens is merging.
        let mut drops = on_pane(DropLaws { gravity: [0.0; 3], ..laws() }, Vec::new());
        for ([y, z], [v, w], log_radius) in parts {
            drops.add(0, [0.0, y, z], [0.0, v, w], half_ball(10_f64.powf(log_radius)));
        }
        let before = drops.drops().to_vec();
        drops.advance(0.0);
        assert_apart(&drops);
        let after = drops.drops();
        let mass = sum(&before, |drop| drop.mass);
        prop_assert!((sum(after, |drop| drop.mass) / mass - 1.0).abs() < 1e-14);
        for axis in 1..3 {
            let scale = sum(&before, |drop| drop.mass * drop.velocity[axis].abs());
            let momentum = |drops: &[Drop]| sum(drops, |drop| drop.mass * drop.velocity[axis]);
            prop_assert!((momentum(after) - momentum(&before)).abs() <= 1e-14 * scale);
            let moment = |drops: &[Drop]| sum(drops, |drop| drop.mass * drop.position[axis]);
            prop_assert!((moment(after) - moment(&before)).abs() <= 1e-14 * 0.05 * mass);
        }
        for drop in after {
            prop_assert!(before.iter().any(|part| part.id == drop.id));
        }
    }
}
