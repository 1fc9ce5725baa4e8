//! Rasters from arrays.

use crate::error::exception;
use corpuscle::Error;
use corpuscle::terrain::{Raster, write_raster_exactly};
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use std::path::PathBuf;

/// Writes an array of rows from the north and columns from the west as a GeoTIFF with all its bits.
#[pyfunction]
#[pyo3(signature = (path, values, corner, cell, crs=None))]
pub fn write_raster(
    py: Python<'_>,
    path: PathBuf,
    values: PyReadonlyArray2<'_, f64>,
    corner: [f64; 2],
    cell: [f64; 2],
    crs: Option<&str>,
) -> PyResult<()> {
    let [rows, columns] = [values.shape()[0], values.shape()[1]];
    let values: Vec<f64> = values.as_array().iter().copied().collect();
    let written = py.detach(|| {
        let raster = Raster::of_values([columns, rows], values, corner, cell, crs)?;
        write_raster_exactly(path, &raster)
    });
    written.map_err(|error| exception(py, &Error::from(error)))
}
