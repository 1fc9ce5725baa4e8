//! Results on standard output.

use serde::Serialize;
use std::io::{self, Write};

/// Prints `text` to standard output. A closed pipe (`| head`) is no error.
pub fn print(text: &str) -> anyhow::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result.map_err(|error| anyhow::anyhow!("cannot write to standard output: {error}")),
    }
}

/// Prints `value` as JSON.
pub fn print_json(value: &impl Serialize) -> anyhow::Result<()> {
    print(&(serde_json::to_string_pretty(value)? + "\n"))
}

/// A number with five digits at most: `1234.5`, `3.2e-13`.
pub fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        return "0".into();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    let digits = 4 - size.log10().floor() as i32;
    match digits {
        -4..=7 => {
            let text = format!("{value:.*}", digits.max(0) as usize);
            if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
        }
        _ => format!("{value:.3e}"),
    }
}

/// A duration in words: `45 s`, `12 min`, `3.5 h`.
pub fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => format!("{s:.2} s"),
        s if s < 90.0 => format!("{s:.0} s"),
        s if s < 5400.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

/// A rate in words: `4.91 M particle-steps/s`.
pub fn rate(per_second: f64, counted: &str) -> String {
    format!("{:.2} M {counted}/s", per_second * 1e-6)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (0.0032, "0.0032"),
            (1234.56, "1234.6"),
            (3.21e-13, "3.210e-13"),
            (1.5e9, "1.500e9"),
            (-20.0, "-20"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn durations_are_in_words() {
        assert_eq!([0.25, 45.0, 720.0, 12600.0].map(duration), ["0.25 s", "45 s", "12 min", "3.5 h"]);
    }
}
