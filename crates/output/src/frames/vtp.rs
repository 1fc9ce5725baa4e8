//! Particles as VTK XML PolyData: vertices with all columns as point data.
//!
//! Arrays stand in one appended section, base64 and zlib-compressed in blocks, so that the file is well-formed XML
//! and a constant column costs next to nothing. Format: the VTK file formats page of the VTK documentation.

use super::csv::own_columns;
use crate::number::Shortest;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use base64::write::EncoderWriter;
use corpuscle_model::{Frame, ParticleSet, Values};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::io::{self, Write};

/// Uncompressed size of a block, bytes.
const BLOCK: usize = 1 << 17;

/// Writes a frame: all sets one after another, told apart by the point array `set` (names in the field array
/// `set_names`); `TimeValue` is the time in s.
pub(super) fn write(file: &mut impl Write, frame: &Frame) -> io::Result<()> {
    let particles: usize = frame.sets.iter().map(ParticleSet::len).sum();
    let mut arrays = Appended::default();
    writeln!(
        file,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n  <PolyData>"
    )?;
    write_field_data(file, frame)?;
    writeln!(
        file,
        "    <Piece NumberOfPoints=\"{particles}\" NumberOfVerts=\"{particles}\" NumberOfLines=\"0\" \
         NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n      <PointData>"
    )?;
    write_point_data(file, frame, &mut arrays)?;
    writeln!(file, "      </PointData>\n      <Points>")?;
    arrays.add(file, "Float64", "position", 3, vectors(frame, |set| &set.position))?;
    writeln!(file, "      </Points>\n      <Verts>")?;
    arrays.add(file, "Int64", "connectivity", 1, (0..particles as i64).flat_map(i64::to_le_bytes))?;
    arrays.add(file, "Int64", "offsets", 1, (1..=particles as i64).flat_map(i64::to_le_bytes))?;
    writeln!(file, "      </Verts>\n    </Piece>\n  </PolyData>")?;
    arrays.finish(file)
}

fn write_field_data(file: &mut impl Write, frame: &Frame) -> io::Result<()> {
    writeln!(
        file,
        "    <FieldData>\n      <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" \
         format=\"ascii\">{}</DataArray>",
        Shortest(frame.time)
    )?;
    // A string array in ASCII is the codes of its letters, each string closed by a 0.
    let names: Vec<String> =
        frame.sets.iter().flat_map(|set| set.name.bytes().chain([0])).map(|byte| byte.to_string()).collect();
    writeln!(
        file,
        "      <Array type=\"String\" Name=\"set_names\" NumberOfTuples=\"{}\" format=\"ascii\">{}</Array>\n    \
         </FieldData>",
        frame.sets.len(),
        names.join(" ")
    )
}

fn write_point_data(file: &mut impl Write, frame: &Frame, arrays: &mut Appended) -> io::Result<()> {
    let sets = frame.sets.iter().enumerate();
    let set = sets.flat_map(|(number, set)| vec![number as i32; set.len()]).flat_map(i32::to_le_bytes);
    arrays.add(file, "Int32", "set", 1, set)?;
    let id = frame.sets.iter().flat_map(|set| &set.id).flat_map(|id| id.to_le_bytes());
    arrays.add(file, "UInt64", "id", 1, id)?;
    arrays.add(file, "Float64", "velocity", 3, vectors(frame, |set| &set.velocity))?;
    arrays.add(file, "Float64", "radius", 1, scalars(frame, |set| &set.radius))?;
    arrays.add(file, "Float64", "mass", 1, scalars(frame, |set| &set.mass))?;
    for (name, is_vector) in own_columns(frame) {
        let components = if is_vector { 3 } else { 1 };
        let values = frame.sets.iter().flat_map(|set| own_values(set, name, components));
        arrays.add(file, "Float64", name, components, values.flat_map(f64::to_le_bytes))?;
    }
    Ok(())
}

fn scalars(frame: &Frame, column: impl Fn(&ParticleSet) -> &Vec<f64>) -> impl Iterator<Item = u8> {
    frame.sets.iter().flat_map(column).flat_map(|value| value.to_le_bytes())
}

fn vectors(frame: &Frame, column: impl Fn(&ParticleSet) -> &Vec<[f64; 3]>) -> impl Iterator<Item = u8> {
    frame.sets.iter().flat_map(column).flatten().flat_map(|value| value.to_le_bytes())
}

/// Values of one of a model's own columns; not-a-number for a set without it.
fn own_values(set: &ParticleSet, name: &str, components: usize) -> Vec<f64> {
    match set.columns.iter().find(|column| column.name == name).map(|column| &column.values) {
        Some(Values::Scalar(values)) => values.clone(),
        Some(Values::Vector(values)) => values.iter().flatten().copied().collect(),
        None => vec![f64::NAN; set.len() * components],
    }
}

/// The appended section as it grows.
#[derive(Default)]
pub(super) struct Appended {
    encoded: String,
}

impl Appended {
    /// Writes the element of an array and keeps its little-endian `bytes` for the appended section.
    pub(super) fn add(
        &mut self,
        file: &mut impl Write,
        kind: &str,
        name: &str,
        components: usize,
        bytes: impl Iterator<Item = u8>,
    ) -> io::Result<()> {
        let offset = self.encoded.len();
        writeln!(
            file,
            "        <DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
             format=\"appended\" offset=\"{offset}\"/>"
        )?;
        self.encode(&bytes.collect::<Vec<u8>>())
    }

    /// Writes the section and the end of the file.
    pub(super) fn finish(self, file: &mut impl Write) -> io::Result<()> {
        write!(file, "  <AppendedData encoding=\"base64\">\n   _")?;
        file.write_all(self.encoded.as_bytes())?;
        writeln!(file, "\n  </AppendedData>\n</VTKFile>")
    }

    /// Block header (count, block size, size of a short last block, compressed sizes) and blocks, each its own base64.
    fn encode(&mut self, bytes: &[u8]) -> io::Result<()> {
        let blocks: Vec<Vec<u8>> = bytes.chunks(BLOCK).map(compress).collect::<io::Result<_>>()?;
        let header = [blocks.len(), BLOCK, bytes.len() % BLOCK].into_iter().chain(blocks.iter().map(Vec::len));
        let header: Vec<u8> = header.flat_map(|number| (number as u64).to_le_bytes()).collect();
        STANDARD.encode_string(header, &mut self.encoded);
        let mut encoded = EncoderWriter::new(Vec::new(), &STANDARD);
        blocks.iter().try_for_each(|block| encoded.write_all(block))?;
        let encoded = encoded.finish()?;
        self.encoded.push_str(std::str::from_utf8(&encoded).expect("base64 is ASCII"));
        Ok(())
    }
}

fn compress(block: &[u8]) -> io::Result<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(block)?;
    encoder.finish()
}
