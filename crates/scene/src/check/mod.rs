//! What a scene must hold to beyond its types; what the keys of a model must, is in its own folder.

mod terrain;

use crate::series::check_rows;
use crate::{Problem, Run, Scene, SceneError, Series};
use toml::Value;

/// Nothing, or the first thing that is not as it must be.
pub type Checked = Result<(), Box<Problem>>;

/// The sides of a box by name, for each axis.
pub(crate) const SIDES: [[&str; 2]; 3] = [["x_min", "x_max"], ["y_min", "y_max"], ["z_min", "z_max"]];

impl Scene {
    /// Checks every value: finite, in range, names unique, exactly one kind given where one is meant.
    ///
    /// # Errors
    /// [`SceneError::Invalid`] with the key and value of the first thing that is not as it must be.
    pub fn check(&self) -> Result<(), SceneError> {
        Ok(self.find_problem()?)
    }

    pub(crate) fn find_problem(&self) -> Checked {
        if self.seed > i64::MAX as u64 {
            return Err(Problem::new("seed", format!(" = {}: must be at most {}", self.seed, i64::MAX)));
        }
        let values = Value::try_from(self).map_err(|error| Problem::new("", error.to_string()))?;
        let check = Check { values };
        check.all_finite()?;
        check.run(&self.run)?;
        self.model.check(&check)
    }
}

/// Whether a name is fit for headers of tables and for names of files: letters, digits, spaces, `_` and `-`.
pub fn is_name(name: &str) -> bool {
    let fits = |c: char| c.is_alphanumeric() || " _-".contains(c);
    !name.trim().is_empty() && name.chars().all(fits)
}

/// Whether two names make the same name of a file, in which spaces are `_`.
pub(crate) fn is_same_file(one: &str, other: &str) -> bool {
    one.replace(' ', "_") == other.replace(' ', "_")
}

/// Checks of a scene's values, which messages show by their keys, as in `"gas.species.0.count"`.
pub struct Check {
    values: Value,
}

impl Check {
    fn all_finite(&self) -> Checked {
        match find_not_finite(&self.values, "") {
            Some(key) => Err(self.problem(&key, "must be a finite number")),
            None => Ok(()),
        }
    }

    fn run(&self, run: &Run) -> Checked {
        self.above("run.until_s", run.until_s, 0.0)?;
        if let Some(period) = run.frame_every_s {
            self.above("run.frame_every_s", period, 0.0)?;
        }
        if let Some(period) = run.gauge_every_s {
            self.above("run.gauge_every_s", period, 0.0)?;
        }
        self.above("run.checkpoint_every_wall_s", run.checkpoint_every_wall_s, 0.0)?;
        self.count("run.frame_every_s", "frames", run.until_s / run.frame_period_s(), 1e6)?;
        self.count("run.gauge_every_s", "gauge rows", run.until_s / run.gauge_period_s(), 1e8)
    }

    pub(crate) fn count(&self, key: &str, of: &str, number: f64, most: f64) -> Checked {
        self.require(key, number < most, || format!("would make {number:.0} {of}; fewer than {most:.0} are possible"))
    }

    /// Refuses a value that is not larger than a bound.
    ///
    /// # Errors
    /// The key, its value and what must be.
    pub fn above(&self, key: &str, value: f64, bound: f64) -> Checked {
        self.require(key, value > bound, || format!("must be larger than {bound}"))
    }

    /// Refuses a value that is smaller than a bound.
    ///
    /// # Errors
    /// The key, its value and what must be.
    pub fn at_least(&self, key: &str, value: f64, bound: f64) -> Checked {
        self.require(key, value >= bound, || format!("must be at least {bound}"))
    }

    /// Refuses a value unless something holds; `otherwise` says what must be.
    ///
    /// # Errors
    /// The key, its value and what must be.
    pub fn require(&self, key: &str, holds: bool, otherwise: impl FnOnce() -> String) -> Checked {
        if holds { Ok(()) } else { Err(self.problem(key, &otherwise())) }
    }

    /// Refuses a name that is not fit for headers of tables.
    ///
    /// # Errors
    /// The key, its value and what must be.
    pub fn name(&self, key: &str, name: &str) -> Checked {
        self.require(key, is_name(name), || "a name must be of letters, digits, spaces, `_` and `-`".into())
    }

    /// Refuses values over time whose times do not rise.
    ///
    /// # Errors
    /// The key, its value and what must be.
    pub fn series(&self, key: &str, series: &Series) -> Checked {
        let Series::Table(rows) = series else { return Ok(()) };
        let at = |row: usize| if rows.is_empty() { key.to_owned() } else { format!("{key}.{row}") };
        check_rows(rows).map_err(|(row, what)| self.problem(&at(row), &what))
    }

    /// Refuses none and several where exactly one of the keys must be given.
    ///
    /// # Errors
    /// The key, its value and what must be.
    pub fn exactly_one(&self, key: &str, given: &[(&str, bool)]) -> Checked {
        let names: Vec<_> = given.iter().map(|(name, _)| *name).collect();
        let found: Vec<_> = given.iter().filter(|(_, given)| *given).map(|(name, _)| *name).collect();
        let names = names.join(", ");
        match found[..] {
            [_] => Ok(()),
            [] => Err(Problem::new(key, format!(": give exactly one of {names}; none is given"))),
            _ => Err(Problem::new(key, format!(": give exactly one of {names}, not {} together", found.join(" and ")))),
        }
    }

    /// The problem at `key`, with its value where that is short.
    pub(crate) fn problem(&self, key: &str, what: &str) -> Box<Problem> {
        let value = key.split('.').try_fold(&self.values, |value, word| match value {
            Value::Array(items) => items.get(word.parse::<usize>().ok()?),
            table => table.get(word),
        });
        let shown = value.map(ToString::to_string).filter(|text| text.len() <= 60 && !text.contains('\n'));
        Problem::new(key, format!("{}: {what}", shown.map(|text| format!(" = {text}")).unwrap_or_default()))
    }
}

/// The key of the first number that is infinite or not a number.
fn find_not_finite(value: &Value, key: &str) -> Option<String> {
    let inside = |word: &str, value| {
        let key = if key.is_empty() { word.to_owned() } else { format!("{key}.{word}") };
        find_not_finite(value, &key)
    };
    match value {
        Value::Float(number) if !number.is_finite() => Some(key.to_owned()),
        Value::Array(items) => items.iter().enumerate().find_map(|(index, item)| inside(&index.to_string(), item)),
        Value::Table(table) => table.iter().find_map(|(word, value)| inside(word, value)),
        _ => None,
    }
}
