//! The velocity of a sheared gas over its height.

use super::Snapshot;
use serde::{Deserialize, Serialize};

/// Sums over balls in layers along y.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Flow {
    /// Velocity along x, and number.
    layers: Vec<[f64; 2]>,
}

impl Flow {
    pub fn new(layers: usize) -> Self {
        Flow { layers: vec![[0.0; 2]; layers] }
    }

    pub fn count<const D: usize>(&mut self, snapshot: &Snapshot<D>) {
        let [low, high] = snapshot.extent[1];
        let layers = self.layers.len();
        for (position, velocity) in snapshot.position.iter().zip(&snapshot.velocity) {
            let part = ((position[1] - low) / (high - low) * layers as f64).max(0.0) as usize;
            let layer = &mut self.layers[part.min(layers - 1)];
            layer[0] += velocity[0];
            layer[1] += 1.0;
        }
    }

    /// Middle of each layer and the mean velocity in it.
    pub fn profile(&self, [low, high]: [f64; 2]) -> Vec<[f64; 2]> {
        let height = (high - low) / self.layers.len() as f64;
        let point = |(layer, sums): (usize, &[f64; 2])| [low + (layer as f64 + 0.5) * height, sums[0] / sums[1]];
        self.layers.iter().enumerate().filter(|(_, sums)| sums[1] > 0.0).map(point).collect()
    }
}
