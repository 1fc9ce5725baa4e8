//! Points and lines at which the water is measured.

use crate::sampling::Sample;
use corpuscle_model::GaugeColumn;
use corpuscle_terrain::Terrain;

/// A point where depth, level and velocity are measured.
#[derive(Debug, Clone)]
pub(crate) struct PointGauge {
    pub name: String,
    pub at: [f64; 2],
}

/// A line through which discharge is measured, positive from its left to its right side.
#[derive(Debug, Clone)]
pub(crate) struct LineGauge {
    pub name: String,
    /// Points along the line with the vector (to the right, as long as the piece it stands for), m.
    pieces: Vec<([f64; 2], [f64; 2])>,
}

impl PointGauge {
    pub fn columns(&self) -> impl Iterator<Item = GaugeColumn> + '_ {
        [("depth", "m"), ("level", "m"), ("velocity_east", "m_per_s"), ("velocity_north", "m_per_s")]
            .into_iter()
            .map(|(quantity, unit)| GaugeColumn { gauge: self.name.clone(), quantity, unit })
    }

    /// Depth, level (the ground's where it is dry) and velocity, of the water there.
    pub fn row(&self, terrain: &Terrain, water: Sample) -> [f64; 4] {
        let [x, y] = self.at;
        let [u, v] = water.velocity;
        [water.depth, terrain.height(x, y) + water.depth, u, v]
    }
}

impl LineGauge {
    /// A line measured every `spacing` m.
    pub fn new(name: String, line: &[[f64; 2]], spacing: f64) -> Self {
        let mut pieces = Vec::new();
        for pair in line.windows(2) {
            let way = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
            let parts = (way[0].hypot(way[1]) / spacing).ceil().max(1.0) as usize;
            pieces.extend((0..parts).map(|part| {
                let along = (part as f64 + 0.5) / parts as f64;
                let right = [way[1] / parts as f64, -way[0] / parts as f64];
                ([pair[0][0] + along * way[0], pair[0][1] + along * way[1]], right)
            }));
        }
        Self { name, pieces }
    }

    pub fn column(&self) -> GaugeColumn {
        GaugeColumn { gauge: self.name.clone(), quantity: "discharge", unit: "m3_per_s" }
    }

    /// The positions that it samples.
    pub fn positions(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.pieces.iter().map(|(at, _)| *at)
    }

    /// Discharge, m3/s, of the water at these positions.
    pub fn discharge(&self, water: &[Sample]) -> f64 {
        let through = |(sample, (_, right)): (&Sample, &([f64; 2], [f64; 2]))| {
            sample.depth * (sample.velocity[0] * right[0] + sample.velocity[1] * right[1])
        };
        water.iter().zip(&self.pieces).map(through).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_northwards_counts_flow_to_the_east_as_positive() {
        let line = LineGauge::new("s".into(), &[[0.0, 0.0], [0.0, 10.0]], 3.0);
        assert_eq!(line.pieces.len(), 4);
        let right: [f64; 2] = [0, 1].map(|axis| line.pieces.iter().map(|piece| piece.1[axis]).sum());
        assert_eq!(right, [10.0, -0.0]);
    }
}
