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

/// Memory that the program itself has allocated, bytes; what libraries in C take is not in it.
pub fn allocated() -> usize {
    ALLOCATOR.current_usage()
}

/// Gives the free memory that the allocator of the C library keeps back to the system, so that resident memory is what is in use. Other C
/// libraries have no such call: nothing is done there.
pub fn give_back() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    #[allow(unsafe_code)]
    // SAFETY: the call takes a number and touches free memory only, under the allocator's own locks; it may be made at any time on any thread.
    unsafe {
        libc::malloc_trim(0);
    }
}

#[cfg(test)]
mod tests {
    use super::{allocated, measured};

    #[test]
    fn the_largest_amount_counts() {
        let (sum, bytes) = measured(|| {
            let large = std::hint::black_box(vec![1_u8; 50_000_000]);
            assert!(allocated() >= 50_000_000, "{}", allocated());
            large.iter().map(|byte| u64::from(*byte)).sum::<u64>()
        });
        assert_eq!(sum, 50_000_000);
        assert!((50_000_000..80_000_000).contains(&bytes), "{bytes}");
        assert!(allocated() < 50_000_000, "{}", allocated());
    }
}
