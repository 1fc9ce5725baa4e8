//! From text to a scene.

use crate::document::Document;
use crate::model::ReadError;
use crate::written::{self, Unread};
use crate::{Problem, Scene, SceneError, units};
use std::path::Path;

impl Scene {
    /// Reads a scene file. Paths in it stay as written: [`Scene::resolve_paths`] makes them absolute.
    ///
    /// # Errors
    /// As [`Scene::parse`], or [`SceneError::Unreadable`].
    pub fn read(path: &Path, overrides: &[(String, String)]) -> Result<Self, SceneError> {
        let unreadable = |source| SceneError::Unreadable { path: path.to_owned(), source };
        let text = crate::read_text(path).map_err(unreadable)?;
        Self::parse(&text, &path.display().to_string(), overrides)
    }

    /// Reads a scene from TOML `text`, called `name` in messages, after setting each `(path, value)` of `overrides`
    /// in it: `("flood.inflow.0.discharge_m3_per_s", "30")`. Checks it as [`Scene::check`] does.
    ///
    /// # Errors
    /// [`SceneError::Invalid`] with the line and key of the first thing that is not as it must be.
    pub fn parse(text: &str, name: &str, overrides: &[(String, String)]) -> Result<Self, SceneError> {
        let mut document = Document::parse(text, name, overrides)?;
        let in_us = document.in_si_names()?;
        let read = Self::read_document(&document, in_us);
        Ok(read.map_err(|problem| if in_us { Box::new(units::in_us(*problem)) } else { problem })?)
    }

    fn read_document(document: &Document<'_>, in_us: bool) -> Result<Self, Box<Problem>> {
        let located = |mut problem: Box<Problem>| {
            problem.location = document.location_of(&problem.key).or_else(|| Some(document.whole()));
            problem
        };
        let mut scene = written::scene(document.root()).map_err(|unread| match unread {
            Unread::Read(ReadError::Type(error)) => explain(&error, document),
            Unread::Read(ReadError::Problem(problem)) => located(problem),
            Unread::Key(key, known) => located(Problem::new(&*key, unknown_word(&key, &known, true))),
        })?;
        scene.find_problem().and_then(|()| all_was_read(&scene, document)).map_err(located)?;
        scene.notes = document.notes().to_vec();
        if in_us {
            units::convert(&mut scene, &document.root())?;
        }
        Ok(scene)
    }
}

/// Refuses what the deserialiser passes over in silence: a third number where two are meant, a list for a table.
fn all_was_read(scene: &Scene, document: &Document<'_>) -> Result<(), Box<Problem>> {
    let values = toml::Value::try_from(scene).map_err(|error| Problem::new("", error.to_string()))?;
    match document.first_missing_in(&values) {
        Some(key) => {
            Err(Problem::new(key, ": this is not used as it is written here; take it out, or look up its form"))
        }
        None => Ok(()),
    }
}

/// A deserialising error in the user's words.
fn explain(error: &toml::de::Error, document: &Document<'_>) -> Box<Problem> {
    let message = error.message().trim_end();
    let span = error.span();
    let key = span.as_ref().map(|span| document.key_at(span)).unwrap_or_default();
    let location = span.as_ref().map(|span| document.location(span));
    if let Some(rest) = message.strip_prefix("missing field ") {
        let name = words_in_ticks(rest).next().unwrap_or_default();
        let key = span.as_ref().map(|span| document.table_at(span)).unwrap_or_default();
        let path = if key.is_empty() { name.to_owned() } else { format!("{key}.{name}") };
        let location = if key.is_empty() { Some(document.whole()) } else { location };
        return Box::new(Problem { what: format!(" is missing: {}", what_to_give(&path, name)), key: path, location });
    }
    let unknown = message.strip_prefix("unknown field ").or_else(|| message.strip_prefix("unknown variant "));
    let what = match unknown {
        Some(rest) => {
            let mut words = words_in_ticks(rest);
            let given = words.next().unwrap_or_default();
            unknown_word(given, &words.collect::<Vec<_>>(), message.starts_with("unknown field"))
        }
        None => wrong_type(message),
    };
    Box::new(Problem { key, what, location })
}

/// What to write for a key that is missing.
fn what_to_give(path: &str, name: &str) -> String {
    match path {
        "run" => "give a table [run] with until_s, the end of the run in seconds".into(),
        "run.until_s" => "give the end of the run in seconds, as in until_s = 600".into(),
        "gas.size" => "give the sides of the box, two or three numbers, as in size = [800.0, 600.0]".into(),
        "dew.size_m" => "give the sides of the box in metres, as in size_m = [0.2, 0.1, 0.2]".into(),
        "dew.spacing_m" => "give the distance between particles in metres, as in spacing_m = 0.005".into(),
        "dew.air" => "give the air, as in air = { temperature_c = 25.0, relative_humidity = 0.6 }".into(),
        _ if name == "name" => "give a name, unique in the scene, as in name = \"P1\"".into(),
        _ if name == "line" => "give the points of a line, as in line = [[0, 0], [100, 0]]".into(),
        _ if name == "discharge_m3_per_s" => {
            "give a number, rows of [time_s, value], or a file, as in { csv = \"hydrograph.csv\" }".into()
        }
        _ => format!("give {name} = ... there"),
    }
}

/// A sentence that says of a word that it is unknown, and offers the nearest of the known ones.
fn unknown_word(given: &str, known: &[&str], is_key: bool) -> String {
    let what =
        if is_key { " is not a key that is known here".to_owned() } else { format!(": `{given}` is not known here") };
    let nearest = known
        .iter()
        .map(|word| (strsim::jaro_winkler(given, word), *word))
        .filter(|(likeness, _)| *likeness > 0.7)
        .max_by(|a, b| a.0.total_cmp(&b.0));
    match nearest {
        Some((_, word)) => format!("{what}; did you mean `{word}`? (known: {})", known.join(", ")),
        None => format!("{what}; known: {}", known.join(", ")),
    }
}

fn words_in_ticks(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

/// "invalid type: string "a", expected f64" with the language's names of types replaced by words.
fn wrong_type(message: &str) -> String {
    let words = [
        ("invalid type: ", "this is the wrong kind of value: "),
        ("invalid value: ", "this value does not fit: "),
        ("invalid length ", "this has the wrong length, "),
        ("expected f64", "expected a number"),
        ("expected u64", "expected a whole number, 0 or more"),
        ("expected usize", "expected a whole number, 0 or more"),
        ("expected a boolean", "expected true or false"),
        ("expected a string", "expected text in quotes"),
        ("expected a map", "expected a table, as in { key = 1.0 }"),
        ("expected path string", "expected a file's path in quotes"),
        ("expected an array of length 2", "expected two numbers, as in [1.0, 2.0]"),
        ("expected an array of length 3", "expected three numbers, as in [1.0, 2.0, 3.0]"),
        ("expected a sequence", "expected a list in [ ]; for tables write their header in double brackets"),
        ("wanted exactly 1 element, found 0 elements", "expected exactly one kind, found none"),
        ("wanted exactly 1 element, more than 1 element", "expected exactly one kind, found more"),
        ("wanted string or table", "this is the wrong kind of value: expected a word in quotes or a table"),
        (
            "this is the wrong kind of value: unit variant, expected newtype variant",
            "this word needs a value of its own, as in { stage = 2.5 } or a table [terrain.plane]",
        ),
    ];
    words.iter().fold(format!(": {message}"), |text, (from, to)| text.replace(from, to))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_word_is_offered_and_a_far_one_is_not() {
        let near = unknown_word("spacng_m", &["scheme", "spacing_m"], true);
        assert!(near.contains("did you mean `spacing_m`?"), "{near}");
        let far = unknown_word("zzz", &["scheme", "spacing_m"], true);
        assert!(!far.contains("did you mean") && far.contains("scheme, spacing_m"), "{far}");
    }
}
