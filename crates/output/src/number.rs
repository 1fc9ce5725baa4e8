//! Numbers as text.

use std::fmt;

/// A number in the shortest form that reads back to the same bits: `0.1`, `1e-7`, `NaN`, `inf`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shortest(pub f64);

impl fmt::Display for Shortest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == 0.0 || (1e-4..1e16).contains(&size) || !size.is_finite() {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Shortest;
    use proptest::prelude::*;

    #[test]
    fn forms() {
        for (value, text) in [
            (0.1, "0.1"),
            (-0.0, "-0"),
            (120.0, "120"),
            (1e-7, "1e-7"),
            (2.5e300, "2.5e300"),
            (f64::NAN, "NaN"),
            (f64::NEG_INFINITY, "-inf"),
        ] {
            assert_eq!(Shortest(value).to_string(), text);
        }
    }

    proptest! {
        #[test]
        fn reads_back_to_the_same_bits(value in any::<f64>().prop_filter("a number", |v| !v.is_nan())) {
            let back: f64 = Shortest(value).to_string().parse().unwrap();
            prop_assert_eq!(back.to_bits(), value.to_bits());
        }
    }
}
