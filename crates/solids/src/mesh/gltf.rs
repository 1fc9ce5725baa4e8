//! glTF and GLB.

use super::Triangles;
use super::catch_panic::caught;
use super::read::refuse_too_many;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use gltf::accessor::{DataType, Dimensions};
use gltf::mesh::Mode;
use gltf::{Accessor, Gltf, Node, Primitive, Semantic};
use std::path::Path;

/// Columns of a matrix that moves points.
type Matrix = [[f64; 4]; 4];

/// Reads all meshes of the scene. `folder` is where files that it names are.
pub(super) fn read(content: &[u8], folder: &Path) -> Result<Triangles, String> {
    // The reader's own checks panic where a part names one that there is not.
    caught(|| read_sound(content, folder))
        .unwrap_or_else(|| Err("this is not a glTF that can be read: parts that it names are missing".into()))
}

fn read_sound(content: &[u8], folder: &Path) -> Result<Triangles, String> {
    // The reader takes a shorter length than that of the header for granted not to be.
    let length = content.get(8..12).map(|bytes| u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]));
    if content.starts_with(b"glTF") && length.is_none_or(|length| length < 12) {
        return Err("this is not a GLB that can be read: its header is cut off".into());
    }
    let gltf = Gltf::from_slice(content).map_err(|error| format!("this is not a glTF that can be read: {error}"))?;
    let buffers = gltf.buffers().map(|buffer| match buffer.source() {
        gltf::buffer::Source::Bin => gltf.blob.clone().ok_or_else(|| "its binary part is missing".to_owned()),
        gltf::buffer::Source::Uri(uri) => buffer_at(uri, folder),
    });
    let buffers = buffers.collect::<Result<Vec<_>, _>>()?;
    let scene = gltf.default_scene().or_else(|| gltf.scenes().next()).ok_or("it has no scene")?;
    let mut found = Triangles::default();
    // y is up in glTF; here z is.
    let upright = [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
    let mut waiting: Vec<(Node, Matrix)> = scene.nodes().map(|node| (node, upright)).collect();
    let mut seen = vec![false; gltf.nodes().len()];
    while let Some((node, above)) = waiting.pop() {
        // Nodes form trees (glTF 2.0, 3.5.2). Those of a file that breaks this could lead round for ever.
        if std::mem::replace(&mut seen[node.index()], true) {
            return Err(format!(
                "its node {} (counted from 0) is below itself or below two others; export the scene again",
                node.index()
            ));
        }
        let own = node.transform().matrix().map(|column| column.map(f64::from));
        let matrix = own.map(|column| moved(&above, column));
        for primitive in node.mesh().iter().flat_map(|mesh| mesh.primitives()) {
            add(&primitive, &buffers, &matrix, &mut found)?;
        }
        waiting.extend(node.children().map(|child| (child, matrix)));
    }
    Ok(found)
}

fn moved(matrix: &Matrix, point: [f64; 4]) -> [f64; 4] {
    std::array::from_fn(|row| (0..4).map(|column| matrix[column][row] * point[column]).sum())
}

fn buffer_at(uri: &str, folder: &Path) -> Result<Vec<u8>, String> {
    if let Some(data) = uri.strip_prefix("data:") {
        let encoded = data.split_once(";base64,").ok_or("it holds data that are not in base64")?.1;
        return STANDARD.decode(encoded).map_err(|error| format!("its data in base64 are damaged: {error}"));
    }
    let path = folder.join(uri);
    std::fs::read(&path).map_err(|error| format!("its part {} cannot be read: {error}", path.display()))
}

fn add(primitive: &Primitive, buffers: &[Vec<u8>], matrix: &Matrix, found: &mut Triangles) -> Result<(), String> {
    if primitive.mode() != Mode::Triangles {
        return Err(format!("it has {:?}; only triangles are read", primitive.mode()));
    }
    let positions = primitive.get(&Semantic::Positions).ok_or("it has triangles without places")?;
    refuse_unreadable(&positions, Dimensions::Vec3, &[DataType::F32])?;
    if let Some(indices) = primitive.indices() {
        refuse_unreadable(&indices, Dimensions::Scalar, &[DataType::U8, DataType::U16, DataType::U32])?;
    }
    let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(Vec::as_slice));
    let cut_off = "its data are shorter than it says";
    let first = found.corners.len() as u32;
    let places = reader.read_positions().ok_or(cut_off)?;
    found.corners.extend(places.map(|[x, y, z]| {
        let [x, y, z, _] = moved(matrix, [x.into(), y.into(), z.into(), 1.0]);
        [x, y, z]
    }));
    let indices: Vec<u32> = match primitive.indices() {
        Some(_) => reader.read_indices().ok_or(cut_off)?.into_u32().collect(),
        None => (0..positions.count() as u32).collect(),
    };
    refuse_too_many(found.triangles.len() + indices.len() / 3)?;
    let corner = |index: u32| first.checked_add(index).ok_or("it names corners that it does not have");
    for of in indices.chunks_exact(3) {
        found.triangles.push([corner(of[0])?, corner(of[1])?, corner(of[2])?]);
    }
    Ok(())
}

/// Refuses what the reader takes for granted not to be.
fn refuse_unreadable(accessor: &Accessor, dimensions: Dimensions, types: &[DataType]) -> Result<(), String> {
    refuse_too_many(accessor.count() / 3)?;
    let (found, kind) = (accessor.dimensions(), accessor.data_type());
    let stride = accessor.view().and_then(|view| view.stride()).unwrap_or(accessor.size());
    let bytes = accessor.offset().max(stride) as u64;
    let fits = accessor.count() > 0 && bytes < super::MOST_BYTES && stride >= accessor.size();
    if accessor.sparse().is_some() || found != dimensions || !types.contains(&kind) || !fits {
        return Err(format!(
            "it has {} sparse or odd numbers ({found:?} of {kind:?}), which are not read",
            accessor.count()
        ));
    }
    Ok(())
}
