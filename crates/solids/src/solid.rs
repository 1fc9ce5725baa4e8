//! A shape or a mesh somewhere in the scene.

use crate::{Depth, Mesh, Nearest, Pose, Samples, Shape, SolidError, sample};

/// A solid in the scene's coordinates, m.
#[derive(Debug, Clone)]
pub struct Solid {
    body: Body,
    pose: Pose,
}

#[derive(Debug, Clone)]
enum Body {
    Shape(Shape),
    Mesh(Mesh),
}

impl Solid {
    /// A shape, turned and moved.
    pub fn of_shape(shape: Shape, pose: Pose) -> Self {
        Self { body: Body::Shape(shape), pose }
    }

    /// A mesh, turned and moved.
    pub fn of_mesh(mesh: Mesh, pose: Pose) -> Self {
        Self { body: Body::Mesh(mesh), pose }
    }

    /// Signed distance of a position to the surface and the way out.
    pub fn nearest(&self, point: [f64; 3]) -> Nearest {
        let nearest = self.nearest_of_its_own(self.pose.unplace(point));
        Nearest { normal: self.pose.turn(nearest.normal), ..nearest }
    }

    /// Signed distance to the surface, m; negative inside.
    pub fn signed_distance(&self, point: [f64; 3]) -> f64 {
        self.nearest_of_its_own(self.pose.unplace(point)).distance
    }

    /// A direction of the scene in the solid's own coordinates.
    pub fn own_direction(&self, direction: [f64; 3]) -> [f64; 3] {
        self.pose.turn_back(direction)
    }

    /// A direction in the solid's own coordinates as one of the scene.
    pub fn direction_of(&self, own: [f64; 3]) -> [f64; 3] {
        self.pose.turn(own)
    }

    /// The axis of its own, and 0 for its negative or 1 for its positive end, along which a direction of the scene points most; the first of those that
    /// are equal.
    pub fn axis_and_end(&self, direction: [f64; 3]) -> [usize; 2] {
        let own = self.pose.turn_back(direction);
        let axis = (1..3).fold(0, |best, axis| if own[axis].abs() > own[best].abs() { axis } else { best });
        [axis, usize::from(own[axis] > 0.0)]
    }

    /// Smallest and largest coordinates of the box round the solid's own box: never too small, where the solid is turned
    /// often larger than need be.
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        let corners = self.own_bounds();
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for corner in 0..8 {
            let own = std::array::from_fn(|axis| corners[corner >> axis & 1][axis]);
            let placed = self.pose.place(own);
            for axis in 0..3 {
                bounds[0][axis] = bounds[0][axis].min(placed[axis]);
                bounds[1][axis] = bounds[1][axis].max(placed[axis]);
            }
        }
        bounds
    }

    /// Volume, m³.
    pub fn volume(&self) -> f64 {
        match &self.body {
            Body::Shape(shape) => shape.volume(),
            Body::Mesh(mesh) => mesh.volume(),
        }
    }

    /// Surface, m².
    pub fn area(&self) -> f64 {
        match &self.body {
            Body::Shape(shape) => shape.area(),
            Body::Mesh(mesh) => mesh.area(),
        }
    }

    /// Particles that stand for the solid, about `spacing` m apart: see [`Samples`].
    ///
    /// # Errors
    /// [`SolidError::Size`] for a spacing that is not above 0, [`SolidError::TooManySamples`].
    pub fn sample(&self, spacing: f64, depth: Depth) -> Result<Samples, SolidError> {
        let samples = sample::sample(self, spacing, depth)?;
        let positions = samples.positions.into_iter().map(|point| self.pose.place(point)).collect();
        Ok(Samples { positions, ..samples })
    }

    /// [`Solid::nearest`] in the solid's own coordinates.
    pub(crate) fn nearest_of_its_own(&self, point: [f64; 3]) -> Nearest {
        match &self.body {
            Body::Shape(shape) => shape.nearest(point),
            Body::Mesh(mesh) => mesh.nearest(point),
        }
    }

    /// The box round the solid in its own coordinates.
    pub(crate) fn own_bounds(&self) -> [[f64; 3]; 2] {
        match &self.body {
            Body::Shape(shape) => shape.bounds(),
            Body::Mesh(mesh) => mesh.bounds(),
        }
    }
}
