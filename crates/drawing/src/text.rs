//! Numbers as text for display. A thin space groups thousands.

const THIN: char = '\u{2009}';

/// Prefixes of units, from large to small.
const PREFIXES: [(f64, &str); 6] = [(1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"), (1e-12, "p")];

/// About three figures: `12 345`, `12.3`, `0.0123`, `3.2 × 10⁻⁷`.
pub fn number(value: f64) -> String {
    let size = value.abs();
    match size {
        _ if !value.is_finite() => "–".into(),
        0.0 => "0".into(),
        1e7.. => scientific(value),
        99.95.. => grouped(value),
        9.995.. => format!("{value:.1}"),
        0.9995.. => format!("{value:.2}"),
        0.001.. => trimmed(value, (2 - size.log10().floor() as i32) as usize),
        _ => scientific(value),
    }
    .replace('-', "−")
}

/// About three figures without zeros at the end, for what is often whole: `20`, `14.2`.
pub fn short_number(value: f64) -> String {
    let text = number(value);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

fn trimmed(value: f64, decimals: usize) -> String {
    format!("{value:.decimals$}").trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn grouped(value: f64) -> String {
    let digits = format!("{:.0}", value.abs());
    let mut text = String::from(if value < 0.0 { "-" } else { "" });
    for (index, digit) in digits.char_indices() {
        if index > 0 && (digits.len() - index) % 3 == 0 && digits.len() > 4 {
            text.push(THIN);
        }
        text.push(digit);
    }
    text
}

fn scientific(value: f64) -> String {
    let text = format!("{value:.1e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent: String = exponent
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            digit => char::from_u32('⁰' as u32 + digit as u32 - '0' as u32).unwrap_or(digit),
        })
        .collect();
    format!("{digits}{THIN}×{THIN}10{exponent}")
}

/// The prefix of a unit that suits a number, and what it stands for.
pub fn prefix(size: f64) -> (f64, &'static str) {
    PREFIXES.into_iter().find(|(factor, _)| size >= factor * 0.999).unwrap_or(PREFIXES[5])
}

/// An area given in m2, in m², ha or km².
pub fn area(square_metres: f64) -> String {
    match square_metres.abs() {
        1e6.. => format!("{} km²", number(square_metres / 1e6)),
        1e4.. => format!("{} ha", number(square_metres / 1e4)),
        _ => format!("{} m²", number(square_metres)),
    }
}

/// A volume given in m3, in m³ or million m³.
pub fn volume(cubic_metres: f64) -> String {
    match cubic_metres.abs() {
        1e6.. => format!("{} million m³", number(cubic_metres / 1e6)),
        _ => format!("{} m³", number(cubic_metres)),
    }
}

/// A time given in s, however short: `20 ns`, `0.3 s`, `12 min`.
pub fn any_time(seconds: f64) -> String {
    if seconds == 0.0 || seconds.abs() >= 0.1 || !seconds.is_finite() {
        return time(seconds);
    }
    let (factor, prefix) = prefix(seconds.abs());
    format!("{} {prefix}s", short_number(seconds / factor))
}

/// A time given in s: `45 s`, `12 min`, `1 h 05 min`, `2 d 3 h`.
pub fn time(seconds: f64) -> String {
    let whole = seconds.abs().round() as u64;
    let (days, hours, minutes) = (whole / 86400, whole / 3600 % 24, whole / 60 % 60);
    match seconds.abs() {
        size if !size.is_finite() => "–".into(),
        172_799.5.. => format!("{days} d {hours} h"),
        3599.5.. => format!("{} h {minutes:02} min", whole / 3600),
        119.5.. if whole.is_multiple_of(60) => format!("{minutes} min"),
        119.5.. => format!("{minutes} min {:02} s", whole % 60),
        _ => format!("{} s", short_number(seconds)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_about_three_figures() {
        for (value, text) in [
            (0.0, "0"),
            (1234567.0, "1\u{2009}234\u{2009}567"),
            (1234.4, "1234"),
            (99.96, "100"),
            (-12.345, "−12.3"),
            (1.0, "1.00"),
            (0.05, "0.05"),
            (0.012345, "0.0123"),
            (3.24e-17, "3.2\u{2009}×\u{2009}10⁻¹⁷"),
            (4.5e8, "4.5\u{2009}×\u{2009}10⁸"),
            (f64::NAN, "–"),
        ] {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn times_read_as_a_clock() {
        for (seconds, text) in [
            (0.5, "0.5 s"),
            (45.0, "45 s"),
            (14.25, "14.2 s"),
            (600.0, "10 min"),
            (605.0, "10 min 05 s"),
            (3900.0, "1 h 05 min"),
            (7199.6, "2 h 00 min"),
            (100_000.0, "27 h 46 min"),
            (183_600.0, "2 d 3 h"),
        ] {
            assert_eq!(time(seconds), text);
        }
    }

    #[test]
    fn short_times_have_a_prefix() {
        assert_eq!([2e-8, 0.0, 0.004, 0.3, 600.0].map(any_time), ["20 ns", "0 s", "4 ms", "0.3 s", "10 min"]);
    }

    #[test]
    fn areas_and_volumes_choose_their_unit() {
        assert_eq!(area(2.5e6), "2.50 km²");
        assert_eq!(area(12_000.0), "1.20 ha");
        assert_eq!(volume(1.5e6), "1.50 million m³");
        assert_eq!(volume(12_345.0), "12\u{2009}345 m³");
    }
}
