//! Particles as rows: `set,id,x,y,z,vx,vy,vz,radius,mass`, then the model's own columns.

use crate::number::Shortest;
use corpuscle_model::{Frame, ParticleSet, Values};
use std::io::{self, Write};

/// Writes a frame. A vector column `flow` becomes `flow_x,flow_y,flow_z`; a set without a column that another set
/// has gets `NaN` there.
pub(super) fn write(file: &mut impl Write, frame: &Frame) -> io::Result<()> {
    let columns = own_columns(frame);
    write!(file, "set,id,x,y,z,vx,vy,vz,radius,mass")?;
    for &(name, is_vector) in &columns {
        match is_vector {
            true => write!(file, ",{name}_x,{name}_y,{name}_z")?,
            false => write!(file, ",{name}")?,
        }
    }
    writeln!(file)?;
    for set in &frame.sets {
        write_set(file, set, &columns)?;
    }
    Ok(())
}

/// Names of the model's own columns over all sets, in order of first appearance, and whether they are vectors.
pub(super) fn own_columns(frame: &Frame) -> Vec<(&'static str, bool)> {
    let mut columns: Vec<(&'static str, bool)> = Vec::new();
    for column in frame.sets.iter().flat_map(|set| &set.columns) {
        if columns.iter().all(|(name, _)| *name != column.name) {
            columns.push((column.name, matches!(column.values, Values::Vector(_))));
        }
    }
    columns
}

fn write_set(file: &mut impl Write, set: &ParticleSet, columns: &[(&'static str, bool)]) -> io::Result<()> {
    let values: Vec<_> =
        columns.iter().map(|(name, _)| set.columns.iter().find(|c| c.name == *name).map(|c| &c.values)).collect();
    for i in 0..set.len() {
        write!(file, "{},{}", set.name, set.id[i])?;
        for value in set.position[i].iter().chain(&set.velocity[i]).chain([&set.radius[i], &set.mass[i]]) {
            write!(file, ",{}", Shortest(*value))?;
        }
        for (values, (_, is_vector)) in values.iter().zip(columns) {
            match values {
                Some(Values::Scalar(scalar)) => write!(file, ",{}", Shortest(scalar[i]))?,
                Some(Values::Vector(vector)) => {
                    let [x, y, z] = vector[i].map(Shortest);
                    write!(file, ",{x},{y},{z}")?;
                }
                None => write!(file, "{}", if *is_vector { ",NaN,NaN,NaN" } else { ",NaN" })?,
            }
        }
        writeln!(file)?;
    }
    Ok(())
}
