//! Fuzz targets of every reader, random scenes, faults and soak: what makes Corpuscle hard to break.
//!
//! A [`Target`] calls a reader with bytes. [`drive`] calls it many times with changed valid inputs ([`mutate`]), and measures time and memory: a reader
//! never panics, never takes longer than [`drive::TIME`], and never allocates more than [`drive::MEMORY`] beyond what its input justifies. All of it
//! runs on stable Rust: instead of the compiler's coverage, the words of a refusal tell which inputs reached something new.

#![warn(missing_docs)]

pub mod corpus;
pub mod drive;
mod memory;
pub mod mutate;
pub mod random;
pub mod scenes;
pub mod soak;
mod targets;

pub use memory::measured;
pub use targets::targets;

/// A reader to be called with bytes.
#[derive(Debug, Clone, Copy)]
pub struct Target {
    /// Name on the command line.
    pub name: &'static str,
    /// What is read.
    pub about: &'static str,
    /// Folder of its valid inputs, below that of all.
    pub corpus: &'static str,
    /// Reads bytes; says in a word what was read, or why not.
    pub read: fn(&[u8]) -> Result<String, String>,
    /// Further valid inputs, made by the program itself.
    pub more: fn() -> Vec<Vec<u8>>,
}
