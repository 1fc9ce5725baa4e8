//! Position of the surface of the solids, from the gradient of the colour c_s = sum V_j W, 1 in solids and 0 in air.

use super::{Searched, Solids};
use crate::air::Scale;
use crate::room::Room;
use corpuscle_sph::kernel::SmoothingKernel;
use rayon::prelude::*;

impl Solids {
    /// Finds the boundary particles, their normals, and which particles are within reach of air.
    pub(super) fn find_boundary(&mut self, room: &Room, scale: &Scale, threshold: f64) {
        let h = scale.h();
        let all = Searched::new(&self.sites(room, h, |_| true), h);
        let normal = |position: [f64; 3]| {
            let mut gradient = [0.0; 3];
            for (site, r_squared) in all.near(position, h) {
                if r_squared > 0.0 {
                    let r = r_squared.sqrt();
                    let slope = self.particles[site.particle as usize].volume * scale.kernel.slope(r) / r;
                    (0..3).for_each(|axis| gradient[axis] += slope * (site.position[axis] - position[axis]));
                }
            }
            let steepness = gradient.iter().map(|along| along * along).sum::<f64>().sqrt();
            let is_steep = steepness * scale.spacing > threshold;
            is_steep.then(|| gradient.map(|along| -along / steepness))
        };
        let normals: Vec<_> = self.particles.par_iter().map(|particle| normal(particle.position)).collect();
        self.particles.iter_mut().zip(normals).for_each(|(particle, normal)| particle.normal = normal);
        let boundary = Searched::new(&self.sites(room, h, |particle| particle.normal.is_some()), h);
        let near: Vec<bool> =
            self.particles.par_iter().map(|particle| boundary.near(particle.position, h).next().is_some()).collect();
        self.particles.iter_mut().zip(near).for_each(|(particle, near)| particle.near_surface = near);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::room::Face;
    use crate::settings::BOUNDARY_THRESHOLD;
    use crate::testing::block;

    #[test]
    fn the_first_layer_of_a_block_is_its_boundary() {
        // 10 x 10 x 6 particles, of which the lowest layer lies on the floor, a wall of the room.
        let room = Room { low: [-20.0, -20.0, 0.0], high: [20.0; 3], faces: [[Face::Wall; 2]; 3] };
        let scale = Scale::new(1.0, corpuscle_scene::KernelName::Mueller);
        let solids = Solids::new(&[block([0.0; 3], [10, 10, 6], 1.0)], &room, &scale, BOUNDARY_THRESHOLD);
        for particle in &solids.particles {
            let [x, y, z] = particle.position;
            let depths = [x, 10.0 - x, y, 10.0 - y, 6.0 - z];
            let on_surface = depths.iter().any(|&depth| depth < 1.0);
            assert_eq!(particle.normal.is_some(), on_surface, "{particle:?}");
            assert_eq!(particle.near_surface, depths.iter().any(|&depth| depth < 2.0));
        }
        let top = solids.particles.iter().find(|particle| particle.position == [5.5, 5.5, 5.5]).unwrap();
        let normal = top.normal.unwrap();
        assert!((normal[2] - 1.0).abs() < 1e-12, "{normal:?}");
        let edge = solids.particles.iter().find(|particle| particle.position == [9.5, 5.5, 5.5]).unwrap();
        let normal = edge.normal.unwrap();
        assert!((normal[0] - 0.5_f64.sqrt()).abs() < 1e-9 && normal[1].abs() < 1e-9, "{normal:?}");
    }

    #[test]
    fn the_end_of_a_block_in_an_open_face_is_no_surface() {
        let mut faces = [[Face::Wall; 2]; 3];
        faces[2][0] = Face::Outlet;
        let room = Room { low: [-20.0, -20.0, 0.0], high: [20.0; 3], faces };
        let solids = Solids::new(
            &[block([0.0; 3], [10, 10, 6], 1.0)],
            &room,
            &Scale::new(1.0, corpuscle_scene::KernelName::Mueller),
            BOUNDARY_THRESHOLD,
        );
        for particle in solids.particles.iter().filter(|particle| particle.position[2] < 1.0) {
            let [x, y, _] = particle.position;
            let on_side = [x, 10.0 - x, y, 10.0 - y].iter().any(|&depth| depth < 1.0);
            assert_eq!(particle.normal.is_some(), on_side, "{particle:?}");
            assert!(particle.normal.is_none_or(|normal| normal[2].abs() < 1e-9), "{particle:?}");
        }
    }
}
