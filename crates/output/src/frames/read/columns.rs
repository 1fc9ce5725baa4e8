//! Columns from the names and numbers of a file.

use corpuscle_model::{Column, Values};
use std::collections::BTreeSet;
use std::sync::Mutex;

/// A name with static lifetime, as columns have it. Files have few different ones; each is leaked once.
pub(super) fn lasting(name: &str) -> &'static str {
    static NAMES: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    let mut names = NAMES.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    if let Some(known) = names.get(name) {
        return known;
    }
    let kept: &'static str = Box::leak(name.to_owned().into_boxed_str());
    names.insert(kept);
    kept
}

/// A column of the rows of one set; none where another set has it and this one not, which files show as not-a-number throughout.
pub(super) fn column(name: &str, values: Values, is_only_set: bool) -> Option<Column> {
    let nothing = match &values {
        Values::Scalar(scalars) => scalars.iter().all(|value| value.is_nan()),
        Values::Vector(vectors) => vectors.as_flattened().iter().all(|value| value.is_nan()),
    };
    (is_only_set || !nothing).then(|| Column { name: lasting(name), unit: "", values })
}
