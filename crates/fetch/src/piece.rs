//! Remote files in pieces of one size, the unit of the cache.

use std::ops::Range;

/// Bytes of a piece.
pub(crate) const PIECE: u64 = 64 * 1024;

/// Most pieces of one request.
pub(crate) const MOST_PIECES: u64 = 16;

/// The pieces that contain so many bytes from `offset` on.
pub(crate) fn pieces_of(offset: u64, len: usize) -> Range<u64> {
    let end = offset + len as u64;
    offset / PIECE..end.div_ceil(PIECE)
}

/// The bytes of some pieces of a file of `length` bytes.
pub(crate) fn bytes_of(pieces: &Range<u64>, length: u64) -> Range<u64> {
    pieces.start * PIECE..(pieces.end * PIECE).min(length)
}

/// Runs of adjacent pieces, none longer than one request.
pub(crate) fn runs(pieces: impl IntoIterator<Item = u64>) -> Vec<Range<u64>> {
    let mut runs: Vec<Range<u64>> = Vec::new();
    for piece in pieces {
        match runs.last_mut() {
            Some(run) if run.end == piece && piece - run.start < MOST_PIECES => run.end = piece + 1,
            _ => runs.push(piece..piece + 1),
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_hold_the_bytes_asked_for() {
        assert_eq!(pieces_of(0, 1), 0..1);
        assert_eq!(pieces_of(PIECE - 1, 2), 0..2);
        assert_eq!(pieces_of(PIECE, PIECE as usize), 1..2);
        assert_eq!(bytes_of(&(1..3), 2 * PIECE + 7), PIECE..2 * PIECE + 7);
    }

    #[test]
    fn neighbours_are_asked_for_together() {
        assert_eq!(runs([0, 1, 2, 5, 6, 9]), [0..3, 5..7, 9..10]);
        assert_eq!(runs(0..MOST_PIECES + 1), [0..MOST_PIECES, MOST_PIECES..MOST_PIECES + 1]);
    }
}
