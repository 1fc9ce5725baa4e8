//! Elementary functions with the same bits on every machine: those of the standard library are the system's, and differ in the last digit.

pub(crate) use libm::{asinh, cos, log as ln, pow, sin, tan};
