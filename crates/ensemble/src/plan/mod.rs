//! Plans: which values each member has.

mod file;
mod sample;
mod table;

pub use file::PlanFile;
pub use table::Plan;
pub(crate) use table::encoded;
