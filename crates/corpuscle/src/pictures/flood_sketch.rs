//! A flood as a map: the ground with its shades from above, the water as discs coloured by depth.

use super::flood::{HIGH_ENOUGH, WALLS, blues, depths, sampled};
use super::{Disc, GroundMap, Moment, Sketch, SketchView, Sketcher};
use crate::Error;
use corpuscle_drawing::text;
use corpuscle_flood::{LineWall, line_walls, obstacle_shapes, usual_depth};
use corpuscle_gpu::Image;
use corpuscle_model::{ParticleSet, SolidShape};
use corpuscle_render::{Axes, ColourTable, HeightField, Key, Overlay, Stage, natural_colours};
use corpuscle_scene::Flood;
use corpuscle_terrain::Terrain;
use std::path::Path;

/// Nodes of the longer side of the ground: enough for obstacles on few cells, and what any browser draws.
const NODES: [usize; 2] = [513, 1025];
/// Part of the colour of an obstacle that its outline has.
const OUTLINE: f64 = 0.6;
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
        let field = sampled(terrain, nodes(terrain));
        let [low, high] = field.range();
        let mut image = shaded(&field);
        // The paths of a scene that was opened are absolute.
        for shape in obstacle_shapes(flood, terrain, Path::new(""), HIGH_ENOUGH)? {
            paint(&mut image, &field, &shape);
        }
        for line in line_walls(flood, terrain, HIGH_ENOUGH)? {
            paint_line(&mut image, &field, &line);
        }
        let stage = Stage::new([bounds.x_min, bounds.y_min, low], [bounds.x_max, bounds.y_max, high]);
        let blues = blues(usual_depth(flood, terrain, Path::new(""))?);
        Ok(Self { stage, ground: GroundMap { image, corners }, blues })
    }

    fn discs(&self, set: &ParticleSet) -> Vec<Disc> {
        let depths = depths(set);
        let disc = |at: usize| Disc {
            position: set.position[at],
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

/// Nodes of the ground `[eastwards, northwards]`, about as far apart both ways.
fn nodes(terrain: &Terrain) -> [usize; 2] {
    let (bounds, grid) = (terrain.bounds(), terrain.map_grid());
    let longer = (grid.columns.max(grid.rows) + 1).clamp(NODES[0], NODES[1]);
    let apart = bounds.size().into_iter().fold(0.0, f64::max) / (longer - 1) as f64;
    bounds.size().map(|length| (length / apart).round() as usize + 1).map(|nodes| nodes.max(2))
}

/// Paints a colour over the pixel of a node; nothing beyond the image.
fn put(image: &mut Image, [column, row]: [i64; 2], shade: f64) {
    let [columns, rows] = [image.width, image.height].map(i64::from);
    if (0..columns).contains(&column) && (0..rows).contains(&row) {
        let pixel = 4 * ((rows - 1 - row) * columns + column) as usize;
        let colour = WALLS.map(|channel| (f64::from(channel) * shade) as u8);
        image.rgba[pixel..pixel + 3].copy_from_slice(&colour);
    }
}

/// The node nearest to a position.
fn node(field: &HeightField, position: [f64; 2]) -> [i64; 2] {
    [0, 1].map(|axis| ((position[axis] - field.origin[axis]) / field.cell[axis]).round() as i64)
}

/// Paints an obstacle from above, with its outline.
fn paint(image: &mut Image, field: &HeightField, shape: &SolidShape) {
    let [low, high] = shape.bounds;
    let height = 0.5 * (low[2] + high[2]);
    let [from, to] = [[low[0], low[1]], [high[0], high[1]]].map(|corner| node(field, corner));
    let is_inside = |column: i64, row: i64| {
        let [x, y] = [(0, column), (1, row)].map(|(axis, at)| field.origin[axis] + field.cell[axis] * at as f64);
        (shape.distance)([x, y, height]) <= 0.0
    };
    for row in from[1]..=to[1] {
        for column in from[0]..=to[0] {
            if is_inside(column, row) {
                let round = [(1, 0), (-1, 0), (0, 1), (0, -1)];
                let is_amid = round.iter().all(|(east, north)| is_inside(column + east, row + north));
                put(image, [column, row], if is_amid { 1.0 } else { OUTLINE });
            }
        }
    }
}

/// Paints a wall of no thickness.
fn paint_line(image: &mut Image, field: &HeightField, wall: &LineWall) {
    let [from, to] = wall.ends;
    let steps = [0, 1].map(|axis| ((to[axis] - from[axis]) / field.cell[axis]).abs());
    let count = (2.0 * steps[0].max(steps[1])).ceil().max(1.0);
    for step in 0..=count as usize {
        let part = step as f64 / count;
        let [column, row] = node(field, [0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis])));
        [[0, 0], [1, 0], [0, 1]]
            .into_iter()
            .for_each(|[east, north]| put(image, [column + east, row + north], OUTLINE));
    }
}

/// The ground in natural colours, with shades.
fn shaded(field: &HeightField) -> Image {
    let mut image = natural_colours(field);
    let [columns, rows] = field.nodes;
    for (pixel, rgba) in image.rgba.chunks_exact_mut(4).enumerate() {
        let (column, row) = (pixel % columns, rows - 1 - pixel / columns);
        let position = [(0, column), (1, row)].map(|(axis, at)| field.origin[axis] + field.cell[axis] * at as f64);
        let [east, north] = field.slope_at(position);
        let facing = (LIGHT[2] - LIGHT[0] * east - LIGHT[1] * north) / (1.0 + east * east + north * north).sqrt();
        let shade = 0.45 + 0.75 * facing.max(0.0);
        rgba[..3].iter_mut().for_each(|channel| *channel = (f64::from(*channel) * shade).min(255.0) as u8);
    }
    image
}
