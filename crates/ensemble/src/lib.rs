//! Ensembles: many runs of one scene with changed values, and statistics over them.
//!
//! A [`PlanFile`] says which values change; its [`Plan`] is a table with a row for each member. [`run`] computes the members that are missing in
//! the ensemble's [`Folder`], [`write_results`] the probabilities, percentiles and means over those that are finished. The folder is the
//! one of the Python package, which can continue and read it.

#![warn(missing_docs)]

mod chosen;
mod error;
mod folder;
mod layout;
mod member;
mod plan;
mod record;
mod results;
mod run;
mod source;
mod statistics;

pub use chosen::Chosen;
pub use error::EnsembleError;
pub use folder::Folder;
pub use plan::{Plan, PlanFile};
pub use record::{Failure, Record};
pub use results::{Written, write_results};
pub use run::{Progress, Workers, run};
pub use source::Source;
