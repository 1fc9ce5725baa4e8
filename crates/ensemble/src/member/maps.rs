//! The maps of a member, in one file of NumPy's format.

use crate::EnsembleError;
use corpuscle::model::Map;
use corpuscle::terrain::MapGrid;
use corpuscle_atomic_file::WholeFile;
use ndarray::{Array1, Array2, ArrayView1, ArrayView2};
use ndarray_npy::{ReadNpyExt, ReadableElement, WritableElement, WriteNpyExt};
use std::error::Error;
use std::fs::File;
use std::io::{BufReader, Seek, Write};
use std::path::Path;
use zip::write::SimpleFileOptions;
use zip::{ZipArchive, ZipWriter};

const MAPS: &str = "maps.npz";
/// Names of the axes in the file.
const AXES: [&str; 2] = ["axis:x", "axis:y"];

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
    let [own_x, own_y] = AXES.map(|axis| axis_of(&mut archive, axis));
    if own_x.map_err(damaged)?.as_slice() != Some(x) || own_y.map_err(damaged)?.as_slice() != Some(y) {
        return Err(EnsembleError::Folder(format!(
            "{} has its maps on another grid than the first member; leave keys out of the plan that change the terrain's cells",
            path.display()
        )));
    }
    let map: Array2<f32> = read(&mut archive, name).map_err(damaged)?;
    if map.dim() != (y.len(), x.len()) {
        return Err(damaged(format!("{name} has {:?} cells", map.dim()).into()));
    }
    Ok(map.iter().copied().collect())
}

fn open(path: &Path) -> Result<ZipArchive<BufReader<File>>, Failed> {
    Ok(ZipArchive::new(BufReader::new(File::open(path)?))?)
}

fn axis_of(archive: &mut ZipArchive<BufReader<File>>, name: &str) -> Result<Array1<f64>, Failed> {
    read(archive, name)
}

fn read<T, D>(archive: &mut ZipArchive<BufReader<File>>, name: &str) -> Result<ndarray::Array<T, D>, Failed>
where
    T: ReadableElement + WritableElement,
    D: ndarray::Dimension,
{
    let file = archive.by_name(&format!("{name}.npy")).map_err(|error| format!("{name}: {error}"))?;
    Ok(ndarray::Array::<T, D>::read_npy(file)?)
}
