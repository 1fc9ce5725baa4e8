//! Links to scenes: the part of a page's address after `#`, as `gas/maxwell?gas.species.0.count=2000`.

use crate::builtin;
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, percent_decode_str, utf8_percent_encode};

/// What is written as it is, beside letters and digits.
const PLAIN: &AsciiSet =
    &NON_ALPHANUMERIC.remove(b'-').remove(b'_').remove(b'.').remove(b'/').remove(b',').remove(b':');

/// A link to a built-in scene with changes of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SceneLink {
    /// Name of the scene.
    pub name: String,
    /// Keys and the values that they get, as `--set` takes them.
    pub changes: Vec<(String, String)>,
}

impl SceneLink {
    /// Reads a link; `#` before it may be there. None for an empty one.
    ///
    /// # Errors
    /// A text that says what is wrong with it.
    pub fn read(link: &str) -> Result<Option<Self>, String> {
        let link = link.trim_start_matches('#');
        if link.is_empty() {
            return Ok(None);
        }
        let (name, changes) = link.split_once('?').unwrap_or((link, ""));
        let name = decoded(name)?;
        if builtin(&name).is_none() {
            return Err(format!("The link names a scene that is not there: {name}"));
        }
        let change = |word: &str| {
            let (path, value) =
                word.split_once('=').ok_or_else(|| format!("The link has a change without a value: {word}"))?;
            Ok((decoded(path)?, decoded(value)?))
        };
        let changes: Result<_, String> = changes.split('&').filter(|word| !word.is_empty()).map(change).collect();
        Ok(Some(Self { name, changes: changes? }))
    }

    /// The link as text; none where the scene is no built-in one.
    pub fn write(name: &str, changes: &[(String, String)]) -> Option<String> {
        builtin(name)?;
        let changes: Vec<_> =
            changes.iter().map(|(path, value)| format!("{}={}", encoded(path), encoded(value))).collect();
        let mark = if changes.is_empty() { "" } else { "?" };
        Some(format!("{name}{mark}{}", changes.join("&")))
    }
}

fn encoded(text: &str) -> String {
    utf8_percent_encode(text, PLAIN).to_string()
}

fn decoded(text: &str) -> Result<String, String> {
    let decoded = percent_decode_str(text).decode_utf8();
    decoded.map(Into::into).map_err(|_| format!("The link is not text: {text}"))
}
