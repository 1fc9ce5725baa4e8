//! Surface of the terrain of a flood: natural colours, a map of the depth, or a picture of the user.

use corpuscle_gpu::Image;
use corpuscle_model::{ParticleSet, Values};
use corpuscle_render::{HeightField, natural_colours};
use std::path::PathBuf;

/// Style of the surface of a flood's terrain.
#[derive(Debug, Clone, Default, PartialEq)]
pub enum GroundStyle {
    /// Meadow, dry grass and rock, with realistic water.
    #[default]
    Natural,
    /// A map of the depth in classes of colour.
    Depth,
    /// A picture, an aerial photo for one: a GeoTIFF, or a PNG file, which covers the ground from corner to corner, north up, or lies where a world
    /// file beside it says.
    Picture(PathBuf),
}

/// Edges between classes, in round numbers: m.
const LADDER: [f64; 17] =
    [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0];
/// From light to dark blue.
const BLUES: [[u8; 3]; 7] = [
    [0xd3, 0xeb, 0xfb],
    [0xa4, 0xd3, 0xf4],
    [0x6f, 0xb5, 0xe8],
    [0x3d, 0x93, 0xd8],
    [0x1d, 0x6f, 0xbd],
    [0x11, 0x4c, 0x93],
    [0x0a, 0x2d, 0x63],
];
/// Weight of the terrain's colour under the depth, and of its hue where it is dry.
const SEEN_THROUGH: f32 = 0.12;
const HUE: f32 = 0.35;
/// Fewest pixels of the map of the depth.
const PIXELS: f64 = 1e6;
/// Least sum of weights of particles at a wet position: as at the shore of realistic water.
const COVERED: f32 = 0.5;
/// Radius over which a particle's depth is averaged, in spacings.
const REACH: f64 = 2.0;

/// Classes of depth and their colours: seven, each edge about twice the one before.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct DepthClasses {
    /// Edges between them, m.
    edges: Vec<f64>,
    /// Least depth that is shown, m.
    least: f64,
}

impl DepthClasses {
    /// Classes for water that is about so deep, m; water shallower than `least`, m, counts as none. They do not follow what is seen, so
    /// that they are the same all through a film.
    pub(super) fn about(depth: f64, least: f64) -> Self {
        let last = LADDER.partition_point(|edge| *edge < 1.5 * depth).clamp(BLUES.len() - 2, LADDER.len() - 1);
        let edges = LADDER[last + 2 - BLUES.len()..=last].to_vec();
        Self { edges, least }
    }

    /// The classes' names and colours, the deepest first.
    pub(super) fn key(&self) -> Vec<(String, [u8; 3])> {
        let name = |class: usize| match (class.checked_sub(1).map(|below| self.edges[below]), self.edges.get(class)) {
            (None, Some(high)) => format!("depth below {high} m"),
            (Some(low), Some(high)) => format!("{low} – {high} m"),
            (low, None) => format!("{} m and more", low.unwrap_or_default()),
        };
        (0..BLUES.len()).rev().map(|class| (name(class), BLUES[class])).collect()
    }

    fn colour(&self, depth: f64) -> Option<[u8; 3]> {
        (depth > self.least).then(|| BLUES[self.edges.partition_point(|edge| *edge <= depth)])
    }

    /// The terrain with a map of the depth of particles over it, between the corners of a field.
    pub(super) fn drape<'a>(&self, field: &HeightField, sets: impl Iterator<Item = &'a ParticleSet>) -> Image {
        let ground = natural_colours(field);
        let [columns, rows] = [ground.width, ground.height].map(f64::from);
        let finer = (PIXELS / (columns * rows)).sqrt().clamp(1.0, 8.0);
        let size = [columns, rows].map(|nodes| (nodes * finer) as usize);
        let mut grid = DepthGrid::new(field, size);
        sets.for_each(|set| grid.add(set));
        let mut rgba = Vec::with_capacity(4 * size[0] * size[1]);
        for row in (0..size[1]).rev() {
            for column in 0..size[0] {
                let at = [(column, size[0], ground.width), (size[1] - 1 - row, size[1], ground.height)]
                    .map(|(at, count, of)| (at * of as usize / count) as u32);
                let [red, green, blue, opacity] = ground.pixel(at[0], at[1]);
                let grey = (0.3 * f32::from(red) + 0.6 * f32::from(green) + 0.1 * f32::from(blue)) * 0.6 + 96.0;
                let dry = [red, green, blue].map(|channel| grey + HUE * (f32::from(channel) - grey));
                let wet = grid.depth(column, row).and_then(|depth| self.colour(depth));
                let colour = match wet {
                    Some(wet) => {
                        std::array::from_fn(|k| f32::from(wet[k]) + SEEN_THROUGH * (dry[k] - f32::from(wet[k])))
                    }
                    None => dry,
                };
                rgba.extend(colour.map(|channel| channel.clamp(0.0, 255.0) as u8));
                rgba.push(opacity);
            }
        }
        Image { width: size[0] as u32, height: size[1] as u32, rgba }
    }
}

/// Depth in pixels: the mean of the particles round each, weighted by poly6.
struct DepthGrid {
    origin: [f64; 2],
    pixel: [f64; 2],
    size: [usize; 2],
    weights: Vec<f32>,
    sums: Vec<f32>,
}

impl DepthGrid {
    fn new(field: &HeightField, size: [usize; 2]) -> Self {
        let pixel = [0, 1].map(|k| field.cell[k] * (field.nodes[k] - 1) as f64 / size[k] as f64);
        let nothing = vec![0.0; size[0] * size[1]];
        Self { origin: field.origin, pixel, size, weights: nothing.clone(), sums: nothing }
    }

    /// Adds the particles of a set that lie on the ground.
    fn add(&mut self, set: &ParticleSet) {
        let Some(Values::Scalar(depths)) =
            set.columns.iter().find(|column| column.name == "depth").map(|column| &column.values)
        else {
            return;
        };
        for ((position, radius), depth) in set.position.iter().zip(&set.radius).zip(depths) {
            if *depth > 0.0 {
                self.add_particle([position[0], position[1]], REACH * 2.0 * radius, *depth as f32);
            }
        }
    }

    fn add_particle(&mut self, position: [f64; 2], reach: f64, depth: f32) {
        let pixels = |axis: usize| {
            let at = |end: f64| (position[axis] + end - self.origin[axis]) / self.pixel[axis];
            (at(-reach).max(0.0) as usize)..(at(reach).ceil().max(0.0) as usize).min(self.size[axis])
        };
        let away = |axis: usize, at: usize| {
            (self.origin[axis] + (at as f64 + 0.5) * self.pixel[axis] - position[axis]) / reach
        };
        for row in pixels(1) {
            let north = away(1, row).powi(2);
            for column in pixels(0) {
                let left = 1.0 - north - away(0, column).powi(2);
                if left > 0.0 {
                    let weight = left.powi(3) as f32;
                    let index = row * self.size[0] + column;
                    self.weights[index] += weight;
                    self.sums[index] += weight * depth;
                }
            }
        }
    }

    /// Depth in a pixel, rows from the south, m; none where it is dry.
    fn depth(&self, column: usize, row: usize) -> Option<f64> {
        let index = row * self.size[0] + column;
        let weight = self.weights[index];
        (weight > COVERED).then(|| f64::from(self.sums[index] / weight))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_model::Column;

    #[test]
    fn classes_double_and_every_depth_has_one() {
        let classes = DepthClasses::about(1.5, 0.01);
        assert_eq!(classes.edges, [0.1, 0.25, 0.5, 1.0, 2.0, 4.0]);
        let key = classes.key();
        assert_eq!((key.len(), key[0].0.as_str(), key[6].0.as_str()), (7, "4 m and more", "depth below 0.1 m"));
        assert_eq!(
            [0.005, 0.05, 0.1, 9.0].map(|depth| classes.colour(depth)),
            [None, Some(BLUES[0]), Some(BLUES[1]), Some(BLUES[6])]
        );
        assert_eq!(DepthClasses::about(1e-6, 0.0).edges[0], LADDER[0]);
        assert_eq!(DepthClasses::about(1e6, 0.0).edges[5], LADDER[16]);
    }

    #[test]
    fn depth_lies_where_the_particles_are() {
        let field = HeightField::sampled([100.0, 50.0], [140.0, 70.0], [41, 21], |_, _| 0.0);
        // Water 0.3 m deep in the western half.
        let position: Vec<[f64; 3]> =
            (0..400).map(|index| [100.5 + f64::from(index % 20), 50.5 + f64::from(index / 20), 0.3]).collect();
        let set = ParticleSet {
            name: "water".into(),
            id: (0..400).collect(),
            velocity: vec![[0.0; 3]; 400],
            radius: vec![0.5; 400],
            mass: vec![300.0; 400],
            columns: vec![Column { name: "depth", unit: "m", values: Values::Scalar(vec![0.3; 400]) }],
            position,
        };
        let image = DepthClasses::about(1.5, 0.01).drape(&field, [&set].into_iter());
        let blue = |part: f64| {
            let [red, _, blue, _] = image.pixel((part * f64::from(image.width)) as u32, image.height / 2);
            i32::from(blue) - i32::from(red) > 60
        };
        assert!([0.05, 0.3, 0.49].into_iter().all(blue));
        assert!(![0.55, 0.8, 0.99].into_iter().any(blue));
    }
}
