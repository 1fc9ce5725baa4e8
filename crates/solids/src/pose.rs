//! Where a solid stands and how it is turned.

use parry3d_f64::math::{Pose as Rigid, Rotation, Vector};

/// A position and a turn: a solid is first turned about its own origin, then moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose(Rigid);

impl Pose {
    /// Origin of the solid at `position` (m), turned by `degrees` about x, then y, then z, axes that stay where they are.
    pub fn new(position: [f64; 3], degrees: [f64; 3]) -> Self {
        let [x, y, z] = degrees.map(f64::to_radians);
        let turn = Rotation::from_rotation_z(z) * Rotation::from_rotation_y(y) * Rotation::from_rotation_x(x);
        Self(Rigid::from_parts(Vector::from(position), turn))
    }

    /// From the solid's own coordinates to the scene's.
    pub fn place(&self, point: [f64; 3]) -> [f64; 3] {
        self.0.transform_point(Vector::from(point)).into()
    }

    /// From the scene's coordinates to the solid's own.
    pub fn unplace(&self, point: [f64; 3]) -> [f64; 3] {
        self.0.inverse_transform_point(Vector::from(point)).into()
    }

    /// Turns a direction from the solid's own coordinates to the scene's.
    pub fn turn(&self, direction: [f64; 3]) -> [f64; 3] {
        self.0.transform_vector(Vector::from(direction)).into()
    }

    /// Turns a direction from the scene's coordinates to the solid's own.
    pub fn turn_back(&self, direction: [f64; 3]) -> [f64; 3] {
        self.0.inverse_transform_vector(Vector::from(direction)).into()
    }
}

impl Default for Pose {
    fn default() -> Self {
        Self(Rigid::identity())
    }
}

#[cfg(test)]
mod tests {
    use super::Pose;

    #[test]
    fn it_is_turned_about_x_then_y_then_z_and_then_moved() {
        let pose = Pose::new([1.0, 2.0, 3.0], [90.0, 0.0, 90.0]);
        // y goes to z by the turn about x and stays there by that about z.
        let placed = pose.place([0.0, 1.0, 0.0]);
        let expected = [1.0, 2.0, 4.0];
        assert!((0..3).all(|axis| (placed[axis] - expected[axis]).abs() < 1e-14), "{placed:?}");
        let back = pose.unplace(placed);
        assert!((0..3).all(|axis| (back[axis] - [0.0, 1.0, 0.0][axis]).abs() < 1e-14), "{back:?}");
        let back = pose.turn_back([0.0, 0.0, 1.0]);
        assert!((0..3).all(|axis| (back[axis] - [0.0, 1.0, 0.0][axis]).abs() < 1e-14), "{back:?}");
    }
}
