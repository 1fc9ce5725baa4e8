//! Links to scenes: the part of a page's address after `#`, as `gas/maxwell?gas.species.0.count=2000`.

use crate::{Source, Start};
use corpuscle::scene::builtin;
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, percent_decode_str, utf8_percent_encode};

/// What is written as it is, beside letters and digits.
const PLAIN: &AsciiSet =
    &NON_ALPHANUMERIC.remove(b'-').remove(b'_').remove(b'.').remove(b'/').remove(b',').remove(b':');

/// What a link opens; `#` before it may be there.
///
/// # Errors
/// A text that says what is wrong with it.
pub fn read(link: &str) -> Result<Start, String> {
    let link = link.trim_start_matches('#');
    if link.is_empty() {
        return Ok(Start::Welcome);
    }
    let (name, changes) = link.split_once('?').unwrap_or((link, ""));
    let name = decoded(name)?;
    let scene = builtin(&name).ok_or_else(|| format!("The link names a scene that is not there: {name}"))?;
    let change = |word: &str| {
        let (path, value) =
            word.split_once('=').ok_or_else(|| format!("The link has a change without a value: {word}"))?;
        Ok((decoded(path)?, decoded(value)?))
    };
    let changes: Result<_, String> = changes.split('&').filter(|word| !word.is_empty()).map(change).collect();
    Ok(Start::Scene(Source { changes: changes?, ..scene.into() }))
}

/// The link to a built-in scene with changes; none for another scene.
pub fn to(source: &Source, changes: &[(String, String)]) -> Option<String> {
    builtin(&source.name)?;
    let changes: Vec<_> = changes.iter().map(|(path, value)| format!("{}={}", encoded(path), encoded(value))).collect();
    let mark = if changes.is_empty() { "" } else { "?" };
    Some(format!("{}{mark}{}", source.name, changes.join("&")))
}

fn encoded(text: &str) -> String {
    utf8_percent_encode(text, PLAIN).to_string()
}

fn decoded(text: &str) -> Result<String, String> {
    let decoded = percent_decode_str(text).decode_utf8();
    decoded.map(Into::into).map_err(|_| format!("The link is not text: {text}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(link: &str) -> Source {
        let Start::Scene(source) = read(link).unwrap() else { panic!("{link}") };
        source
    }

    #[test]
    fn a_link_is_the_scene_with_its_changes() {
        let source = scene("#gas/maxwell?gas.species.0.count=2000&seed=7");
        assert_eq!(source.name, "gas/maxwell");
        assert_eq!(source.scene().unwrap().seed, 7);
        assert_eq!(to(&source, &source.changes).unwrap(), "gas/maxwell?gas.species.0.count=2000&seed=7");
    }

    #[test]
    fn any_change_comes_back() {
        let source = scene("flood/dam-break");
        let changes = vec![("flood.gauge.2".to_owned(), "{ name = \"a & b #1 = 50 %\", at = [1.0, -2.5] }".to_owned())];
        let link = to(&source, &changes).unwrap();
        assert!(link.is_ascii() && !link.contains(' ') && !link.contains('"'), "{link}");
        assert_eq!(scene(&link).changes, changes);
    }

    #[test]
    fn what_is_wrong_with_a_link_is_told() {
        assert!(matches!(read(""), Ok(Start::Welcome)));
        for (link, told) in [("#gas/none", "gas/none"), ("gas/maxwell?seed", "seed"), ("%FF?a=b", "%FF")] {
            assert!(read(link).unwrap_err().contains(told), "{link}");
        }
    }
}
