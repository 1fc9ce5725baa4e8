//! Memory that a call allocates.

use peak_alloc::PeakAlloc;

/// Counts all allocations of the process.
#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// The result of `work`, and by how many bytes the memory of the process grew at most while it ran, on all threads.
pub fn measured<T>(work: impl FnOnce() -> T) -> (T, usize) {
    let before = ALLOCATOR.current_usage();
    ALLOCATOR.reset_peak_usage();
    let result = work();
    (result, ALLOCATOR.peak_usage().saturating_sub(before))
}

#[cfg(test)]
mod tests {
    use super::measured;

    #[test]
    fn the_largest_amount_counts() {
        let (sum, bytes) = measured(|| {
            let large = std::hint::black_box(vec![1_u8; 50_000_000]);
            large.iter().map(|byte| u64::from(*byte)).sum::<u64>()
        });
        assert_eq!(sum, 50_000_000);
        assert!((50_000_000..80_000_000).contains(&bytes), "{bytes}");
    }
}
