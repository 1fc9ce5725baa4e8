//! The maps of a member, in one file of NumPy's format.

use crate::EnsembleError;
use corpuscle::model::Map;
use corpuscle::terrain::MapGrid;
use corpuscle_atomic_file::WholeFile;
use ndarray::{Array1, Array2, ArrayView1, ArrayView2};
use ndarray_npy::npy::header::Header;
use ndarray_npy::{ReadNpyExt, ReadableElement, WritableElement, WriteNpyExt};
use std::error::Error;
use std::fs::File;
use std::io::{BufReader, Read, Seek, Write};
use std::path::Path;
use zip::write::SimpleFileOptions;
use zip::{ZipArchive, ZipWriter};

const MAPS: &str = "maps.npz";
/// Names of the axes in the file.
const AXES: [&str; 2] = ["axis:x", "axis:y"];
/// Longest header of an array, bytes, its signature included. Those of maps and axes have 128.
const MOST_HEADER: usize = 512;

type Failed = Box<dyn Error + Send + Sync>;

/// The x of the columns and the y of the rows of a grid, in its own coordinates.
pub(crate) fn axes(grid: &MapGrid) -> [Vec<f64>; 2] {
    let x = (0..grid.columns).map(|column| grid.georeference.centre(column, 0)[0]).collect();
    let y = (0..grid.rows).map(|row| grid.georeference.centre(0, row)[1]).collect();
    [x, y]
}

/// Writes maps and their axes.
pub(super) fn write(folder: &Path, maps: &[Map], grid: &MapGrid) -> Result<(), EnsembleError> {
    let path = folder.join(MAPS);
    let mut file = WholeFile::create(&path).map_err(EnsembleError::file(&path))?;
    let mut written = || -> Result<(), Failed> {
        let mut archive = ZipWriter::new(&mut file);
        for map in maps {
            put(&mut archive, map.name, |out| {
                Ok(ArrayView2::from_shape((map.rows, map.columns), &map.values)?.write_npy(out)?)
            })?;
        }
        for (name, axis) in AXES.iter().zip(axes(grid)) {
            put(&mut archive, name, |out| Ok(ArrayView1::from(&axis).write_npy(out)?))?;
        }
        archive.finish()?;
        Ok(())
    };
    written().map_err(|error| EnsembleError::file(&path)(std::io::Error::other(error)))?;
    file.finish().map_err(EnsembleError::file(&path))
}

fn put<W: Write + Seek>(
    archive: &mut ZipWriter<W>,
    name: &str,
    write: impl FnOnce(&mut ZipWriter<W>) -> Result<(), Failed>,
) -> Result<(), Failed> {
    archive.start_file(format!("{name}.npy"), SimpleFileOptions::default().large_file(true))?;
    write(archive)
}

/// Reads a map of a member, row by row from the north, and checks that it lies on a grid with these axes.
pub(crate) fn read_map(folder: &Path, name: &str, [x, y]: &[Vec<f64>; 2]) -> Result<Vec<f32>, EnsembleError> {
    let path = folder.join(MAPS);
    let damaged = |error: Failed| EnsembleError::damaged(&path, error);
    let mut archive = open(&path).map_err(damaged)?;
    let mut is_same = true;
    for (axis, expected) in AXES.iter().zip([x, y]) {
        let own: Option<Array1<f64>> = read(&mut archive, axis, &[expected.len()]).map_err(damaged)?;
        is_same &= own.is_some_and(|own| own.as_slice() == Some(expected));
    }
    if !is_same {
        return Err(EnsembleError::Folder(format!(
            "{} has its maps on another grid than the first member; leave keys out of the plan that change the terrain's cells",
            path.display()
        )));
    }
    let (rows, columns) = (y.len(), x.len());
    let map: Option<Array2<f32>> = read(&mut archive, name, &[rows, columns]).map_err(damaged)?;
    let map = map.ok_or_else(|| damaged(format!("{name} does not have {rows} x {columns} cells").into()))?;
    Ok(map.iter().copied().collect())
}

fn open(path: &Path) -> Result<ZipArchive<BufReader<File>>, Failed> {
    Ok(ZipArchive::new(BufReader::new(File::open(path)?))?)
}

/// Reads an array of a shape; none where it has another one. Memory is taken for the shape expected, whatever the file says.
fn read<T, D>(
    archive: &mut ZipArchive<BufReader<File>>,
    name: &str,
    shape: &[usize],
) -> Result<Option<ndarray::Array<T, D>>, Failed>
where
    T: ReadableElement + WritableElement,
    D: ndarray::Dimension,
{
    let mut file = archive.by_name(&format!("{name}.npy")).map_err(|error| format!("{name}: {error}"))?;
    let mut head = Vec::new();
    file.by_ref().take(MOST_HEADER as u64).read_to_end(&mut head)?;
    // Signature, version, then the length of the header in 2 bytes or, from version 2 on, in 4.
    let length = match head.get(6..12) {
        Some(&[1, _, a, b, ..]) => 10 + usize::from(u16::from_le_bytes([a, b])),
        Some(&[_, _, a, b, c, d]) => 12 + u32::from_le_bytes([a, b, c, d]) as usize,
        _ => 0,
    };
    let head_alone = head.get(..length).ok_or_else(|| format!("{name} has a header of {length} bytes"))?;
    if Header::from_reader(&mut { head_alone })?.shape != shape {
        return Ok(None);
    }
    let bytes = shape.iter().product::<usize>() * size_of::<T>();
    // One byte more, so that an array that goes on is noticed.
    let rest = (length + bytes + 1).saturating_sub(head.len()) as u64;
    Ok(Some(ndarray::Array::<T, D>::read_npy(head.as_slice().chain(file.take(rest)))?))
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAME: &str = "max_depth";

    /// A file of maps whose first array, `NAME`, has these bytes, and that has axes with so many values.
    fn with_map(folder: &Path, bytes: &[u8], axes: [usize; 2]) {
        let mut archive = ZipWriter::new(File::create(folder.join(MAPS)).unwrap());
        put(&mut archive, NAME, |out| Ok(out.write_all(bytes)?)).unwrap();
        for (name, count) in AXES.iter().zip(axes) {
            put(&mut archive, name, |out| Ok(Array1::<f64>::zeros(count).write_npy(out)?)).unwrap();
        }
        archive.finish().unwrap();
    }

    fn npy(shape: &str, data: &[u8]) -> Vec<u8> {
        let header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}\n");
        let length = (header.len() as u16).to_le_bytes();
        [b"\x93NUMPY\x01\x00".as_slice(), &length, header.as_bytes(), data].concat()
    }

    #[test]
    fn memory_is_taken_for_the_shape_expected_only() {
        let folder = tempfile::tempdir().unwrap();
        let axes = [vec![0.0; 3], vec![0.0; 2]];
        let read_back = |bytes: &[u8]| {
            with_map(folder.path(), bytes, [3, 2]);
            read_map(folder.path(), NAME, &axes).map_err(|error| error.to_string())
        };
        assert_eq!(read_back(&npy("(2, 3)", &[0; 24])), Ok(vec![0.0; 6]));
        let huge = npy("(1000000000, 100000)", &[0; 24]);
        assert!(read_back(&huge).unwrap_err().contains("max_depth does not have 2 x 3 cells"));
        for data in [23, 25, 1 << 20] {
            assert!(read_back(&npy("(2, 3)", &vec![0; data])).unwrap_err().contains("maps.npz cannot be used"));
        }
        let long_header = [b"\x93NUMPY\x02\x00".as_slice(), &u32::MAX.to_le_bytes(), b"{}"].concat();
        assert!(read_back(&long_header).unwrap_err().contains("has a header of 4294967307 bytes"));
        let deep = npy(&"(".repeat(5000), &[]);
        assert!(read_back(&deep).unwrap_err().contains("has a header of 5"));
        assert!(read_back(&npy(&"(".repeat(400), &[])).is_err());
        assert!(read_back(b"\x93NUMPY").is_err() && read_back(b"").is_err());
    }

    #[test]
    fn axes_of_another_length_are_those_of_another_grid() {
        let folder = tempfile::tempdir().unwrap();
        with_map(folder.path(), &npy("(2, 3)", &[0; 24]), [4, 2]);
        let error = read_map(folder.path(), NAME, &[vec![0.0; 3], vec![0.0; 2]]).unwrap_err();
        assert!(error.to_string().contains("on another grid"), "{error}");
    }
}
