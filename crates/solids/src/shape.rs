//! Solids given by a few numbers.

use crate::{Nearest, Profile, SolidError};
use std::f64::consts::PI;

/// A solid given by a few numbers, in its own coordinates, m.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A box with its middle at the origin.
    Box {
        /// Lengths of its sides.
        size: [f64; 3],
    },
    /// A ball with its middle at the origin.
    Sphere {
        /// Its radius.
        radius: f64,
    },
    /// A cylinder along z with its middle at the origin.
    Cylinder {
        /// Its radius.
        radius: f64,
        /// Its length along z.
        height: f64,
    },
    /// A profile turned about z.
    Revolution(Profile),
}

impl Shape {
    /// A box.
    ///
    /// # Errors
    /// [`SolidError::Size`] for a side that is not above 0.
    pub fn cuboid(size: [f64; 3]) -> Result<Self, SolidError> {
        size.iter().try_for_each(|&side| above_zero("the side of a box in m", side))?;
        Ok(Self::Box { size })
    }

    /// A ball.
    ///
    /// # Errors
    /// [`SolidError::Size`] for a radius that is not above 0.
    pub fn sphere(radius: f64) -> Result<Self, SolidError> {
        above_zero("the radius of a sphere in m", radius)?;
        Ok(Self::Sphere { radius })
    }

    /// A cylinder.
    ///
    /// # Errors
    /// [`SolidError::Size`] for a radius or height that is not above 0.
    pub fn cylinder(radius: f64, height: f64) -> Result<Self, SolidError> {
        above_zero("the radius of a cylinder in m", radius)?;
        above_zero("the height of a cylinder in m", height)?;
        Ok(Self::Cylinder { radius, height })
    }

    /// Distance and way out, exact.
    pub fn nearest(&self, point: [f64; 3]) -> Nearest {
        match self {
            Self::Box { size } => {
                let (distance, normal) = nearest_of_box(point, size.map(|side| 0.5 * side));
                Nearest { distance, normal }
            }
            Self::Sphere { radius } => {
                let (length, normal) = length_and_direction(point);
                Nearest { distance: length - radius, normal }
            }
            Self::Cylinder { radius, height } => {
                turned(point, |around, along| nearest_of_box([around, along], [*radius, 0.5 * height]))
            }
            Self::Revolution(profile) => turned(point, |around, along| profile.nearest([around, along])),
        }
    }

    /// Its smallest and largest coordinates.
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        let about_origin = |half: [f64; 3]| [half.map(|length| -length), half];
        match self {
            Self::Box { size } => about_origin(size.map(|side| 0.5 * side)),
            Self::Sphere { radius } => about_origin([*radius; 3]),
            Self::Cylinder { radius, height } => about_origin([*radius, *radius, 0.5 * height]),
            Self::Revolution(profile) => {
                let ([low, high], radius) = (profile.range(), profile.largest_radius());
                [[-radius, -radius, low], [radius, radius, high]]
            }
        }
    }

    /// Its volume, m³.
    pub fn volume(&self) -> f64 {
        match self {
            Self::Box { size } => size.iter().product(),
            Self::Sphere { radius } => 4.0 / 3.0 * PI * radius.powi(3),
            Self::Cylinder { radius, height } => PI * radius * radius * height,
            Self::Revolution(profile) => profile.volume(),
        }
    }

    /// Its surface, m².
    pub fn area(&self) -> f64 {
        match self {
            Self::Box { size: [x, y, z] } => 2.0 * (x * y + y * z + z * x),
            Self::Sphere { radius } => 4.0 * PI * radius * radius,
            Self::Cylinder { radius, height } => 2.0 * PI * radius * (radius + height),
            Self::Revolution(profile) => profile.area(),
        }
    }
}

pub(crate) fn above_zero(what: &'static str, value: f64) -> Result<(), SolidError> {
    let fine = value > 0.0 && value.is_finite();
    if fine { Ok(()) } else { Err(SolidError::Size { what, value, must: "a finite number above 0" }) }
}

/// Length of a vector and its direction; along the first axis where it has none.
pub(crate) fn length_and_direction<const D: usize>(vector: [f64; D]) -> (f64, [f64; D]) {
    let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    let direction = if length > 0.0 { vector.map(|x| x / length) } else { first_axis() };
    (length, direction)
}

fn first_axis<const D: usize>() -> [f64; D] {
    std::array::from_fn(|axis| if axis == 0 { 1.0 } else { 0.0 })
}

/// Signed distance of a box about the origin with these half sides, and its gradient.
fn nearest_of_box<const D: usize>(point: [f64; D], half: [f64; D]) -> (f64, [f64; D]) {
    let beyond: [f64; D] = std::array::from_fn(|axis| point[axis].abs() - half[axis]);
    let with_signs = |vector: [f64; D]| std::array::from_fn(|axis| vector[axis].copysign(point[axis]));
    if beyond.iter().any(|&length| length > 0.0) {
        let (length, direction) = length_and_direction(beyond.map(|length| length.max(0.0)));
        return (length, with_signs(direction));
    }
    let nearest = (0..D).reduce(|best, axis| if beyond[axis] > beyond[best] { axis } else { best }).unwrap_or(0);
    let direction = std::array::from_fn(|axis| if axis == nearest { 1.0 } else { 0.0 });
    (beyond[nearest], with_signs(direction))
}

/// The nearest point of a solid of revolution, from that of its half plane (distance from the axis, position along it).
fn turned(point: [f64; 3], in_half_plane: impl Fn(f64, f64) -> (f64, [f64; 2])) -> Nearest {
    let (around, direction) = length_and_direction([point[0], point[1]]);
    let (distance, [out, along]) = in_half_plane(around, point[2]);
    Nearest { distance, normal: [out * direction[0], out * direction[1], along] }
}
