//! Selection of cases and benches by name.

use crate::refusal::refuse;

/// The items whose name is one of `wanted` or begins with one and a slash; all where none is wanted.
pub fn select<'a, T>(
    items: &'a [T],
    name: impl Fn(&T) -> &'static str,
    wanted: &[String],
) -> anyhow::Result<Vec<&'a T>> {
    let fits = |item: &T, word: &str| {
        let rest = name(item).strip_prefix(word.trim_end_matches('/'));
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
    };
    if let Some(unknown) = wanted.iter().find(|word| !items.iter().any(|item| fits(item, word))) {
        let names: Vec<_> = items.iter().map(&name).collect();
        return Err(refuse(format!("there is no `{unknown}`; there are: {}", names.join(", "))));
    }
    Ok(items.iter().filter(|item| wanted.is_empty() || wanted.iter().any(|word| fits(item, word))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pick(wanted: &[&str]) -> anyhow::Result<Vec<&'static str>> {
        let wanted: Vec<_> = wanted.iter().map(|word| word.to_string()).collect();
        let items = &["flood/stoker", "flood/stoker-wet", "gas/one"];
        Ok(select(items, |name| name, &wanted)?.into_iter().copied().collect())
    }

    #[test]
    fn by_name_by_beginning_or_all() {
        assert_eq!(pick(&[]).unwrap().len(), 3);
        assert_eq!(pick(&["flood"]).unwrap(), ["flood/stoker", "flood/stoker-wet"]);
        assert_eq!(pick(&["flood/stoker", "gas/"]).unwrap(), ["flood/stoker", "gas/one"]);
        let error = pick(&["flood", "flod"]).unwrap_err().to_string();
        assert!(error.contains("`flod`") && error.contains("gas/one"), "{error}");
    }
}
