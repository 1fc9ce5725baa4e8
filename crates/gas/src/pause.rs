//! Why a method came back from a run.

/// Why a method came back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pause {
    /// No event is left up to the requested time.
    Reached,
    /// The requested number of events has been handled.
    Worked,
    /// A new window is due.
    WindowFull,
    /// Collisions follow each other without anything moving.
    Standstill,
}
