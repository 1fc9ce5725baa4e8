//! Upload of tables over time or over a level.

use super::shared::TABLE;
use corpuscle_gpu::to_pair;

/// Tables by number.
#[derive(Default)]
pub(in crate::voronoi) struct Tables {
    /// Rows of each: abscissa, and value.
    all: Vec<Vec<[f64; 2]>>,
}

impl Tables {
    /// Adds a table; returns its number.
    pub fn add(&mut self, rows: impl IntoIterator<Item = [f64; 2]>) -> u32 {
        self.all.push(rows.into_iter().collect());
        self.all.len() as u32 - 1
    }

    pub fn count(&self) -> u32 {
        self.all.len() as u32
    }

    /// The words on the device: a header for each table, then all rows.
    pub fn words(&self) -> Vec<u32> {
        let mut words = vec![0; TABLE as usize * self.all.len()];
        for (number, rows) in self.all.iter().enumerate() {
            let header = TABLE as usize * number;
            words[header] = words.len() as u32;
            words[header + 1] = rows.len() as u32;
            for &[abscissa, value] in rows {
                let [high, low] = to_pair(abscissa);
                words.extend([high, low, value as f32].map(f32::to_bits));
            }
        }
        words
    }
}
