//! Maps as NetCDF-4 with the CF conventions 1.8.
//!
//! A NetCDF-4 file is an HDF5 file whose dimensions are dimension scales; written so, one map is in memory at a time.

mod coordinates;
mod quantities;

use crate::ExportError;
use crate::error::Failed;
use crate::hdf5::{DEFLATE, HasAttributes, create};
use crate::run::Run;
use coordinates::Coordinates;
use corpuscle_atomic_file::write_whole_by_path;
use corpuscle_output::MapFiles;
use corpuscle_terrain::Survey;
use quantities::quantity;
use rust_hdf5::{H5Dataset, H5File};
use std::path::Path;

/// Side of a chunk, cells.
const CHUNK: usize = 256;

/// Writes the maps of a run.
pub(crate) fn write(run: &Run, file: &Path) -> Result<(), ExportError> {
    let maps = MapFiles::list(&run.folder)?;
    let grid = maps.grid()?;
    write_whole_by_path(file, |path| {
        let file = create(path)?;
        write_attributes(&file, run, &maps, &grid)?;
        write_maps(&file, &maps, &grid)?;
        Ok(file.close()?)
    })
    .map_err(Failed::at(file))
}

/// What the file says of itself.
fn write_attributes(file: &H5File, run: &Run, maps: &MapFiles, grid: &Survey) -> Result<(), Failed> {
    file.text("Conventions", "CF-1.8")?;
    file.text("title", &run.title())?;
    file.text("source", &run.source())?;
    if let Some(system) = &grid.georeference.system {
        file.text("crs", &system.name)?;
    }
    if let Some(time) = run.end().or(maps.times().last().copied()) {
        file.set_attr_numeric("time_s", &time)?;
    }
    Ok(())
}

fn write_maps(file: &H5File, maps: &MapFiles, grid: &Survey) -> Result<(), Failed> {
    let coordinates = Coordinates::write(file, grid, maps.times())?;
    let size = [grid.rows, grid.columns];
    let chunk = size.map(|cells| cells.min(CHUNK));
    for name in maps.names() {
        let values = maps.read(name, grid.rows * grid.columns)?;
        let map = file.new_dataset::<f32>().shape(size).chunk(&chunk);
        let map = map.shuffle_deflate(DEFLATE).fill_value(f32::NAN).create(name)?;
        map.write_raw(&values)?;
        describe(&map, name, &coordinates)?;
    }
    if maps.times().is_empty() {
        return Ok(());
    }
    let name = maps.name_over_time();
    let [rows, columns] = size;
    let over_time =
        file.new_dataset::<f32>().shape([maps.times().len(), rows, columns]).chunk(&[1, chunk[0], chunk[1]]);
    let over_time = over_time.shuffle_deflate(DEFLATE).fill_value(f32::NAN).create(name)?;
    for index in 0..maps.times().len() {
        let values = maps.read_at(index, grid.rows * grid.columns)?;
        over_time.write_slice(&[index, 0, 0], &[1, rows, columns], &values)?;
    }
    describe(&over_time, name, &coordinates)
}

/// What the variable of a map says of itself.
fn describe(map: &H5Dataset, name: &str, coordinates: &Coordinates) -> Result<(), Failed> {
    let (title, unit) = quantity(name);
    map.text("long_name", &title)?;
    if let Some(unit) = unit {
        map.text("units", unit)?;
    }
    map.new_attr::<f32>().shape([1]).create("_FillValue")?.write_array(&[f32::NAN])?;
    coordinates.attach(map)
}
