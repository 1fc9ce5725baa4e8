//! What a model gives, as arrays of NumPy. Vectors are handed over, not copied.

use corpuscle::model::{Chart, Column, Frame, Map, ParticleSet, Path, Values};
use corpuscle::terrain::{MapGrid, Terrain};
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// A list of vectors as an array of `count` rows of three.
fn vectors<'py>(py: Python<'py>, values: Vec<[f64; 3]>) -> PyResult<Bound<'py, PyAny>> {
    let count = values.len();
    Ok(values.into_flattened().into_pyarray(py).reshape([count, 3])?.into_any())
}

/// A frame as (time, [(name of the set, {column: (array, unit)})]); units are empty where the scene is not in SI units.
pub fn frame(py: Python<'_>, frame: Frame, is_si: bool) -> PyResult<(f64, Bound<'_, PyList>)> {
    let sets = PyList::empty(py);
    for set in frame.sets {
        let name = set.name.clone();
        sets.append((name, columns(py, set, is_si)?))?;
    }
    Ok((frame.time, sets))
}

fn columns(py: Python<'_>, set: ParticleSet, is_si: bool) -> PyResult<Bound<'_, PyDict>> {
    let ParticleSet { id, position, velocity, radius, mass, columns, .. } = set;
    let named = PyDict::new(py);
    let unit = |unit| if is_si { unit } else { "" };
    named.set_item("id", (id.into_pyarray(py), ""))?;
    named.set_item("position", (vectors(py, position)?, unit("m")))?;
    named.set_item("velocity", (vectors(py, velocity)?, unit("m/s")))?;
    named.set_item("radius", (radius.into_pyarray(py), unit("m")))?;
    named.set_item("mass", (mass.into_pyarray(py), unit("kg")))?;
    for Column { name, unit, values } in columns {
        match values {
            Values::Scalar(values) => named.set_item(name, (values.into_pyarray(py), unit))?,
            Values::Vector(values) => named.set_item(name, (vectors(py, values)?, unit))?,
        }
    }
    Ok(named)
}

/// Maps as [(name, title, unit, array of rows from the north and columns from the west)].
pub fn maps(py: Python<'_>, maps: Vec<Map>) -> PyResult<Bound<'_, PyList>> {
    let list = PyList::empty(py);
    for Map { name, title, unit, columns, rows, values } in maps {
        list.append((name, title, unit, values.into_pyarray(py).reshape([rows, columns])?))?;
    }
    Ok(list)
}

/// The grid of the maps: x of the columns, y of the rows, the name of the reference system, and metres in a unit of x and y; none for degrees.
pub fn grid<'py>(py: Python<'py>, terrain: &Terrain) -> PyResult<Bound<'py, PyAny>> {
    let MapGrid { columns, rows, georeference, .. } = terrain.map_grid();
    let x: Vec<_> = (0..*columns).map(|column| georeference.centre(column, 0)[0]).collect();
    let y: Vec<_> = (0..*rows).map(|row| georeference.centre(0, row)[1]).collect();
    let system = georeference.system.as_ref();
    let name = system.map(|system| system.name.clone());
    let metres = match system {
        Some(system) => (!system.geographic).then_some(system.metres_per_unit),
        None => Some(1.0),
    };
    Ok((x.into_pyarray(py), y.into_pyarray(py), name, metres).into_pyobject(py)?.into_any())
}

/// Charts as [{name, title, x, y, note, series: [(name, points, errors)]}].
pub fn charts(py: Python<'_>, charts: Vec<Chart>) -> PyResult<Bound<'_, PyList>> {
    let list = PyList::empty(py);
    for Chart { name, title, x, y, series, note } in charts {
        let drawn = PyList::empty(py);
        for series in series {
            let count = series.points.len();
            let points = series.points.into_flattened().into_pyarray(py).reshape([count, 2])?;
            drawn.append((series.name, points, series.errors.into_pyarray(py)))?;
        }
        let chart = PyDict::new(py);
        chart.set_item("name", name)?;
        chart.set_item("title", title)?;
        chart.set_item("x", (x.label, x.unit))?;
        chart.set_item("y", (y.label, y.unit))?;
        chart.set_item("note", note)?;
        chart.set_item("series", drawn)?;
        list.append(chart)?;
    }
    Ok(list)
}

/// Trajectories as [(name, times, points)].
pub fn paths(py: Python<'_>, paths: Vec<Path>) -> PyResult<Bound<'_, PyList>> {
    let list = PyList::empty(py);
    for Path { name, times, points } in paths {
        list.append((name, times.into_pyarray(py), vectors(py, points)?))?;
    }
    Ok(list)
}
