//! How deep a text in TOML nests.

use std::ops::Range;
use toml_parser::Source;
use toml_parser::lexer::TokenKind;

/// Most lists and tables that are open at once. The parser's own bound does not hold after an error (toml_parser 1.1.5): it calls itself for each
/// bracket, until the stack is full.
pub(crate) const DEEPEST: usize = 80;

/// The first part of a text in TOML that is within 80 lists and tables, as a range of bytes: such a text must not be parsed. A key of several
/// words is a table for each.
pub fn too_deep(text: &str) -> Option<Range<usize>> {
    // What closes each list or table that is open, with the dots of its present key; and how deep all that is.
    let (mut open, mut depth) = (vec![(TokenKind::Eof, 0_usize)], 0_usize);
    for token in Source::new(text).lex() {
        let kind = token.kind();
        match kind {
            TokenKind::LeftSquareBracket => open.push((TokenKind::RightSquareBracket, 0)),
            TokenKind::LeftCurlyBracket => open.push((TokenKind::RightCurlyBracket, 0)),
            _ => {}
        }
        let (closes, dots) = open.last_mut()?;
        match kind {
            TokenKind::LeftSquareBracket | TokenKind::LeftCurlyBracket => depth += 1,
            // Another bracket than the one that is open closes nothing.
            TokenKind::RightSquareBracket | TokenKind::RightCurlyBracket if *closes == kind => {
                depth -= 1 + *dots;
                open.pop();
            }
            TokenKind::Dot => {
                *dots += 1;
                depth += 1;
            }
            TokenKind::Newline | TokenKind::Comma => depth -= std::mem::take(dots),
            _ => {}
        }
        if depth > DEEPEST {
            return Some(token.span().start()..token.span().end());
        }
    }
    None
}

/// What is wrong with a text that nests too deep.
pub const TOO_DEEP: &str =
    "more than 80 lists and tables are open here, one within the other; is a bracket not closed?";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;

    #[test]
    fn brackets_in_words_and_comments_do_not_count_and_closed_ones_neither() {
        let line = "a = [[1, 2], [3]] # [[[\nb = \"{{{\"\n[c.d]\n";
        assert_eq!(too_deep(&line.repeat(100)), None);
        assert_eq!(too_deep(&format!("a = {}1{}", "[".repeat(80), "]".repeat(80))), None);
        assert_eq!(too_deep(&format!("a = {}1", "[".repeat(81))), Some(84..85));
        assert_eq!(too_deep(&"a = [1.5, 2.5]\nb.c = { d.e = 1.5 }\n".repeat(100)), None);
        assert!(too_deep(&"a = [{}}] {{ ] ".repeat(100)).is_some());
        assert_eq!(too_deep(&format!("a = {{ {}b = 1 }}", "c.".repeat(80))), Some(165..166));
    }

    /// The stack overflowed, in `toml_parser`, at 9,700 tables that are not closed, each with an error in it.
    #[test]
    fn a_text_that_nests_too_deep_is_refused_with_its_location() {
        let text = "x = { inflow = { v5.0, y = 0.8, z = [3, 0.0] }\n[dew.faces]\n".repeat(20_000);
        let error = Scene::parse(&text, "deep.toml", &[]).unwrap_err().to_string();
        assert!(error.contains("deep.toml:155") && error.contains("one within the other"), "{error}");
        let path = (["a"; 200_000].join("."), "1".to_owned());
        let error = Scene::parse("run.until_s = 1", "a.toml", &[path]).unwrap_err().to_string();
        assert!(error.contains("at most 80 words"), "{}", &error[error.len() - 300..]);
        let change = ("seed".to_owned(), text);
        let error = Scene::parse("run.until_s = 1", "a.toml", &[change]).unwrap_err().to_string();
        assert!(error.contains("seed"), "{error}");
    }
}
