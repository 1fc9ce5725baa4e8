//! The folder of an ensemble: its scene, its plan, and a folder for each member.

use crate::layout::{FORMAT, write_text};
use crate::{Chosen, EnsembleError, Plan, Record, Source};
use corpuscle_atomic_file::clear_unfinished;
use serde::{Deserialize, Serialize};
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

const ABOUT: &str = "ensemble.json";
const SCENE: &str = "scene.toml";
const PLAN: &str = "plan.csv";
const MEMBERS: &str = "members";
/// What may stand in a folder before it is an ensemble's: another task of a job array may make it at the same moment.
const OWN: [&str; 5] = [ABOUT, SCENE, PLAN, MEMBERS, "inputs"];

/// What `ensemble.json` has.
#[derive(Debug, Serialize, Deserialize)]
struct About {
    format: u32,
    name: String,
    statistics: Option<Chosen>,
}

/// An ensemble's folder.
///
/// It has `ensemble.json` (version of the layout, chosen statistics), `scene.toml`, `plan.csv`, and for each member that was run
/// `members/NNNNNN/` with `maps.npz`, `gauges.csv` and `member.json`.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    name: String,
    scene: String,
    plan: Plan,
}

impl Folder {
    /// The folder for a scene and a plan: a new one, or the one that has both already. The choice of statistics is stored.
    ///
    /// # Errors
    /// [`EnsembleError::Folder`] where it holds something else, [`EnsembleError::File`] where it cannot be written.
    pub fn prepare(path: &Path, source: &Source, plan: &Plan, statistics: &Chosen) -> Result<Self, EnsembleError> {
        if path.exists() && !path.is_dir() {
            return Err(EnsembleError::Folder(format!("{} is a file; name a folder", path.display())));
        }
        fs::create_dir_all(path).map_err(EnsembleError::file(path))?;
        let about = path.join(ABOUT);
        if !about.exists() {
            refuse_others(path)?;
        }
        clear_unfinished(path).map_err(EnsembleError::file(path))?;
        let name = if about.exists() { read_about(path)?.name } else { source.name.clone() };
        let scene = source.toml()?;
        let text = serde_json::to_string_pretty(&About {
            format: FORMAT,
            name: name.clone(),
            statistics: Some(statistics.clone()),
        });
        let text = text.map_err(|error| EnsembleError::damaged(&about, error))?;
        store(path, SCENE, &scene, "scene", |stored| scene_difference(stored, &scene))?;
        let plan_path = path.join(PLAN);
        store(path, PLAN, &plan.csv(), "plan", |stored| match Plan::from_csv(stored, &plan_path) {
            Ok(stored) => stored.difference(plan),
            Err(error) => Some(error.to_string()),
        })?;
        write_text(&about, &(text + "\n"))?;
        Ok(Self { path: path.to_owned(), name, scene, plan: plan.clone() })
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The scene's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The scene without the members' changes, as TOML.
    pub fn scene(&self) -> &str {
        &self.scene
    }

    /// The plan.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The folder of a member.
    pub(crate) fn member(&self, number: usize) -> PathBuf {
        self.path.join(MEMBERS).join(format!("{number:06}"))
    }

    /// The record of a member; none where it has not been run to an end.
    ///
    /// # Errors
    /// [`EnsembleError::Folder`] where it is damaged or that of another member.
    pub fn record(&self, number: usize) -> Result<Option<Record>, EnsembleError> {
        let folder = self.member(number);
        let Some(record) = Record::read(&folder)? else { return Ok(None) };
        let changes = self.plan.changes(number);
        let same = record.changes.len() == changes.len()
            && changes
                .iter()
                .all(|(key, value)| record.changes.get(key).is_some_and(|stored| same_value(stored, value)));
        if record.number != number || !same {
            return Err(EnsembleError::Folder(format!(
                "{} holds another member: its changes are not those of row {number} of the plan; remove it and run the plan again",
                folder.display()
            )));
        }
        Ok(Some(record))
    }
}

/// True for values that are equal as numbers, whether written 2 or 2.0.
fn same_value(a: &serde_json::Value, b: &serde_json::Value) -> bool {
    a == b || (a.is_number() && b.is_number() && a.as_f64() == b.as_f64())
}

fn refuse_others(path: &Path) -> Result<(), EnsembleError> {
    let entries = fs::read_dir(path).map_err(EnsembleError::file(path))?;
    let names = entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned());
    let mut others: Vec<_> = names.filter(|name| !OWN.contains(&name.as_str()) && !name.starts_with('.')).collect();
    others.sort();
    match others.first() {
        Some(first) => Err(EnsembleError::Folder(format!(
            "the folder {} is no ensemble's: it holds {first}{}; name another folder, or empty this one",
            path.display(),
            if others.len() > 1 { " and more" } else { "" }
        ))),
        None => Ok(()),
    }
}

fn read_about(path: &Path) -> Result<About, EnsembleError> {
    let file = path.join(ABOUT);
    let text = fs::read_to_string(&file).map_err(EnsembleError::file(&file))?;
    let about: About = serde_json::from_str(&text)
        .map_err(|error| EnsembleError::Folder(format!("{} is damaged: {error}", file.display())))?;
    match about.format {
        FORMAT => Ok(about),
        other => Err(EnsembleError::Folder(format!(
            "the ensemble in {} has the layout {other}, and this version of corpuscle knows {FORMAT}; name another folder",
            path.display()
        ))),
    }
}

/// Writes a text, or refuses where another is stored.
fn store(
    folder: &Path,
    name: &str,
    text: &str,
    what: &str,
    difference: impl FnOnce(&str) -> Option<String>,
) -> Result<(), EnsembleError> {
    let path = folder.join(name);
    match fs::read_to_string(&path) {
        Err(error) if error.kind() == ErrorKind::NotFound => write_text(&path, text),
        Err(error) => Err(EnsembleError::file(&path)(error)),
        Ok(stored) => match difference(&stored) {
            None => Ok(()),
            Some(how) => Err(EnsembleError::Folder(format!(
                "the folder {} holds an ensemble of another {what}: {how}; name another folder, or remove this one if its members are no longer needed",
                folder.display()
            ))),
        },
    }
}

fn scene_difference(stored: &str, given: &str) -> Option<String> {
    let mut lines = stored.lines().zip(given.lines()).enumerate();
    let differing = lines.find(|(_, (stored, given))| stored != given).map(|(number, (stored, given))| {
        format!(
            "line {} of {SCENE} is `{}` in the stored scene, `{}` in the given one",
            number + 1,
            stored.trim(),
            given.trim()
        )
    });
    let [stored, given] = [stored, given].map(|text| text.lines().count());
    let longer =
        || (stored != given).then(|| format!("the stored {SCENE} has {stored} lines, the given scene {given}"));
    differing.or_else(longer)
}
