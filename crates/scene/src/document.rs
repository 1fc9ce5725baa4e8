//! The text of a scene as a tree with the position of each value.

use crate::error::{Location, Problem};
use crate::nesting::DEEPEST;
use crate::{TOO_DEEP, old_names, too_deep, units};
use std::borrow::Cow;
use std::ops::Range;
use toml::de::{DeArray, DeTable, DeValue};
use toml::{Spanned, Value};

/// A parsed TOML document with the overrides of the command line put in.
///
/// Places are byte ranges of the file's text, with the overrides' values counted on behind it, one byte apart.
pub(crate) struct Document<'a> {
    name: &'a str,
    text: &'a str,
    overrides: &'a [(String, String)],
    root: Spanned<DeValue<'a>>,
    /// What had an old name, in sentences that begin with its location.
    notes: Vec<String>,
}

impl<'a> Document<'a> {
    /// Parses `text`, then sets each `(path, value)` of `overrides` in it. Old names have become the present ones.
    pub fn parse(text: &'a str, name: &'a str, overrides: &'a [(String, String)]) -> Result<Self, Box<Problem>> {
        let root = Spanned::new(0..0, DeValue::Table(DeTable::new()));
        let mut document = Self { name, text, overrides, root, notes: Vec::new() };
        if let Some(span) = too_deep(text) {
            let what = format!("this is not TOML: {TOO_DEEP}");
            return Err(Box::new(Problem { key: String::new(), what, location: Some(document.location(&span)) }));
        }
        let table = DeTable::parse(text).map_err(|error| {
            let what = format!("this is not TOML: {}", error.message().trim_end());
            Box::new(Problem { key: String::new(), what, location: error.span().map(|span| document.location(&span)) })
        })?;
        document.root = Spanned::new(table.span(), DeValue::Table(table.into_inner()));
        document.rename_old()?;
        let mut offset = text.len() + 1;
        for (path, value) in overrides {
            let span = offset..offset + value.len();
            let (words, note) = old_names::present(path);
            document.notes.extend(note.map(|note| document.located(&span, &note)));
            set(&mut document.root, path, words, override_value(value, offset)).map_err(|what| {
                let location = Some(document.location(&span));
                Box::new(Problem { key: path.clone(), what, location })
            })?;
            offset += value.len() + 1;
        }
        document.rename_old()?;
        Ok(document)
    }

    fn rename_old(&mut self) -> Result<(), Box<Problem>> {
        let renamed = old_names::rename(&mut self.root).map_err(|(key, what)| {
            let location = self.location_of(&key);
            Box::new(Problem { key, what, location })
        })?;
        let notes: Vec<_> = renamed.iter().map(|(span, note)| self.located(span, note)).collect();
        self.notes.extend(notes);
        Ok(())
    }

    /// A note with its location before it.
    fn located(&self, span: &Range<usize>, note: &str) -> String {
        format!("{}: {note}", self.location(span).address())
    }

    /// What had an old name, in sentences.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The tree with the keys of a flood in feet called as they are in metres; whether it is one.
    pub fn in_si_names(&mut self) -> Result<bool, Box<Problem>> {
        if !units::are_us(&self.root) {
            return Ok(false);
        }
        let written = self.root.clone();
        units::rename(&mut self.root).map_err(|(key, what)| {
            self.root = written;
            let location = self.location_of(&key);
            Box::new(Problem { key, what, location })
        })?;
        Ok(true)
    }

    /// The tree, for deserialising.
    pub fn root(&self) -> Spanned<DeValue<'a>> {
        self.root.clone()
    }

    /// The file as a whole.
    pub fn whole(&self) -> Location {
        Location { source: self.name.to_owned(), line: None, column: 1, width: 0, text: String::new() }
    }

    /// Where the value of `key` is written, or the nearest table round it that is written.
    pub fn location_of(&self, key: &str) -> Option<Location> {
        let mut node = &self.root;
        for word in key.split('.') {
            match child(node, word) {
                Some(next) => node = next,
                None => break,
            }
        }
        let is_root = std::ptr::eq(node, &self.root);
        (!is_root).then(|| self.location(&node.span()))
    }

    /// The path of the first key or item that is written here but not in `values`.
    pub fn first_missing_in(&self, values: &Value) -> Option<String> {
        first_missing(&self.root, values, "")
    }

    /// The path of the innermost key or value written at `span`.
    pub fn key_at(&self, span: &Range<usize>) -> String {
        self.innermost(span, |_| true)
    }

    /// The path of the innermost table written at `span`: that of `--set flood.gauge.1.at=…`, which has the span of its only value, is
    /// `flood.gauge.1`.
    pub fn table_at(&self, span: &Range<usize>) -> String {
        self.innermost(span, |value| matches!(value, DeValue::Table(_)))
    }

    fn innermost(&self, span: &Range<usize>, is_meant: impl Fn(&DeValue<'_>) -> bool) -> String {
        let mut best = (usize::MAX, String::new());
        visit(&self.root, "", &mut |path, range, value| {
            let inside = range.start <= span.start && span.end <= range.end;
            if inside && range.len() <= best.0 && is_meant(value) {
                best = (range.len(), path.to_owned());
            }
        });
        best.1
    }

    /// The line of the file, or the argument, that holds `span`.
    pub fn location(&self, span: &Range<usize>) -> Location {
        if span.start <= self.text.len() { self.location_in_text(span) } else { self.location_in_overrides(span) }
    }

    fn location_in_text(&self, span: &Range<usize>) -> Location {
        let bytes = self.text.as_bytes();
        let start = span.start.min(bytes.len());
        let line_start = bytes[..start].iter().rposition(|&b| b == b'\n').map_or(0, |newline| newline + 1);
        let line_end = bytes[start..].iter().position(|&b| b == b'\n').map_or(bytes.len(), |length| start + length);
        let characters = |range: Range<usize>| String::from_utf8_lossy(&bytes[range]).chars().count();
        Location {
            source: self.name.to_owned(),
            line: Some(1 + bytes[..line_start].iter().filter(|&&b| b == b'\n').count()),
            column: 1 + characters(line_start..start),
            width: characters(start..span.end.clamp(start, line_end)),
            text: String::from_utf8_lossy(&bytes[line_start..line_end]).trim_end().to_owned(),
        }
    }

    fn location_in_overrides(&self, span: &Range<usize>) -> Location {
        let mut end = self.text.len() + 1;
        let at_fault = self.overrides.iter().find(|(_, value)| {
            end += value.len() + 1;
            span.start < end
        });
        let text = at_fault.map(|(path, value)| format!("{path}={value}")).unwrap_or_default();
        Location { source: format!("--set {text}"), line: None, column: 1, width: text.chars().count(), text }
    }
}

/// The value of an override: TOML where it is, else the words themselves, so that a name needs no quotes.
fn override_value(text: &str, offset: usize) -> Spanned<DeValue<'_>> {
    let words = || Spanned::new(offset..offset + text.len(), DeValue::String(Cow::Borrowed(text)));
    if too_deep(text).is_some() {
        return words();
    }
    DeValue::parse(text).map_or_else(|_| words(), |value| shifted(value, offset))
}

/// The same value with all its spans moved on by `offset` bytes.
fn shifted(value: Spanned<DeValue<'_>>, offset: usize) -> Spanned<DeValue<'_>> {
    let moved = |span: Range<usize>| span.start + offset..span.end + offset;
    let span = moved(value.span());
    let inner = match value.into_inner() {
        DeValue::Array(items) => DeValue::Array(items.into_iter().map(|item| shifted(item, offset)).collect()),
        DeValue::Table(entries) => DeValue::Table(
            entries
                .into_iter()
                .map(|(key, value)| (Spanned::new(moved(key.span()), key.into_inner()), shifted(value, offset)))
                .collect(),
        ),
        other => other,
    };
    Spanned::new(span, inner)
}

/// Puts `value` at `path`, whose present words are `words`, making tables and lists on the way, and a new row where the index is one past the last.
fn set<'a>(
    root: &mut Spanned<DeValue<'a>>,
    path: &str,
    words: Vec<&'a str>,
    value: Spanned<DeValue<'a>>,
) -> Result<(), String> {
    if path.split('.').any(str::is_empty) {
        return Err(": a path is words joined by dots, as in --set flood.inflow.0.discharge_m3_per_s=30".into());
    }
    if words.len() > DEEPEST {
        return Err(format!(": a path has at most {DEEPEST} words"));
    }
    let mut node = root;
    let mut words = words.into_iter().peekable();
    while let Some(word) = words.next() {
        let holder = match words.peek() {
            Some(&"0") => DeValue::Array(DeArray::new()),
            _ => DeValue::Table(DeTable::new()),
        };
        node = slot(node, word, Spanned::new(value.span(), holder))?;
    }
    *node = value;
    Ok(())
}

/// The value called `word` in `node`, put there as `new` where there is none.
fn slot<'n, 'a>(
    node: &'n mut Spanned<DeValue<'a>>,
    word: &'a str,
    new: Spanned<DeValue<'a>>,
) -> Result<&'n mut Spanned<DeValue<'a>>, String> {
    match node.get_mut() {
        DeValue::Table(table) => Ok(table.entry(Spanned::new(new.span(), Cow::Borrowed(word))).or_insert(new)),
        DeValue::Array(items) => {
            let count = items.len();
            let index = word.parse().ok().filter(|&index: &usize| index <= count).ok_or_else(|| {
                format!(": `{word}` must be the number of a row, 0 to {count} ({count} adds a row at the end)")
            })?;
            if index == count {
                items.push(new);
            }
            Ok(&mut items.as_mut()[index])
        }
        other => Err(format!(": there is no `{word}` in a {}", other.type_str())),
    }
}

fn child<'n, 'a>(node: &'n Spanned<DeValue<'a>>, word: &str) -> Option<&'n Spanned<DeValue<'a>>> {
    match node.get_ref() {
        DeValue::Table(table) => table.get(word),
        DeValue::Array(items) => items.as_ref().get(word.parse::<usize>().ok()?),
        _ => None,
    }
}

fn first_missing(node: &Spanned<DeValue<'_>>, value: &Value, path: &str) -> Option<String> {
    let below = |word: &str, inner, value: Option<&Value>| {
        let path = join(path, word);
        value.map_or(Some(path.clone()), |value| first_missing(inner, value, &path))
    };
    match (node.get_ref(), value) {
        (DeValue::Table(given), Value::Table(read)) => {
            given.iter().find_map(|(key, inner)| below(key.get_ref(), inner, read.get(key.get_ref().as_ref())))
        }
        (DeValue::Array(given), Value::Array(read)) => {
            given.iter().enumerate().find_map(|(index, inner)| below(&index.to_string(), inner, read.get(index)))
        }
        (DeValue::Table(_) | DeValue::Array(_), _) => Some(path.to_owned()),
        _ => None,
    }
}

/// Calls `see` with the path and span of every key and every value below `node`.
fn visit(node: &Spanned<DeValue<'_>>, path: &str, see: &mut impl FnMut(&str, Range<usize>, &DeValue<'_>)) {
    see(path, node.span(), node.get_ref());
    match node.get_ref() {
        DeValue::Table(table) => {
            for (key, value) in table {
                let path = join(path, key.get_ref());
                see(&path, key.span(), value.get_ref());
                visit(value, &path, see);
            }
        }
        DeValue::Array(items) => {
            for (index, item) in items.iter().enumerate() {
                visit(item, &join(path, &index.to_string()), see);
            }
        }
        _ => {}
    }
}

fn join(path: &str, word: &str) -> String {
    if path.is_empty() { word.to_owned() } else { format!("{path}.{word}") }
}
