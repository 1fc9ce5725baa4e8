//! Which tiles of the ground are drawn, and how finely.
//!
//! A tile has 64 x 64 quads. Beginning with one tile over all, each is cut into four as long as its quads are seen larger than a few
//! samples. So the number of quads follows the picture, not the terrain.

use super::HeightField;
use crate::shared::{QUADS, TileInstance};
use crate::{Camera, Lens, Stage};
use glam::DVec3;

/// Indices of the triangles of a tile with its skirt.
pub(super) const INDICES: u32 = 6 * QUADS * QUADS + 4 * 6 * QUADS;
/// A quad may be seen so large, samples; and one of a tile at the border, where the upright sides end at the finest nodes.
const LARGEST: f64 = 4.0;
const LARGEST_AT_BORDER: f64 = 1.5;

/// Corners of the triangles of a tile: its quads, then those of the skirt round it.
pub(super) fn indices() -> Vec<u32> {
    let side = QUADS + 1;
    let mut all = Vec::with_capacity(INDICES as usize);
    let mut quad = |a: u32, b: u32, c: u32, d: u32| all.extend([a, b, c, c, b, d]);
    for row in 0..QUADS {
        for column in 0..QUADS {
            let first = row * side + column;
            quad(first, first + 1, first + side, first + side + 1);
        }
    }
    // South, north, west, east.
    for edge in 0..4 {
        let surface = |along: u32| match edge {
            0 => along,
            1 => QUADS * side + along,
            2 => along * side,
            _ => along * side + QUADS,
        };
        let skirt = side * side + edge * side;
        (0..QUADS).for_each(|at| quad(surface(at), surface(at + 1), skirt + at, skirt + at + 1));
    }
    all
}

/// The tiles for a picture of `size` samples.
pub(super) fn choose(field: &HeightField, stage: &Stage, camera: &Camera, size: [u32; 2]) -> Vec<TileInstance> {
    let quads = field.nodes.map(|count| count as u32 - 1);
    let mut stride = 1;
    while stride * QUADS < quads[0].max(quads[1]) {
        stride *= 2;
    }
    let mut chosen = Vec::new();
    let mut open = vec![TileInstance { first: [0, 0], stride, unused: 0 }];
    while let Some(tile) = open.pop() {
        let TileInstance { first: [column, row], stride, .. } = tile;
        if column >= quads[0] || row >= quads[1] {
            continue;
        }
        let is_border =
            column == 0 || row == 0 || column + QUADS * stride >= quads[0] || row + QUADS * stride >= quads[1];
        let largest = if is_border { LARGEST_AT_BORDER } else { LARGEST };
        if stride == 1 || seen_size(field, stage, camera, size, tile) <= largest {
            chosen.push(tile);
        } else {
            let half = stride / 2;
            let middle = half * QUADS;
            let quarter = |[x, y]: [u32; 2]| TileInstance { first: [column + x, row + y], stride: half, unused: 0 };
            open.extend([[0, 0], [middle, 0], [0, middle], [middle, middle]].map(quarter));
        }
    }
    chosen
}

/// How large the quads of a tile are seen at most, samples.
fn seen_size(
    field: &HeightField,
    stage: &Stage,
    camera: &Camera,
    size: [u32; 2],
    TileInstance { first: [column, row], stride, .. }: TileInstance,
) -> f64 {
    let length = field.cell[0].max(field.cell[1]) * f64::from(stride);
    match camera.lens {
        Lens::Orthographic { height } => length / height * f64::from(size[1]),
        Lens::Perspective { field_of_view } => {
            let span = f64::from(QUADS * stride);
            let from = [0, 1].map(|k| field.origin[k] + field.cell[k] * f64::from([column, row][k]));
            let to = [0, 1].map(|k| from[k] + field.cell[k] * span);
            let nearest = DVec3::new(
                camera.eye.x.clamp(from[0], to[0]),
                camera.eye.y.clamp(from[1], to[1]),
                camera.eye.z.clamp(stage.from.z, stage.to.z),
            );
            let distance = (camera.eye - nearest).length().max(1e-9);
            length / (2.0 * distance * (0.5 * field_of_view).tan()) * f64::from(size[1])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square field of `quads` x `quads` quads of 1 m.
    fn field(quads: usize) -> HeightField {
        HeightField { origin: [0.0; 2], cell: [1.0; 2], nodes: [quads + 1; 2], heights: vec![0.0; (quads + 1).pow(2)] }
    }

    #[test]
    fn tiles_cover_every_quad_once() {
        let field = field(300);
        let stage = Stage::new([0.0; 3], [300.0, 300.0, 1.0]);
        let camera = Camera::orbit(&stage, [0.3, 0.2], 0.6, 1.5, 0.0);
        let mut covered = vec![0_u8; 300 * 300];
        for TileInstance { first: [column, row], stride, .. } in choose(&field, &stage, &camera, [600, 400]) {
            for y in row..(row + 64 * stride).min(300) {
                for x in column..(column + 64 * stride).min(300) {
                    covered[(y * 300 + x) as usize] += 1;
                }
            }
        }
        assert!(covered.iter().all(|times| *times == 1));
    }

    #[test]
    fn a_large_terrain_has_no_more_quads_than_the_picture_needs() {
        let field = field(4096);
        let stage = Stage::new([0.0; 3], [4096.0, 4096.0, 400.0]);
        let camera = Camera::orbit(&stage, [1.0, 0.5], 0.6, 1.8, 0.0);
        let tiles = choose(&field, &stage, &camera, [1920, 1080]);
        assert!((40..400).contains(&tiles.len()), "{}", tiles.len());
        assert_eq!(indices().len(), INDICES as usize);
    }
}
