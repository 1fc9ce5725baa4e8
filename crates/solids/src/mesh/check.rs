//! Whether triangles bound a solid.

use super::Triangles;
use std::collections::HashMap;

/// The triangles with corners at the same position taken for one, without those of no area, wound alike and outward; and what
/// was put right.
pub(super) fn solid(read: Triangles) -> Result<(Triangles, Vec<String>), String> {
    refuse_invalid_corners(&read)?;
    let mut notes = Vec::new();
    let mut mesh = welded(&read);
    let flat = read.triangles.len() - mesh.triangles.len();
    if flat > 0 {
        notes.push(format!(
            "{flat} triangles of {} have two corners at one position and were left out",
            read.triangles.len()
        ));
    }
    if mesh.triangles.is_empty() {
        return Err("it has no triangles with an area".into());
    }
    let turned = wind_alike(&mut mesh)?;
    if turned == mesh.triangles.len() {
        notes.push("its triangles were wound as seen from inside and turned".into());
    } else if turned > 0 {
        notes.push(format!("{turned} triangles of {} were wound against the others and turned", mesh.triangles.len()));
    }
    let (volume, area) = volume_and_area(&mesh.corners, &mesh.triangles);
    if volume.abs() <= 1e-9 * area.powf(1.5) {
        return Err(format!(
            "it encloses no volume ({volume:.3e} m³, with a surface of {area:.3e} m²): a solid needs an inside. Give it a thickness in a \
             program for meshes"
        ));
    }
    Ok((mesh, notes))
}

fn refuse_invalid_corners(read: &Triangles) -> Result<(), String> {
    if let Some(at) = read.corners.iter().position(|corner| corner.iter().any(|x| !x.is_finite())) {
        return Err(format!(
            "corner {at} (counted from 0) is at {:?}: each coordinate must be a finite number",
            read.corners[at]
        ));
    }
    let count = read.corners.len();
    let outside = |triangle: &[u32; 3]| triangle.iter().any(|&corner| corner as usize >= count);
    if let Some(at) = read.triangles.iter().position(outside) {
        let triangle = read.triangles[at];
        return Err(format!("triangle {at} (counted from 0) has the corners {triangle:?}, of {count}"));
    }
    Ok(())
}

/// Corners at the same position become one; triangles with two corners at one position are left out.
fn welded(read: &Triangles) -> Triangles {
    let mut known: HashMap<[u64; 3], u32> = HashMap::new();
    let mut corners = Vec::new();
    let one_of = |corner: &[f64; 3]| {
        // -0 is 0.
        let position = corner.map(|x| (x + 0.0).to_bits());
        *known.entry(position).or_insert_with(|| {
            corners.push(*corner);
            corners.len() as u32 - 1
        })
    };
    let which: Vec<u32> = read.corners.iter().map(one_of).collect();
    let triangles = read.triangles.iter().map(|triangle| triangle.map(|corner| which[corner as usize]));
    let triangles = triangles.filter(|[a, b, c]| a != b && b != c && c != a).collect();
    Triangles { corners, triangles }
}

/// The two triangles at an edge: number, and whether it runs from the smaller to the larger corner.
type Sides = Vec<(u32, bool)>;

/// Turns triangles that are wound against their neighbours; gives their number.
///
/// # Errors
/// Where an edge has one triangle, or more than two.
fn wind_alike(mesh: &mut Triangles) -> Result<usize, String> {
    let mut edges: HashMap<[u32; 2], Sides> = HashMap::new();
    for (at, triangle) in mesh.triangles.iter().enumerate() {
        for [from, to] in edges_of(*triangle) {
            edges.entry([from.min(to), from.max(to)]).or_default().push((at as u32, from < to));
        }
    }
    let open = edges.values().filter(|sides| sides.len() == 1).count();
    if open > 0 {
        let first = edges.iter().filter(|(_, sides)| sides.len() == 1).map(|(edge, _)| *edge).min();
        let [a, b] = first.unwrap_or_default().map(|corner| mesh.corners[corner as usize]);
        return Err(format!(
            "it is not watertight: {open} open edges, one of them from {a:?} to {b:?} (in the file's unit); a solid needs a closed \
             surface. Close it, or give it a thickness, in a program for meshes"
        ));
    }
    let crowded = edges.values().filter(|sides| sides.len() > 2).count();
    if crowded > 0 {
        return Err(format!(
            "{crowded} edges have more than two triangles, so that inside and outside cannot be told; remove inner walls and \
             triangles that lie on one another in a program for meshes"
        ));
    }
    let flips = flips(mesh, &edges)?;
    for (triangle, _) in mesh.triangles.iter_mut().zip(&flips).filter(|(_, flip)| **flip) {
        triangle.swap(1, 2);
    }
    Ok(flips.iter().filter(|flip| **flip).count())
}

fn edges_of([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// Which triangles must be turned. Each connected surface keeps the winding of most of its triangles, and a surface that is
/// wound inward as a whole is turned where it is the only one: a hollow is wound inward on purpose.
fn flips(mesh: &Triangles, edges: &HashMap<[u32; 2], Sides>) -> Result<Vec<bool>, String> {
    let count = mesh.triangles.len();
    let mut flips = vec![None; count];
    let mut surfaces = 0;
    for start in 0..count {
        if flips[start].is_some() {
            continue;
        }
        surfaces += 1;
        flips[start] = Some(false);
        let mut members = vec![start];
        let mut next = 0;
        while let Some(&at) = members.get(next) {
            next += 1;
            for [from, to] in edges_of(mesh.triangles[at]) {
                let sides = &edges[&[from.min(to), from.max(to)]];
                let [one, other] = [sides[0], sides[1]];
                let (mine, (neighbour, theirs)) = if one.0 as usize == at { (one.1, other) } else { (other.1, one) };
                let wanted = flips[at].map(|flip: bool| flip != (mine == theirs));
                match flips[neighbour as usize] {
                    None => {
                        flips[neighbour as usize] = wanted;
                        members.push(neighbour as usize);
                    }
                    known if known != wanted => {
                        return Err("it has only one side, like a Moebius strip: it bounds no solid".into());
                    }
                    _ => {}
                }
            }
        }
        let turned = members.iter().filter(|&&at| flips[at] == Some(true)).count();
        if 2 * turned > members.len() {
            members.iter().for_each(|&at| flips[at] = flips[at].map(|flip: bool| !flip));
        }
    }
    let mut flips: Vec<bool> = flips.into_iter().map(|flip| flip.unwrap_or(false)).collect();
    let wound = mesh.triangles.iter().zip(&flips).map(|(&[a, b, c], &flip)| if flip { [a, c, b] } else { [a, b, c] });
    let (volume, _) = volume_and_area(&mesh.corners, &wound.collect::<Vec<_>>());
    if volume < 0.0 && surfaces == 1 {
        flips.iter_mut().for_each(|flip| *flip = !*flip);
    } else if volume < 0.0 {
        return Err(format!(
            "its {surfaces} surfaces together enclose a negative volume: turn those that are inside out"
        ));
    }
    Ok(flips)
}

/// Volume by the divergence theorem, positive where triangles turn left seen from outside, and area.
pub(super) fn volume_and_area(corners: &[[f64; 3]], triangles: &[[u32; 3]]) -> (f64, f64) {
    // Measured from a corner, so that a mesh far from its origin loses no digits.
    let origin = corners.first().copied().unwrap_or_default();
    let mut sums = (0.0, 0.0);
    for triangle in triangles {
        let [a, b, c] = triangle.map(|corner| less(corners[corner as usize], origin));
        let normal = cross(less(b, a), less(c, a));
        sums.0 += dot(a, normal) / 6.0;
        sums.1 += 0.5 * dot(normal, normal).sqrt();
    }
    sums
}

fn less(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
