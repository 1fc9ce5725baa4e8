//! Cloud-optimised GeoTIFF, written with the `geotiff-writer` library.

use super::Raster;
use crate::{Georeference, MapGrid, TerrainError};
use corpuscle_atomic_file::WholeFile;
use geotiff_reader::transform::GeoTransform;
use geotiff_writer::{CogBuilder, Compression, GeoTiffBuilder, NumericSample, Predictor, RasterType, Resampling};
use ndarray::ArrayView2;
use std::path::Path;

/// Side of a tile in the file, cells.
const TILE: u32 = 256;

/// Writes a map as cloud-optimised GeoTIFF: 32-bit floating point, Deflate, tiled, with the position and the reference system of `grid`.
/// `values` are `rows * columns`, row by row from the north-west; those that are not a number are written as `no_data`,
/// which the file names. The file appears whole or not at all.
///
/// One that is larger than a tile has overviews: every second cell, every fourth, and so on, until one tile has all. They take cells as
/// they are, since a mean is a value that no cell has.
///
/// # Errors
/// [`TerrainError::Write`] where the folder, the disk or the number of values does not allow it.
pub fn write_geotiff(path: impl AsRef<Path>, grid: &MapGrid, values: &[f32], no_data: f32) -> Result<(), TerrainError> {
    write(path.as_ref(), &grid.georeference, [grid.columns, grid.rows], values, no_data)
}

/// Writes a raster as [`write_geotiff`] does.
///
/// # Errors
/// As [`write_geotiff`].
pub fn write_raster(path: impl AsRef<Path>, raster: &Raster, no_data: f32) -> Result<(), TerrainError> {
    let values: Vec<f32> = raster.values.iter().map(|value| *value as f32).collect();
    write(path.as_ref(), &raster.georeference, [raster.columns, raster.rows], &values, no_data)
}

/// Writes a raster as [`write_geotiff`] does, but with all bits of its values: 64-bit floating point, cells without data as not-a-number.
///
/// # Errors
/// As [`write_geotiff`].
pub fn write_raster_exactly(path: impl AsRef<Path>, raster: &Raster) -> Result<(), TerrainError> {
    write_samples(path.as_ref(), &raster.georeference, [raster.columns, raster.rows], &raster.values, "nan")
}

fn write(
    path: &Path,
    georeference: &Georeference,
    size: [usize; 2],
    values: &[f32],
    no_data: f32,
) -> Result<(), TerrainError> {
    let filled: Vec<f32> = values.iter().map(|value| if value.is_nan() { no_data } else { *value }).collect();
    write_samples(path, georeference, size, &filled, &no_data.to_string())
}

fn write_samples<T: NumericSample>(
    path: &Path,
    georeference: &Georeference,
    [columns, rows]: [usize; 2],
    values: &[T],
    no_data: &str,
) -> Result<(), TerrainError> {
    let array = ArrayView2::from_shape((rows, columns), values).map_err(|error| TerrainError::write(path, error))?;
    let builder = builder(georeference, [columns, rows], no_data);
    let mut file = WholeFile::create(path).map_err(|error| TerrainError::write(path, error))?;
    let optimised =
        CogBuilder::new(builder).overview_levels(overviews(columns.max(rows))).resampling(Resampling::NearestNeighbor);
    optimised.write_2d_to(&mut file, array).map_err(|error| TerrainError::write(path, error))?;
    file.finish().map_err(|error| TerrainError::write(path, error))
}

/// Steps, in cells, of the overviews of a raster with so many cells along its longer side: powers of two, until one tile has it all.
fn overviews(side: usize) -> Vec<u32> {
    (1..u32::BITS)
        .map(|power| 1 << power)
        .take_while(|step| side.div_ceil(*step as usize / 2) > TILE as usize)
        .collect()
}

/// What the file says about itself.
fn builder(georeference: &Georeference, [columns, rows]: [usize; 2], no_data: &str) -> GeoTiffBuilder {
    let transform = GeoTransform::from_origin_and_pixel_size(
        georeference.corner[0],
        georeference.corner[1],
        georeference.cell[0],
        -georeference.cell[1],
    );
    let start = GeoTiffBuilder::new(columns as u32, rows as u32);
    let keys = georeference.keys.keys.iter().fold(start, |builder, key| builder.geokey(key.id, key.value.clone()));
    // Without a reference system no key at all is written: a lone raster type reads as an unnamed system.
    let keys = if georeference.keys.keys.is_empty() { keys } else { keys.raster_type(RasterType::PixelIsArea) };
    keys.transform(transform)
        .nodata(no_data)
        .compression(Compression::Deflate)
        .predictor(Predictor::FloatingPoint)
        .tile_size(TILE, TILE)
}
