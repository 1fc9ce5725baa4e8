//! The file of a plan.

use super::Plan;
use super::sample::{MOST_SOBOL_KEYS, MOST_SOBOL_MEMBERS, combinations, latin_hypercube, sobol};
use crate::{Chosen, EnsembleError, Source};
use corpuscle::scene::{TOO_DEEP, builtin, read_text, too_deep};
use serde::Deserialize;
use serde_json::{Number, Value};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Most members of a plan.
const MOST_MEMBERS: usize = 1_000_000;

/// A plan as its file has it: the scene, what all members have, what changes, and which statistics are wanted.
#[derive(Debug)]
pub struct PlanFile {
    /// The scene, with the changes that all members have.
    pub source: Source,
    /// The table of what changes.
    pub plan: Plan,
    /// Which statistics are wanted.
    pub statistics: Chosen,
}

/// How values are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Sample {
    Grid,
    LatinHypercube,
    Sobol,
}

/// The file as written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    scene: String,
    sample: Option<Sample>,
    members: Option<usize>,
    #[serde(default = "one")]
    seed: u64,
    table: Option<PathBuf>,
    #[serde(default)]
    set: toml::Table,
    #[serde(default)]
    change: toml::Table,
    #[serde(default)]
    statistics: Chosen,
}

fn one() -> u64 {
    1
}

/// Values of a key to choose from.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Choice {
    List(Vec<Value>),
    Range(Range),
}

/// Values between two ends.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Range {
    pub from: f64,
    pub to: f64,
    /// True for values whose logarithm is uniform.
    #[serde(default)]
    pub log: bool,
    /// True for whole numbers, both ends among them.
    #[serde(default)]
    pub whole: bool,
}

impl PlanFile {
    /// Reads a plan. Relative paths in it start from its folder.
    ///
    /// # Errors
    /// [`EnsembleError::Plan`] with the line or the key, [`EnsembleError::File`] for a file that cannot be read,
    /// [`EnsembleError::Scene`] for a scene that is not as it must be.
    pub fn read(path: &Path) -> Result<Self, EnsembleError> {
        let text = read_text(path).map_err(|error| EnsembleError::plan(path, format!("cannot be read: {error}")))?;
        let wrong_at = |range: Option<std::ops::Range<usize>>, what: &str| {
            let line = range.map(|range| text[..range.start].matches('\n').count() + 1);
            EnsembleError::Plan { path: path.to_owned(), line, what: what.to_owned() }
        };
        if let Some(range) = too_deep(&text) {
            return Err(wrong_at(Some(range), TOO_DEEP));
        }
        let written: Written = toml::from_str(&text).map_err(|error| wrong_at(error.span(), error.message()))?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let plan = written.plan(path, folder)?;
        written.statistics.check().map_err(|what| EnsembleError::plan(path, what))?;
        let mut set = Vec::new();
        flatten("", &written.set, &mut |key, value| {
            set.push((key, value.to_string()));
            Ok(())
        })
        .map_err(|what| EnsembleError::plan(path, what))?;
        let name = match builtin(&written.scene) {
            Some(_) => written.scene,
            None => folder.join(&written.scene).to_string_lossy().into_owned(),
        };
        Ok(Self { source: Source::find(&name, set)?, plan, statistics: written.statistics })
    }
}

impl Written {
    fn plan(&self, path: &Path, folder: &Path) -> Result<Plan, EnsembleError> {
        let wrong = |what: String| EnsembleError::plan(path, what);
        match (&self.table, self.sample) {
            (Some(_), Some(_)) => Err(wrong("it has `sample` and `table`; give one of them".into())),
            (None, None) => Err(wrong(
                "it says neither `sample` (\"grid\", \"latin-hypercube\" or \"sobol\") nor `table` (a CSV file with a row for each member)".into(),
            )),
            (Some(_), None) if !self.change.is_empty() || self.members.is_some() => {
                Err(wrong("a plan with `table` has its changes and members there; leave `change` and `members` out".into()))
            }
            (Some(table), None) => {
                let table = folder.join(table);
                let text = read_text(&table).map_err(EnsembleError::file(&table))?;
                Plan::from_csv(&text, &table)
            }
            (None, Some(sample)) => self.sampled(sample).map_err(wrong),
        }
    }

    fn sampled(&self, sample: Sample) -> Result<Plan, String> {
        let mut choices = BTreeMap::new();
        flatten("", &self.change, &mut |key, value| {
            let choice = Choice::of(&key, value)?;
            choices.insert(key, choice);
            Ok(())
        })?;
        if choices.is_empty() {
            return Err(
                "nothing changes: give `change` at least one key, as flood.manning = { from = 0.02, to = 0.06 }".into(),
            );
        }
        let columns: Vec<String> = choices.keys().cloned().collect();
        let choices: Vec<Choice> = choices.into_values().collect();
        let rows = match sample {
            Sample::Grid => grid(&columns, choices, self.members)?,
            Sample::LatinHypercube => latin_hypercube(&choices, self.count(MOST_MEMBERS)?, self.seed),
            Sample::Sobol if choices.len() > MOST_SOBOL_KEYS => {
                return Err(format!(
                    "a Sobol sequence has at most {MOST_SOBOL_KEYS} keys, and `change` has {}",
                    choices.len()
                ));
            }
            Sample::Sobol => sobol(&choices, self.count(MOST_SOBOL_MEMBERS)?, self.seed),
        };
        Ok(Plan { columns, rows })
    }

    fn count(&self, most: usize) -> Result<usize, String> {
        match self.members {
            Some(count) if (1..=most).contains(&count) => Ok(count),
            Some(count) => Err(format!("members = {count}: must be from 1 to {most}")),
            None => Err("`members` is missing: how many to sample, as members = 32".into()),
        }
    }
}

fn grid(columns: &[String], choices: Vec<Choice>, members: Option<usize>) -> Result<Vec<Vec<Value>>, String> {
    if members.is_some() {
        return Err("a grid has as many members as there are combinations; leave `members` out".into());
    }
    let list = |(key, choice): (&String, Choice)| match choice {
        Choice::List(values) => Ok(values),
        Choice::Range(_) => Err(format!(
            "{key} of a grid is a list, as [0.02, 0.03]; for a range sample \"latin-hypercube\" or \"sobol\""
        )),
    };
    let lists: Vec<Vec<Value>> = columns.iter().zip(choices).map(list).collect::<Result<_, _>>()?;
    let count = lists
        .iter()
        .try_fold(1_usize, |count, list| count.checked_mul(list.len()).filter(|count| *count <= MOST_MEMBERS));
    match count {
        Some(_) => Ok(combinations(&lists)),
        None => Err(format!("the grid has more than {MOST_MEMBERS} combinations; give shorter lists")),
    }
}

impl Choice {
    fn of(key: &str, value: &toml::Value) -> Result<Self, String> {
        match value {
            toml::Value::Array(items) if items.is_empty() => Err(format!("the list of {key} is empty")),
            toml::Value::Array(items) => {
                items.iter().map(|item| plain(key, item)).collect::<Result<_, _>>().map(Self::List)
            }
            toml::Value::Table(table) => Range::of(key, table).map(Self::Range),
            _ => Err(format!(
                "{key} changes, so it needs a list, as [0.02, 0.03], or a range, as {{ from = 0.02, to = 0.06 }}; what all members have stands in `set`"
            )),
        }
    }
}

impl Range {
    fn of(key: &str, table: &toml::Table) -> Result<Self, String> {
        let range: Self =
            table.clone().try_into().map_err(|error: toml::de::Error| format!("{key}: {}", error.message()))?;
        let Self { from, to, log, whole } = range;
        if !(from.is_finite() && to.is_finite() && from < to) {
            return Err(format!("{key}: from = {from} must be below to = {to}, both finite"));
        }
        if log && (from <= 0.0 || whole) {
            return Err(format!("{key}: a logarithmic range begins above 0 and has no whole numbers"));
        }
        if whole && (from.fract() != 0.0 || to.fract() != 0.0 || from.abs().max(to.abs()) > 9e15) {
            return Err(format!("{key}: both ends of a range of whole numbers are whole numbers"));
        }
        Ok(range)
    }
}

/// Goes through the values of nested tables by their dotted keys; a table with an end of a range is a value.
fn flatten(
    before: &str,
    table: &toml::Table,
    take: &mut dyn FnMut(String, &toml::Value) -> Result<(), String>,
) -> Result<(), String> {
    table.iter().try_for_each(|(key, value)| {
        let key = if before.is_empty() { key.clone() } else { format!("{before}.{key}") };
        match value {
            toml::Value::Table(inner) if !inner.contains_key("from") && !inner.contains_key("to") => {
                flatten(&key, inner, take)
            }
            value => take(key, value),
        }
    })
}

/// A value in the types of JSON.
fn plain(key: &str, value: &toml::Value) -> Result<Value, String> {
    match value {
        toml::Value::String(text) => Ok(Value::from(text.as_str())),
        toml::Value::Integer(number) => Ok(Value::from(*number)),
        toml::Value::Boolean(yes) => Ok(Value::from(*yes)),
        toml::Value::Float(number) => match Number::from_f64(*number) {
            Some(number) => Ok(Value::Number(number)),
            None => Err(format!("{key}: {number} must be a finite number")),
        },
        toml::Value::Array(items) => items.iter().map(|item| plain(key, item)).collect(),
        toml::Value::Datetime(_) | toml::Value::Table(_) => {
            Err(format!("{key}: {value} cannot be a value; values are numbers, true or false, text, or lists of these"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;
    use std::fs;

    fn read(text: &str) -> Result<PlanFile, EnsembleError> {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("table.csv"), "flood.manning\n0.02\n0.04\n").unwrap();
        let path = folder.path().join("plan.toml");
        fs::write(&path, text).unwrap();
        PlanFile::read(&path)
    }

    #[test]
    fn plans_are_read_in_all_their_forms() {
        let grid = read(
            "scene = \"flood/valley\"\nsample = \"grid\"\n[set]\nflood.spacing_m = 12.0\n[change]\nflood.manning = [0.02, 0.03]\n\"seed\" = [1, 2, 3]\n",
        )
        .unwrap();
        assert_eq!(grid.plan.columns, ["flood.manning", "seed"]);
        assert_eq!(grid.plan.rows.len(), 6);
        assert_eq!(grid.plan.rows[5], [json!(0.03), json!(3)]);
        assert!(grid.source.toml().unwrap().contains("spacing_m = 12.0"));
        for sample in ["latin-hypercube", "sobol"] {
            let text = format!(
                "scene = \"flood/valley\"\nsample = \"{sample}\"\nmembers = 8\n[change.flood]\nmanning = {{ from = 0.02, to = 0.06 }}\n"
            );
            let sampled = read(&text).unwrap().plan;
            assert_eq!((sampled.rows.len(), sampled.columns[0].as_str()), (8, "flood.manning"));
        }
        let table = read("scene = \"flood/valley\"\ntable = \"table.csv\"\n").unwrap();
        assert_eq!(table.plan.rows, [[json!(0.02)], [json!(0.04)]]);
    }

    #[test]
    fn plans_that_are_wrong_say_where_and_what_to_do() {
        let cases = [
            ("scene = \"flood/valley\"\nsampel = \"grid\"\n", "plan.toml:2: unknown field `sampel`"),
            ("scene = \"flood/valley\"\n", "neither `sample`"),
            ("scene = \"flood/valley\"\nsample = \"grid\"\n", "nothing changes"),
            ("scene = \"flood/valley\"\nsample = \"grid\"\n[change]\nflood.manning = 0.02\n", "needs a list"),
            (
                "scene = \"flood/valley\"\nsample = \"grid\"\n[change]\nflood.manning = []\n",
                "list of flood.manning is empty",
            ),
            (
                "scene = \"flood/valley\"\nsample = \"grid\"\n[change]\nflood.manning = { from = 1, to = 2 }\n",
                "of a grid is a list",
            ),
            (
                "scene = \"flood/valley\"\nsample = \"sobol\"\n[change]\nflood.manning = { from = 1, to = 2 }\n",
                "`members` is missing",
            ),
            (
                "scene = \"flood/valley\"\nsample = \"sobol\"\nmembers = 0\n[change]\nflood.manning = { from = 1, to = 2 }\n",
                "members = 0",
            ),
            (
                "scene = \"flood/valley\"\nsample = \"sobol\"\nmembers = 4\n[change]\nflood.manning = { from = 2, to = 1 }\n",
                "must be below",
            ),
            (
                "scene = \"flood/valley\"\nsample = \"sobol\"\nmembers = 4\n[change]\nflood.manning = { from = 0, to = 1, log = true }\n",
                "logarithmic",
            ),
            (
                "scene = \"flood/valley\"\nsample = \"sobol\"\nmembers = 4\n[change]\nseed = { from = 0.5, to = 1, whole = true }\n",
                "whole numbers",
            ),
            (
                "scene = \"flood/valley\"\nsample = \"sobol\"\nmembers = 4\n[change]\nflood.manning = { from = nan, to = 1 }\n",
                "must be below",
            ),
            ("scene = \"flood/valley\"\ntable = \"none.csv\"\n", "none.csv"),
            ("scene = \"flood/valley\"\ntable = \"table.csv\"\nmembers = 3\n", "leave `change` and `members` out"),
            ("scene = \"flood/none\"\ntable = \"table.csv\"\n", "flood/none"),
            ("scene = \"flood/valley\"\ntable = \"table.csv\"\n[set]\nflood.maning = 1\n", "flood.maning"),
            ("scene = \"flood/valley\"\ntable = \"table.csv\"\n[statistics]\npercentiles = [101]\n", "from 0 to 100"),
        ];
        for (text, told) in cases {
            let error = read(text).unwrap_err();
            assert!(error.to_string().contains(told), "{text}: {error}");
        }
    }
}
