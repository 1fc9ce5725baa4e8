//! Particles from extended XYZ, as [`crate::frames`] writes it.

use super::columns::column;
use crate::frames::xyz::FIRST;
use corpuscle_model::{Frame, ParticleSet, Values};

/// Reads a frame; its time stands in the file.
pub(super) fn read(text: &str) -> Result<Frame, String> {
    let mut lines = text.lines();
    let count = lines.next().and_then(|line| line.trim().parse::<usize>().ok());
    let count = count.ok_or("its first line is not the number of particles")?;
    let about = lines.next().ok_or("its second line is missing")?;
    let time = word_after(about, "Time=").and_then(|time| time.parse().ok()).ok_or("it has no Time")?;
    let properties = word_after(about, "Properties=").ok_or("it has no Properties")?;
    let own = own_columns(properties)?;
    let mut sets: Vec<(ParticleSet, Vec<Vec<f64>>)> = Vec::new();
    let width: usize = own.iter().map(|(_, width)| width).sum();
    let mut rows = 0;
    for (row, line) in lines.enumerate() {
        read_row(line, width, &mut sets).map_err(|what| format!("line {}: {what}", row + 3))?;
        rows += 1;
    }
    if rows != count {
        return Err(format!("it has {rows} particles where its first line says {count}"));
    }
    let is_only_set = sets.len() == 1;
    let whole = |(mut set, numbers): (ParticleSet, Vec<Vec<f64>>)| {
        set.columns = values(&own, &numbers).filter_map(|(name, values)| column(name, values, is_only_set)).collect();
        set
    };
    Ok(Frame { time, sets: sets.into_iter().map(whole).collect() })
}

/// The word that follows a key.
fn word_after<'a>(about: &'a str, key: &str) -> Option<&'a str> {
    about.split_whitespace().find_map(|word| word.strip_prefix(key))
}

/// Names and widths of the model's own columns.
fn own_columns(properties: &str) -> Result<Vec<(&str, usize)>, String> {
    let rest = properties.strip_prefix(FIRST).ok_or_else(|| format!("its Properties do not begin with {FIRST}"))?;
    let words: Vec<&str> = rest.split(':').skip(1).collect();
    let column = |of: &[&'_ str]| match of {
        [_, "R", "1"] => Ok(1),
        [_, "R", "3"] => Ok(3),
        _ => Err(format!("its Properties have a column `{}`", of.join(":"))),
    };
    words.chunks(3).map(|of| Ok((of[0], column(of)?))).collect()
}

/// Adds a row to the set of its species, the model's own numbers column by column.
fn read_row(line: &str, width: usize, sets: &mut Vec<(ParticleSet, Vec<Vec<f64>>)>) -> Result<(), String> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let [species, x, y, z, id, numbers @ ..] = &words[..] else { return Err("it is too short".into()) };
    if sets.last().is_none_or(|(set, _)| set.name != *species) {
        let set = ParticleSet { name: (*species).to_owned(), ..ParticleSet::default() };
        sets.push((set, vec![Vec::new(); width]));
    }
    let number = |word: &str| word.parse::<f64>().map_err(|_| format!("`{word}` is not a number"));
    let position = [number(x)?, number(y)?, number(z)?];
    let numbers = numbers.iter().map(|word| number(word)).collect::<Result<Vec<f64>, String>>()?;
    let [u, v, w, radius, mass, own @ ..] = &numbers[..] else { return Err("it is too short".into()) };
    if own.len() != width {
        return Err(format!("it has {} numbers of the model's own where there should be {width}", own.len()));
    }
    let Some((set, columns)) = sets.last_mut() else { return Ok(()) };
    set.id.push(id.parse().map_err(|_| format!("`{id}` is not the number of a particle"))?);
    set.position.push(position);
    set.velocity.push([*u, *v, *w]);
    set.radius.push(*radius);
    set.mass.push(*mass);
    columns.iter_mut().zip(own).for_each(|(column, value)| column.push(*value));
    Ok(())
}

/// Scalars and vectors by name.
fn values<'a>(own: &'a [(&'a str, usize)], numbers: &'a [Vec<f64>]) -> impl Iterator<Item = (&'a str, Values)> {
    let mut at = 0;
    own.iter().map(move |(name, width)| {
        let first = at;
        at += width;
        let values = match width {
            1 => Values::Scalar(numbers[first].clone()),
            _ => {
                let row = |row: usize| [0, 1, 2].map(|axis| numbers[first + axis][row]);
                Values::Vector((0..numbers[first].len()).map(row).collect())
            }
        };
        (*name, values)
    })
}
