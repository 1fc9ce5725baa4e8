//! A flood as a map: the ground with its shades from above, the water as discs coloured by depth.

use super::flood::{blues, depths, height_field};
use super::{Disc, GroundMap, Moment, Sketch, SketchView, Sketcher};
use crate::Error;
use corpuscle_drawing::text;
use corpuscle_flood::usual_depth;
use corpuscle_gpu::Image;
use corpuscle_model::ParticleSet;
use corpuscle_render::{Axes, ColourTable, HeightField, Key, Overlay, Stage, natural_colours};
use corpuscle_scene::Flood;
use corpuscle_terrain::Terrain;
use std::path::Path;

/// Most nodes per side of the ground: what any browser draws.
const MOST_NODES: usize = 1025;
/// Margins for axes and legend: left, right, below and above, parts of the height of the picture.
const MARGINS: [f64; 4] = [0.19, 0.06, 0.2, 0.12];
/// Radius of a disc over that of the particle: discs of neighbours meet.
const RADIUS: f64 = 1.35;
/// The light of the ground's shades: from the north-west, as on maps (Horn 1981).
const LIGHT: [f64; 3] = [-0.5, 0.5, 0.707];

/// Sketches a flood.
pub(crate) struct FloodSketch {
    stage: Stage,
    ground: GroundMap,
    blues: ColourTable,
}

impl FloodSketch {
    pub(crate) fn new(flood: &Flood, terrain: &Terrain) -> Result<Self, Error> {
        let bounds = terrain.bounds();
        let corners = [[bounds.x_min, bounds.y_min], [bounds.x_max, bounds.y_max]];
        let field = height_field(terrain, 1.0, MOST_NODES);
        let [low, high] = field.range();
        let stage = Stage::new([bounds.x_min, bounds.y_min, low], [bounds.x_max, bounds.y_max, high]);
        let blues = blues(usual_depth(flood, terrain, Path::new(""))?);
        Ok(Self { stage, ground: GroundMap { image: shaded(&field), corners }, blues })
    }

    fn discs(&self, set: &ParticleSet) -> Vec<Disc> {
        let depths = depths(set);
        let disc = |at: usize| Disc {
            place: set.position[at],
            radius: RADIUS * set.radius[at],
            colour: self.blues.colour(depths.get(at).copied().unwrap_or(0.0) as f32),
            has_rim: false,
        };
        (0..set.len()).map(disc).collect()
    }
}

impl Sketcher for FloodSketch {
    fn sketch(&mut self, seen: &SketchView, title: &str, moment: &Moment<'_>) -> Sketch {
        let (from, mut to): ([f64; 3], [f64; 3]) = (self.stage.from.into(), self.stage.to.into());
        to[2] = from[2];
        let overlay = Overlay {
            title: title.into(),
            time: format!("t = {}", text::time(moment.frame.time)),
            key: Some(Key::Values("Depth, m".into(), self.blues.clone())),
            axes: Some(Axes { from, to, unit: "m".into(), heights: 1.0 }),
            ..Overlay::default()
        };
        let discs = moment.frame.sets.iter().flat_map(|set| self.discs(set)).collect();
        let camera = seen.plan(&self.stage, MARGINS);
        Sketch { shown: seen.shown(self.stage, camera, overlay), patches: Vec::new(), discs, lines: Vec::new() }
    }

    fn ground(&self) -> Option<GroundMap> {
        Some(self.ground.clone())
    }
}

/// The ground in natural colours, with shades.
fn shaded(field: &HeightField) -> Image {
    let mut image = natural_colours(field);
    let [columns, rows] = field.nodes;
    for (pixel, rgba) in image.rgba.chunks_exact_mut(4).enumerate() {
        let (column, row) = (pixel % columns, rows - 1 - pixel / columns);
        let place = [(0, column), (1, row)].map(|(axis, at)| field.origin[axis] + field.cell[axis] * at as f64);
        let [east, north] = field.slope_at(place);
        let facing = (LIGHT[2] - LIGHT[0] * east - LIGHT[1] * north) / (1.0 + east * east + north * north).sqrt();
        let shade = 0.45 + 0.75 * facing.max(0.0);
        rgba[..3].iter_mut().for_each(|channel| *channel = (f64::from(*channel) * shade).min(255.0) as u8);
    }
    image
}
