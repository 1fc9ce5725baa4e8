//! glTF and GLB.

use super::Triangles;
use super::catch_panic::caught;
use super::read::{read_at_most, refuse_too_many};
use super::{MOST_BYTES, MOST_TRIANGLES};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use gltf::accessor::{DataType, Dimensions};
use gltf::mesh::Mode;
use gltf::{Accessor, Gltf, Node, Primitive, Semantic};
use std::borrow::Cow;
use std::path::{Component, Path};

/// Most corners of all parts together.
const MOST_CORNERS: usize = 3 * MOST_TRIANGLES;

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
    let buffers = buffers(&gltf, folder)?;
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

/// The data of all buffers, which together are no more than a file may have.
fn buffers<'a>(gltf: &'a Gltf, folder: &Path) -> Result<Vec<Cow<'a, [u8]>>, String> {
    let mut left = MOST_BYTES;
    let mut buffers = Vec::new();
    for buffer in gltf.buffers() {
        let data = match buffer.source() {
            // It has the first buffer only (glTF 2.0, 4.4.3.3).
            gltf::buffer::Source::Bin if buffer.index() > 0 => {
                return Err(format!(
                    "its buffer {} (counted from 0) has no uri; only the first may have none",
                    buffer.index()
                ));
            }
            gltf::buffer::Source::Bin => Cow::Borrowed(gltf.blob.as_deref().ok_or("its binary part is missing")?),
            gltf::buffer::Source::Uri(uri) => Cow::Owned(buffer_at(uri, folder, left)?),
        };
        left = left.checked_sub(data.len() as u64).ok_or_else(too_long)?;
        buffers.push(data);
    }
    Ok(buffers)
}

fn too_long() -> String {
    format!(
        "its buffers have more than {MOST_BYTES} bytes. Make a coarser mesh: one finer than the particles is of no use"
    )
}

fn buffer_at(uri: &str, folder: &Path, most: u64) -> Result<Vec<u8>, String> {
    if let Some(data) = uri.strip_prefix("data:") {
        let encoded = data.split_once(";base64,").ok_or("it holds data that are not in base64")?.1;
        return STANDARD.decode(encoded).map_err(|error| format!("its data in base64 are damaged: {error}"));
    }
    if uri.is_empty()
        || !Path::new(uri).components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir))
    {
        return Err(format!(
            "its part `{uri}` does not lie in its folder; put it beside it and name it without `..` and `/` at the front"
        ));
    }
    let path = folder.join(uri);
    let content =
        read_at_most(&path, most).map_err(|error| format!("its part {} cannot be read: {error}", path.display()))?;
    content.ok_or_else(too_long)
}

fn add(primitive: &Primitive, buffers: &[Cow<[u8]>], matrix: &Matrix, found: &mut Triangles) -> Result<(), String> {
    if primitive.mode() != Mode::Triangles {
        return Err(format!("it has {:?}; only triangles are read", primitive.mode()));
    }
    let positions = primitive.get(&Semantic::Positions).ok_or("it has triangles without positions")?;
    refuse_unreadable(&positions, Dimensions::Vec3, &[DataType::F32])?;
    if let Some(indices) = primitive.indices() {
        refuse_unreadable(&indices, Dimensions::Scalar, &[DataType::U8, DataType::U16, DataType::U32])?;
    }
    let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(|data| &**data));
    let cut_off = "its data are shorter than it says";
    // Parts may share their corners, which so can be far more than the file has bytes.
    if found.corners.len() + positions.count() > MOST_CORNERS {
        return Err(format!(
            "its parts have more than {MOST_CORNERS} corners, those that they share counted for each; join parts that share them"
        ));
    }
    let first = found.corners.len() as u32;
    let corners = reader.read_positions().ok_or(cut_off)?;
    found.corners.extend(corners.map(|[x, y, z]| {
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
    let fits = accessor.count() > 0 && bytes < MOST_BYTES && stride >= accessor.size();
    if accessor.sparse().is_some() || found != dimensions || !types.contains(&kind) || !fits {
        return Err(format!(
            "it has {} sparse or odd numbers ({found:?} of {kind:?}), which are not read",
            accessor.count()
        ));
    }
    Ok(())
}
