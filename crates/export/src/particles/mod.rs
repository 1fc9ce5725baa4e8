//! Particles of all frames in one file.

mod columns;
mod vtkhdf;
mod xyz;

pub(crate) use vtkhdf::write as write_vtkhdf;
pub(crate) use xyz::write as write_xyz;
