//! Meshes: OBJ, STL, PLY, glTF, GLB.

use super::{none, on_file};
use crate::Target;
use corpuscle_solids::Mesh;

pub(super) const TARGETS: &[Target] = &[
    Target { name: "obj", about: "meshes in OBJ", corpus: "obj", read: obj, more: none },
    Target { name: "stl", about: "meshes in STL, text and binary", corpus: "stl", read: stl, more: none },
    Target { name: "ply", about: "meshes in PLY, text and binary", corpus: "ply", read: ply, more: none },
    Target { name: "gltf", about: "meshes in glTF", corpus: "gltf", read: gltf, more: none },
    Target { name: "glb", about: "meshes in GLB", corpus: "glb", read: glb, more: none },
];

fn mesh(name: &str, bytes: &[u8]) -> Result<String, String> {
    on_file(name, bytes, |path| {
        let is_in_metres = name.starts_with("gl");
        let unit = (!is_in_metres).then_some(1.0);
        let mesh =
            Mesh::read(path, unit).map_err(|error| error.to_string().replace(&path.display().to_string(), ""))?;
        mesh.nearest([0.1, 0.2, 0.3]);
        Ok(mesh.notes().join(" "))
    })
}

fn obj(bytes: &[u8]) -> Result<String, String> {
    mesh("a.obj", bytes)
}

fn stl(bytes: &[u8]) -> Result<String, String> {
    mesh("a.stl", bytes)
}

fn ply(bytes: &[u8]) -> Result<String, String> {
    mesh("a.ply", bytes)
}

fn gltf(bytes: &[u8]) -> Result<String, String> {
    mesh("gl.gltf", bytes)
}

fn glb(bytes: &[u8]) -> Result<String, String> {
    mesh("gl.glb", bytes)
}
