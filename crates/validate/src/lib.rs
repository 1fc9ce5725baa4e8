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

pub use bench::{Bench, BenchOptions, PassTime, Rate, benches, register_bench};
pub use case::{Case, Options, Row, cases, register_case};
pub use corpuscle_flood::FloodModel;
pub use flood::bench::{BenchWater, bench_water};
