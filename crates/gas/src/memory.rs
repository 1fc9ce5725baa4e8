//! Memory for large tables.
//!
//! Events come from all over the gas, one after the other: in pages of 4 KiB nearly every one of them misses in the CPU's table of
//! pages. Large pages are requested where the system gives them.
//! And what will be needed soon can be prefetched.

/// Size of a large page.
const LARGE_PAGE: usize = 1 << 21;

/// An empty table with room for `len` entries, in large pages where there can be any.
pub(crate) fn reserved<T>(len: usize) -> Vec<T> {
    let bytes = len * size_of::<T>();
    if bytes < LARGE_PAGE / 4 {
        return Vec::with_capacity(len);
    }
    // Up to a whole number of large pages.
    let room = bytes.next_multiple_of(LARGE_PAGE) + LARGE_PAGE;
    let table = Vec::with_capacity(room / size_of::<T>());
    ask_for_large_pages(table.as_ptr() as usize, room);
    table
}

#[cfg(target_os = "linux")]
#[allow(unsafe_code, reason = "no safe call advises the kernel; large pages are a measured gain")]
fn ask_for_large_pages(start: usize, bytes: usize) {
    let first = start.next_multiple_of(LARGE_PAGE);
    let last = (start + bytes) / LARGE_PAGE * LARGE_PAGE;
    if first < last {
        // SAFETY: the range lies within an allocation, and the advice does not change what it holds. A refusal does no harm.
        unsafe { libc::madvise(first as *mut libc::c_void, last - first, libc::MADV_HUGEPAGE) };
    }
}

#[cfg(not(target_os = "linux"))]
fn ask_for_large_pages(_start: usize, _bytes: usize) {}

/// A table of `len` equal entries.
pub(crate) fn filled<T: Clone>(len: usize, value: T) -> Vec<T> {
    let mut table = reserved(len);
    table.resize(len, value);
    table
}

/// Prefetches the cache line of something that will be read some hundreds of nanoseconds later: into the second cache, which takes
/// up twice as many such requests at a time as the first.
#[inline(always)]
#[allow(unsafe_code, reason = "no safe call prefetches on stable Rust; a measured gain")]
pub(crate) fn prefetch<T>(item: &T) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T1, _mm_prefetch};
        // SAFETY: the address is that of a living value, and asking for it neither reads nor writes it.
        unsafe { _mm_prefetch::<_MM_HINT_T1>(std::ptr::from_ref(item).cast()) };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = item;
}
