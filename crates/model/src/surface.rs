//! The surface of a solid, patch by patch.

use crate::Column;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::Arc;

/// The surface of a solid as square patches, with what is known of each. Serialised it is without the solid itself.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Surface {
    /// Name of the solid.
    pub name: String,
    /// Middle of each patch, m.
    pub position: Vec<[f64; 3]>,
    /// The way out of the solid at each patch.
    pub normal: Vec<[f64; 3]>,
    /// Half the side of each patch, m.
    pub half_width: Vec<f64>,
    /// What is known of the patches; every column has one entry for each.
    pub columns: Vec<Column>,
    /// The solid itself, to be drawn.
    #[serde(skip)]
    pub shape: SolidShape,
}

impl Surface {
    /// A column of numbers by its name.
    pub fn scalar(&self, name: &str) -> Option<&[f64]> {
        self.columns.iter().find(|column| column.name == name).and_then(|column| match &column.values {
            crate::Values::Scalar(values) => Some(values.as_slice()),
            crate::Values::Vector(_) => None,
        })
    }
}

/// Where a solid is.
#[derive(Clone)]
pub struct SolidShape {
    /// Its smallest and largest coordinates, m.
    pub bounds: [[f64; 3]; 2],
    /// Distance from its surface, m, negative inside; outside never more than the true one.
    pub distance: Distance,
}

impl Default for SolidShape {
    /// No solid.
    fn default() -> Self {
        Self { bounds: [[0.0; 3]; 2], distance: Arc::new(|_| f64::INFINITY) }
    }
}

/// A signed distance, m, by place.
pub type Distance = Arc<dyn Fn([f64; 3]) -> f64 + Send + Sync>;

impl fmt::Debug for SolidShape {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("SolidShape").field("bounds", &self.bounds).finish_non_exhaustive()
    }
}
