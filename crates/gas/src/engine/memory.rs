//! Memory for large tables.

/// A table with room for `len` entries.
pub(crate) fn reserved<T>(len: usize) -> Vec<T> {
    Vec::with_capacity(len)
}

/// A table of `len` equal entries.
pub(crate) fn filled<T: Clone>(len: usize, value: T) -> Vec<T> {
    let mut table = reserved(len);
    table.resize(len, value);
    table
}
