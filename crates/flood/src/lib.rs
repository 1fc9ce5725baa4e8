//! Shallow water as particles over terrain.

pub mod arrangement;
pub mod balanced;
mod density;
pub mod edges;
pub mod particle;
pub mod seeding;
