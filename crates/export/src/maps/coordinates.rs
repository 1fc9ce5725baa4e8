//! Coordinates of maps, and their reference system, in the CF conventions.

use crate::error::Failed;
use crate::hdf5::HasAttributes;
use corpuscle_terrain::{Georeference, ReferenceSystem, Survey};
use rust_hdf5::{H5Dataset, H5File};

/// Name of the variable that describes the reference system, as GDAL and rioxarray expect it.
const SYSTEM: &str = "spatial_ref";

/// The coordinates of maps in a file.
pub(super) struct Coordinates {
    /// Scales of the dimensions, from the last one of a map on: x, y, time.
    scales: Vec<H5Dataset>,
    /// True where the reference system is described.
    has_system: bool,
}

impl Coordinates {
    /// Writes the centres of the cells, rows from the north, times, s, and the reference system.
    pub(super) fn write(file: &H5File, grid: &Survey, times: &[f64]) -> Result<Self, Failed> {
        let Georeference { system, .. } = &grid.georeference;
        let x: Vec<f64> = (0..grid.columns).map(|column| grid.georeference.centre(column, 0)[0]).collect();
        let y: Vec<f64> = (0..grid.rows).map(|row| grid.georeference.centre(0, row)[1]).collect();
        let mut scales = Vec::new();
        for (name, values) in [("x", x), ("y", y)] {
            let axis = scale(file, name, &values)?;
            describe_axis(&axis, name, system.as_ref())?;
            scales.push(axis);
        }
        if !times.is_empty() {
            let time = scale(file, "time", times)?;
            time.text("long_name", "Time since the start of the simulation")?;
            time.text("units", "s")?;
            time.text("axis", "T")?;
            scales.push(time);
        }
        let has_system = system.as_ref().map_or(Ok(false), |system| write_system(file, system))?;
        Ok(Self { scales, has_system })
    }

    /// Says of a map which coordinates it has: of y and x, or of time, y and x.
    pub(super) fn attach(&self, map: &H5Dataset) -> Result<(), Failed> {
        if self.has_system {
            map.text("grid_mapping", SYSTEM)?;
        }
        let axes = map.shape().len();
        for (from_last, scale) in self.scales.iter().take(axes).enumerate() {
            map.attach_scale(axes - 1 - from_last, scale)?;
        }
        Ok(())
    }
}

/// Writes the values of a coordinate.
fn scale(file: &H5File, name: &str, values: &[f64]) -> Result<H5Dataset, Failed> {
    let axis = file.new_dataset::<f64>().shape([values.len()]).create(name)?;
    axis.write_raw(values)?;
    axis.set_scale(Some(name))?;
    Ok(axis)
}

/// Attributes of the coordinate `x` or `y`: degrees, or the unit of the system; metres without a system.
fn describe_axis(axis: &H5Dataset, name: &str, system: Option<&ReferenceSystem>) -> Result<(), Failed> {
    let is_x = name == "x";
    if system.is_some_and(|system| system.geographic) {
        let [standard, long, unit] =
            if is_x { ["longitude", "Longitude", "degrees_east"] } else { ["latitude", "Latitude", "degrees_north"] };
        axis.text("standard_name", standard)?;
        axis.text("long_name", long)?;
        axis.text("units", unit)?;
    } else {
        let metres = system.map_or(1.0, |system| system.metres_per_unit);
        axis.text("standard_name", &format!("projection_{name}_coordinate"))?;
        axis.text("long_name", if is_x { "Easting" } else { "Northing" })?;
        axis.text("units", &if metres == 1.0 { "m".to_owned() } else { format!("{metres} m") })?;
    }
    axis.text("axis", if is_x { "X" } else { "Y" })
}

/// Writes the variable that describes the reference system; says whether there was anything to write.
fn write_system(file: &H5File, system: &ReferenceSystem) -> Result<bool, Failed> {
    let Some(code) = system.epsg else { return Ok(false) };
    let variable = file.new_dataset::<i32>().scalar().create(SYSTEM)?;
    variable.write_raw(&[0])?;
    if system.geographic {
        variable.text("grid_mapping_name", "latitude_longitude")?;
    }
    match system.well_known_text() {
        Some(text) => {
            variable.text("crs_wkt", text)?;
            variable.text("spatial_ref", text)?;
        }
        None => variable.text("spatial_ref", &format!("EPSG:{code}"))?,
    }
    Ok(true)
}
