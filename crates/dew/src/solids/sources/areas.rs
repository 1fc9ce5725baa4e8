//! Which area of a solid's surface each of its particles stands for, measured on the solid's true form and cut at the box's sides.

use crate::room::Room;
use crate::solids::{Searched, Solids, distance_squared};
use corpuscle_solids::Solid;

/// Rays for a length of a spacing by which areas are measured.
const DIVISIONS: f64 = 8.0;

/// The same for areas in a side of the box: there are fewer of them.
const DIVISIONS_IN_SIDE: f64 = 24.0;

/// Rays are followed in steps of the distance to the surface, or, where that is smaller, of so small a part of what is between rays: what is thinner is not seen.
const STEPS_BETWEEN_RAYS: f64 = 16.0;

/// Radius of the search for particles from their surface, in spacings.
const SEARCHED: f64 = 2.0;

/// Surface areas of a solid, by rays through it.
pub struct AreaSampler<'a> {
    solid: &'a Solid,
    room: &'a Room,
    spacing: f64,
    particles: Searched,
    count: usize,
}

impl<'a> AreaSampler<'a> {
    /// The solid with this number.
    pub fn new(solids: &Solids, number: u32, solid: &'a Solid, room: &'a Room, spacing: f64) -> Self {
        let sites = solids.sites(room, 0.0, |particle| particle.body == number);
        let particles = Searched::new(&sites, SEARCHED * spacing);
        Self { solid, room, spacing, particles, count: solids.particles.len() }
    }

    /// Area of the surface in the box for each particle of all solids, m2. What lies in the plane of a side of the box is left out: no air is there.
    ///
    /// Rays a distance d apart along each axis a meet the surface, each for an area d^2 / |n_a|; with the weights n_a^2, whose sum is 1, none counts twice.
    pub fn in_box(&self) -> Vec<f64> {
        let mut areas = vec![0.0; self.count];
        for axis in 0..3 {
            self.for_each_ray(axis, DIVISIONS, |position, area| self.add_crossings(axis, position, area, &mut areas));
        }
        areas
    }

    /// Calls `each` for rays along an axis with their first positions and the areas between them, m2. They fill the box round the solid, so that faces along its axes are
    /// met exactly.
    fn for_each_ray(&self, axis: usize, divisions: f64, mut each: impl FnMut([f64; 3], f64)) {
        let [low, high] = self.bounds();
        let beside = [(axis + 1) % 3, (axis + 2) % 3];
        let lengths = beside.map(|axis| high[axis] - low[axis]);
        let counts = lengths.map(|length| (length * divisions / self.spacing).round().max(1.0));
        let between = [0, 1].map(|k| lengths[k] / counts[k]);
        for i in 0..counts[0] as usize {
            for j in 0..counts[1] as usize {
                let mut position = low;
                position[beside[0]] += (i as f64 + 0.5) * between[0];
                position[beside[1]] += (j as f64 + 0.5) * between[1];
                each(position, between[0] * between[1]);
            }
        }
    }

    /// Follows a ray and adds the areas at its crossings with the surface.
    fn add_crossings(&self, axis: usize, mut position: [f64; 3], area: f64, areas: &mut [f64]) {
        let shortest = self.spacing / DIVISIONS / STEPS_BETWEEN_RAYS;
        // From before the solid to beyond it, and within the box: a surface in the plane of a side is not met.
        let [low, high] = self.solid.bounds();
        let within = 1e-3 * shortest;
        position[axis] = (low[axis] - shortest).max(self.room.low[axis] + within);
        let end = (high[axis] + shortest).min(self.room.high[axis] - within);
        let mut before = self.solid.signed_distance(position);
        while position[axis] < end {
            let from = position[axis];
            // The surface is at least as far away as the distance.
            position[axis] = (from + before.abs().max(shortest)).min(end);
            let after = self.solid.signed_distance(position);
            if (before < 0.0) != (after < 0.0) {
                // Seen from outside, the nearest face is that which the ray crosses, however near an edge is.
                let mut outside = position;
                outside[axis] = if before < 0.0 { position[axis] } else { from };
                if let Some(particle) = self.nearest_particle(outside) {
                    areas[particle] += area * self.solid.nearest(outside).normal[axis].abs();
                }
            }
            before = after;
        }
    }

    /// Area with which each particle of all solids lies in a side of the box, m2: at the lower, 0, or upper, 1, end of an axis.
    pub fn in_side(&self, [axis, end]: [usize; 2]) -> Vec<f64> {
        let cell = self.spacing / DIVISIONS_IN_SIDE;
        let mut areas = vec![0.0; self.count];
        self.for_each_ray(axis, DIVISIONS_IN_SIDE, |mut position, area| {
            position[axis] = [self.room.low[axis] + 0.5 * cell, self.room.high[axis] - 0.5 * cell][end];
            let part = (0.5 - self.solid.signed_distance(position) / cell).clamp(0.0, 1.0);
            if part > 0.0
                && let Some(particle) = self.nearest_particle(position)
            {
                areas[particle] += part * area;
            }
        });
        areas
    }

    /// Smallest and largest coordinates of what of the solid is in the box, m.
    fn bounds(&self) -> [[f64; 3]; 2] {
        let [low, high] = self.solid.bounds();
        [
            [0, 1, 2].map(|axis| low[axis].max(self.room.low[axis])),
            [0, 1, 2].map(|axis| high[axis].min(self.room.high[axis])),
        ]
    }

    fn nearest_particle(&self, position: [f64; 3]) -> Option<usize> {
        let near = self.particles.near(position, SEARCHED * self.spacing);
        let distance = |site: &crate::solids::Site| distance_squared(site.position, position);
        near.map(|(site, _)| site).min_by(|a, b| distance(a).total_cmp(&distance(b))).map(|site| site.particle as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::AreaSampler;
    use crate::air::Scale;
    use crate::room::{Face, Room};
    use crate::solids::{Body, Material, Solids};
    use corpuscle_solids::{Pose, Shape, Solid};

    const GLASS: Material = Material { conductivity: 1.4, heat_capacity: 750.0, density: 2500.0 };

    /// Areas in the box and in its side at z = 0, m2, of a solid in a box of 0.03 by 0.04 by 0.05 m.
    fn areas(shape: Shape, position: [f64; 3], degrees: [f64; 3], spacing: f64) -> [f64; 2] {
        let room = Room { low: [0.0; 3], high: [0.03, 0.04, 0.05], faces: [[Face::Wall; 2]; 3] };
        let solid = Solid::of_shape(shape, Pose::new(position, degrees));
        let mut body = Body::sampled(solid.clone(), spacing, GLASS, 280.0, false).unwrap();
        let is_inside = |position: &[f64; 3]| (0..3).all(|axis| (0.0..room.high[axis]).contains(&position[axis]));
        let kept: Vec<usize> = (0..body.positions.len()).filter(|&at| is_inside(&body.positions[at])).collect();
        body.positions = kept.iter().map(|&at| body.positions[at]).collect();
        let solids = Solids::new(&[body], &room, &Scale::new(spacing, corpuscle_scene::KernelName::Mueller), 0.15);
        let measured = AreaSampler::new(&solids, 0, &solid, &room, spacing);
        [measured.in_box(), measured.in_side([2, 0])].map(|areas| areas.iter().sum())
    }

    fn assert_near(found: f64, exact: f64, error: f64) {
        assert!((found / exact - 1.0).abs() < error, "{found} for {exact}");
    }

    #[test]
    fn areas_are_those_of_the_true_form_turned_or_not_and_cut_by_the_box() {
        for degrees in [[0.0; 3], [20.0, 35.0, 50.0], [7.0, -63.0, 12.0]] {
            for spacing in [2e-3, 1.3e-3] {
                let cuboid = Shape::cuboid([0.01, 0.014, 0.008]).unwrap();
                let [in_box, in_side] = areas(cuboid, [0.0151, 0.0207, 0.0248], degrees, spacing);
                assert_near(in_box, 2.0 * (0.01 * 0.014 + 0.014 * 0.008 + 0.008 * 0.01), 0.004);
                assert_eq!(in_side, 0.0);
            }
        }
        // A ball whose centre is 3 mm above the side: a zone of 8 mm, and a disk of 4 mm.
        let [in_box, in_side] = areas(Shape::sphere(0.005).unwrap(), [0.0142, 0.0193, 0.003], [0.0; 3], 1e-3);
        assert_near(in_box, std::f64::consts::TAU * 0.005 * 0.008, 0.004);
        assert_near(in_side, std::f64::consts::PI * 0.004_f64.powi(2), 0.01);
    }

    #[test]
    fn what_lies_in_a_side_of_the_box_meets_no_air() {
        let cuboid = Shape::cuboid([0.02, 0.03, 0.006]).unwrap();
        let [in_box, in_side] = areas(cuboid, [0.015, 0.021, 0.003], [0.0; 3], 1.1e-3);
        assert_near(in_box, 0.02 * 0.03 + 2.0 * 0.05 * 0.006, 0.004);
        assert_near(in_side, 0.02 * 0.03, 0.004);
        // From side to side, nearly exactly.
        let cuboid = Shape::cuboid([0.03, 0.04, 0.006]).unwrap();
        let found = areas(cuboid, [0.015, 0.02, 0.003], [0.0; 3], 1.1e-3);
        found.into_iter().for_each(|area| assert_near(area, 0.03 * 0.04, 1e-5));
    }
}
