//! A surface as VTK XML PolyData: a square for each of its patches, with their values as cell data.

use super::vtp::Appended;
use corpuscle_model::{Surface, Values};
use std::io::{self, Write};

/// Writes a surface.
pub(crate) fn write(file: &mut impl Write, surface: &Surface) -> io::Result<()> {
    let patches = surface.position.len();
    let mut arrays = Appended::default();
    writeln!(
        file,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n  <PolyData>\n    \
         <Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" \
         NumberOfPolys=\"{patches}\">\n      <CellData>",
        4 * patches
    )?;
    let bytes = |values: &[f64]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
    for column in &surface.columns {
        match &column.values {
            Values::Scalar(values) => arrays.add(file, "Float64", column.name, 1, bytes(values).into_iter())?,
            Values::Vector(values) => {
                arrays.add(file, "Float64", column.name, 3, bytes(values.as_flattened()).into_iter())?;
            }
        }
    }
    arrays.add(file, "Float64", "normal", 3, bytes(surface.normal.as_flattened()).into_iter())?;
    let area: Vec<f64> = surface.half_width.iter().map(|half| 4.0 * half * half).collect();
    arrays.add(file, "Float64", "area_m2", 1, bytes(&area).into_iter())?;
    writeln!(file, "      </CellData>\n      <Points>")?;
    let corners: Vec<[f64; 3]> = (0..patches).flat_map(|patch| corners(surface, patch)).collect();
    arrays.add(file, "Float64", "position", 3, bytes(corners.as_flattened()).into_iter())?;
    writeln!(file, "      </Points>\n      <Polys>")?;
    arrays.add(file, "Int64", "connectivity", 1, (0..4 * patches as i64).flat_map(i64::to_le_bytes))?;
    arrays.add(file, "Int64", "offsets", 1, (1..=patches as i64).flat_map(|patch| (4 * patch).to_le_bytes()))?;
    writeln!(file, "      </Polys>\n    </Piece>\n  </PolyData>")?;
    arrays.finish(file)
}

/// Corners of a patch, in turn.
fn corners(surface: &Surface, patch: usize) -> [[f64; 3]; 4] {
    let (middle, half) = (surface.position[patch], surface.half_width[patch]);
    let [x, y, z] = surface.normal[patch];
    // Two directions across it (Duff et al., Journal of Computer Graphics Techniques 6, 2017, 1).
    let sign = 1_f64.copysign(z);
    let (a, b) = (-1.0 / (sign + z), -x * y / (sign + z));
    let (one, other) = ([1.0 + sign * x * x * a, sign * b, -sign * x], [b, sign + y * y * a, -y]);
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .map(|[right, up]| std::array::from_fn(|axis| middle[axis] + half * (right * one[axis] + up * other[axis])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_model::{Column, SolidShape};
    use std::sync::Arc;

    #[test]
    fn a_patch_is_a_square_round_its_middle() {
        let surface = Surface {
            name: "pane".into(),
            position: vec![[1.0, 2.0, 3.0]],
            normal: vec![[1.0, 0.0, 0.0]],
            half_width: vec![0.5],
            columns: vec![Column { name: "water_kg_per_m2", unit: "kg/m2", values: Values::Scalar(vec![0.25]) }],
            shape: SolidShape { bounds: [[0.0; 3]; 2], distance: Arc::new(|_| 0.0) },
        };
        for [x, y, z] in corners(&surface, 0) {
            assert_eq!((x, (y - 2.0).abs(), (z - 3.0).abs()), (1.0, 0.5, 0.5));
        }
        let mut file = Vec::new();
        write(&mut file, &surface).unwrap();
        let text = String::from_utf8(file).unwrap();
        let mut reader = quick_xml::Reader::from_str(&text);
        let mut arrays = 0;
        loop {
            match reader.read_event().unwrap() {
                quick_xml::events::Event::Empty(_) => arrays += 1,
                quick_xml::events::Event::Eof => break,
                _ => {}
            }
        }
        assert_eq!(arrays, 6, "{text}");
        assert!(text.contains("NumberOfPolys=\"1\"") && text.contains("water_kg_per_m2"));
    }
}
