//! Changes of valid inputs, some blind and some that keep the structure of text and of binary fields.

use crate::random::Random;

/// Longest input that is made, bytes, but for a few.
const LONGEST: usize = 1 << 16;

/// Longest of the few large inputs, bytes.
const LARGE: usize = 2 << 20;

/// Part of all inputs that are large.
const LARGE_PART: f64 = 0.004;

/// Numbers as text at which readers may fail.
const NUMBERS: [&str; 34] = [
    "0",
    "-0",
    "-1",
    "1",
    "2",
    "3",
    "0.5",
    "1e-9",
    "1e9",
    "1e308",
    "-1e308",
    "1e-308",
    "5e-324",
    "1e400",
    "nan",
    "NaN",
    "inf",
    "-inf",
    "255",
    "256",
    "65535",
    "65536",
    "100000000",
    "2147483647",
    "2147483648",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "18446744073709551615",
    "18446744073709551616",
    "-9223372036854775808",
    "0x10",
    "1_0",
    "",
];

/// Whole numbers at which readers of binary fields may fail.
const WHOLE: [u64; 18] = [
    0,
    1,
    2,
    3,
    7,
    8,
    127,
    128,
    255,
    256,
    0x7fff,
    0xffff,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_ffff,
    0x10_0000,
    0x7fff_ffff_ffff_ffff,
    u64::MAX,
];

/// Floating-point numbers at which readers of binary fields may fail.
const FLOATING: [f64; 9] =
    [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN, f64::MIN_POSITIVE, 1e-300];

/// What is put into text.
const PIECES: [&str; 20] =
    ["\"", "'", "`", "\n", "\r\n", "\0", ",", ";", ":", "#", "=", "\\", "é", "\u{feff}", "𝄞", "<", "&", "{", "[[", "-"];

/// A pool of inputs, and what is made of them.
#[derive(Debug)]
pub struct Mutator {
    pool: Vec<Vec<u8>>,
    /// The first inputs, which stay.
    kept: usize,
    words: Vec<Vec<u8>>,
}

impl Mutator {
    /// A mutator of these inputs.
    pub fn new(seeds: Vec<Vec<u8>>) -> Self {
        let mut words: Vec<Vec<u8>> =
            seeds.iter().filter(|seed| is_text(seed)).flat_map(|seed| words_of(seed)).collect();
        words.sort_unstable();
        words.dedup();
        Self { kept: seeds.len(), pool: seeds, words }
    }

    /// Adds an input whose outcome was new.
    pub fn add(&mut self, input: &[u8], random: &mut Random) {
        const MOST: usize = 1000;
        if self.pool.len() < self.kept + MOST {
            self.pool.push(input.to_vec());
        } else {
            let index = self.kept + random.below(MOST);
            self.pool[index] = input.to_vec();
        }
    }

    /// The next input.
    pub fn next(&self, random: &mut Random) -> Vec<u8> {
        if self.pool.is_empty() {
            return (0..random.below(64)).map(|_| random.bits() as u8).collect();
        }
        // Half of all come from the first inputs, which are valid.
        let from = if random.chance(0.5) { self.kept.max(1) } else { self.pool.len() };
        let mut input = self.pool[random.below(from)].clone();
        let is_text = is_text(&input);
        let changes = 1 + random.below(2) * random.below(6);
        for _ in 0..changes {
            let (blind, text) = (random.chance(if is_text { 0.1 } else { 0.4 }), is_text && !random.chance(0.05));
            match (blind, text) {
                (true, _) => self.change_blindly(&mut input, random),
                (false, true) => self.change_text(&mut input, random),
                (false, false) => self.change_fields(&mut input, random),
            }
            input.truncate(LARGE);
        }
        let longest = LONGEST.max(4 * self.pool[0].len());
        if random.chance(LARGE_PART) {
            enlarge(&mut input, random);
            input.truncate(LARGE.max(longest));
        } else {
            input.truncate(longest);
        }
        input
    }

    fn change_blindly(&self, input: &mut Vec<u8>, random: &mut Random) {
        let at = random.below(input.len());
        match random.below(7) {
            0 if !input.is_empty() => input[at] ^= 1 << random.below(8),
            1 if !input.is_empty() => input[at] = random.bits() as u8,
            2 => input.truncate(at),
            3 => drop(input.drain(at..(at + 1 + random.below(16)).min(input.len()))),
            4 => input.insert(at, random.bits() as u8),
            5 => repeat(input, at, random),
            _ => {
                // The beginning of this one, the end of another.
                let other = random.one_of(&self.pool).clone();
                input.truncate(at);
                input.extend_from_slice(&other[random.below(other.len())..]);
            }
        }
    }

    fn change_fields(&self, input: &mut [u8], random: &mut Random) {
        let width = *random.one_of(&[1, 2, 4, 8]);
        if input.len() < width {
            return;
        }
        // Headers are where a change does most.
        let span = if random.chance(0.5) { input.len().min(512) } else { input.len() };
        let mut at = random.below(span.saturating_sub(width) + 1);
        if random.chance(0.5) {
            at -= at % width;
        }
        let field = &mut input[at..at + width];
        let value = match random.below(4) {
            0 | 1 => *random.one_of(&WHOLE),
            2 => random.one_of(&FLOATING).to_bits(),
            _ => {
                let mut bytes = [0; 8];
                bytes[..width].copy_from_slice(field);
                u64::from_le_bytes(bytes).wrapping_add(random.below(17) as u64).wrapping_sub(8)
            }
        };
        let is_single = width == 4 && random.chance(0.2);
        let bytes =
            if is_single { u64::from((*random.one_of(&FLOATING) as f32).to_bits()) } else { value }.to_le_bytes();
        field.copy_from_slice(&bytes[..width]);
        if random.chance(0.3) {
            field.reverse();
        }
    }

    fn change_text(&self, input: &mut Vec<u8>, random: &mut Random) {
        match random.below(12) {
            0..=3 => {
                let (spans, number) = (numbers_of(input), random.one_of(&NUMBERS).as_bytes());
                replace(input, &spans, number, random);
            }
            4 | 5 if !self.words.is_empty() => {
                let (spans, word): (_, &Vec<u8>) = (spans_of_words(input), random.one_of(&self.words));
                replace(input, &spans, word, random);
            }
            6 => {
                let lines = lines_of(input);
                let (from, to) = *random.one_of(&lines);
                drop(input.drain(from..to));
            }
            7 => {
                let lines = lines_of(input);
                let (from, to) = *random.one_of(&lines);
                let line = input[from..to].to_vec();
                let times = if random.chance(0.9) { 1 } else { random.below(200) };
                let times = times.min(LARGE / line.len().max(1));
                let start = random.one_of(&lines).0;
                input.splice(start..start, line.repeat(times));
            }
            8 => {
                let piece = random.one_of(&PIECES).as_bytes();
                let at = random.below(input.len() + 1);
                input.splice(at..at, piece.iter().copied());
            }
            9 => {
                // Deep nesting.
                let (open, close) =
                    *random.one_of(&[("[", "]"), ("(", ")"), ("{\"a\":", "}"), ("-", ""), ("<a>", "</a>"), ("a.", "")]);
                let deepest = if random.chance(0.1) { 5000 } else { 20 };
                let depth = 1 + random.below(deepest);
                let at = random.below(input.len() + 1);
                let to = (at + random.below(8)).min(input.len());
                input.splice(to..to, close.repeat(depth).bytes());
                input.splice(at..at, open.repeat(depth).bytes());
            }
            10 => {
                let at = random.below(input.len());
                repeat(input, at, random);
            }
            _ => {
                let spans = spans_of_words(input);
                replace(input, &spans, &[], random);
            }
        }
    }
}

/// Repeats some bytes where they are.
fn repeat(input: &mut Vec<u8>, at: usize, random: &mut Random) {
    let to = (at + 1 + random.below(64)).min(input.len());
    let piece = input.get(at..to).unwrap_or_default().to_vec();
    let times = if random.chance(0.9) { 1 } else { random.below(100) };
    input.splice(at..at, piece.repeat(times));
}

/// Repeats a piece of an input, often whole lines, until it has up to [`LARGE`] bytes.
fn enlarge(input: &mut Vec<u8>, random: &mut Random) {
    let lines = lines_of(input);
    let (from, to) = if random.chance(0.5) {
        *random.one_of(&lines)
    } else {
        let from = random.below(input.len());
        (from, (from + 1 + random.below(256)).min(input.len()))
    };
    let piece = input.get(from..to).unwrap_or_default().to_vec();
    if !piece.is_empty() {
        let times = 1 + random.below(LARGE) / piece.len();
        input.splice(from..from, piece.repeat(times));
    }
}

fn replace(input: &mut Vec<u8>, spans: &[(usize, usize)], by: &[u8], random: &mut Random) {
    if !spans.is_empty() {
        let (from, to) = *random.one_of(spans);
        input.splice(from..to, by.iter().copied());
    }
}

/// Whether bytes are a text, by their beginning.
fn is_text(input: &[u8]) -> bool {
    let start = &input[..input.len().min(256)];
    let odd = start.iter().filter(|byte| !byte.is_ascii_graphic() && !byte.is_ascii_whitespace()).count();
    10 * odd <= start.len()
}

/// Where runs of bytes of one kind are.
fn runs(input: &[u8], is_of: impl Fn(u8) -> bool) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut start = None;
    for (at, byte) in input.iter().copied().chain([b'\n']).enumerate() {
        match (start, is_of(byte) && at < input.len()) {
            (None, true) => start = Some(at),
            (Some(from), false) => {
                found.push((from, at));
                start = None;
            }
            _ => {}
        }
    }
    found
}

fn numbers_of(input: &[u8]) -> Vec<(usize, usize)> {
    let mut found = runs(input, |byte| byte.is_ascii_digit() || matches!(byte, b'.' | b'-' | b'+' | b'e'));
    found.retain(|&(from, to)| input[from..to].iter().any(u8::is_ascii_digit));
    found
}

fn spans_of_words(input: &[u8]) -> Vec<(usize, usize)> {
    runs(input, |byte| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'.' | b'-'))
}

fn words_of(input: &[u8]) -> Vec<Vec<u8>> {
    spans_of_words(input)
        .into_iter()
        .map(|(from, to)| input[from..to].to_vec())
        .filter(|word| word.len() < 40)
        .collect()
}

/// Lines with their ends; one where there is no text.
fn lines_of(input: &[u8]) -> Vec<(usize, usize)> {
    let ends = input.iter().enumerate().filter(|(_, byte)| **byte == b'\n').map(|(at, _)| at + 1);
    let mut from = 0;
    let mut lines: Vec<_> = ends.chain([input.len()]).map(|to| (std::mem::replace(&mut from, to), to)).collect();
    lines.retain(|(from, to)| from < to);
    if lines.is_empty() {
        lines.push((0, 0));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_seed_makes_the_same_inputs_and_most_are_changed() {
        let seeds = vec![b"ncols 3\nnrows 4\n1 2 3\n".to_vec(), (0..200).collect()];
        let mutator = Mutator::new(seeds.clone());
        let made = |seed| {
            let mut random = Random::new(seed);
            (0..300).map(|_| mutator.next(&mut random)).collect::<Vec<_>>()
        };
        assert_eq!(made(1), made(1));
        assert_ne!(made(1), made(2));
        assert!(made(1).iter().filter(|input| !seeds.contains(input)).count() > 240);
    }

    #[test]
    fn some_inputs_are_large() {
        let mutator = Mutator::new(vec![b"1 2 3\n4 5 6\n".to_vec()]);
        let mut random = Random::new(3);
        let sizes: Vec<usize> = (0..5000).map(|_| mutator.next(&mut random).len()).collect();
        let large = sizes.iter().filter(|size| **size > 4 * LONGEST).count();
        assert!((2..100).contains(&large) && sizes.iter().all(|size| *size <= LARGE), "{large}");
    }

    #[test]
    fn any_input_can_be_changed() {
        for seed in [vec![], vec![b'a'], vec![0], b"\n".to_vec(), vec![255; 3]] {
            let mutator = Mutator::new(vec![seed]);
            let mut random = Random::new(7);
            (0..2000).for_each(|_| drop(mutator.next(&mut random)));
        }
    }

    #[test]
    fn numbers_words_and_lines_are_found() {
        let text = b"a 1.5\nbc -2e3";
        assert_eq!(numbers_of(text), [(2, 5), (9, 13)]);
        assert_eq!(spans_of_words(text), [(0, 1), (2, 5), (6, 8), (9, 13)]);
        assert_eq!(lines_of(text), [(0, 6), (6, 13)]);
    }
}
