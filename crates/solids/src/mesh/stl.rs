//! STL, binary and ASCII.

use super::Triangles;
use super::read::refuse_too_many;
use std::io::Cursor;
use stl_io::create_stl_reader;

/// Bytes of a binary STL before its triangles, and of a triangle.
pub(super) const HEAD: usize = 84;
const EACH: usize = 50;

pub(super) fn read(content: Vec<u8>) -> Result<Triangles, String> {
    let mut cursor = Cursor::new(as_the_reader_tells_them_apart(content)?);
    let reader = create_stl_reader(&mut cursor).map_err(wrong)?;
    let mut found = Triangles::default();
    for triangle in reader {
        let triangle = triangle.map_err(wrong)?;
        let first = found.corners.len() as u32;
        found.corners.extend(triangle.vertices.map(|corner| corner.0.map(f64::from)));
        found.triangles.push([first, first + 1, first + 2]);
        refuse_too_many(found.triangles.len())?;
    }
    Ok(found)
}

fn wrong(error: std::io::Error) -> String {
    format!("this is not an STL that can be read: {error}")
}

/// Number of triangles in the header of a binary STL of a given length in bytes; none where it is no binary STL.
pub(super) fn count_told(head: &[u8], bytes: u64) -> Option<usize> {
    let count = head.get(80..HEAD).map(|bytes| u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))?;
    (HEAD as u64 + u64::from(count) * EACH as u64 == bytes).then_some(count as usize)
}

/// The reader takes for ASCII what begins with "solid " and for binary all else. Some binary files begin so too, and some
/// ASCII ones have no name after "solid".
fn as_the_reader_tells_them_apart(mut content: Vec<u8>) -> Result<Vec<u8>, String> {
    if count_told(&content, content.len() as u64).is_some() {
        content[..80].fill(0);
        return Ok(content);
    }
    if content.starts_with(b"solid") {
        let first_line = content.iter().position(|&byte| byte == b'\n').unwrap_or(content.len());
        content.splice(..first_line, *b"solid mesh");
        return Ok(content);
    }
    Err(format!(
        "this is neither a binary STL, which has {HEAD} bytes and {EACH} for each triangle that its header tells, nor an ASCII one, \
         which begins with \"solid\""
    ))
}
