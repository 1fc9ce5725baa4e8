//! PLY, ASCII and binary.

use super::read::{add_polygon, refuse_too_many};
use super::{MOST_TRIANGLES, Triangles};
use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};

/// Most rows of all elements together: as many corners as triangles may have, faces, and twice as many rows of other elements.
const MOST_ROWS: usize = 6 * MOST_TRIANGLES;

/// A row of a PLY file: a corner, a face, or something else.
#[derive(Default)]
struct Row {
    position: [Option<f64>; 3],
    corners: Option<Vec<u32>>,
}

impl PropertyAccess for Row {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        match name {
            "x" => self.position[0] = number(&value),
            "y" => self.position[1] = number(&value),
            "z" => self.position[2] = number(&value),
            "vertex_indices" | "vertex_index" => self.corners = value.to_u32_list(),
            _ => return PropertyAccessResult::Ignored,
        }
        PropertyAccessResult::Set
    }
}

fn number(value: &Property) -> Option<f64> {
    match value {
        Property::Double(value) => Some(*value),
        other => other.to_f32_lossy().map(f64::from),
    }
}

pub(super) fn read(content: &[u8]) -> Result<Triangles, String> {
    let wrong = |error: &dyn std::fmt::Display| format!("this is not a PLY that can be read: {error}");
    let parser = Parser::<Row>::new();
    let mut reader = Reader::new(content);
    let header = parser.read_header(&mut reader).map_err(|error| wrong(&error))?;
    let mut found = Triangles::default();
    let mut rows_told = 0_usize;
    for (name, element) in &header.elements {
        if element.properties.is_empty() && element.count > 0 {
            return Err(format!("its {} elements `{name}` have no properties; leave them out", element.count));
        }
        rows_told = rows_told.saturating_add(element.count);
        if rows_told > MOST_ROWS {
            return Err(format!(
                "it has {rows_told} rows or more, corners and faces together; {MOST_ROWS} are possible"
            ));
        }
        refuse_too_many(if name == "vertex" { element.count / 3 } else { element.count })?;
        let rows = parser.read_payload_for_element(&mut reader, element, &header).map_err(|error| wrong(&error))?;
        for (at, row) in rows.into_iter().enumerate() {
            match (name.as_str(), row.position, row.corners) {
                ("vertex", [Some(x), Some(y), Some(z)], _) => found.corners.push([x, y, z]),
                ("vertex", ..) => return Err(format!("vertex {at} (counted from 0) has no x, y and z")),
                ("face", _, Some(corners)) => {
                    refuse_too_many(found.triangles.len() + corners.len().min(MOST_TRIANGLES + 1))?;
                    add_polygon(&corners, &mut found.triangles);
                }
                ("face", ..) => {
                    return Err(format!("face {at} (counted from 0) has no vertex_indices that are 0 or more"));
                }
                _ => {}
            }
        }
    }
    Ok(found)
}
