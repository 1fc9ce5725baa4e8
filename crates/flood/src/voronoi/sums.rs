//! Sums over the faces of chunks of cells.

use corpuscle_model::{ExactSum, ReproducibleSum};

/// Sums of the two components of vectors.
pub(crate) fn total<'a>(parts: impl Iterator<Item = &'a [ReproducibleSum<f64>; 2]>) -> [ExactSum; 2] {
    let mut sums = [ExactSum::default(); 2];
    for part in parts {
        sums.iter_mut().zip(part).for_each(|(sum, part)| part.add_to(sum));
    }
    sums
}
