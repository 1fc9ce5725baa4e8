//! Sampling of ranges.

use super::file::{Choice, Range};
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Number, Value};

/// Most keys of a Sobol sequence.
pub(super) const MOST_SOBOL_KEYS: usize = sobol_burley::NUM_DIMENSIONS as usize;

/// Most members of a Sobol sequence.
pub(super) const MOST_SOBOL_MEMBERS: usize = 1 << 16;

/// All combinations of lists; the last varies fastest.
pub(super) fn combinations(lists: &[Vec<Value>]) -> Vec<Vec<Value>> {
    lists.iter().fold(vec![Vec::new()], |rows, list| {
        rows.iter()
            .flat_map(|row| list.iter().map(|value| [row.as_slice(), std::slice::from_ref(value)].concat()))
            .collect()
    })
}

/// A Latin hypercube: for each key as many strata of equal probability as members, each drawn from once
/// (McKay, Beckman & Conover 1979, Technometrics 21).
pub(super) fn latin_hypercube(choices: &[Choice], members: usize, seed: u64) -> Vec<Vec<Value>> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let columns: Vec<Vec<Value>> = choices
        .iter()
        .map(|choice| {
            let mut strata: Vec<usize> = (0..members).collect();
            strata.shuffle(&mut random);
            let part =
                |stratum: usize, random: &mut ChaCha8Rng| (stratum as f64 + random.random::<f64>()) / members as f64;
            strata.into_iter().map(|stratum| choice.quantile(part(stratum, &mut random))).collect()
        })
        .collect();
    (0..members).map(|member| columns.iter().map(|column| column[member].clone()).collect()).collect()
}

/// A Sobol sequence with Owen's scrambling, by the library `sobol_burley`.
pub(super) fn sobol(choices: &[Choice], members: usize, seed: u64) -> Vec<Vec<Value>> {
    let seed = (seed ^ (seed >> 32)) as u32;
    let value = |member: usize, (dimension, choice): (usize, &Choice)| {
        choice.quantile(f64::from(sobol_burley::sample(member as u32, dimension as u32, seed)))
    };
    (0..members).map(|member| choices.iter().enumerate().map(|choice| value(member, choice)).collect()).collect()
}

impl Choice {
    /// The value below which a part of the probability lies; `part` is from 0 to below 1.
    fn quantile(&self, part: f64) -> Value {
        match self {
            Self::List(values) => values[((part * values.len() as f64) as usize).min(values.len() - 1)].clone(),
            Self::Range(range) => range.quantile(part),
        }
    }
}

impl Range {
    fn quantile(&self, part: f64) -> Value {
        let &Self { from, to, log, whole } = self;
        if whole {
            return Value::from((from + (part * (to - from + 1.0)).floor().min(to - from)) as i64);
        }
        let value = if log { (from.ln() + part * (to.ln() - from.ln())).exp() } else { from + part * (to - from) };
        // Of finite ends every value between is finite.
        Number::from_f64(value.clamp(from, to)).map_or(Value::Null, Value::Number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn uniform(from: f64, to: f64) -> Choice {
        Choice::Range(Range { from, to, log: false, whole: false })
    }

    fn column(rows: &[Vec<Value>], number: usize) -> Vec<f64> {
        rows.iter().map(|row| row[number].as_f64().unwrap()).collect()
    }

    #[test]
    fn a_latin_hypercube_has_one_value_in_each_stratum() {
        let choices = [uniform(0.0, 16.0), Choice::Range(Range { from: 1.0, to: 65536.0, log: true, whole: false })];
        for seed in 0..20 {
            let rows = latin_hypercube(&choices, 16, seed);
            let mut strata: Vec<_> = column(&rows, 0).iter().map(|value| value.floor() as usize).collect();
            strata.sort_unstable();
            assert_eq!(strata, (0..16).collect::<Vec<_>>());
            let mut strata: Vec<_> = column(&rows, 1).iter().map(|value| value.log2().floor() as usize).collect();
            strata.sort_unstable();
            assert_eq!(strata, (0..16).collect::<Vec<_>>());
        }
        assert_ne!(latin_hypercube(&choices, 16, 1), latin_hypercube(&choices, 16, 2));
        assert_eq!(latin_hypercube(&choices, 16, 1), latin_hypercube(&choices, 16, 1));
    }

    #[test]
    fn a_sobol_sequence_fills_the_square_evenly() {
        for seed in 0..10 {
            let rows = sobol(&[uniform(0.0, 8.0), uniform(0.0, 8.0)], 64, seed);
            // A (0, 2)-sequence in base 2: one of 64 points in each of 64 squares.
            let mut squares: Vec<_> = column(&rows, 0)
                .iter()
                .zip(column(&rows, 1))
                .map(|(x, y)| x.floor() as usize * 8 + y.floor() as usize)
                .collect();
            squares.sort_unstable();
            assert_eq!(squares, (0..64).collect::<Vec<_>>(), "seed {seed}");
        }
    }

    #[test]
    fn whole_numbers_and_lists_are_drawn_equally_often() {
        let choices = [
            Choice::Range(Range { from: 1.0, to: 4.0, log: false, whole: true }),
            Choice::List(vec![json!("a"), json!("b")]),
        ];
        let rows = latin_hypercube(&choices, 40, 5);
        for value in 1..=4 {
            assert_eq!(rows.iter().filter(|row| row[0] == json!(value)).count(), 10, "{value}");
        }
        assert_eq!(rows.iter().filter(|row| row[1] == json!("a")).count(), 20);
    }

    #[test]
    fn a_grid_varies_its_last_key_fastest() {
        let rows = combinations(&[vec![json!(1), json!(2)], vec![json!("x"), json!("y")]]);
        let expected = [[json!(1), json!("x")], [json!(1), json!("y")], [json!(2), json!("x")], [json!(2), json!("y")]];
        assert_eq!(rows, expected);
    }
}
