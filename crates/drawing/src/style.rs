//! The look of all figures. One style sheet: on a page its colours follow light and dark, in a PNG they are fixed.

/// Rules for the classes that figures use. Colours are variables.
pub const FIGURE_CSS: &str = include_str!("figure.css");

/// Values of the style sheet's variables: name, in light, in dark. Series colours are Okabe and Ito's, which people with
/// any colour vision tell apart, lightened for dark pages.
const COLOURS: [(&str, &str, &str); 12] = [
    ("page", "#ffffff", "#12181f"),
    ("panel", "#f5f7f9", "#1a222b"),
    ("ink", "#17212b", "#e6ebf0"),
    ("muted", "#5a6875", "#9aa8b5"),
    ("line", "#d9dfe5", "#303b47"),
    ("accent", "#0b5fa5", "#6db5ee"),
    ("series-0", "#0072b2", "#4aa8e0"),
    ("series-1", "#d55e00", "#f08a3c"),
    ("series-2", "#009e73", "#34c79b"),
    ("series-3", "#b0558c", "#dc93bd"),
    ("series-4", "#8a6d00", "#e0be45"),
    ("series-5", "#4b4f9c", "#9da1ea"),
];

/// Which colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Theme {
    /// Dark on light: paper.
    Light,
    /// Light on dark.
    Dark,
}

impl Theme {
    /// The declarations of the colour variables, for a page's style sheet.
    pub fn variables(self) -> String {
        COLOURS.iter().map(|(name, light, dark)| format!("--{name}:{};", self.choose(light, dark))).collect()
    }

    /// A style sheet with its variables replaced, for readers that know none.
    pub fn resolve(self, css: &str) -> String {
        COLOURS.iter().fold(css.to_owned(), |css, (name, light, dark)| {
            css.replace(&format!("var(--{name})"), self.choose(light, dark))
        })
    }

    fn choose<'a>(self, light: &'a str, dark: &'a str) -> &'a str {
        match self {
            Self::Light => light,
            Self::Dark => dark,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_variable_of_the_figures_has_a_value() {
        assert!(FIGURE_CSS.contains("var(--ink)"));
        assert!(!Theme::Light.resolve(FIGURE_CSS).contains("var("));
        assert!(Theme::Dark.variables().contains("--ink:#e6ebf0;"));
    }
}
