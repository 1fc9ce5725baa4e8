//! The record of a member.

use crate::EnsembleError;
use crate::layout::{FORMAT, write_text};
use corpuscle::output::Summary;
use corpuscle::terrain::MapGrid;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::any::Any;
use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

const RECORD: &str = "member.json";
const FINISHED: &str = "finished";

/// The error that ended a member.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Failure {
    /// `SceneError` where the scene was refused, `RunError` where an accepted run failed, or the name of an exception.
    #[serde(rename = "type")]
    pub kind: String,
    /// What is wrong.
    pub message: String,
    /// The key of the scene that it is about.
    pub key: Option<String>,
    /// The line of the scene's text, counted from 1.
    pub line: Option<usize>,
    /// The part of the message that says what to do.
    pub remedy: Option<String>,
}

impl Failure {
    pub(crate) fn of(error: &corpuscle::Error) -> Self {
        let problem = match error {
            corpuscle::Error::Scene(error) => error.problem(),
            _ => None,
        };
        let message = error.to_string();
        let remedy =
            message.lines().next().and_then(|first| first.split_once("; ")).map(|(_, remedy)| remedy.to_owned());
        Self {
            kind: if error.is_refusal() { "SceneError" } else { "RunError" }.into(),
            key: problem.map(|problem| problem.key.clone()).filter(|key| !key.is_empty()),
            line: problem.and_then(|problem| problem.location.as_ref()).and_then(|location| location.line),
            message,
            remedy,
        }
    }

    pub(crate) fn of_panic(cause: &(dyn Any + Send)) -> Self {
        let text = cause.downcast_ref::<&str>().map(|text| (*text).to_owned());
        let text = text.or_else(|| cause.downcast_ref::<String>().cloned()).unwrap_or_else(|| "no message".into());
        let remedy = "please report it with the scene";
        let message = format!("the program failed by a mistake of its own: {text}; {remedy}");
        Self { kind: "RunError".into(), message, key: None, line: None, remedy: Some(remedy.into()) }
    }
}

/// What a map shows, and its unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Described {
    /// What it shows: `Maximum depth`.
    pub long_name: String,
    /// Its unit; 1 for a number.
    pub units: String,
}

/// The attributes of an axis of maps, in the convention CF.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// Name of the quantity in the convention.
    pub standard_name: String,
    /// The quantity in words.
    pub long_name: String,
    /// Its unit.
    pub units: String,
    /// `X` or `Y`.
    pub axis: String,
}

impl Axis {
    /// The two axes of a grid.
    pub(crate) fn both(grid: &MapGrid) -> BTreeMap<String, Self> {
        let system = grid.georeference.system.as_ref();
        let axis = |name: &str, [degrees, metres]: [[&str; 3]; 2]| {
            let unit = match system.map_or(1.0, |system| system.metres_per_unit) {
                1.0 => "m".to_owned(),
                metres => format!("{metres} m"),
            };
            let [standard_name, long_name, units] = match system {
                Some(system) if system.geographic => degrees.map(str::to_owned),
                _ => [metres[0].to_owned(), metres[1].to_owned(), unit],
            };
            (name.to_owned(), Self { standard_name, long_name, units, axis: name.to_uppercase() })
        };
        let x = [["longitude", "Longitude", "degrees_east"], ["projection_x_coordinate", "Easting", ""]];
        let y = [["latitude", "Latitude", "degrees_north"], ["projection_y_coordinate", "Northing", ""]];
        [axis("x", x), axis("y", y)].into()
    }
}

/// A member's record, which is written after its other files.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    format: u32,
    /// Its number, counted from 0.
    pub number: usize,
    status: String,
    /// What was changed in the scene.
    pub changes: Map<String, Value>,
    /// How often it was run.
    pub attempts: u32,
    /// The error that ended it.
    pub error: Option<Failure>,
    /// Wall-clock time of its last run, s.
    pub wall_time_s: Option<f64>,
    /// Time of the last row of gauges, s.
    pub last_time_s: Option<f64>,
    /// Version of Corpuscle.
    pub version: Option<String>,
    /// The summary of its run.
    pub summary: Option<Summary>,
    /// The last value of each gauge; null where there is none.
    pub final_gauges: Option<BTreeMap<String, Option<f64>>>,
    /// Its maps by name.
    pub maps: Option<BTreeMap<String, Described>>,
    /// The axes of its maps.
    pub coordinates: Option<BTreeMap<String, Axis>>,
    /// The maps' reference system.
    pub crs: Option<String>,
}

impl Record {
    /// The record of a member whose results are to be filled in.
    pub(crate) fn new(number: usize, changes: Map<String, Value>, attempts: u32) -> Self {
        Self {
            format: FORMAT,
            number,
            status: FINISHED.into(),
            changes,
            attempts,
            error: None,
            wall_time_s: None,
            last_time_s: None,
            version: Some(env!("CARGO_PKG_VERSION").into()),
            summary: None,
            final_gauges: None,
            maps: None,
            coordinates: None,
            crs: None,
        }
    }

    pub(crate) fn fail(&mut self, failure: Failure) {
        self.status = "failed".into();
        self.error = Some(failure);
    }

    /// True where the run came to its end and the files are complete.
    pub fn is_finished(&self) -> bool {
        self.status == FINISHED
    }

    /// The record in a member's folder; none where there is none.
    pub(crate) fn read(folder: &Path) -> Result<Option<Self>, EnsembleError> {
        let path = folder.join(RECORD);
        let text = match fs::read_to_string(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            text => text.map_err(EnsembleError::file(&path))?,
        };
        let record: Self = serde_json::from_str(&text).map_err(|error| EnsembleError::damaged(&path, error))?;
        if record.format != FORMAT {
            let what = format!("it has the layout {}, and this version of corpuscle knows {FORMAT}", record.format);
            return Err(EnsembleError::damaged(&path, what));
        }
        // Names of maps become names of files.
        if let Some(name) = record.maps.iter().flatten().map(|(name, _)| name).find(|name| !is_map_name(name)) {
            let what =
                format!("its map `{}` has a name that is not of letters, digits, `_` and `-`", name.escape_debug());
            return Err(EnsembleError::damaged(&path, what));
        }
        Ok(Some(record))
    }

    pub(crate) fn write(&self, folder: &Path) -> Result<(), EnsembleError> {
        let path = folder.join(RECORD);
        let text = serde_json::to_string_pretty(self).map_err(|error| EnsembleError::damaged(&path, error))?;
        write_text(&path, &(text + "\n"))
    }
}

/// True for a name that may be part of a file's name.
fn is_map_name(name: &str) -> bool {
    let fits = |letter: char| letter.is_ascii_alphanumeric() || "_-".contains(letter);
    !name.is_empty() && name.chars().all(fits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_with_names_that_lead_elsewhere_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let read = |name: &str| {
            let mut record = Record::new(0, Map::new(), 1);
            let map = Described { long_name: "Maximum depth".into(), units: "m".into() };
            record.maps = Some([(name.to_owned(), map)].into());
            record.write(folder.path()).unwrap();
            Record::read(folder.path()).map_err(|error| error.to_string())
        };
        assert!(read("max_depth-2").unwrap().is_some());
        for name in ["../../up", "/tmp/x", "a/b", "a\\b", "..", "", "C:x"] {
            let error = read(name).unwrap_err();
            let shown = format!("its map `{}` has a name", name.escape_debug());
            assert!(error.contains("member.json cannot be used") && error.contains(&shown), "{error}");
        }
    }
}
