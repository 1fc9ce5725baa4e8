//! Shapes: exact distances, and particles that stand for them.

use corpuscle_solids::{Depth, Pose, Profile, Shape, Solid, SolidError, WineGlass};
use proptest::prelude::*;

fn shapes() -> Vec<Shape> {
    let ring = Profile::new(vec![[0.3, -0.1], [0.5, 0.0], [0.3, 0.2]]).unwrap();
    vec![
        Shape::cuboid([1.0, 0.5, 0.7]).unwrap(),
        Shape::sphere(0.5).unwrap(),
        Shape::cylinder(0.4, 0.9).unwrap(),
        Shape::Revolution(ring),
        WineGlass { height: 1.0, bowl_radius: 0.4, foot_radius: 0.35, stem_radius: 0.1, wall: 0.08 }.shape().unwrap(),
    ]
}

fn pose() -> Pose {
    Pose::new([0.3, -2.0, 1.0], [20.0, 50.0, -70.0])
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn a_box_is_sampled_as_a_lattice() {
    let solid = Solid::of_shape(Shape::cuboid([0.4, 0.3, 0.2]).unwrap(), Pose::default());
    let samples = solid.sample(0.1, Depth::Full).unwrap();
    assert_eq!(samples.positions.len(), 24);
    assert!(samples.volumes.iter().all(|volume| (volume / 1e-3 - 1.0).abs() < 1e-12));
    let shallowest = samples.positions.iter().map(|&at| -solid.signed_distance(at)).fold(f64::INFINITY, f64::min);
    assert!((shallowest - 0.05).abs() < 1e-15);
}

#[test]
fn volumes_and_areas_sum_to_those_of_the_solid() {
    for shape in shapes() {
        let solid = Solid::of_shape(shape.clone(), pose());
        for spacing in [0.05, 0.021] {
            let samples = solid.sample(spacing, Depth::Full).unwrap();
            let (volume, area) = (samples.volumes.iter().sum::<f64>(), samples.areas.iter().sum::<f64>());
            assert!((volume / solid.volume() - 1.0).abs() < 1e-10, "{shape:?}: {volume} {}", solid.volume());
            assert!((area / solid.area() - 1.0).abs() < 1e-10, "{shape:?}: {area} {}", solid.area());
        }
    }
}

#[test]
fn particles_are_inside_and_about_a_spacing_apart() {
    for shape in shapes() {
        let solid = Solid::of_shape(shape.clone(), pose());
        let spacing = 0.04;
        let samples = solid.sample(spacing, Depth::Full).unwrap();
        for &position in &samples.positions {
            assert!(solid.signed_distance(position) < 0.0, "{shape:?}: {position:?}");
        }
        for (at, &one) in samples.positions.iter().enumerate() {
            let nearest =
                samples.positions[..at].iter().map(|&other| distance(one, other)).fold(f64::INFINITY, f64::min);
            assert!(nearest > 0.3 * spacing, "{shape:?}: {nearest}");
        }
        let least = samples.volumes.iter().copied().fold(f64::INFINITY, f64::min);
        let most = samples.volumes.iter().copied().fold(0.0, f64::max);
        assert!(least > 0.0 && most < 4.0 * spacing.powi(3), "{shape:?}: {least} to {most}");
    }
}

#[test]
fn layers_are_the_outermost_of_all_particles() {
    for shape in shapes() {
        let solid = Solid::of_shape(shape.clone(), Pose::default());
        let all = solid.sample(0.03, Depth::Full).unwrap();
        let some = solid.sample(0.03, Depth::Layers(2)).unwrap();
        let bits = |at: [f64; 3]| at.map(f64::to_bits);
        let known: std::collections::HashMap<_, _> =
            all.positions.iter().zip(&all.volumes).map(|(&at, volume)| (bits(at), volume)).collect();
        for (&at, volume) in some.positions.iter().zip(&some.volumes) {
            assert_eq!(known.get(&bits(at)), Some(&volume), "{shape:?}: {at:?}");
        }
        let kept: std::collections::HashSet<_> = some.positions.iter().map(|&at| bits(at)).collect();
        for &at in all.positions.iter().filter(|at| !kept.contains(&bits(**at))) {
            assert!(solid.signed_distance(at) < -0.05, "{shape:?}: {at:?} is left out");
        }
    }
}

#[test]
fn any_number_of_threads_samples_alike() {
    let solid = Solid::of_shape(shapes().pop().unwrap(), pose());
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| solid.sample(0.01, Depth::Layers(3)).unwrap())
    };
    assert_eq!(with(1), with(4));
}

#[test]
fn what_cannot_be_is_refused() {
    for size in [[0.0, 1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, f64::NAN], [1.0, f64::INFINITY, 1.0]] {
        assert!(matches!(Shape::cuboid(size), Err(SolidError::Size { .. })), "{size:?}");
    }
    let refused = |corners: &[[f64; 2]]| Profile::new(corners.to_vec()).unwrap_err().to_string();
    assert!(refused(&[[0.0, 0.0], [1.0, 0.0]]).contains("2 corners"));
    assert!(refused(&[[0.0, 0.0], [1.0, 0.0], [-1.0, 1.0]]).contains("[-1.0, 1.0]"));
    assert!(refused(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]).contains("cross or touch"));
    assert!(refused(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]).contains("corners 0 and 2 cross"));
    let solid = Solid::of_shape(Shape::sphere(1.0).unwrap(), Pose::default());
    assert!(matches!(solid.sample(0.0, Depth::Full), Err(SolidError::Size { .. })));
    assert!(matches!(solid.sample(1e-4, Depth::Full), Err(SolidError::TooManySamples { .. })));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// A position moved by its distance against the way out lies on the surface, and no position of the surface is nearer.
    #[test]
    fn distances_are_those_to_the_nearest_point(x in -0.9..0.9, y in -0.9..0.9, z in -0.7..1.3) {
        for shape in shapes() {
            let point = [x, y, z];
            let nearest = shape.nearest(point);
            let foot = std::array::from_fn(|axis| point[axis] - nearest.distance * nearest.normal[axis]);
            prop_assert!(shape.nearest(foot).distance.abs() < 1e-9, "{shape:?}");
            prop_assert!((distance(nearest.normal, [0.0; 3]) - 1.0).abs() < 1e-9, "{shape:?}");
            // The distance changes by the length of a step at most, and by all of it along the way out.
            let step = 1e-4 * nearest.distance.signum();
            let out = std::array::from_fn(|axis| point[axis] + step * nearest.normal[axis]);
            let after = shape.nearest(out);
            let grown = after.distance - nearest.distance;
            // Outside, and where the step does not lead across to where another part of the surface is nearest.
            let is_smooth = nearest.distance > 0.0 && distance(after.normal, nearest.normal) < 1e-6;
            prop_assert!(grown.abs() <= 1e-4 + 1e-12 && (!is_smooth || (grown - 1e-4).abs() < 1e-9), "{shape:?} {grown}");
        }
    }

    #[test]
    fn any_solid_sums_to_its_volume_by_particles_inside_it(
        kind in 0..4, size in [0.05..1.0, 0.05..1.0, 0.05..1.0], turn in [0.0..360.0, 0.0..360.0, 0.0..360.0], spacing in 0.03..0.2,
    ) {
        let [a, b, c] = size;
        let shape = match kind {
            0 => Shape::cuboid(size),
            1 => Shape::sphere(a),
            2 => Shape::cylinder(a, b),
            _ => Profile::new(vec![[a, 0.0], [a + b, 0.0], [a + 0.5 * b, c]]).map(Shape::Revolution),
        };
        let solid = Solid::of_shape(shape.unwrap(), Pose::new([1.0, 2.0, 3.0], turn));
        let samples = solid.sample(spacing, Depth::Full).unwrap();
        prop_assert!((samples.volumes.iter().sum::<f64>() / solid.volume() - 1.0).abs() < 1e-9);
        prop_assert!((samples.areas.iter().sum::<f64>() / solid.area() - 1.0).abs() < 1e-9);
        prop_assert!(samples.volumes.iter().all(|&volume| volume > 0.0));
        prop_assert!(samples.positions.iter().all(|&at| solid.signed_distance(at) < 0.0));
    }

    /// The sign of the distance agrees with counting: the part of random points that are inside is the volume.
    #[test]
    fn the_volume_is_where_the_distance_is_negative(points in prop::collection::vec([0.0..1.0, 0.0..1.0, 0.0..1.0], 4000)) {
        for shape in shapes() {
            let [low, high] = shape.bounds();
            let inside = |point: &&[f64; 3]| {
                let point = std::array::from_fn(|axis| low[axis] + (high[axis] - low[axis]) * point[axis]);
                shape.nearest(point).distance < 0.0
            };
            let found = points.iter().filter(inside).count() as f64 / points.len() as f64;
            let part = shape.volume() / (0..3).map(|axis| high[axis] - low[axis]).product::<f64>();
            let error = (part * (1.0 - part) / points.len() as f64).sqrt();
            prop_assert!((found - part).abs() <= 5.0 * error, "{shape:?}");
        }
    }
}
