//! Floods in feet. Where `flood.units` is `"us"`, keys end in `_ft`, `_ft3_per_s`, `_in_per_h` and so on. They are read as if they
//! ended in `_m` and so on, checked as they are written, and then turned into metres.

use crate::{FloodScene, Problem, Scene};
use serde::Deserialize;
use toml::de::{DeTable, DeValue};
use toml::{Spanned, Value};

/// The international foot, m.
const FOOT: f64 = 0.3048;

/// Ends of keys in feet, the same in metres, and the one unit in the other. None is the end of one behind it.
const ENDS: [(&str, &str, f64); 5] = [
    ("_ft3_per_s", "_m3_per_s", FOOT * FOOT * FOOT),
    ("_ft_per_s2", "_m_per_s2", FOOT),
    ("_ft_per_s", "_m_per_s", FOOT),
    ("_in_per_h", "_mm_per_h", 25.4),
    ("_ft", "_m", FOOT),
];

/// Whether the scene in a document is in feet.
pub(crate) fn are_us(root: &Spanned<DeValue<'_>>) -> bool {
    let units = root.get_ref().get("flood").and_then(|flood| flood.get_ref().get("units"));
    units.and_then(|units| units.get_ref().as_str()) == Some("us")
}

/// Gives the keys below `[flood]` the names that they have in metres.
///
/// # Errors
/// The path of a key that is in metres, and what to write.
pub(crate) fn rename(root: &mut Spanned<DeValue<'_>>) -> Result<(), (String, String)> {
    let DeValue::Table(table) = root.get_mut() else { return Ok(()) };
    let flood = table.iter_mut().find(|(key, _)| key.get_ref() == "flood");
    flood.map_or(Ok(()), |(_, flood)| rename_below(flood, "flood"))
}

fn rename_below(node: &mut Spanned<DeValue<'_>>, path: &str) -> Result<(), (String, String)> {
    match node.get_mut() {
        DeValue::Table(table) => {
            let mut renamed = DeTable::new();
            for (mut key, mut value) in std::mem::replace(table, DeTable::new()) {
                let below = format!("{path}.{}", key.get_ref());
                if let Some(us) = us_name(key.get_ref()) {
                    return Err((below, format!(": with units = \"us\" give {us} instead")));
                }
                if let Some(si) = si_name(key.get_ref()) {
                    *key.get_mut() = si.into();
                }
                rename_below(&mut value, &below)?;
                renamed.insert(key, value);
            }
            *table = renamed;
            Ok(())
        }
        DeValue::Array(items) => {
            let mut rows = items.iter_mut().enumerate();
            rows.try_for_each(|(index, item)| rename_below(item, &format!("{path}.{index}")))
        }
        _ => Ok(()),
    }
}

fn si_name(key: &str) -> Option<String> {
    ENDS.iter().find_map(|(us, si, _)| key.strip_suffix(us).map(|stem| format!("{stem}{si}")))
}

/// The name that a key in metres below `[flood]` has in a scene in feet (`flood.units = "us"`); none where it has no such unit.
pub fn us_name(key: &str) -> Option<String> {
    ENDS.iter().find_map(|(us, si, _)| key.strip_suffix(si).map(|stem| format!("{stem}{us}")))
}

/// The problem with its keys as they are written in feet.
pub(crate) fn in_us(problem: Problem) -> Problem {
    if !problem.key.starts_with("flood") {
        return problem;
    }
    Problem { key: words_in_us(&problem.key), what: words_in_us(&problem.what), ..problem }
}

fn words_in_us(text: &str) -> String {
    let is_end = |c: char| !c.is_alphanumeric() && c != '_';
    let word = |part: &str| {
        let (word, end) = part.split_at(part.find(is_end).unwrap_or(part.len()));
        format!("{}{end}", us_name(word).unwrap_or_else(|| word.to_owned()))
    };
    text.split_inclusive(is_end).map(word).collect()
}

/// Turns what `given` writes of a flood in feet into metres. What is left out has its default in metres already.
pub(crate) fn convert(scene: &mut Scene, given: &Spanned<DeValue<'_>>) -> Result<(), Box<Problem>> {
    let (Some(FloodScene { flood, .. }), Some(given)) = (scene.model.get_mut(), given.get_ref().get("flood")) else {
        return Ok(());
    };
    let failed = |error: String| Problem::new("flood.units", error);
    let mut value = Value::try_from(&*flood).map_err(|error| failed(error.to_string()))?;
    convert_below(&mut value, given);
    if let Value::Table(table) = &mut value {
        table.insert("units".into(), "si".into());
    }
    *flood = crate::Flood::deserialize(value).map_err(|error| failed(error.to_string()))?;
    Ok(())
}

fn convert_below(value: &mut Value, given: &Spanned<DeValue<'_>>) {
    match (value, given.get_ref()) {
        (Value::Table(values), DeValue::Table(given)) => {
            for (key, given) in given {
                let key: &str = key.get_ref();
                match (values.get_mut(key), factors(key)) {
                    (Some(value), Some(factors)) if !is_rows_of_tables(value) => scale(value, factors),
                    (Some(value), _) => convert_below(value, given),
                    (None, _) => {}
                }
            }
        }
        (Value::Array(values), DeValue::Array(given)) => {
            values.iter_mut().zip(given.iter()).for_each(|(value, given)| convert_below(value, given));
        }
        _ => {}
    }
}

/// By what the numbers of a key are multiplied; in rows of two numbers, those of the first and of the second column.
fn factors(key: &str) -> Option<[f64; 2]> {
    match key {
        "stage" | "paddle" => Some([1.0, FOOT]),
        "discharge" => Some([1.0, FOOT * FOOT * FOOT]),
        "rating" => Some([FOOT, FOOT * FOOT * FOOT]),
        // m^(1/2)/s, and s/m.
        "coefficient" | "chezy" => Some([1.0, FOOT.sqrt()]),
        "linear" => Some([1.0, 1.0 / FOOT]),
        _ => ENDS.iter().find(|(_, si, _)| key.ends_with(si)).map(|(.., factor)| [1.0, *factor]),
    }
}

fn is_rows_of_tables(value: &Value) -> bool {
    value.as_array().is_some_and(|rows| rows.iter().any(Value::is_table))
}

fn scale(value: &mut Value, factors: [f64; 2]) {
    match value {
        Value::Float(number) => *number *= factors[1],
        Value::Array(items) if items.iter().all(Value::is_array) => {
            for row in items.iter_mut().filter_map(Value::as_array_mut) {
                row.iter_mut().zip(factors).for_each(|(number, factor)| scale(number, [factor; 2]));
            }
        }
        Value::Array(items) => items.iter_mut().for_each(|item| scale(item, factors)),
        // An expression; a path is not below a key with a unit, but for those of rasters, which are in metres.
        Value::String(expression) => *expression = format!("({expression}) * {:?}", factors[1]),
        Value::Table(rasters) if !rasters.contains_key("csv") => {}
        // A file of values over time.
        Value::Table(file) => {
            let before = file.get("factor").and_then(Value::as_float).unwrap_or(1.0);
            file.insert("factor".into(), (before * factors[1]).into());
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_go_both_ways() {
        for (us, si) in [("spacing_ft", "spacing_m"), ("rate_in_per_h", "rate_mm_per_h"), ("a_ft3_per_s", "a_m3_per_s")]
        {
            assert_eq!((us_name(si).as_deref(), si_name(us).as_deref()), (Some(us), Some(si)));
        }
        assert_eq!((us_name("manning"), si_name("until_s")), (None, None));
        assert_eq!(words_in_us("give one of level_m, depth_m: 1.0"), "give one of level_ft, depth_ft: 1.0");
    }
}
