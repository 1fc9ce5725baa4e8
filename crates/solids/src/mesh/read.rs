//! From a file to a mesh.

use super::{MOST_BYTES, MOST_TRIANGLES, Mesh, Triangles, gltf, obj, ply, stl};
use crate::SolidError;
use corpuscle_scene::open_file;
use std::io::Read;
use std::path::Path;

pub(super) fn read(path: &Path, unit: Option<f64>) -> Result<Mesh, SolidError> {
    let unreadable = |source| SolidError::Unreadable { path: path.to_owned(), source };
    let wrong = |what: String| SolidError::Mesh { path: path.to_owned(), what };
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default().to_ascii_lowercase();
    let too_long = |bytes: &str| {
        wrong(format!(
            "the file has {bytes} bytes; {MOST_BYTES} are possible. Make a coarser mesh: one finer than the particles is of no use"
        ))
    };
    let (file, bytes) = open_file(path).map_err(unreadable)?;
    if bytes > MOST_BYTES {
        return Err(too_long(&bytes.to_string()));
    }
    if extension == "stl" {
        let mut head = Vec::new();
        file.take(stl::HEAD as u64).read_to_end(&mut head).map_err(unreadable)?;
        refuse_too_many(stl::count_told(&head, bytes).unwrap_or(0)).map_err(wrong)?;
    }
    let content = read_at_most(path, MOST_BYTES).map_err(unreadable)?.ok_or_else(|| too_long("too many"))?;
    let triangles = match extension.as_str() {
        "stl" => stl::read(content),
        "obj" => obj::read(&content),
        "ply" => ply::read(&content),
        "gltf" | "glb" => gltf::read(&content, path.parent().unwrap_or(Path::new(""))),
        _ => Err("this is not a mesh that can be read: its name must end in .obj, .stl, .ply, .gltf or .glb".into()),
    };
    let is_in_metres = ["gltf", "glb"].contains(&extension.as_str());
    let metres = match (unit, is_in_metres) {
        (Some(metres), _) => metres,
        (None, true) => 1.0,
        (None, false) => {
            return Err(wrong(
                "this format does not say what its numbers are measured in; give its unit of length".into(),
            ));
        }
    };
    if !(metres > 0.0 && metres.is_finite()) {
        return Err(wrong(format!("its unit of length is {metres} m; it must be a finite number above 0")));
    }
    let Triangles { corners, triangles } = triangles.map_err(wrong)?;
    let corners = corners.into_iter().map(|corner| corner.map(|x| metres * x)).collect();
    Mesh::new(path, corners, triangles)
}

/// All bytes of a file; none where there are more than `most`, as of a device that has no end.
pub(super) fn read_at_most(path: &Path, most: u64) -> std::io::Result<Option<Vec<u8>>> {
    let mut content = Vec::new();
    open_file(path)?.0.take(most + 1).read_to_end(&mut content)?;
    Ok((content.len() as u64 <= most).then_some(content))
}

/// Refuses more triangles than there is memory for.
pub(super) fn refuse_too_many(count: usize) -> Result<(), String> {
    let fits = count <= MOST_TRIANGLES;
    let refusal = || {
        format!(
            "it has {count} triangles or more; {MOST_TRIANGLES} are possible. Make a coarser mesh: one finer than the particles is \
             of no use"
        )
    };
    if fits { Ok(()) } else { Err(refusal()) }
}

/// Adds the triangles of a polygon whose corners are given in turn, all from its first corner.
pub(super) fn add_polygon(corners: &[u32], triangles: &mut Vec<[u32; 3]>) {
    for pair in corners.get(1..).unwrap_or_default().windows(2) {
        triangles.push([corners[0], pair[0], pair[1]]);
    }
}
