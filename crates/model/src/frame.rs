//! Particles at one time, as named columns.

use crate::name::{self, Name};
use serde::{Deserialize, Serialize};

/// All particles of a model at one time.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Frame {
    /// Simulated time, s.
    pub time: f64,
    /// The particle sets (one for flood; several species or phases in other models).
    pub sets: Vec<ParticleSet>,
}

/// One set of like particles. Every column has one entry for each particle.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ParticleSet {
    /// What these particles are, one word: `water`.
    pub name: String,
    /// Identity of each particle, lasting over the run.
    pub id: Vec<u64>,
    /// Position, m.
    pub position: Vec<[f64; 3]>,
    /// Velocity, m/s.
    pub velocity: Vec<[f64; 3]>,
    /// Radius to draw the particle with, m.
    pub radius: Vec<f64>,
    /// Mass, kg.
    pub mass: Vec<f64>,
    /// The model's own columns.
    pub columns: Vec<Column>,
}

impl ParticleSet {
    /// Number of particles.
    pub fn len(&self) -> usize {
        self.id.len()
    }

    /// True where the set has no particle.
    pub fn is_empty(&self) -> bool {
        self.id.is_empty()
    }
}

/// A named quantity of each particle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Column {
    /// Name as in files: lower case, words joined by `_`.
    #[serde(deserialize_with = "name::read")]
    pub name: Name,
    /// Unit as printed: `m`, `m/s`, `kg`; empty for a number.
    #[serde(deserialize_with = "name::read")]
    pub unit: Name,
    /// The values.
    pub values: Values,
}

/// Values of a column.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Values {
    /// One number each.
    Scalar(Vec<f64>),
    /// Three components each.
    Vector(Vec<[f64; 3]>),
}
