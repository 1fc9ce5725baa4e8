//! Cases with known answers, and rates on this machine.
//!
//! A [`Case`] runs a scene whose answer is known and gives [`Row`]s: what was measured, and the bound it must keep.
//! A [`Bench`] runs a scene whose cost matters and gives [`Rate`]s.

mod bench;
mod case;
mod device;
mod dew;
mod flood;
mod gas;
mod gpu_copy;
mod missed;
mod options;
mod registry;
mod row;

pub use bench::{Bench, BenchOptions, PassTime, Rate};
pub use case::Case;
pub use corpuscle_flood::FloodModel;
pub use flood::bench::{BenchWater, bench_water};
pub use options::Options;
pub use registry::{benches, cases, register_bench, register_case};
pub use row::Row;
