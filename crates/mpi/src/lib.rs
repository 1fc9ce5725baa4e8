//! Processes that `mpirun` started, as those of a run. Empty without the feature `mpi`.

#![warn(missing_docs)]

#[cfg(feature = "mpi")]
mod process;

#[cfg(feature = "mpi")]
pub use process::connect;
