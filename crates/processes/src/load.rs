//! How evenly work is distributed.

/// Largest load of a process over the mean; above it work is distributed anew.
pub const MAX_IMBALANCE: f64 = 1.1;

/// Steps between two checks of the load.
pub const STEPS_BETWEEN_BALANCING: u64 = 64;

/// Load of the busiest of `count` processes over the mean, by the process of each piece of work; 1 where there is no work.
pub fn imbalance(owners: &[u16], work: &[f64], count: usize) -> f64 {
    let mut sums = vec![0.0; count];
    owners.iter().zip(work).for_each(|(owner, work)| sums[usize::from(*owner)] += work);
    let total: f64 = sums.iter().sum();
    if total > 0.0 { sums.iter().copied().fold(0.0, f64::max) * count as f64 / total } else { 1.0 }
}
