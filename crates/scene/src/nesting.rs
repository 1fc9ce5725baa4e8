//! How deep a text in TOML nests.

use std::ops::Range;
use toml_parser::Source;
use toml_parser::lexer::TokenKind;

/// Most brackets that are open at one place. The parser's own bound does not hold after an error (toml_parser 1.1.5): it calls itself for each
/// bracket, until the stack is full.
const DEEPEST: usize = 80;

/// The first bracket of a text in TOML within 80 others, as a range of bytes: such a text must not be parsed.
pub fn too_deep(text: &str) -> Option<Range<usize>> {
    let mut open = 0_usize;
    for token in Source::new(text).lex() {
        match token.kind() {
            TokenKind::LeftSquareBracket | TokenKind::LeftCurlyBracket => open += 1,
            TokenKind::RightSquareBracket | TokenKind::RightCurlyBracket => open = open.saturating_sub(1),
            _ => {}
        }
        if open > DEEPEST {
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
    }

    /// The stack overflowed, in `toml_parser`, at 9,700 tables that are not closed, each with an error in it.
    #[test]
    fn a_text_that_nests_too_deep_is_refused_with_its_place() {
        let text = "x = { inflow = { v5.0, y = 0.8, z = [3, 0.0] }\n[dew.faces]\n".repeat(20_000);
        let error = Scene::parse(&text, "deep.toml", &[]).unwrap_err().to_string();
        assert!(error.contains("deep.toml:159") && error.contains("one within the other"), "{error}");
        let change = ("seed".to_owned(), text);
        let error = Scene::parse("run.until_s = 1", "a.toml", &[change]).unwrap_err().to_string();
        assert!(error.contains("seed"), "{error}");
    }
}
