//! Expressions of the position: `2 + 0.1 * exp(-((x - 50)^2 + (y - 50)^2) / 200)`.
//!
//! Reading and computing are our own, so that an error names its character and what to write, and -x^2 is -(x^2) as in mathematics.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Longer texts are refused.
const MOST_CHARACTERS: usize = 2000;

/// Deeper nesting is refused: reading it would use up the stack.
const MOST_DEPTH: usize = 100;

/// An expression of a position x, y in the terrain's own coordinates.
///
/// Numbers, `x`, `y`, `pi`, `e`; `+ - * / ^` with the precedence of mathematics (`-x^2` is -(x²), `2^3^2` is 2⁹); comparisons `< <= > >=`,
/// 1 where they hold and 0 elsewhere; and the functions of [`Expression::FUNCTIONS`].
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Expression {
    text: String,
    root: Node,
}

/// What is wrong with an expression.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("the expression `{text}` cannot be read at character {at}: {what}")]
pub struct ExpressionError {
    /// The expression.
    pub text: String,
    /// Where it cannot be read, in characters from 1.
    pub at: usize,
    /// What is wrong there, and what to write.
    pub what: String,
}

#[derive(Debug, Clone)]
enum Node {
    Number(f64),
    X,
    Y,
    Negative(Box<Node>),
    Binary(Operator, Box<[Node; 2]>),
    One(One, Box<Node>),
    Two(Two, Box<[Node; 2]>),
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Operator {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Less,
    AtMost,
    Greater,
    AtLeast,
}

/// A function of one number, and of two.
type One = fn(f64) -> f64;
type Two = fn(f64, f64) -> f64;

/// Functions of one number.
const ONE: [(&str, One); 15] = [
    ("sin", f64::sin),
    ("cos", f64::cos),
    ("tan", f64::tan),
    ("asin", f64::asin),
    ("acos", f64::acos),
    ("atan", f64::atan),
    ("sinh", f64::sinh),
    ("cosh", f64::cosh),
    ("tanh", f64::tanh),
    ("exp", f64::exp),
    ("ln", f64::ln),
    ("log10", f64::log10),
    ("sqrt", f64::sqrt),
    ("abs", f64::abs),
    ("floor", f64::floor),
];

/// Functions of two numbers.
const TWO: [(&str, Two); 4] = [("min", f64::min), ("max", f64::max), ("atan2", f64::atan2), ("hypot", f64::hypot)];

/// Operators, the longer of two that begin alike first; how strongly each binds, and whether it groups from the right.
const OPERATORS: [(&str, Operator, u8, bool); 9] = [
    ("<=", Operator::AtMost, 1, false),
    (">=", Operator::AtLeast, 1, false),
    ("<", Operator::Less, 1, false),
    (">", Operator::Greater, 1, false),
    ("+", Operator::Add, 2, false),
    ("-", Operator::Subtract, 2, false),
    ("*", Operator::Multiply, 3, false),
    ("/", Operator::Divide, 3, false),
    ("^", Operator::Power, 5, true),
];

/// How strongly a sign binds: more than a product, less than a power.
const SIGN: u8 = 4;

impl Expression {
    /// The functions that may be called, for messages.
    pub const FUNCTIONS: &str =
        "sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, exp, ln, log10, sqrt, abs, floor, min, max, atan2, hypot";

    /// Reads an expression.
    ///
    /// # Errors
    /// [`ExpressionError`] with the first character that cannot be read.
    pub fn parse(text: &str) -> Result<Self, ExpressionError> {
        let mut reader = Reader { characters: text.chars().collect(), at: 0 };
        let read = reader.whole();
        let error = |what| ExpressionError { text: text.chars().take(200).collect(), at: reader.at + 1, what };
        Ok(Self { root: read.map_err(error)?, text: text.to_owned() })
    }

    /// The value at a position. It may be not-a-number or infinite, as `sqrt(-1)` and `1 / 0` are.
    pub fn at(&self, x: f64, y: f64) -> f64 {
        self.root.at(x, y)
    }

    /// The text that it was read from.
    pub fn text(&self) -> &str {
        &self.text
    }
}

impl Node {
    fn at(&self, x: f64, y: f64) -> f64 {
        match self {
            Self::Number(number) => *number,
            Self::X => x,
            Self::Y => y,
            Self::Negative(node) => -node.at(x, y),
            Self::Binary(operator, nodes) => operator.apply(nodes[0].at(x, y), nodes[1].at(x, y)),
            Self::One(function, node) => function(node.at(x, y)),
            Self::Two(function, nodes) => function(nodes[0].at(x, y), nodes[1].at(x, y)),
        }
    }
}

impl Operator {
    fn apply(self, a: f64, b: f64) -> f64 {
        let holds = |condition: bool| f64::from(u8::from(condition));
        match self {
            Self::Add => a + b,
            Self::Subtract => a - b,
            Self::Multiply => a * b,
            Self::Divide => a / b,
            Self::Power => a.powf(b),
            Self::Less => holds(a < b),
            Self::AtMost => holds(a <= b),
            Self::Greater => holds(a > b),
            Self::AtLeast => holds(a >= b),
        }
    }
}

/// Reads by precedence climbing (Pratt 1973).
struct Reader {
    characters: Vec<char>,
    at: usize,
}

impl Reader {
    fn whole(&mut self) -> Result<Node, String> {
        if self.characters.len() > MOST_CHARACTERS {
            return Err(format!("it has more than {MOST_CHARACTERS} characters; give a raster instead"));
        }
        let node = self.operation(0, 0)?;
        match self.peek() {
            None => Ok(node),
            Some(')') => Err("this `)` closes nothing".into()),
            Some(other) => Err(format!("an operator (+ - * / ^ < <= > >=) is missing before `{other}`")),
        }
    }

    /// Operations that bind more strongly than `least`.
    fn operation(&mut self, least: u8, depth: usize) -> Result<Node, String> {
        if depth > MOST_DEPTH {
            return Err(format!("it is nested more than {MOST_DEPTH} deep"));
        }
        let mut node = self.operand(depth)?;
        while let Some((operator, length, strength, from_right)) = self.operator().filter(|found| found.2 > least) {
            self.at += length;
            let right = self.operation(if from_right { strength - 1 } else { strength }, depth + 1)?;
            node = Node::Binary(operator, Box::new([node, right]));
        }
        Ok(node)
    }

    fn operator(&mut self) -> Option<(Operator, usize, u8, bool)> {
        self.peek()?;
        let rest = &self.characters[self.at..];
        let found = OPERATORS.iter().find(|(sign, ..)| sign.chars().eq(rest.iter().copied().take(sign.len())));
        found.map(|(sign, operator, strength, from_right)| (*operator, sign.len(), *strength, *from_right))
    }

    fn operand(&mut self, depth: usize) -> Result<Node, String> {
        match self.peek() {
            None => Err("it ends here where a number, x, y or a function is expected".into()),
            Some('-') => {
                self.at += 1;
                Ok(Node::Negative(Box::new(self.operation(SIGN, depth + 1)?)))
            }
            Some('+') => {
                self.at += 1;
                self.operation(SIGN, depth + 1)
            }
            Some('(') => {
                self.at += 1;
                let node = self.operation(0, depth + 1)?;
                self.expect(')')?;
                Ok(node)
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() => self.word(depth),
            Some(other) => Err(format!("`{other}` stands where a number, x, y or a function is expected")),
        }
    }

    fn number(&mut self) -> Result<Node, String> {
        let is_part = |k: usize| {
            let c = self.characters.get(k).copied()?;
            let after_e = k > self.at && matches!(self.characters[k - 1], 'e' | 'E');
            let is_exponent = matches!(c, 'e' | 'E')
                && self.characters.get(k + 1).is_some_and(|next| next.is_ascii_digit() || "+-".contains(*next));
            (c.is_ascii_digit() || c == '.' || is_exponent || (after_e && "+-".contains(c))).then_some(c)
        };
        let text: String = (self.at..).map_while(is_part).collect();
        let number = text.parse().ok().filter(|number: &f64| number.is_finite());
        let number = number.ok_or_else(|| format!("`{text}` is no number"))?;
        self.at += text.len();
        Ok(Node::Number(number))
    }

    fn word(&mut self, depth: usize) -> Result<Node, String> {
        let is_part = |c: &&char| c.is_alphanumeric() || **c == '_';
        let word: String = self.characters[self.at..].iter().take_while(is_part).collect();
        let one = ONE.iter().find(|(name, _)| *name == word);
        let two = TWO.iter().find(|(name, _)| *name == word);
        let node = match word.as_str() {
            "x" => Node::X,
            "y" => Node::Y,
            "pi" => Node::Number(std::f64::consts::PI),
            "e" => Node::Number(std::f64::consts::E),
            _ if one.is_none() && two.is_none() => {
                return Err(format!("`{word}` is not known here; known: x, y, pi, e, {}", Self::functions()));
            }
            _ => {
                self.at += word.chars().count();
                return self.call(one.map(|one| one.1), two.map(|two| two.1), depth);
            }
        };
        self.at += word.chars().count();
        Ok(node)
    }

    fn functions() -> &'static str {
        Expression::FUNCTIONS
    }

    fn call(&mut self, one: Option<One>, two: Option<Two>, depth: usize) -> Result<Node, String> {
        self.expect('(')?;
        let first = self.operation(0, depth + 1)?;
        let node = match (one, two) {
            (Some(function), _) => Node::One(function, Box::new(first)),
            (None, Some(function)) => {
                self.expect(',')?;
                Node::Two(function, Box::new([first, self.operation(0, depth + 1)?]))
            }
            (None, None) => first,
        };
        self.expect(')')?;
        Ok(node)
    }

    /// The next character after any spaces.
    fn peek(&mut self) -> Option<char> {
        while self.characters.get(self.at).is_some_and(|c| c.is_whitespace()) {
            self.at += 1;
        }
        self.characters.get(self.at).copied()
    }

    fn expect(&mut self, wanted: char) -> Result<(), String> {
        match self.peek() {
            Some(found) if found == wanted => {
                self.at += 1;
                Ok(())
            }
            Some(found) => Err(format!("`{wanted}` is expected, not `{found}`")),
            None => Err(format!("`{wanted}` is missing at its end")),
        }
    }
}

impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl TryFrom<String> for Expression {
    type Error = ExpressionError;

    fn try_from(text: String) -> Result<Self, ExpressionError> {
        Self::parse(&text)
    }
}

impl From<Expression> for String {
    fn from(expression: Expression) -> Self {
        expression.text
    }
}

impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn at(text: &str, x: f64, y: f64) -> f64 {
        Expression::parse(text).unwrap().at(x, y)
    }

    #[test]
    fn precedence_is_that_of_mathematics() {
        for (text, value) in [
            ("-x^2", -9.0),
            ("2^3^2", 512.0),
            ("2^-1", 0.5),
            ("8 - 3 - 2", 3.0),
            ("8 / 2 / 2", 2.0),
            ("1 + 2 * x", 7.0),
            ("(1 + 2) * x", 9.0),
            ("-2 * -x", 6.0),
            ("1.5e2 + 2E-1", 150.2),
            ("2*e", 2.0 * std::f64::consts::E),
            ("x > 2", 1.0),
            ("x + 1 <= y", 1.0),
            ("(x < 1) * 5", 0.0),
            ("max(x, min(y, 2))", 3.0),
            ("sqrt(x^2 + y^2) - hypot(x, y)", 0.0),
            ("cos(pi)", -1.0),
            ("  +x  ", 3.0),
        ] {
            assert_eq!(at(text, 3.0, 4.0), value, "{text}");
        }
    }

    #[test]
    fn errors_tell_the_position_and_what_to_write() {
        for (text, position, what) in [
            ("", 1, "ends here"),
            ("2 +", 4, "ends here"),
            ("2 x", 3, "an operator"),
            ("2 * z", 5, "`z` is not known here; known: x, y"),
            ("sin x", 5, "`(` is expected, not `x`"),
            ("max(1)", 6, "`,` is expected"),
            ("(1 + 2", 7, "`)` is missing"),
            ("1)", 2, "closes nothing"),
            ("1.2.3", 1, "is no number"),
            ("1e999", 1, "is no number"),
            ("3 # 4", 3, "an operator"),
            ("* 4", 1, "`*` stands where"),
        ] {
            let error = Expression::parse(text).unwrap_err();
            assert!(error.at == position && error.what.contains(what), "{text}: {error}");
        }
        assert!(Expression::parse(&"(".repeat(1900)).unwrap_err().what.contains("nested"));
        assert!(Expression::parse(&"-".repeat(1900)).unwrap_err().what.contains("nested"));
        assert!(Expression::parse(&"1+".repeat(1900)).unwrap_err().what.contains("characters"));
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_refused(text in "[-+*/^()<>=.,0-9xyepisqrt ö]{0,60}") {
            if let Ok(expression) = Expression::parse(&text) {
                let _ = expression.at(1.0, 2.0);
                prop_assert_eq!(Expression::parse(expression.text()).unwrap(), expression);
            }
        }
    }
}
