//! Triangles that go through one another.

use parry3d_f64::shape::{TriMesh, Triangle};
use rayon::prelude::*;
use robust::{Coord3D, orient3d};

/// Refuses a mesh of which two triangles go through one another. Signs of volumes are exact (Shewchuk, Discrete & Computational
/// Geometry 18, 1997, 305), so that triangles with a corner or an edge on
/// another do not count.
pub(super) fn refuse(mesh: &TriMesh) -> Result<(), String> {
    let crossed = |one: u32| {
        let triangle = mesh.triangle(one);
        let bounds = triangle.local_aabb();
        let others = mesh.bvh().intersect_aabb(&bounds).filter(|&other| other > one);
        others.filter(|&other| cross(&triangle, &mesh.triangle(other))).collect::<Vec<_>>()
    };
    let pairs: Vec<(u32, Vec<u32>)> = (0..mesh.indices().len() as u32)
        .into_par_iter()
        .map(|one| (one, crossed(one)))
        .filter(|(_, all)| !all.is_empty())
        .collect();
    let count: usize = pairs.iter().map(|(_, others)| others.len()).sum();
    let Some((one, others)) = pairs.first() else { return Ok(()) };
    let near = mesh.triangle(*one).center();
    let other = others.iter().min().unwrap_or(one);
    Err(format!(
        "it crosses itself: {count} pairs of triangles go through one another, the first of them {one} and {other} (counted from 0) \
         near [{:.4}, {:.4}, {:.4}] m; unite the parts in a program for meshes, or make a solid of each",
        near.x, near.y, near.z
    ))
}

/// Whether an edge of one goes from one side of the other to its other side through it.
fn cross(one: &Triangle, other: &Triangle) -> bool {
    let pierces = |edges: &Triangle, face: &Triangle| {
        let [a, b, c] = [edges.a, edges.b, edges.c];
        [[a, b], [b, c], [c, a]]
            .into_iter()
            .any(|edge| goes_through(edge.map(exact), [face.a, face.b, face.c].map(exact)))
    };
    pierces(one, other) || pierces(other, one)
}

fn exact(point: parry3d_f64::math::Vector) -> Coord3D<f64> {
    Coord3D { x: point.x, y: point.y, z: point.z }
}

fn goes_through([from, to]: [Coord3D<f64>; 2], [a, b, c]: [Coord3D<f64>; 3]) -> bool {
    if orient3d(a, b, c, from) * orient3d(a, b, c, to) >= 0.0 {
        return false;
    }
    let sides = [orient3d(from, to, a, b), orient3d(from, to, b, c), orient3d(from, to, c, a)];
    sides.iter().all(|&side| side >= 0.0) || sides.iter().all(|&side| side <= 0.0)
}
