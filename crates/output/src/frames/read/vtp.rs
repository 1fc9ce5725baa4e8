//! Particles from VTK XML PolyData as [`crate::frames`] writes it: arrays in one appended section, base64, zlib blocks.

use super::columns::column;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use corpuscle_model::{Frame, ParticleSet, Values};
use flate2::read::ZlibDecoder;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::cell::Cell;
use std::collections::BTreeSet;
use std::io::Read;

/// Arrays that every file has; other arrays of point data are the model's own.
const KNOWN: [&str; 5] = ["set", "id", "velocity", "radius", "mass"];

/// Most bytes of arrays for each letter of the appended section. Numbers of particles alone, which differ from one to the next, keep files
/// as they are written far below it.
const MOST_UNPACKED: usize = 100;
/// Bytes of arrays that any file may have.
const ANY_UNPACKED: usize = 1 << 20;
/// Letters of the first three numbers of an array, which are decoded twice.
const START: usize = 32;

/// An array in the appended section.
struct Array {
    name: String,
    components: usize,
    offset: usize,
    of_points: bool,
}

/// A file in pieces.
#[derive(Default)]
struct Pieces {
    time: String,
    set_names: String,
    points: Option<usize>,
    arrays: Vec<Array>,
    appended: String,
}

/// Reads a file.
pub(super) fn read(text: &str) -> Result<Frame, String> {
    let pieces = Pieces::of(text)?;
    let points = pieces.points.ok_or("it has no `Piece` with its number of points")?;
    let time = pieces.time.trim().parse().map_err(|_| format!("its TimeValue `{}` is not a number", pieces.time))?;
    pieces.refuse_repeated()?;
    let appended = Appended::new(&pieces);
    let bytes = |name: &str, size: usize| {
        let array = pieces.arrays.iter().find(|array| array.name == name).ok_or(format!("it has no array `{name}`"))?;
        let bytes = appended
            .decode(array.offset, points.saturating_mul(size))
            .map_err(|what| format!("the array `{name}` is damaged: {what}"))?;
        if points.checked_mul(size) == Some(bytes.len()) {
            Ok(bytes)
        } else {
            Err(format!("the array `{name}` does not fit {points} points"))
        }
    };
    let scalars = |name: &str| bytes(name, 8).map(|bytes| doubles(&bytes));
    let vectors = |name: &str| bytes(name, 24).map(|bytes| triples(&doubles(&bytes)));
    let set: Vec<i32> = words(&bytes("set", 4)?).map(i32::from_le_bytes).collect();
    let id: Vec<u64> = words(&bytes("id", 8)?).map(u64::from_le_bytes).collect();
    let (position, velocity) = (vectors("position")?, vectors("velocity")?);
    let (radius, mass) = (scalars("radius")?, scalars("mass")?);
    let own = pieces.arrays.iter().filter(|array| array.of_points && !KNOWN.contains(&array.name.as_str()));
    let own = own.map(|array| {
        let values = match array.components {
            1 => Values::Scalar(scalars(&array.name)?),
            3 => Values::Vector(vectors(&array.name)?),
            other => return Err(format!("the array `{}` has {other} components, not 1 or 3", array.name)),
        };
        Ok((array.name.as_str(), values))
    });
    let own = own.collect::<Result<Vec<_>, String>>()?;
    let names = set_names(&pieces.set_names)?;
    let mut rows_of = vec![Vec::new(); names.len()];
    for (row, number) in set.iter().enumerate() {
        let rows = usize::try_from(*number).ok().and_then(|number| rows_of.get_mut(number));
        rows.ok_or_else(|| format!("a point is of set {number}, and there are {} sets", names.len()))?.push(row);
    }
    let of_set = |(name, rows): (&String, &Vec<usize>)| {
        let pick = |values: &[f64]| rows.iter().map(|row| values[*row]).collect::<Vec<f64>>();
        let pick_vectors = |values: &[[f64; 3]]| rows.iter().map(|row| values[*row]).collect::<Vec<[f64; 3]>>();
        let picked = |(name, values): &(&str, Values)| {
            let values = match values {
                Values::Scalar(scalars) => Values::Scalar(pick(scalars)),
                Values::Vector(vectors) => Values::Vector(pick_vectors(vectors)),
            };
            column(name, values, names.len() == 1)
        };
        ParticleSet {
            name: name.clone(),
            id: rows.iter().map(|row| id[*row]).collect(),
            position: pick_vectors(&position),
            velocity: pick_vectors(&velocity),
            radius: pick(&radius),
            mass: pick(&mass),
            columns: own.iter().filter_map(picked).collect(),
        }
    };
    Ok(Frame { time, sets: names.iter().zip(&rows_of).map(of_set).collect() })
}

impl Pieces {
    fn of(text: &str) -> Result<Self, String> {
        let mut reader = Reader::from_str(text);
        let mut pieces = Self::default();
        let mut inside: Vec<(Vec<u8>, String)> = Vec::new();
        loop {
            match reader.read_event().map_err(|error| format!("it is not well-formed: {error}"))? {
                Event::Start(element) => {
                    let tag = element.name().as_ref().to_vec();
                    if tag == b"Piece" {
                        let points = attribute(&element, "NumberOfPoints")?;
                        pieces.points = Some(points.parse().map_err(|_| format!("`{points}` is no number of points"))?);
                    }
                    inside.push((tag, attribute(&element, "Name").unwrap_or_default()));
                }
                Event::End(_) => drop(inside.pop()),
                Event::Empty(element) if element.name().as_ref() == b"DataArray" => {
                    let of_points = inside.last().is_some_and(|(tag, _)| tag == b"PointData");
                    pieces.arrays.push(array(&element, of_points)?);
                }
                Event::Text(content) => {
                    let content = content.decode().map_err(|error| error.to_string())?;
                    match inside.last() {
                        Some((tag, _)) if tag == b"AppendedData" => pieces.appended.push_str(&content),
                        Some((_, name)) if name == "TimeValue" => pieces.time.push_str(&content),
                        Some((_, name)) if name == "set_names" => pieces.set_names.push_str(&content),
                        _ => {}
                    }
                }
                Event::Eof => {
                    let start = pieces.appended.find('_').ok_or("it has no appended data")?;
                    pieces.appended = pieces.appended[start + 1..].trim_end().to_owned();
                    return Ok(pieces);
                }
                _ => {}
            }
        }
    }

    /// Refuses arrays of one name, of which only the first could be told.
    fn refuse_repeated(&self) -> Result<(), String> {
        let mut names = BTreeSet::new();
        match self.arrays.iter().find(|array| !names.insert(&array.name)) {
            Some(array) => Err(format!("it has two arrays `{}`", array.name)),
            None => Ok(()),
        }
    }
}

fn array(element: &BytesStart<'_>, of_points: bool) -> Result<Array, String> {
    let number = |name: &str| {
        let text = attribute(element, name)?;
        text.parse::<usize>().map_err(|_| format!("the {name} `{text}` of an array is not a number"))
    };
    Ok(Array {
        name: attribute(element, "Name")?,
        components: number("NumberOfComponents")?,
        offset: number("offset")?,
        of_points,
    })
}

/// An attribute as text.
pub(super) fn attribute(element: &BytesStart<'_>, name: &str) -> Result<String, String> {
    let found = element.try_get_attribute(name).map_err(|error| error.to_string())?;
    let found = found.ok_or_else(|| format!("an element has no attribute `{name}`"))?;
    Ok(found.unescape_value().map_err(|error| error.to_string())?.into_owned())
}

/// The names of the sets: codes of their letters, each name closed by a 0.
fn set_names(codes: &str) -> Result<Vec<String>, String> {
    let bytes = codes.split_whitespace().map(str::parse::<u8>).collect::<Result<Vec<u8>, _>>();
    let bytes = bytes.map_err(|_| "its set_names are not codes of letters")?;
    let text = String::from_utf8(bytes).map_err(|_| "its set_names are not text")?;
    Ok(text.split_terminator('\0').map(str::to_owned).collect())
}

/// The appended section, with what may still be decoded of it: each letter once, however many arrays name it.
struct Appended<'a> {
    text: &'a str,
    /// Letters.
    packed: Cell<usize>,
    /// Bytes of arrays.
    unpacked: Cell<usize>,
}

impl<'a> Appended<'a> {
    fn new(pieces: &'a Pieces) -> Self {
        let text = pieces.appended.as_str();
        let packed = Cell::new(text.len() + START * pieces.arrays.len());
        Self {
            text,
            packed,
            unpacked: Cell::new(ANY_UNPACKED.saturating_add(text.len().saturating_mul(MOST_UNPACKED))),
        }
    }

    /// The bytes of base64 at an offset, and where it ends.
    fn plain(&self, from: usize, bytes: usize) -> Result<(Vec<u8>, usize), String> {
        let end = bytes.div_ceil(3).checked_mul(4).and_then(|letters| letters.checked_add(from));
        let text = end.and_then(|end| self.text.get(from..end)).ok_or_else(cut)?;
        spend(&self.packed, text.len()).ok_or("its data are those of another array, too")?;
        Ok((STANDARD.decode(text).map_err(|error| error.to_string())?, from + text.len()))
    }

    /// The bytes of the array at an offset; never many more than `expected`, whatever a damaged file says.
    fn decode(&self, offset: usize, expected: usize) -> Result<Vec<u8>, String> {
        spend(&self.unpacked, expected).ok_or("the file is too short for as many points and arrays as it names")?;
        // Count of blocks, size of a block, size of a short last block, then the compressed size of each.
        let (start, _) = self.plain(offset, 24)?;
        let count = words::<8>(&start).map(u64::from_le_bytes).next().unwrap_or(0) as usize;
        let length = count.checked_add(3).and_then(|words| words.checked_mul(8)).ok_or_else(cut)?;
        let (header, from) = self.plain(offset, length)?;
        let sizes: Vec<usize> = words::<8>(&header).skip(3).map(|word| u64::from_le_bytes(word) as usize).collect();
        let total = sizes.iter().try_fold(0_usize, |sum, size| sum.checked_add(*size)).ok_or_else(cut)?;
        let (blocks, _) = self.plain(from, total)?;
        let mut bytes = Vec::new();
        let mut rest = blocks.as_slice();
        for size in sizes {
            let (block, others) = rest.split_at_checked(size).ok_or_else(cut)?;
            rest = others;
            let room = expected.saturating_add(1).saturating_sub(bytes.len()) as u64;
            ZlibDecoder::new(block).take(room).read_to_end(&mut bytes).map_err(|error| error.to_string())?;
        }
        Ok(bytes)
    }
}

fn cut() -> String {
    "it ends too early".into()
}

/// Takes from what is left; none where that is less.
fn spend(left: &Cell<usize>, much: usize) -> Option<()> {
    left.set(left.get().checked_sub(much)?);
    Some(())
}

fn words<const N: usize>(bytes: &[u8]) -> impl Iterator<Item = [u8; N]> {
    bytes.as_chunks::<N>().0.iter().copied()
}

fn doubles(bytes: &[u8]) -> Vec<f64> {
    words(bytes).map(f64::from_le_bytes).collect()
}

fn triples(values: &[f64]) -> Vec<[f64; 3]> {
    values.as_chunks::<3>().0.to_vec()
}
