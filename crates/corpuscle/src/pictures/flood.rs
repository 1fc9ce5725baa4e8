//! Pictures of a flood: water on the block of ground.

use super::{Moment, Studio};
use crate::Error;
use corpuscle_drawing::text;
use corpuscle_gpu::Image;
use corpuscle_model::{ParticleSet, Values};
use corpuscle_render::{
    BallStyle, Camera, ColourTable, Drawable, Floor, HeightField, Key, Light, Overlay, Stage, Terrain, natural_colours,
};
use corpuscle_terrain::Terrain as Ground;

/// From where the block of ground is seen, radians: from the south-east, from above; and how wide the lens is.
const DIRECTION: [f64; 2] = [-1.15, 0.6];
const FIELD_OF_VIEW: f64 = 0.5;
const MARGIN: f64 = 0.06;
/// How far the sun stands to the left of the eye, radians.
const SUN: f64 = -1.0;
/// Nodes a side of the drawn ground at most: what a texture can hold everywhere, and a terrain of 4096 x 4096 has.
const MOST_NODES: usize = 4097;
/// Height of the block below its lowest ground, part of its width.
const BASE: f64 = 0.06;
/// Depths from light to dark.
const DEPTHS: [[u8; 3]; 5] =
    [[0xa4, 0xd3, 0xf4], [0x6f, 0xb5, 0xe8], [0x3d, 0x93, 0xd8], [0x1d, 0x6f, 0xbd], [0x0a, 0x2d, 0x63]];

/// Draws a flood.
pub(super) struct FloodPicture {
    stage: Stage,
    ground: Terrain,
    floor: Floor,
    /// The depth that has the last colour, m: the largest so far, so that colours keep their meaning as long as they can.
    deepest: f64,
}

impl FloodPicture {
    pub(super) fn new(studio: &Studio, ground: &Ground) -> Result<Self, Error> {
        let bounds = ground.bounds();
        let grid = ground.map_grid();
        let nodes = [grid.columns, grid.rows].map(|cells| (cells + 1).min(MOST_NODES));
        let (from, to) = ([bounds.x_min, bounds.y_min], [bounds.x_max, bounds.y_max]);
        let field = HeightField::sampled(from, to, nodes, |x, y| ground.height(x, y));
        let [low, high] = field.range();
        let base = low - BASE * (to[0] - from[0]).max(to[1] - from[1]);
        let stage = Stage::new([from[0], from[1], base], [to[0], to[1], high]);
        let colours = natural_colours(&field);
        let ground = Terrain::new(&studio.renderer, &stage, field, &colours, base)?;
        Ok(Self { stage, ground, floor: Floor::new(&studio.renderer, &stage, base), deepest: 0.0 })
    }

    pub(super) fn draw(&mut self, studio: &Studio, title: &str, moment: &Moment<'_>) -> Result<Image, Error> {
        let camera = Camera::orbit(&self.stage, DIRECTION, FIELD_OF_VIEW, studio.aspect(), MARGIN);
        let light = Light::day().from_azimuth(DIRECTION[0] + SUN);
        let all = moment.frame.sets.iter().flat_map(depths);
        self.deepest = all.copied().fold(self.deepest, f64::max);
        let table = ColourTable { low: 0.0, high: self.deepest.max(1e-3) as f32, colours: DEPTHS.to_vec() };
        let balls = moment.frame.sets.iter().flat_map(|set| {
            let depths = depths(set);
            (0..set.len()).map(move |at| (set.position[at], set.radius[at], depths.get(at).copied().unwrap_or(0.0)))
        });
        let mut water = studio.balls.balls(studio.renderer.gpu(), &self.stage, &BallStyle::new(table.clone()), balls);
        let overlay = Overlay {
            title: title.into(),
            time: format!("t = {}", text::time(moment.frame.time)),
            key: Some(Key::Values("Depth of water, m".into(), table)),
            ..Overlay::default()
        };
        let mut things: [&mut dyn Drawable; 3] = [&mut self.ground, &mut self.floor, &mut water];
        studio.take(&self.stage, &camera, &light, &mut things, &overlay)
    }
}

/// Depth at each particle, m; empty where the set has none.
fn depths(set: &ParticleSet) -> &[f64] {
    set.columns.iter().find(|column| column.name == "depth").map_or(&[], |column| match &column.values {
        Values::Scalar(values) => values,
        Values::Vector(_) => &[],
    })
}
