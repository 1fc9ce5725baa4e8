//! Roofs: rain on an obstacle runs off over its edge.

use crate::obstacles::Outline;
use crate::polygon::is_inside;
use crate::voronoi::domain::{Domain, total};
use crate::voronoi::mesh::Mesh;
use crate::voronoi::start::Clip;
use corpuscle_model::ExactSum;
use corpuscle_terrain::Bounds;

/// Area of each of `count` obstacles within a rectangle, m2.
pub(crate) fn areas(outlines: &[Outline], count: usize, bounds: Bounds) -> Vec<f64> {
    let Bounds { x_min, x_max, y_min, y_max } = bounds;
    let rectangle = [[x_min, y_min], [x_max, y_min], [x_max, y_max], [x_min, y_max]];
    let mut areas = vec![0.0; count];
    let mut clip = Clip::default();
    for outline in outlines {
        for (number, ring) in outline.rings.iter().enumerate() {
            // A ring inside an odd number of others is a court.
            let [x, y] = ring[0];
            let round = outline.rings.iter().enumerate().filter(|(k, other)| *k != number && is_inside(other, x, y));
            let sign = if round.count() % 2 == 0 { 1.0 } else { -1.0 };
            areas[outline.obstacle] += sign * clip.area_inside(ring, &rectangle);
        }
    }
    areas
}

/// The area of roofs, by obstacle, that each cell gets the rain of, m2: shared out by the length of its faces to the obstacle. Empty where there are no roofs.
pub(crate) fn collect(mesh: &Mesh, roofs: &[f64], domain: Option<&Domain>) -> Vec<f64> {
    if roofs.iter().all(|area| *area <= 0.0) {
        return Vec::new();
    }
    let mut round = vec![ExactSum::default(); roofs.len()];
    let length = |face: u32| {
        let [x, y] = mesh.faces[face as usize].normal;
        x.hypot(y)
    };
    let owns = |face: u32| domain.is_none_or(|domain| domain.owns(mesh.faces[face as usize].cells[0] as usize));
    let own = mesh.obstacle_faces.iter().filter(|(face, _)| owns(*face));
    own.for_each(|&(face, obstacle)| round[obstacle as usize].add(length(face)));
    total(domain, &mut [], &mut round.iter_mut().collect::<Vec<_>>());
    let round: Vec<f64> = round.iter().map(ExactSum::value).collect();
    let mut collected = vec![0.0; mesh.len()];
    for &(face, obstacle) in &mesh.obstacle_faces {
        let obstacle = obstacle as usize;
        collected[mesh.faces[face as usize].cells[0] as usize] += roofs[obstacle] * length(face) / round[obstacle];
    }
    collected
}
