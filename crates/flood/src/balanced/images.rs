//! What particles look like beyond an edge.

use super::{Balanced, Slopes};
use crate::edges::{EdgeRule, EdgeRules};
use crate::scheme::Surroundings;

impl Balanced {
    /// Fills in the images from the particles that they show.
    pub(super) fn show_images(&mut self, surroundings: &Surroundings) {
        let Surroundings { edges, terrain, .. } = surroundings;
        for &(place, source) in &self.arrangement.images {
            let place = place as usize;
            let image = self.arrangement.entries[place].image;
            let mut column = self.columns[source as usize];
            let mut ground_slope = self.slopes[source as usize].ground;
            let (x, y) = (self.arrangement.x[place], self.arrangement.y[place]);
            let bounds = edges.bounds;
            if let Some(rule) = edges.along_x(image) {
                match rule {
                    EdgeRule::Periodic => {
                        let [west, east] = [bounds.x_min, bounds.x_max].map(|side| terrain.height(side, column.y));
                        column.surface += f64::from(image.x) * (east - west);
                    }
                    EdgeRule::Wall => (column.u, ground_slope[0]) = (-column.u, -ground_slope[0]),
                    EdgeRule::Open | EdgeRule::Stage(_) => {}
                }
            }
            if let Some(rule) = edges.along_y(image) {
                match rule {
                    EdgeRule::Periodic => {
                        let [south, north] = [bounds.y_min, bounds.y_max].map(|side| terrain.height(column.x, side));
                        column.surface += f64::from(image.y) * (north - south);
                    }
                    EdgeRule::Wall => (column.v, ground_slope[1]) = (-column.v, -ground_slope[1]),
                    EdgeRule::Open | EdgeRule::Stage(_) => {}
                }
            }
            (column.x, column.y) = (x, y);
            self.columns[place] = column;
            self.slopes[place].ground = ground_slope;
            self.slopes[place].outside = f64::from(u8::from(!edges.is_periodic(image)));
        }
    }

    /// Turns the slopes of the images as their edges turn them.
    pub(super) fn turn_images(&mut self, edges: &EdgeRules) {
        for &(place, source) in &self.arrangement.images {
            let image = self.arrangement.entries[place as usize].image;
            let Slopes { ground, outside, .. } = self.slopes[place as usize];
            let mut turned = Slopes { ground, outside, ..self.slopes[source as usize] };
            for (axis, rule) in [edges.along_x(image), edges.along_y(image)].into_iter().enumerate() {
                if rule == Some(&EdgeRule::Wall) {
                    turned.mirror(axis);
                }
            }
            self.slopes[place as usize] = turned;
        }
    }
}

impl Slopes {
    /// As a mirror across `axis` shows them.
    fn mirror(&mut self, axis: usize) {
        self.renormalisation[1] = -self.renormalisation[1];
        self.surface[axis] = -self.surface[axis];
        // The velocity along the axis turns round, and so does every slope along it: twice is not at all.
        let (along, across) = if axis == 0 { (&mut self.u, &mut self.v) } else { (&mut self.v, &mut self.u) };
        along[1 - axis] = -along[1 - axis];
        across[axis] = -across[axis];
    }
}
