//! A scene as its file writes it: what all scenes have, side by side with the tables of one model.

use crate::model::{ReadError, SceneKind, Tables, kinds};
use crate::{Problem, Run, Scene};
use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

/// The keys that all scenes have.
const KEYS: [&str; 4] = ["title", "description", "seed", "run"];

/// What all scenes have.
#[derive(Deserialize)]
struct General {
    #[serde(default)]
    title: String,
    #[serde(default)]
    description: String,
    #[serde(default = "default_seed")]
    seed: u64,
    run: Run,
}

fn default_seed() -> u64 {
    1
}

/// Why a document is no scene.
pub(crate) enum Unread {
    /// As [`ReadError`].
    Read(ReadError),
    /// There is a key at the top that no scene has; and all that are known there.
    Key(String, Vec<&'static str>),
}

impl From<toml::de::Error> for Unread {
    fn from(error: toml::de::Error) -> Self {
        Self::Read(ReadError::Type(error))
    }
}

impl From<Box<Problem>> for Unread {
    fn from(problem: Box<Problem>) -> Self {
        Self::Read(ReadError::Problem(problem))
    }
}

/// The scene of a document.
pub(crate) fn scene(root: Spanned<DeValue<'_>>) -> Result<Scene, Unread> {
    let span = root.span();
    let DeValue::Table(root) = root.into_inner() else { return Err(Problem::new("", "a scene is a table").into()) };
    let kinds = kinds();
    let is_of_model = |key: &str| kinds.iter().any(|kind| kind.tables.contains(&key));
    let [mut general, mut of_model] = [DeTable::new(), DeTable::new()];
    for (key, value) in root {
        match &**key.get_ref() {
            name if KEYS.contains(&name) => general.insert(key, value),
            name if is_of_model(name) => of_model.insert(key, value),
            name => {
                let known = KEYS.into_iter().chain(kinds.iter().flat_map(|kind| kind.tables).copied());
                return Err(Unread::Key(name.to_owned(), known.collect()));
            }
        };
    }
    let general = Spanned::new(span, DeValue::Table(general));
    let General { title, description, seed, run } = General::deserialize(ValueDeserializer::from(general))?;
    let mut tables = Tables(of_model);
    let kind = kind_of(&kinds, &tables)?;
    let model = kind.read(&mut tables).map_err(Unread::Read)?;
    Ok(Scene { title, description, seed, run, model, notes: Vec::new() })
}

/// The model of a scene: the one that its tables are of.
fn kind_of<'a>(kinds: &'a [SceneKind], Tables(tables): &Tables<'_>) -> Result<&'a SceneKind, Box<Problem>> {
    let mut there: Vec<(usize, &SceneKind, &str)> = Vec::new();
    for (key, _) in tables {
        let is_its = |kind: &&SceneKind| kind.tables.contains(&&**key.get_ref());
        there.extend(kinds.iter().find(is_its).map(|kind| (key.span().start, kind, &**key.get_ref())));
    }
    there.sort_by_key(|(place, ..)| *place);
    let Some(&(_, kind, first)) = there.first() else {
        let names: Vec<_> = kinds.iter().map(|kind| format!("[{}]", kind.tables.join("] and ["))).collect();
        return Err(Problem::new(
            "",
            format!("the scene has no model: give the tables of one: {}", names.join(", or ")),
        ));
    };
    match there.iter().find(|(_, other, _)| other.name != kind.name) {
        Some((.., other)) => {
            Err(Problem::new(*other, format!(": a scene has one model; take out [{other}], or [{first}]")))
        }
        None => Ok(kind),
    }
}
