//! Pictures of a flood: water on the block of ground.

use super::{Moment, Studio};
use crate::Error;
use corpuscle_drawing::text;
use corpuscle_flood::obstacle_shapes;
use corpuscle_gpu::Image;
use corpuscle_render::{
    Axes, Camera, Drawable, Droplet, Floor, Fluid, FluidStyle, HeightField, Light, Overlay, Solid, SolidStyle, Stage, Terrain,
    Water, WaterSides, natural_colours,
};
use corpuscle_scene::Flood as Settings;
use corpuscle_terrain::Terrain as Ground;
use std::path::Path;

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
/// Height of obstacles that are only said to be high enough, m.
const HIGH_ENOUGH: f64 = 7.0;
/// Colour of buildings.
const WALLS: [u8; 3] = [206, 196, 184];

/// Draws a flood.
pub(super) struct FloodPicture {
    stage: Stage,
    ground: Terrain,
    floor: Floor,
    buildings: Vec<Solid>,
    field: HeightField,
    water: Water,
    sides: WaterSides,
    fluid: Option<Fluid>,
}

impl FloodPicture {
    pub(super) fn new(studio: &Studio, settings: &Settings, ground: &Ground) -> Result<Self, Error> {
        let bounds = ground.bounds();
        let grid = ground.map_grid();
        let nodes = [grid.columns, grid.rows].map(|cells| (cells + 1).min(MOST_NODES));
        let (from, to) = ([bounds.x_min, bounds.y_min], [bounds.x_max, bounds.y_max]);
        let field = HeightField::sampled(from, to, nodes, |x, y| {
            if has_data(ground, [x, y]) { ground.height(x, y) } else { f64::NAN }
        });
        let [low, high] = field.range();
        let base = low - BASE * (to[0] - from[0]).max(to[1] - from[1]);
        // The paths of a scene that was opened are absolute.
        let shapes = obstacle_shapes(settings, ground, Path::new(""), HIGH_ENOUGH)?;
        let roof = shapes.iter().map(|shape| shape.bounds[1][2]).fold(high, f64::max);
        let stage = Stage::new([from[0], from[1], base], [to[0], to[1], roof]);
        let colours = natural_colours(&field);
        let walls = |shape| Solid::new(&studio.renderer, &stage, shape, SolidStyle::Opaque(WALLS, 0.1));
        let buildings = shapes.iter().map(walls).collect();
        let ground = Terrain::new(&studio.renderer, &stage, field.clone(), &colours, base)?;
        Ok(Self {
            stage,
            ground,
            buildings,
            floor: Floor::new(&studio.renderer, &stage, base),
            field,
            water: Water::default(),
            sides: WaterSides::new(&studio.renderer, &stage),
            fluid: None,
        })
    }

    pub(super) fn draw(&mut self, studio: &Studio, title: &str, moment: &Moment<'_>) -> Result<Image, Error> {
        let gpu = studio.renderer.gpu();
        let camera = Camera::orbit(&self.stage, DIRECTION, FIELD_OF_VIEW, studio.aspect(), MARGIN);
        let light = Light::day().from_azimuth(DIRECTION[0] + SUN);
        let sets = || moment.frame.sets.iter().filter(|set| !set.is_empty());
        let radii = || sets().flat_map(|set| &set.radius);
        let mean = radii().sum::<f64>() / radii().count().max(1) as f64;
        let stage = self.stage;
        let within = Some([stage.from, stage.to].map(|corner| [corner.x, corner.y]));
        // Its style is that of the first particles there are, so that it does not change in a film.
        let wet = (mean > 0.0)
            .then(|| FluidStyle { within, ..FluidStyle::water(mean) })
            .map(|style| self.fluid.get_or_insert_with(|| studio.fluids.fluid(gpu, &stage, style)));
        let overlay = Overlay {
            title: title.into(),
            time: format!("t = {}", text::time(moment.frame.time)),
            axes: Some(Axes { from: self.stage.from.into(), to: self.stage.to.into(), unit: "m".into() }),
            ..Overlay::default()
        };
        let droplets: Vec<Droplet> = sets().flat_map(|set| self.water.droplets(moment.frame.time, set)).collect();
        self.sides.fill(gpu, &self.field, &droplets);
        let mut things: Vec<&mut dyn Drawable> = vec![&mut self.ground, &mut self.floor, &mut self.sides];
        things.extend(self.buildings.iter_mut().map(|building| building as &mut dyn Drawable));
        if let Some(fluid) = wet {
            fluid.fill(gpu, droplets);
            things.push(fluid);
        }
        studio.take(&self.stage, &camera, &light, &mut things, &overlay)
    }
}

/// False for places beside a cell of the terrain's own grid in which its file has no data.
fn has_data(ground: &Ground, [x, y]: [f64; 2]) -> bool {
    let grid = ground.map_grid();
    let [column, row] = grid.position(x, y);
    // A place on a line between cells has both beside it.
    let beside =
        |at: f64, count: usize| [at - 0.25, at + 0.25].map(|at| at.round().clamp(0.0, count as f64 - 1.0) as usize);
    let rows = beside(row, grid.rows);
    beside(column, grid.columns).iter().all(|column| rows.iter().all(|row| ground.is_valid_cell(*column, *row)))
}
