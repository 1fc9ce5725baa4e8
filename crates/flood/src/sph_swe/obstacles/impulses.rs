//! Impulses of the water on obstacles: of particles that are put back to the wall, and of forces over time.

use crate::sph_swe::{DENSITY, SphSweFlood, State};

impl SphSweFlood {
    /// Puts particles that penetrate obstacles back to the wall.
    pub(in crate::sph_swe) fn resolve_obstacle_penetration(&mut self) {
        if self.surroundings.obstacles.any() {
            let State { particles, impulses, momentum, put_back, .. } = &mut self.state;
            let sum = |impulses: &[[f64; 2]]| impulses.iter().flatten().sum::<f64>();
            let before = sum(impulses);
            let back = self.surroundings.obstacles.resolve_penetration(particles, self.spacing, impulses);
            *put_back += back as u64;
            momentum.book(-DENSITY * (sum(impulses) - before));
        }
    }

    /// Sums the forces on obstacles over a step.
    pub(in crate::sph_swe) fn add_obstacle_impulses(&mut self, step: f64) {
        let now = self.solver.on_obstacles();
        let State { on_obstacles, impulses, .. } = &mut self.state;
        for ((impulse, last), now) in impulses.iter_mut().zip(on_obstacles.iter_mut()).zip(now) {
            (0..2).for_each(|k| impulse[k] += step * now[k]);
            *last = *now;
        }
    }
}
