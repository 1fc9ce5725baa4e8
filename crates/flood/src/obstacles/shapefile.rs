//! Polygons of shapefiles (ESRI Shapefile Technical Description, 1998), read from the main file alone.
//!
//! Reading is our own: each count is compared with the bytes that are there before anything is reserved for it.

use corpuscle_terrain::Polygon;

/// Number at the start of the file, big-endian.
const FILE_CODE: i32 = 9994;
/// Bytes of the header, and of that of a record.
const HEADER: usize = 100;
const RECORD_HEADER: usize = 8;
/// Kinds of polygons: plain, with z, with a measure.
const POLYGONS: [i32; 3] = [5, 15, 25];
/// Bytes of a polygon before its rings: the kind and the bounds.
const BEFORE_COUNTS: usize = 36;

/// The rings of each polygon together: holes are rings too, by the even-odd rule. Other shapes are left out.
pub(super) fn polygons(bytes: &[u8]) -> Result<Vec<Polygon>, String> {
    if big(bytes, 0) != Some(FILE_CODE) {
        return Err("is no shapefile: its first number is not 9994".into());
    }
    if bytes.len() < HEADER {
        return Err("is cut off: it ends within its header".into());
    }
    let mut found = Vec::new();
    let mut at = HEADER;
    for number in 1.. {
        if at >= bytes.len() {
            break;
        }
        let record =
            record(bytes, at).ok_or_else(|| format!("is damaged or cut off: record {number} goes beyond its end"))?;
        at += RECORD_HEADER + record.len();
        match little(record, 0) {
            Some(kind) if POLYGONS.contains(&kind) => {
                let polygon = polygon(record).map_err(|what| format!("is damaged: record {number} {what}"))?;
                found.push(polygon);
            }
            _ => {}
        }
    }
    Ok(found)
}

/// The content of the record whose header begins at a byte; its length is given in words of two bytes.
fn record(bytes: &[u8], at: usize) -> Option<&[u8]> {
    let words = usize::try_from(big(bytes, at + 4)?).ok()?;
    let start = at + RECORD_HEADER;
    bytes.get(start..start.checked_add(words.checked_mul(2)?)?)
}

fn polygon(record: &[u8]) -> Result<Polygon, String> {
    let cut = || "has fewer corners than it says".to_owned();
    let count = |at: usize| little(record, at).and_then(|count| usize::try_from(count).ok());
    let (parts, points) = count(BEFORE_COUNTS).zip(count(BEFORE_COUNTS + 4)).ok_or_else(cut)?;
    let starts = BEFORE_COUNTS + 8;
    let rest = record.get(starts..).and_then(|rest| rest.split_at_checked(parts.checked_mul(4)?));
    let (starts, rest) = rest.ok_or_else(cut)?;
    let points = points.checked_mul(16).and_then(|bytes| rest.get(..bytes)).ok_or_else(cut)?;
    let points: Vec<[f64; 2]> = points.as_chunks::<16>().0.iter().map(point).collect();
    if points.as_flattened().iter().any(|number| !number.is_finite()) {
        return Err("has a corner that is not a finite number".into());
    }
    let first = |start: &[u8; 4]| usize::try_from(i32::from_le_bytes(*start)).unwrap_or(usize::MAX);
    let mut firsts: Vec<usize> = starts.as_chunks::<4>().0.iter().map(first).collect();
    firsts.push(points.len());
    let ring = |ends: &[usize]| points.get(ends[0]..ends[1]).map(<[_]>::to_vec);
    firsts
        .windows(2)
        .map(ring)
        .collect::<Option<_>>()
        .ok_or_else(|| "has rings that begin where there is no corner".into())
}

fn point(bytes: &[u8; 16]) -> [f64; 2] {
    let numbers = bytes.as_chunks::<8>().0;
    [f64::from_le_bytes(numbers[0]), f64::from_le_bytes(numbers[1])]
}

fn big(bytes: &[u8], at: usize) -> Option<i32> {
    bytes.get(at..)?.first_chunk().map(|number| i32::from_be_bytes(*number))
}

fn little(bytes: &[u8], at: usize) -> Option<i32> {
    bytes.get(at..)?.first_chunk().map(|number| i32::from_le_bytes(*number))
}

#[cfg(test)]
mod tests {
    use super::*;

    const OUTER: [[f64; 2]; 5] = [[0.0, 0.0], [0.0, 9.0], [9.0, 9.0], [9.0, 0.0], [0.0, 0.0]];
    const HOLE: [[f64; 2]; 4] = [[2.0, 2.0], [4.0, 2.0], [4.0, 4.0], [2.0, 2.0]];

    fn content(kind: i32, rings: &[&[[f64; 2]]], more: usize) -> Vec<u8> {
        let mut bytes = kind.to_le_bytes().to_vec();
        bytes.extend([0; 32]);
        let points: Vec<_> = rings.concat();
        bytes.extend((rings.len() as i32).to_le_bytes());
        bytes.extend((points.len() as i32).to_le_bytes());
        let mut first = 0_i32;
        for ring in rings {
            bytes.extend(first.to_le_bytes());
            first += ring.len() as i32;
        }
        bytes.extend(points.as_flattened().iter().flat_map(|number| number.to_le_bytes()));
        bytes.extend(vec![0; more]);
        bytes
    }

    fn file(records: &[Vec<u8>]) -> Vec<u8> {
        let mut bytes = FILE_CODE.to_be_bytes().to_vec();
        bytes.resize(HEADER, 0);
        for (number, record) in records.iter().enumerate() {
            bytes.extend((number as i32 + 1).to_be_bytes());
            bytes.extend((record.len() as i32 / 2).to_be_bytes());
            bytes.extend(record);
        }
        bytes
    }

    #[test]
    fn polygons_of_all_kinds_are_read_and_other_shapes_left_out() {
        let point = [1_i32.to_le_bytes().to_vec(), vec![0; 16]].concat();
        let null = 0_i32.to_le_bytes().to_vec();
        let bytes = file(&[
            content(5, &[&OUTER, &HOLE], 0),
            point,
            null,
            content(15, &[&OUTER], 88),
            content(25, &[&HOLE], 48),
        ]);
        let found = polygons(&bytes).unwrap();
        let whole = vec![OUTER.to_vec(), HOLE.to_vec()];
        assert_eq!(found, [whole, vec![OUTER.to_vec()], vec![HOLE.to_vec()]]);
    }

    /// The library that read these before reserved memory for as many corners as the file says: it ended the program, or panicked where the
    /// number is negative.
    #[test]
    fn counts_that_the_file_cannot_hold_are_refused_before_anything_is_reserved() {
        let sound = file(&[content(5, &[&OUTER, &HOLE], 0)]);
        let at = HEADER + RECORD_HEADER + BEFORE_COUNTS;
        for (offset, number) in
            [(at, i32::MAX), (at, -1), (at + 4, i32::MAX), (at + 4, -1), (at + 8, -1), (at + 12, 99)]
        {
            let mut bytes = sound.clone();
            bytes[offset..offset + 4].copy_from_slice(&number.to_le_bytes());
            let words = polygons(&bytes).unwrap_err();
            assert!(words.contains("record 1 has"), "{offset} {number}: {words}");
        }
        let mut bytes = sound.clone();
        bytes[HEADER + 4..HEADER + 8].copy_from_slice(&(-8_i32).to_be_bytes());
        assert!(polygons(&bytes).unwrap_err().contains("record 1 goes beyond its end"));
        bytes = sound.clone();
        let first_corner = at + 16;
        bytes[first_corner..first_corner + 8].copy_from_slice(&f64::NAN.to_le_bytes());
        assert!(polygons(&bytes).unwrap_err().contains("not a finite number"));
        for length in 0..sound.len() {
            assert!(polygons(&sound[..length]).is_err() || length == HEADER, "{length}");
        }
    }
}
