//! What earlier versions called otherwise, or had.
//!
//! Scheme `paper` of dew is `particle-condensation`, that of a flood is `sph-swe`, and its table `[flood.paper]` is `[flood.sph_swe]`; what is written out has the new names. Scheme `balanced` is
//! gone, and with it `[flood.refinement]`: both are refused. A note says what was read by an old name. Scenes that a run wrote out held `[flood.balanced]` and `flood.rain.film_m` in every
//! scheme; where another scheme is written these are ignored, as they had no effect there.

use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The table of scheme `sph-swe`, and what it was called.
const TABLE: [&str; 2] = ["sph_swe", "paper"];
/// The scheme, and what it was called.
const SCHEME: [&str; 2] = ["sph-swe", "paper"];
/// The scheme of dew as patented, and what it was called.
const DEW_SCHEME: [&str; 2] = ["particle-condensation", "paper"];

/// Scheme `balanced`, and its tables.
const GONE: &str = "balanced";
const GONE_TABLES: [&str; 2] = [GONE, "refinement"];

/// An old name in a document: where it is written, and a note to the user that says so.
pub(crate) type Renamed = (Range<usize>, String);

/// A note that `old` is called `new` now.
fn note(old: &str, new: &str) -> String {
    format!("{old} is an old name, which is still read: write {new}")
}

/// Gives the table and the schemes in a document their present names, and takes out what does nothing. Returns what had an old name.
///
/// # Errors
/// The path of a table that is there by both names, or of what is gone, and what to do.
pub(crate) fn rename(root: &mut Spanned<DeValue<'_>>) -> Result<Vec<Renamed>, (String, String)> {
    let mut renamed = Vec::new();
    let DeValue::Table(root) = root.get_mut() else { return Ok(renamed) };
    if let Some(dew) = table_of(root, "dew") {
        renamed.extend(rename_scheme(dew, "dew", DEW_SCHEME));
    }
    let Some(flood) = table_of(root, "flood") else { return Ok(renamed) };
    renamed.extend(rename_scheme(flood, "flood", SCHEME));
    take_out(flood)?;
    if flood.contains_key(TABLE[1]) && flood.contains_key(TABLE[0]) {
        let what = format!(": this is an old name of flood.{}, which is there too; take out one of them", TABLE[0]);
        return Err((format!("flood.{}", TABLE[1]), what));
    }
    if let Some((mut key, table)) = flood.remove_entry(TABLE[1]) {
        renamed.push((key.span(), note_of_table()));
        *key.get_mut() = TABLE[0].into();
        flood.insert(key, table);
    }
    Ok(renamed)
}

/// A model's table.
fn table_of<'a, 'b>(root: &'a mut DeTable<'b>, model: &str) -> Option<&'a mut DeTable<'b>> {
    match root.get_mut(model)?.get_mut() {
        DeValue::Table(table) => Some(table),
        _ => None,
    }
}

/// Gives a scheme in the table of a model its present name.
fn rename_scheme(table: &mut DeTable<'_>, model: &str, names: [&'static str; 2]) -> Option<Renamed> {
    let scheme = table.get_mut("scheme").filter(|scheme| scheme.get_ref().as_str() == Some(names[1]))?;
    let [new, old] = names.map(|name| format!("{model}.scheme = \"{name}\""));
    let renamed = (scheme.span(), note(&old, &new));
    *scheme.get_mut() = DeValue::String(names[0].into());
    Some(renamed)
}

fn note_of_table() -> String {
    let [new, old] = TABLE.map(|table| format!("flood.{table}"));
    note(&old, &new)
}

/// Refuses scheme balanced, and takes out what does nothing in other schemes.
fn take_out(flood: &mut DeTable<'_>) -> Result<(), (String, String)> {
    let scheme = flood.get("scheme").and_then(|scheme| scheme.get_ref().as_str());
    if scheme == Some(GONE) {
        let what = " = \"balanced\": this scheme is gone; take \"voronoi\", which is right on any ground, or leave the line out";
        return Err(("flood.scheme".into(), what.into()));
    }
    let is_written = scheme.is_some();
    for table in GONE_TABLES.into_iter().filter(|table| flood.contains_key(*table)) {
        if table != GONE || !is_written {
            let what = ": this is of scheme balanced, which is gone; take it out (finer cells of scheme voronoi are in [[flood.finer]] and \
                        [flood.adaptive])";
            return Err((format!("flood.{table}"), what.into()));
        }
    }
    flood.remove(GONE);
    if let Some(DeValue::Table(rain)) = flood.get_mut("rain").map(Spanned::get_mut) {
        rain.remove("film_m");
    }
    Ok(())
}

/// The words of a path, with the table's present name, and a note where it had the old one.
pub(crate) fn present(path: &str) -> (Vec<&str>, Option<String>) {
    let mut words: Vec<_> = path.split('.').collect();
    let is_old = words.starts_with(&["flood", TABLE[1]]);
    if is_old {
        words[1] = TABLE[0];
    }
    (words, is_old.then(note_of_table))
}
