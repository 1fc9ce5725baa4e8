//! A wavy plane with a ball over it, made of particles, against the exact surfaces.
//!
//! Two measures, over the pixels of a picture of 1280 x 720:
//!
//! - **Normal error**: the mean angle between the normal of the smoothed surface and that of the exact surface that the line of
//!   sight through the middle of the pixel meets first. Over all pixels in which both are, but those within [`BAND`] pixels of the
//!   ball's outline, where the next measure counts, and of the plane's border.
//! - **Silhouette bleed**: of the pixels within [`BAND`] pixels of the ball's exact outline, on either side, where the plane is more
//!   than six particle radii behind, the part whose distance
//!   is neither that of the ball nor that of the plane: more than two particle radii behind the farthest that is seen of the ball,
//!   and more than two before the plane on this line of sight. A filter that mixes ball and plane makes such pixels; particles
//!   that stand out do not.

use corpuscle_gpu::Gpu;
use corpuscle_render::{
    Camera, Drawable, Droplet, FluidPainter, FluidStyle, Light, Renderer, Smoothing, Stage, Target,
};
use glam::{DVec2, DVec3};

const SIZE: [u32; 2] = [1280, 720];
/// Pixels on either side of the ball's outline.
const BAND: f64 = 8.0;
/// Half the side of the plane, and of its waves height and wave number.
const HALF: f64 = 1.0;
const WAVE: (f64, f64) = (0.03, 9.0);
/// The ball.
const MIDDLE: DVec3 = DVec3::new(0.1, -0.1, 0.4);
const RADIUS: f64 = 0.3;
/// How far particles are off their lattice, in spacings.
const SHAKEN: f64 = 0.25;
/// The same off their surface.
const LIFTED: f64 = 0.1;
/// Distance between particles.
const SPACING: f64 = 0.0174;
/// Radius of particles.
const BALL: f64 = 1.1 * SPACING;

pub struct Scene {
    pub droplets: Vec<Droplet>,
    /// What each pixel should show.
    exact: Vec<Exact>,
}

/// What a pixel should show.
enum Exact {
    /// Nothing that counts.
    Nothing,
    /// A surface with this normal.
    Surface(DVec3),
    /// The ball's outline: distances of the farthest that is seen of the ball, and of the plane.
    Outline(f64, f64),
}

/// What is measured.
pub struct Quality {
    /// Mean, degrees.
    pub normal_error: f64,
    /// Part of the pixels at the outline.
    pub bleed: f64,
}

/// Height and slope of the plane.
fn wave(x: f64, y: f64) -> (f64, DVec2) {
    let (height, k) = WAVE;
    let z = height * (k * x).sin() * (k * y).cos();
    (z, DVec2::new(height * k * (k * x).cos() * (k * y).cos(), -height * k * (k * x).sin() * (k * y).sin()))
}

/// Where a line of sight meets the plane: height falls along it.
fn plane_along(origin: DVec3, direction: DVec3) -> Option<f64> {
    let above = |t: f64| {
        let position = origin + t * direction;
        position.z - wave(position.x, position.y).0
    };
    let (mut near, mut far) = (0.0, 10.0);
    if above(far) > 0.0 {
        return None;
    }
    for _ in 0..45 {
        let middle = 0.5 * (near + far);
        if above(middle) > 0.0 { near = middle } else { far = middle }
    }
    let position = origin + near * direction;
    (position.x.abs() < HALF && position.y.abs() < HALF).then_some(near)
}

/// Where a line of sight meets the ball, and how far from its middle it passes.
fn ball_along(origin: DVec3, direction: DVec3) -> (Option<f64>, f64) {
    let to = MIDDLE - origin;
    let along = to.dot(direction);
    let passes = (to - along * direction).length();
    ((passes < RADIUS).then(|| along - (RADIUS * RADIUS - passes * passes).sqrt()), passes)
}

impl Scene {
    /// Balls whose outer sides lie about in the exact surfaces, on a lattice, shaken.
    pub fn wavy_plane_and_ball() -> Self {
        let mut random = Random(7);
        let mut droplets = Vec::new();
        let count = (2.0 * HALF / SPACING) as i32;
        for row in 0..=count {
            for column in 0..=count {
                let x = -HALF + SPACING * (f64::from(column) + SHAKEN * random.next());
                let y = -HALF + SPACING * (f64::from(row) + SHAKEN * random.next());
                let (z, slope) = wave(x, y);
                let normal = DVec3::new(-slope.x, -slope.y, 1.0).normalize();
                droplets.push(Droplet::ball(
                    (DVec3::new(x, y, z) - (BALL + LIFTED * SPACING * random.next()) * normal).into(),
                    BALL,
                ));
            }
        }
        // Points on a sphere at equal distances (Fibonacci lattice).
        let points = (4.0 * std::f64::consts::PI * RADIUS * RADIUS / (SPACING * SPACING)) as i32;
        for point in 0..points {
            let z = 1.0 - (2.0 * f64::from(point) + 1.0) / f64::from(points);
            let angle = 2.399_963_229_7 * f64::from(point) + SHAKEN * SPACING / RADIUS * random.next();
            let out = DVec3::new((1.0 - z * z).sqrt() * angle.cos(), (1.0 - z * z).sqrt() * angle.sin(), z);
            droplets
                .push(Droplet::ball((MIDDLE + (RADIUS - BALL + LIFTED * SPACING * random.next()) * out).into(), BALL));
        }
        Self { droplets, exact: exact() }
    }

    /// With a style's own smoothing, its range times so much.
    pub fn measure(&self, gpu: &Gpu, smoothing: Smoothing, ranges: f64) -> Quality {
        let renderer = Renderer::new(gpu);
        let water = FluidStyle::water(BALL);
        let style = FluidStyle { smoothing, range: ranges * water.range, ..water };
        let mut fluid = FluidPainter::new(&renderer).fluid(gpu, &stage(), style).unwrap();
        fluid.fill(gpu, self.droplets.iter().copied());
        let target = Target::new(gpu, SIZE, 1).unwrap();
        renderer.draw(&target, &stage(), &camera(), &Light::day(), &mut [&mut fluid as &mut dyn Drawable], None);
        compare(&self.exact, &fluid.distances(gpu).unwrap(), &fluid.normals(gpu).unwrap())
    }
}

fn stage() -> Stage {
    Stage::new([-HALF, -HALF, -0.1], [HALF, HALF, 0.9])
}

fn camera() -> Camera {
    Camera::orbit(&stage(), [-1.2, 0.75], 0.6, f64::from(SIZE[0]) / f64::from(SIZE[1]), 0.0)
}

fn compare(exact: &[Exact], distances: &[Option<f64>], normals: &[Option<[f64; 3]>]) -> Quality {
    let (mut angles, mut compared, mut bled, mut outline) = (0.0, 0, 0, 0);
    for ((exact, distance), normal) in exact.iter().zip(distances).zip(normals) {
        match (exact, distance, normal) {
            (Exact::Outline(rim, plane), Some(distance), _) => {
                outline += 1;
                bled += i32::from(*distance > rim + 2.0 * BALL && *distance < plane - 2.0 * BALL);
            }
            (Exact::Surface(exact), _, Some(normal)) => {
                angles += DVec3::from(*normal).angle_between(*exact).to_degrees();
                compared += 1;
            }
            _ => (),
        }
    }
    assert!(compared > 100_000 && outline > 4_000, "{compared} {outline}");
    Quality { normal_error: angles / f64::from(compared), bleed: f64::from(bled) / f64::from(outline) }
}

fn exact() -> Vec<Exact> {
    let rays = Rays::new(&camera());
    let pixels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| DVec2::new(x.into(), y.into()) + 0.5));
    pixels.map(|pixel| exact_at(&rays, pixel)).collect()
}

fn exact_at(rays: &Rays, pixel: DVec2) -> Exact {
    let eye = rays.eye;
    let (direction, forward) = rays.through(pixel);
    let (ball, passes) = ball_along(eye, direction);
    let plane = plane_along(eye, direction);
    let pixels_to_outline = (passes - RADIUS) / (rays.pixel * (MIDDLE - eye).length());
    if pixels_to_outline.abs() <= BAND {
        let rim = ((MIDDLE - eye).length_squared() - RADIUS * RADIUS).sqrt() * forward;
        let behind = plane.map(|plane| plane * forward).filter(|behind| behind - rim > 6.0 * BALL);
        return behind.map_or(Exact::Nothing, |behind| Exact::Outline(rim, behind));
    }
    if let Some(hit) = ball {
        return Exact::Surface((eye + hit * direction - MIDDLE).normalize());
    }
    let Some(hit) = plane else { return Exact::Nothing };
    let position = eye + hit * direction;
    if position.x.abs().max(position.y.abs()) > HALF - 5.0 * SPACING {
        return Exact::Nothing;
    }
    let (_, slope) = wave(position.x, position.y);
    Exact::Surface(DVec3::new(-slope.x, -slope.y, 1.0).normalize())
}

/// The lines of sight of a camera with perspective.
struct Rays {
    eye: DVec3,
    forward: DVec3,
    right: DVec3,
    up: DVec3,
    /// Height of a pixel at distance 1.
    pixel: f64,
}

impl Rays {
    fn new(camera: &Camera) -> Self {
        let forward = (camera.target - camera.eye).normalize();
        let right = forward.cross(camera.up).normalize();
        let corpuscle_render::Lens::Perspective { field_of_view } = camera.lens else { panic!("perspective") };
        let pixel = 2.0 * (0.5 * field_of_view).tan() / f64::from(SIZE[1]);
        Self { eye: camera.eye, forward, right, up: right.cross(forward), pixel }
    }

    /// Direction through a position in the picture, and its part along the middle line of sight.
    fn through(&self, position: DVec2) -> (DVec3, f64) {
        let [x, y] = [position.x - 0.5 * f64::from(SIZE[0]), 0.5 * f64::from(SIZE[1]) - position.y];
        let direction = (self.forward + self.pixel * (x * self.right + y * self.up)).normalize();
        (direction, direction.dot(self.forward))
    }
}

/// Numbers from -1 to 1 (splitmix64: Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) as f64 / 2f64.powi(63) - 1.0
    }
}
