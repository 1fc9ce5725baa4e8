//! Random rough hills.

use super::noise::Noise;
use super::{bounds, not_negative, positive};
use crate::{Terrain, TerrainError};
use corpuscle_scene::RoughHills;
use rayon::prelude::*;

/// Fractal noise from 0 up to the given relief.
pub(crate) fn make(hills: &RoughHills, seed: u64) -> Result<Terrain, TerrainError> {
    let RoughHills { extent, relief_m, hill_size_m, roughness } = hills.clone();
    let bounds = bounds("rough-hills", &extent)?;
    positive("rough-hills", &[("hill_size_m", hill_size_m)])?;
    not_negative("rough-hills", &[("relief_m", relief_m), ("roughness", roughness)])?;
    let noise = Noise::new(seed, 0);
    // A wave of noise takes two hills' widths; waves shorter than four cells cannot be drawn.
    let finest = 2.0 * extent.cell_m / hill_size_m;
    let raw = |x: f64, y: f64| noise.fractal(x / hill_size_m, y / hill_size_m, roughness, finest);
    let grid = crate::MapGrid::over(bounds, extent.cell_m);
    let (lowest, highest) = (0..grid.columns * grid.rows)
        .into_par_iter()
        .map(|index| {
            let [x, y] = grid.centre(index % grid.columns, index / grid.columns);
            let height = raw(x, y);
            (height, height)
        })
        .reduce(|| (f64::INFINITY, f64::NEG_INFINITY), |a, b| (a.0.min(b.0), a.1.max(b.1)));
    let scale = if highest > lowest { relief_m / (highest - lowest) } else { 0.0 };
    Ok(Terrain::gridded(bounds, extent.cell_m, |x, y| scale * (raw(x, y) - lowest)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relief_is_as_asked_and_the_seed_decides() {
        let hills = RoughHills::default();
        let terrain = make(&hills, 5).unwrap();
        let grid = terrain.map_grid();
        let heights = |terrain: &Terrain| -> Vec<f64> {
            (0..grid.columns * grid.rows)
                .map(|i| {
                    let [x, y] = grid.centre(i % grid.columns, i / grid.columns);
                    terrain.height(x, y)
                })
                .collect()
        };
        let first = heights(&terrain);
        let lowest = first.iter().copied().fold(f64::INFINITY, f64::min);
        let highest = first.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        assert!(lowest.abs() < 1e-9 && (highest - 20.0).abs() < 1e-9, "{lowest} {highest}");
        assert_eq!(first, heights(&make(&hills, 5).unwrap()));
        assert_ne!(first, heights(&make(&hills, 6).unwrap()));
    }
}
