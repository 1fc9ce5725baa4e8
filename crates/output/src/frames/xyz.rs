//! Particles as extended XYZ, which OVITO, VMD and ASE open: a line with their number, a line that says what stands in the columns, and a row for
//! each. Format: github.com/libAtoms/extxyz. VMD reads the first four columns, so species and position come first.

use super::csv::own_columns;
use crate::number::Shortest;
use corpuscle_model::{Container, Frame, ParticleSet, Values};
use std::io::{self, Write};

/// Columns that every file begins with.
pub(super) const FIRST: &str = "species:S:1:pos:R:3:id:I:1:velo:R:3:radius:R:1:mass:R:1";

/// Writes a frame as extended XYZ; with the box round the particles, where there is one. A set is a species, with `_` for spaces in its name; a set
/// without a column that another set has gets `NaN` there.
///
/// # Errors
/// What the system says where it cannot be written.
pub fn write(file: &mut impl Write, frame: &Frame, container: Option<&Container>) -> io::Result<()> {
    let columns = own_columns(frame);
    writeln!(file, "{}", frame.sets.iter().map(ParticleSet::len).sum::<usize>())?;
    if let Some(container) = container {
        write_box(file, container)?;
    }
    write!(file, "Properties={FIRST}")?;
    for &(name, is_vector) in &columns {
        write!(file, ":{name}:R:{}", if is_vector { 3 } else { 1 })?;
    }
    writeln!(file, " Time={}", Shortest(frame.time))?;
    frame.sets.iter().try_for_each(|set| write_set(file, set, &columns))
}

/// The box as lattice and origin, not periodic, so that programs do not unwrap positions.
fn write_box(file: &mut impl Write, Container { from, to }: &Container) -> io::Result<()> {
    let side = |axis: usize| Shortest(to[axis] - from[axis]);
    let [x, y, z] = from.map(Shortest);
    write!(file, "Lattice=\"{} 0 0 0 {} 0 0 0 {}\" ", side(0), side(1), side(2))?;
    write!(file, "Origin=\"{x} {y} {z}\" pbc=\"F F F\" ")
}

fn write_set(file: &mut impl Write, set: &ParticleSet, columns: &[(&'static str, bool)]) -> io::Result<()> {
    let species = set.name.replace(' ', "_");
    let values: Vec<_> =
        columns.iter().map(|(name, _)| set.columns.iter().find(|c| c.name == *name).map(|c| &c.values)).collect();
    for i in 0..set.len() {
        let [x, y, z] = set.position[i].map(Shortest);
        write!(file, "{species} {x} {y} {z} {}", set.id[i])?;
        for value in set.velocity[i].iter().chain([&set.radius[i], &set.mass[i]]) {
            write!(file, " {}", Shortest(*value))?;
        }
        for (values, (_, is_vector)) in values.iter().zip(columns) {
            match values {
                Some(Values::Scalar(scalar)) => write!(file, " {}", Shortest(scalar[i]))?,
                Some(Values::Vector(vector)) => {
                    let [x, y, z] = vector[i].map(Shortest);
                    write!(file, " {x} {y} {z}")?;
                }
                None => write!(file, "{}", if *is_vector { " NaN NaN NaN" } else { " NaN" })?,
            }
        }
        writeln!(file)?;
    }
    Ok(())
}
