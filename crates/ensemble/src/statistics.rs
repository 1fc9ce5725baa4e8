//! Statistics over members that are read one after another.
//!
//! No statistic keeps more than a fixed number of arrays, whatever the number of members, and each depends on the values and their order
//! alone: the same bits for any number of threads.

use crate::EnsembleError;
use rayon::prelude::*;

/// Memory that percentiles take for the values of a block of cells, bytes.
pub(crate) const MEMORY: usize = 1 << 30;

/// Values of members, each an array of one length. Not-a-number is no value.
pub(crate) struct Values<'a, T> {
    /// Number of members.
    pub members: usize,
    /// Number of values of each.
    pub cells: usize,
    /// Reads the values of a member, by its position among these.
    pub read: &'a (dyn Fn(usize) -> Result<Vec<T>, EnsembleError> + Sync),
}

impl<T: Send> Values<'_, T> {
    /// Goes through the members in order; as many are read at the same time as there are threads.
    fn each(&self, mut take: impl FnMut(usize, Vec<T>)) -> Result<(), EnsembleError> {
        let at_once = rayon::current_num_threads();
        for first in (0..self.members).step_by(at_once) {
            let part = (first..self.members.min(first + at_once)).into_par_iter();
            let read: Vec<Vec<T>> = part.map(self.read).collect::<Result<_, _>>()?;
            read.into_iter().enumerate().for_each(|(number, values)| take(first + number, values));
        }
        Ok(())
    }
}

/// What no value counts as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Absent {
    /// As 0: a dry cell has no depth.
    Zero,
    /// As infinity: an arrival that never comes. Left out of means.
    Never,
    /// The member is left out there.
    LeftOut,
}

impl Absent {
    fn value(self) -> f64 {
        match self {
            Self::Zero => 0.0,
            Self::Never => f64::INFINITY,
            Self::LeftOut => f64::NAN,
        }
    }

    fn fill(self, value: f64) -> f64 {
        if value.is_nan() { self.value() } else { value }
    }
}

/// Number of values, mean, and standard error of the mean, by cell.
pub(crate) struct Moments {
    pub count: Vec<usize>,
    /// Not-a-number where there is no value.
    pub mean: Vec<f64>,
    /// Not-a-number for fewer than two values.
    pub standard_error: Vec<f64>,
}

/// The share of members whose value is above a threshold. No value is not above.
pub(crate) fn share_above<T: Copy + Into<f64> + Send>(
    values: &Values<'_, T>,
    threshold: f64,
) -> Result<Vec<f64>, EnsembleError> {
    let mut counts = vec![0_usize; values.cells];
    values.each(|_, read| {
        counts.iter_mut().zip(read).for_each(|(count, value)| *count += usize::from(value.into() > threshold));
    })?;
    Ok(counts.into_iter().map(|count| count as f64 / values.members as f64).collect())
}

/// Means and standard errors by Welford's method (Technometrics 4, 1962), in the order of members.
pub(crate) fn moments<T: Copy + Into<f64> + Send>(
    values: &Values<'_, T>,
    absent: Absent,
) -> Result<Moments, EnsembleError> {
    let mut count = vec![0_usize; values.cells];
    let mut mean = vec![0.0; values.cells];
    let mut squares = vec![0.0; values.cells];
    values.each(|_, read| {
        for (cell, value) in read.into_iter().enumerate() {
            let value = absent.fill(value.into());
            if value.is_finite() {
                count[cell] += 1;
                let difference = value - mean[cell];
                mean[cell] += difference / count[cell] as f64;
                squares[cell] += difference * (value - mean[cell]);
            }
        }
    })?;
    let error = |(count, squares): (&usize, &f64)| match *count {
        0 | 1 => f64::NAN,
        count => (squares / (count - 1) as f64 / count as f64).sqrt(),
    };
    let standard_error = count.iter().zip(&squares).map(error).collect();
    mean.iter_mut().zip(&count).filter(|(_, count)| **count == 0).for_each(|(mean, _)| *mean = f64::NAN);
    Ok(Moments { count, mean, standard_error })
}

/// Percentiles with linear interpolation between order statistics (definition 7 of Hyndman & Fan 1996, The American Statistician 50): an array for each of
/// `percents`. They are exact: cells that have a value in any member are sorted a block of `memory` bytes after another.
pub(crate) fn percentiles<T>(
    values: &Values<'_, T>,
    percents: &[f64],
    absent: Absent,
    memory: usize,
) -> Result<Vec<Vec<f64>>, EnsembleError>
where
    T: Copy + Into<f64> + Send + Sync,
{
    let cells = cells_with_a_value(values)?;
    let mut result = vec![vec![absent.value(); values.cells]; percents.len()];
    let block = (memory / size_of::<T>() / values.members.max(1)).max(1);
    for part in cells.chunks(block) {
        let sorted = sorted(values, part, absent)?;
        let found: Vec<Vec<f64>> = sorted
            .par_chunks(values.members)
            .map(|of_cell| {
                let counted = of_cell.partition_point(|value| !absent.fill((*value).into()).is_nan());
                let statistic = |rank: usize| absent.fill(of_cell[rank].into());
                percents.iter().map(|percent| between(*percent, counted, statistic)).collect()
            })
            .collect();
        for (cell, of_cell) in part.iter().zip(found) {
            result.iter_mut().zip(of_cell).for_each(|(result, value)| result[*cell] = value);
        }
    }
    Ok(result)
}

fn cells_with_a_value<T: Copy + Into<f64> + Send>(values: &Values<'_, T>) -> Result<Vec<usize>, EnsembleError> {
    let mut has_value = vec![false; values.cells];
    values.each(|_, read| {
        has_value.iter_mut().zip(read).for_each(|(has, value)| *has |= !value.into().is_nan());
    })?;
    Ok((0..values.cells).filter(|cell| has_value[*cell]).collect())
}

/// The values of all members at some cells, each cell's together and sorted; those that are left out come last.
fn sorted<T>(values: &Values<'_, T>, cells: &[usize], absent: Absent) -> Result<Vec<T>, EnsembleError>
where
    T: Copy + Into<f64> + Send + Sync,
{
    let mut all: Vec<T> = Vec::new();
    values.each(|member, read| {
        if all.is_empty() {
            all = vec![read[cells[0]]; cells.len() * values.members];
        }
        cells.iter().enumerate().for_each(|(index, cell)| all[index * values.members + member] = read[*cell]);
    })?;
    all.par_chunks_mut(values.members).for_each(|of_cell| {
        of_cell.sort_by(|a, b| {
            let [a, b] = [*a, *b].map(|value| absent.fill(value.into()));
            // Not-a-number of either sign comes last.
            a.is_nan().cmp(&b.is_nan()).then(a.total_cmp(&b))
        });
    });
    Ok(all)
}

/// A percentile from order statistics; infinite where the upper of the two neighbours has a weight and is.
fn between(percent: f64, counted: usize, statistic: impl Fn(usize) -> f64) -> f64 {
    let position = percent / 100.0 * (counted - 1) as f64;
    let rank = position.floor() as usize;
    let weight = position - rank as f64;
    let lower = statistic(rank);
    let upper = statistic((rank + 1).min(counted - 1));
    if lower.is_finite() && weight > 0.0 { lower + weight * (upper - lower) } else { lower }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const N: f64 = f64::NAN;

    fn with<R>(table: &[Vec<f64>], use_them: impl FnOnce(&Values<'_, f64>) -> R) -> R {
        let read = |member: usize| Ok(table[member].clone());
        use_them(&Values { members: table.len(), cells: table[0].len(), read: &read })
    }

    #[test]
    fn a_dry_cell_counts_as_its_kind_of_map_says() {
        let table = [vec![1.0, N, N], vec![3.0, 2.0, N], vec![2.0, 4.0, N], vec![5.0, N, N]];
        let median = |absent| with(&table, |values| percentiles(values, &[50.0], absent, MEMORY).unwrap().remove(0));
        assert_eq!(median(Absent::Zero), [2.5, 1.0, 0.0]);
        assert_eq!(median(Absent::Never)[..2], [2.5, f64::INFINITY]);
        let left_out = median(Absent::LeftOut);
        assert_eq!(left_out[..2], [2.5, 3.0]);
        assert!(left_out[2].is_nan());
        let of = |absent| with(&table, |values| moments(values, absent).unwrap());
        assert_eq!(of(Absent::Zero).mean, [2.75, 1.5, 0.0]);
        assert_eq!((of(Absent::Never).mean[1], of(Absent::Never).count[1]), (3.0, 2));
        assert!(of(Absent::LeftOut).mean[2].is_nan());
        assert_eq!(with(&table, |values| share_above(values, 2.0).unwrap()), [0.5, 0.25, 0.0]);
    }

    #[test]
    fn the_ends_and_the_error_of_one_member() {
        let table = [vec![4.0]];
        let all = with(&table, |values| percentiles(values, &[0.0, 50.0, 100.0], Absent::Zero, MEMORY).unwrap());
        assert_eq!(all, [[4.0], [4.0], [4.0]]);
        assert!(with(&table, |values| moments(values, Absent::Zero).unwrap()).standard_error[0].is_nan());
    }

    proptest! {
        #[test]
        fn blocks_give_what_sorting_all_gives(
            table in proptest::collection::vec(proptest::collection::vec(prop_oneof![Just(N), -9.0..9.0], 7), 1..20),
            percent in 0.0..=100.0,
        ) {
            for absent in [Absent::Zero, Absent::Never, Absent::LeftOut] {
                let found = |memory| with(&table, |values| percentiles(values, &[percent], absent, memory).unwrap().remove(0));
                let blocks = found(3 * 8 * table.len());
                for (cell, value) in found(MEMORY).iter().enumerate() {
                    prop_assert_eq!(value.to_bits(), blocks[cell].to_bits());
                    let mut column: Vec<f64> = table.iter().map(|row| absent.fill(row[cell])).filter(|value| !value.is_nan()).collect();
                    column.sort_by(f64::total_cmp);
                    let Some(last) = column.len().checked_sub(1) else {
                        prop_assert!(value.is_nan());
                        continue;
                    };
                    let position = percent / 100.0 * last as f64;
                    let [low, high] = [position.floor(), position.ceil()].map(|rank| column[rank as usize]);
                    if high.is_finite() {
                        let expected = low + (high - low) * position.fract();
                        prop_assert!((value - expected).abs() <= 1e-12 * 9.0);
                    } else {
                        prop_assert!(low.is_infinite() || position.fract() == 0.0 || value.is_infinite());
                    }
                }
            }
        }

        #[test]
        fn moments_are_those_of_two_passes(column in proptest::collection::vec(-1e3..1e3, 2..30)) {
            let table: Vec<Vec<f64>> = column.iter().map(|value| vec![*value]).collect();
            let found = with(&table, |values| moments(values, Absent::LeftOut).unwrap());
            let count = column.len() as f64;
            let mean = column.iter().sum::<f64>() / count;
            let error = (column.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0) / count).sqrt();
            prop_assert!((found.mean[0] - mean).abs() < 1e-9);
            prop_assert!((found.standard_error[0] - error).abs() < 1e-9);
        }
    }
}
