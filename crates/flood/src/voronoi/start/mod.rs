//! The water at the start: how much of it stands in each cell.

use super::mesh::Mesh;
use super::water::Column;
use crate::error::setup;
use crate::extent::{is_beside, span};
use crate::initial_water::{Filling, StartWater};
use corpuscle_model::ModelError;
use corpuscle_scene::Flood;
use corpuscle_terrain::Terrain;
use rayon::prelude::*;

impl StartWater<'_> {
    /// The water of this body in a cell, whose convex parts have corners in model coordinates.
    pub(crate) fn column(&self, mesh: &Mesh, cell: usize, parts: &[Vec<[f64; 2]>], scratch: &mut Clip) -> Column {
        let area = mesh.area[cell];
        let inside = |outline| parts.iter().map(|part| scratch.area_inside(outline, part)).sum::<f64>();
        let share = self.polygon.as_deref().map(inside).map_or(1.0, |inside| inside / area);
        if share <= 0.0 {
            return Column::default();
        }
        let depth = match &self.filling {
            Filling::Depth(depth) => mean_over(parts, |x, y| depth(x, y).max(0.0)),
            Filling::Level(level) => mesh.depth_below(cell, mean_over(parts, level)),
        };
        let volume = share * area * depth;
        if volume <= 0.0 {
            return Column::default();
        }
        let momentum = [0, 1].map(|axis| volume * mean_over(parts, |x, y| (self.velocity)(x, y)[axis]));
        Column { volume, momentum }
    }
}

/// The water at the start of all cells of a mesh.
pub(crate) fn columns(mesh: &Mesh, bodies: &[StartWater]) -> Vec<Column> {
    (0..mesh.len())
        .into_par_iter()
        .with_min_len(256)
        .map_init(Default::default, |(parts, clip): &mut (Vec<Vec<[f64; 2]>>, Clip), cell| {
            mesh.parts(cell, parts);
            let mut sum = Column::default();
            for body in bodies {
                let column = body.column(mesh, cell, parts, clip);
                sum.volume += column.volume;
                (0..2).for_each(|axis| sum.momentum[axis] += column.momentum[axis]);
            }
            sum
        })
        .collect()
}

/// Mean of a function over convex polygons.
fn mean_over(parts: &[Vec<[f64; 2]>], function: impl Fn(f64, f64) -> f64) -> f64 {
    if let [part] = parts {
        return mean(part, function);
    }
    let sum = parts.iter().map(|part| (super::mesh::area(part), part)).filter(|(area, _)| *area > 0.0);
    let (sum, area) =
        sum.fold((0.0, 0.0), |(sum, total), (area, part)| (sum + area * mean(part, &function), total + area));
    if area > 0.0 { sum / area } else { 0.0 }
}

/// Mean of a function over a convex polygon: over the triangles of its fan, each cut into four, by the rule with a point in the middle of each
/// side, exact to second degree (Strang & Fix 1973, section 4.3).
fn mean(polygon: &[[f64; 2]], function: impl Fn(f64, f64) -> f64) -> f64 {
    let centre = [0, 1].map(|axis| polygon.iter().map(|r| r[axis]).sum::<f64>() / polygon.len() as f64);
    let (mut sum, mut area) = (0.0, 0.0);
    let middle = |p: [f64; 2], q: [f64; 2]| [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
    for k in 0..polygon.len() {
        let [a, b] = [polygon[k], polygon[(k + 1) % polygon.len()]];
        let part = (a[0] - centre[0]) * (b[1] - centre[1]) - (b[0] - centre[0]) * (a[1] - centre[1]);
        let [ab, bc, ca] = [middle(a, b), middle(b, centre), middle(centre, a)];
        let mut values = 0.0;
        for [p, q, r] in [[a, ab, ca], [ab, b, bc], [ca, bc, centre], [ab, bc, ca]] {
            values += [middle(p, q), middle(q, r), middle(r, p)].map(|[x, y]| function(x, y)).iter().sum::<f64>();
        }
        sum += part * values / 12.0;
        area += part;
    }
    sum / area
}

/// Working memory for cutting polygons.
#[derive(Default)]
pub(crate) struct Clip(Vec<[f64; 2]>, Vec<[f64; 2]>);

impl Clip {
    /// Area of a polygon inside a convex one with corners in counter-clockwise order, m2.
    pub fn area_inside(&mut self, polygon: &[[f64; 2]], convex: &[[f64; 2]]) -> f64 {
        let subject = self.inside(polygon, convex);
        let origin = convex[0];
        let corners = (0..subject.len()).map(|n| {
            let [p, q] = [subject[n], subject[(n + 1) % subject.len()]];
            let [p, q] = [p, q].map(|r| [r[0] - origin[0], r[1] - origin[1]]);
            p[0] * q[1] - q[0] * p[1]
        });
        (0.5 * corners.sum::<f64>()).abs()
    }

    /// The part of a polygon inside a convex one with corners in counter-clockwise order (Sutherland & Hodgman 1974).
    pub fn inside(&mut self, polygon: &[[f64; 2]], convex: &[[f64; 2]]) -> &[[f64; 2]] {
        let Self(subject, cut) = self;
        subject.clear();
        subject.extend_from_slice(polygon);
        for k in 0..convex.len() {
            let [a, b] = [convex[k], convex[(k + 1) % convex.len()]];
            let left = |p: [f64; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
            cut.clear();
            for n in 0..subject.len() {
                let [p, q] = [subject[n], subject[(n + 1) % subject.len()]];
                let [here, there] = [left(p), left(q)];
                if here >= 0.0 {
                    cut.push(p);
                }
                if (here >= 0.0) != (there >= 0.0) {
                    let part = here / (here - there);
                    cut.push([0, 1].map(|axis| p[axis] + part * (q[axis] - p[axis])));
                }
            }
            std::mem::swap(subject, cut);
        }
        subject
    }
}

/// Refuses a polygon that lies wholly outside the terrain.
pub(crate) fn check_polygons(scene: &Flood, terrain: &Terrain) -> Result<(), ModelError> {
    for (number, water) in scene.water.iter().enumerate() {
        let Some(polygon) = &water.polygon else { continue };
        let corners: Vec<[f64; 2]> = polygon.iter().map(|&corner| terrain.to_model(corner)).collect();
        if is_beside(&corners, terrain.bounds(), 0.0) {
            return Err(setup(format!(
                "flood.water.{number}.polygon lies wholly outside the terrain, which spans {}: give its corners in the \
                 terrain's own coordinates",
                span(terrain)
            )));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_part_of_a_bay_inside_a_cell_is_exact() {
        let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
        let bay = [[-1.0, -1.0], [5.0, -1.0], [5.0, 5.0], [2.0, 1.0], [-1.0, 5.0]];
        // Cut out of the square: what lies above y = 1 + 4/3 |x - 2|, which leaves it at 11/3 on both sides.
        let mut clip = Clip::default();
        let expected = 16.0 - (4.0 * (4.0 - 11.0 / 3.0) + 0.5 * 4.0 * (11.0 / 3.0 - 1.0));
        assert!((clip.area_inside(&bay, &square) - expected).abs() < 1e-12);
        let turned: Vec<_> = bay.iter().rev().copied().collect();
        assert!((clip.area_inside(&turned, &square) - expected).abs() < 1e-12);
        assert_eq!(clip.area_inside(&bay.map(|[x, y]| [x + 20.0, y]), &square), 0.0);
    }

    #[test]
    fn means_of_quadratic_functions_are_exact() {
        let triangle = [[1.0, 0.0], [4.0, 1.0], [2.0, 5.0]];
        let value = mean(&triangle, |x, y| x * x - 2.0 * x * y + 3.0 * y);
        let middles = [[2.5, 0.5], [3.0, 3.0], [1.5, 2.5]];
        let exact = middles.map(|[x, y]: [f64; 2]| x * x - 2.0 * x * y + 3.0 * y).iter().sum::<f64>() / 3.0;
        assert!((value - exact).abs() < 1e-12);
    }
}
