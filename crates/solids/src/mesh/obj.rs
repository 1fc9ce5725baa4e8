//! Wavefront OBJ.

use super::Triangles;
use super::read::refuse_too_many;
use tobj::{LoadOptions, load_obj_buf};

pub(super) fn read(mut content: &[u8]) -> Result<Triangles, String> {
    let faces = content.split(|&byte| byte == b'\n').filter(|line| line.starts_with(b"f ")).count();
    refuse_too_many(faces)?;
    let options = LoadOptions { triangulate: true, ignore_points: true, ignore_lines: true, ..LoadOptions::default() };
    let no_materials = |_: &std::path::Path| Ok(Default::default());
    let (models, _) = load_obj_buf(&mut content, &options, no_materials)
        .map_err(|error| format!("this is not an OBJ that can be read: {error}"))?;
    let mut found = Triangles::default();
    for model in models {
        let first = found.corners.len() as u32;
        found.corners.extend(model.mesh.positions.chunks_exact(3).map(|at| [at[0], at[1], at[2]]));
        let triangles = model.mesh.indices.chunks_exact(3);
        found.triangles.extend(triangles.map(|of| [first + of[0], first + of[1], first + of[2]]));
    }
    refuse_too_many(found.triangles.len())?;
    Ok(found)
}
