//! Numbers that vary over the ground at the start.

use crate::Expression;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::fmt;
use std::path::PathBuf;

/// A number, or an expression of the position in the terrain's own coordinates.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Field {
    /// The same everywhere.
    Number(f64),
    /// As in `"2 + 0.1 * exp(-(x - 50)^2)"`.
    Expression(Expression),
}

impl Field {
    /// The number, where it is one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            Self::Expression(_) => None,
        }
    }

    /// The value at a position in the terrain's own coordinates.
    pub fn at(&self, x: f64, y: f64) -> f64 {
        match self {
            Self::Number(number) => *number,
            Self::Expression(expression) => expression.at(x, y),
        }
    }
}

impl From<f64> for Field {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl<'de> Deserialize<'de> for Field {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(FieldVisitor)
    }
}

struct FieldVisitor;

impl Visitor<'_> for FieldVisitor {
    type Value = Field;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a number, or an expression of x and y in quotes")
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<Field, E> {
        Ok(Field::Number(number))
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<Field, E> {
        Ok(Field::Number(number as f64))
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<Field, E> {
        Ok(Field::Number(number as f64))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Field, E> {
        Expression::parse(text).map(Field::Expression).map_err(E::custom)
    }
}

/// Velocity at the start.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum StartVelocity {
    /// Its components `[east, north]`, m/s.
    Components([Field; 2]),
    /// A pair of rasters of its components, m/s.
    Rasters(VelocityRasters),
}

/// Rasters of a velocity's components, m/s; 0 where they have no data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VelocityRasters {
    /// The component eastwards.
    pub east: PathBuf,
    /// The component northwards.
    pub north: PathBuf,
}

impl Default for StartVelocity {
    fn default() -> Self {
        [0.0; 2].into()
    }
}

impl From<[f64; 2]> for StartVelocity {
    fn from(components: [f64; 2]) -> Self {
        Self::Components(components.map(Field::Number))
    }
}

impl<'de> Deserialize<'de> for StartVelocity {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(VelocityVisitor)
    }
}

struct VelocityVisitor;

impl<'de> Visitor<'de> for VelocityVisitor {
    type Value = StartVelocity;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("two numbers or expressions, as in [1.0, \"0.1 * x\"], or rasters, as in { east = \"u.tif\", north = \"v.tif\" }")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut row: A) -> Result<StartVelocity, A::Error> {
        let mut next = |number| {
            row.next_element()?.ok_or_else(|| A::Error::invalid_length(number, &"two components, east and north"))
        };
        Ok(StartVelocity::Components([next(0)?, next(1)?]))
    }

    fn visit_map<A: MapAccess<'de>>(self, table: A) -> Result<StartVelocity, A::Error> {
        VelocityRasters::deserialize(MapAccessDeserializer::new(table)).map(StartVelocity::Rasters)
    }
}
