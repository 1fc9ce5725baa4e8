//! Names of earlier versions that are still read: scheme `paper` of a flood is `sph-swe`, and its table `[flood.paper]` is
//! `[flood.sph_swe]`. What is written out has the new names.

use toml::Spanned;
use toml::de::DeValue;

/// The table of scheme `sph-swe`, and what it was called.
const TABLE: [&str; 2] = ["sph_swe", "paper"];
/// The scheme, and what it was called.
const SCHEME: [&str; 2] = ["sph-swe", "paper"];

/// Gives the table and the scheme in a document their present names.
///
/// # Errors
/// The path of a table that is there by both names, and what to do.
pub(crate) fn rename(root: &mut Spanned<DeValue<'_>>) -> Result<(), (String, String)> {
    let DeValue::Table(root) = root.get_mut() else { return Ok(()) };
    let Some((_, flood)) = root.iter_mut().find(|(key, _)| key.get_ref() == "flood") else { return Ok(()) };
    let DeValue::Table(flood) = flood.get_mut() else { return Ok(()) };
    if let Some(DeValue::String(name)) = flood.get_mut("scheme").map(Spanned::get_mut)
        && *name == SCHEME[1]
    {
        *name = SCHEME[0].into();
    }
    if flood.contains_key(TABLE[1]) && flood.contains_key(TABLE[0]) {
        let what = format!(": this is an old name of flood.{}, which is there too; take out one of them", TABLE[0]);
        return Err((format!("flood.{}", TABLE[1]), what));
    }
    if let Some((mut key, table)) = flood.remove_entry(TABLE[1]) {
        *key.get_mut() = TABLE[0].into();
        flood.insert(key, table);
    }
    Ok(())
}

/// The words of a path, with the table's present name.
pub(crate) fn present(path: &str) -> Vec<&str> {
    let mut words: Vec<_> = path.split('.').collect();
    if words.starts_with(&["flood", TABLE[1]]) {
        words[1] = TABLE[0];
    }
    words
}
