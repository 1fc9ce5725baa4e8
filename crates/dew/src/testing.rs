//! What several tests need.

use crate::solids::{Body, Material};

/// Glass (Incropera & DeWitt, table A.3).
pub const GLASS: Material = Material { conductivity: 1.4, heat_capacity: 750.0, density: 2500.0 };

/// A block of glass of so many particles along each axis, a `spacing` apart, with a corner at `corner`.
pub fn block(corner: [f64; 3], counts: [usize; 3], spacing: f64) -> Body {
    let mut positions = Vec::new();
    for z in 0..counts[2] {
        for y in 0..counts[1] {
            for x in 0..counts[0] {
                let index = [x, y, z];
                positions.push([0, 1, 2].map(|axis| corner[axis] + (index[axis] as f64 + 0.5) * spacing));
            }
        }
    }
    let volumes = vec![spacing.powi(3); positions.len()];
    let areas = vec![spacing.powi(2); positions.len()];
    Body { positions, volumes, areas, material: GLASS, temperature: 280.0, held: true, surface: None, walls: None }
}
