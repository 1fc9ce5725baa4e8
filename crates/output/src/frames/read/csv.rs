//! Particles from rows: `set,id,x,y,z,vx,vy,vz,radius,mass`, then the model's own columns.

use super::columns::column;
use corpuscle_model::{Frame, ParticleSet, Values};

/// Columns that every table begins with.
const FIRST: [&str; 10] = ["set", "id", "x", "y", "z", "vx", "vy", "vz", "radius", "mass"];

/// Reads a table. Columns `flow_x,flow_y,flow_z` side by side become one of vectors.
pub(super) fn read(text: &str, time: f64) -> Result<Frame, String> {
    let mut reader = ::csv::Reader::from_reader(text.as_bytes());
    let header: Vec<String> = reader.headers().map_err(|error| error.to_string())?.iter().map(str::to_owned).collect();
    if header.len() < FIRST.len() || header[..FIRST.len()] != FIRST {
        return Err(format!("its first line does not begin with {}", FIRST.join(",")));
    }
    let mut sets: Vec<(ParticleSet, Vec<Vec<f64>>)> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| error.to_string())?;
        let line = record.position().map_or(0, ::csv::Position::line);
        if sets.last().is_none_or(|(set, _)| set.name != record[0]) {
            let set = ParticleSet { name: record[0].to_owned(), ..ParticleSet::default() };
            sets.push((set, vec![Vec::new(); header.len() - FIRST.len()]));
        }
        let Some((set, own)) = sets.last_mut() else { continue };
        let wrong = |cell: &str| format!("line {line}: `{cell}` is not a number");
        set.id.push(record[1].parse().map_err(|_| wrong(&record[1]))?);
        let number = |cell: &str| cell.parse::<f64>().map_err(|_| wrong(cell));
        let numbers = record.iter().skip(2).map(number).collect::<Result<Vec<f64>, String>>()?;
        set.position.push([numbers[0], numbers[1], numbers[2]]);
        set.velocity.push([numbers[3], numbers[4], numbers[5]]);
        set.radius.push(numbers[6]);
        set.mass.push(numbers[7]);
        own.iter_mut().zip(&numbers[8..]).for_each(|(column, value)| column.push(*value));
    }
    let is_only_set = sets.len() == 1;
    let names = &header[FIRST.len()..];
    let whole = |(mut set, own): (ParticleSet, Vec<Vec<f64>>)| {
        set.columns = named(names, own).filter_map(|(name, values)| column(name, values, is_only_set)).collect();
        set
    };
    Ok(Frame { time, sets: sets.into_iter().map(whole).collect() })
}

/// Scalars and vectors by name.
fn named(names: &[String], own: Vec<Vec<f64>>) -> impl Iterator<Item = (&str, Values)> {
    let mut at = 0;
    std::iter::from_fn(move || {
        let name = names.get(at)?;
        if let Some(stem) = vector_at(names, at) {
            let vectors = (0..own[at].len()).map(|row| [own[at][row], own[at + 1][row], own[at + 2][row]]).collect();
            at += 3;
            return Some((stem, Values::Vector(vectors)));
        }
        at += 1;
        Some((name.as_str(), Values::Scalar(own[at - 1].clone())))
    })
}

/// The name of the vector whose components begin at a column.
fn vector_at(names: &[String], at: usize) -> Option<&str> {
    let stem = names[at].strip_suffix("_x")?;
    let is = |index: usize, axis: &str| names.get(index).is_some_and(|name| *name == format!("{stem}_{axis}"));
    (is(at + 1, "y") && is(at + 2, "z")).then_some(stem)
}
