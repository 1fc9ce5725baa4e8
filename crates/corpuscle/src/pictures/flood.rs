//! Pictures of a flood: water on a block of terrain.

use super::ground_picture;
use super::ground_style::DepthClasses;
use super::lines::plates;
use super::times::Times;
use super::{DrawContext, GroundStyle, Moment, OwnView, PictureSettings, Quality, Shown, Subject, WaterColour};
use crate::Error;
use corpuscle_drawing::colour::split;
use corpuscle_drawing::text;
use corpuscle_flood::{line_walls, obstacle_shapes, usual_depth};
use corpuscle_gpu::{DeviceParticles, Gpu, PassTiming};
use corpuscle_model::{ParticleSet, Values};
use corpuscle_render::{
    Axes, BallStyle, Balls, BallsOfDevice, ColourTable, DeviceWater, Drawable, Droplet, Floor, Fluid, FluidStyle,
    HeightField, Key, KeyPosition, Lens, Light, Overlay, Shading, Solid, SolidStyle, Stage, Terrain, ValueOfDevice,
    Water, WaterSides, natural_colours,
};
use corpuscle_scene::Flood;
use std::path::Path;

/// Default azimuth and elevation of the camera (from the south-east, from above), and field of view, radians.
const DIRECTION: [f64; 2] = [-1.15, 0.6];
const OWN_VIEW: OwnView =
    OwnView { direction: DIRECTION, field_of_view: 0.5, margin: 0.06, margins: [0.13, 0.06, 0.2, 0.09] };
/// Azimuth of the sun to the left of the camera, radians.
const SUN: f64 = -1.0;
/// Most nodes per side of the drawn terrain: what any texture can hold, and a terrain of 4096 x 4096 has. Half as many where
/// addresses have 32 bits, as in a page of a browser, which has one thread to prepare them.
const MOST_NODES: usize = if usize::BITS > 32 { 4097 } else { 2049 };
/// Height of the block below its lowest elevation, fraction of its width.
const BASE: f64 = 0.06;
/// Height of obstacles without a crest, m.
pub(super) const HIGH_ENOUGH: f64 = 7.0;
/// Depth that water is made for which is as clear as clear deep water, m, and how turbid other water is at least and at most: a flood
/// of centimetres is muddy, and would not be seen otherwise.
const CLEAR: f64 = 1.5;
const TURBID: [f64; 2] = [0.4, 20.0];
/// Colours of shallow to deep water at simple quality.
const BLUES: [u32; 4] = [0x00bfe3f7, 0x006fb5e8, 0x001d6fbd, 0x000a2d63];
/// Drawn thickness of walls of no thickness, fraction of the longer side of the terrain.
const LINE_WIDTH: f64 = 0.003;
/// Colour of obstacles.
pub(super) const WALLS: [u8; 3] = [206, 196, 184];
/// So many obstacles are a town, whose buildings have roofs and windows.
const TOWN: usize = 4;
/// Colours of walls and of roofs in a town.
const PLASTER: [[u8; 3]; 5] = [[214, 204, 188], [198, 178, 150], [178, 132, 106], [196, 198, 196], [222, 214, 202]];
const ROOFS: [[u8; 3]; 3] = [[150, 84, 62], [122, 116, 112], [134, 96, 76]];

/// Draws a flood.
pub(crate) struct FloodPicture {
    stage: Stage,
    ground: Terrain,
    floor: Floor,
    buildings: Vec<Solid>,
    field: HeightField,
    water: Water,
    /// Water from particles in GPU memory, once there were any.
    pub(super) device_water: Option<DeviceWater>,
    /// Times of the passes, where they are measured.
    pub(super) times: Option<Times>,
    sides: WaterSides,
    pub(super) fluid: Option<Fluid>,
    /// True where compute shaders draw the particles.
    splats: bool,
    /// Turbidity of the water over that of clear deep water.
    turbid: f64,
    /// Classes of the map of the depth, where one is drawn.
    depth: Option<DepthClasses>,
    /// The colours of depth at simple quality.
    blues: ColourTable,
    /// Exaggeration of heights.
    heights: f64,
    water_colour: WaterColour,
    light: Light,
}

impl Subject for FloodPicture {
    fn draw(&mut self, context: &DrawContext, title: &str, moment: &Moment<'_>) -> Result<Shown, Error> {
        let gpu = context.renderer.gpu();
        let camera = context.camera(&self.stage, &OWN_VIEW, moment.frame.time);
        let is_plan = matches!(camera.lens, Lens::Orthographic { .. });
        let light = context.lit(self.light);
        let is_of_frame = |set: &&ParticleSet| !set.is_empty() && (moment.on_device.is_none() || self.depth.is_some());
        let sets: Vec<ParticleSet> =
            moment.frame.sets.iter().filter(is_of_frame).map(|set| raised(set, self.heights)).collect();
        let overlay = self.overlay(context, title, moment, is_plan);
        if let Some(depth) = &self.depth {
            self.ground.drape(gpu, &depth.drape(&self.field, sets.iter()))?;
        }
        let mut discs: Vec<Balls> = match (context.quality, moment.on_device) {
            (Quality::Full, _) => Vec::new(),
            _ if self.depth.is_some() => Vec::new(),
            (Quality::Simple, Some(particles)) => vec![self.discs_of_device(context, particles)?],
            (Quality::Simple, None) => sets.iter().map(|set| self.discs(context, set)).collect(),
        };
        let is_wet =
            self.depth.is_none() && context.quality == Quality::Full && self.fill_water(context, moment, &sets)?;
        let quick = context.quality == Quality::Simple;
        self.ground.draw_quickly(quick);
        let mut things: Vec<&mut dyn Drawable> = vec![&mut self.ground];
        if !is_plan && !quick && !context.target.transparent {
            things.push(&mut self.floor);
        }
        things.extend(self.buildings.iter_mut().map(|building| building as &mut dyn Drawable));
        things.extend(discs.iter_mut().map(|set| set as &mut dyn Drawable));
        if let Some(fluid) = self.fluid.as_mut().filter(|_| is_wet) {
            things.extend([&mut self.sides as &mut dyn Drawable, fluid]);
        }
        let shown = context.take(&self.stage, &camera, &light, &mut things, overlay)?;
        self.note_times();
        Ok(shown)
    }

    /// Not where the terrain shows a map of the depth: the host draws that.
    fn draws_from_device(&self) -> bool {
        self.depth.is_none()
    }

    fn shows_glances(&self) -> bool {
        self.depth.is_none()
    }

    fn splat(&mut self) {
        self.splats = true;
    }

    fn measure(&mut self, gpu: &Gpu) {
        self.measure_passes(gpu);
    }

    fn taken(&self) -> Vec<(&'static str, PassTiming)> {
        self.taken_by_passes()
    }
}

impl FloodPicture {
    pub(crate) fn new(
        context: &DrawContext,
        settings: &Flood,
        ground: &corpuscle_terrain::Terrain,
        drawn: HeightField,
        picture: &PictureSettings,
    ) -> Result<Self, Error> {
        let PictureSettings { ground: ground_style, heights, .. } = picture;
        let heights = *heights;
        let bounds = ground.bounds();
        let (from, to) = ([bounds.x_min, bounds.y_min], [bounds.x_max, bounds.y_max]);
        let field = raised_ground(drawn, heights);
        let [low, high] = field.range();
        let base = low - BASE * (to[0] - from[0]).max(to[1] - from[1]);
        // The paths of a scene that was opened are absolute.
        let shapes = obstacle_shapes(settings, ground, Path::new(""), HIGH_ENOUGH)?;
        let lines = line_walls(settings, ground, HIGH_ENOUGH)?;
        let tops = lines.iter().flat_map(|line| line.crest.map(|crest| heights * crest));
        let roof = shapes.iter().map(|shape| shape.bounds[1][2]).chain(tops).fold(high, f64::max);
        let stage = Stage::new([from[0], from[1], base], [to[0], to[1], roof]);
        let colours = natural_colours(&field);
        let is_town = shapes.len() >= TOWN;
        let solid = |(number, shape)| Solid::new(&context.renderer, &stage, shape, style(number, is_town));
        let mut buildings: Vec<Solid> = shapes.iter().enumerate().map(solid).collect();
        if !lines.is_empty() {
            let thickness = LINE_WIDTH * (to[0] - from[0]).max(to[1] - from[1]);
            let corners = plates(&lines, thickness, heights);
            buildings.push(Solid::of_corners(&context.renderer, &stage, &corners, SolidStyle::Opaque(WALLS, 0.1)));
        }
        let mut mesh = Terrain::new(&context.renderer, &stage, field.clone(), &colours, base)?;
        if let GroundStyle::Picture(path) = ground_style {
            mesh.drape(context.renderer.gpu(), &ground_picture(path, ground, &colours)?)?;
        }
        let depth = usual_depth(settings, ground, Path::new(""))?;
        Ok(Self {
            stage,
            ground: mesh,
            buildings,
            floor: Floor::new(&context.renderer, base),
            field,
            water: Water::default(),
            device_water: None,
            times: None,
            sides: WaterSides::new(&context.renderer, &stage),
            fluid: None,
            splats: false,
            turbid: (CLEAR / depth).clamp(TURBID[0], TURBID[1]),
            depth: (*ground_style == GroundStyle::Depth).then(|| DepthClasses::about(depth, settings.wet_depth_m)),
            blues: blues(depth),
            heights,
            water_colour: picture.water,
            light: picture.sun.light(Light::day(), DIRECTION[0] + SUN, ground)?,
        })
    }

    /// Updates the water to a moment, from these sets where it is not in GPU memory; false where there is none.
    fn fill_water(&mut self, context: &DrawContext, moment: &Moment<'_>, sets: &[ParticleSet]) -> Result<bool, Error> {
        let spacing = moment.on_device.map(|particles| particles.spacing);
        let radius = spacing.map(|spacing| 0.5 * spacing).or_else(|| mean_radius(sets));
        let Self { stage, field, .. } = self;
        let (gpu, time) = (context.renderer.gpu(), moment.frame.time);
        let within = Some([stage.from, stage.to].map(|corner| [corner.x, corner.y]));
        let style = |radius| FluidStyle { within, ..self.water_colour.style(radius).turbid(self.turbid) };
        // Its style is that of the first particles there are, so that it does not change in a film. Where all have gone the ground is still wet.
        let fluid = match (&mut self.fluid, radius) {
            (Some(fluid), _) => fluid,
            (none, Some(radius)) => none.insert(context.fluids.fluid(gpu, stage, style(radius))?),
            (None, None) => return Ok(false),
        };
        fluid.splat(self.splats);
        fluid.set_time(gpu, time);
        if let Some(particles) = moment.on_device {
            let water = match &mut self.device_water {
                Some(water) => water,
                none => none.insert(DeviceWater::new(gpu, stage, field, self.heights)?),
            };
            water.update(gpu, time, particles)?;
            self.sides.draw_from(water);
            fluid.draw_from(water);
        } else {
            let water = &mut self.water;
            let droplets: Vec<Droplet> =
                sets.iter().flat_map(|set| water.droplets(time, set, |position| field.slope_at(position))).collect();
            self.sides.fill(gpu, field, &droplets);
            fluid.fill(gpu, droplets);
        }
        Ok(true)
    }

    fn disc_style(&self) -> BallStyle {
        BallStyle { shading: Shading::Matt, ..BallStyle::new(self.blues.clone()) }
    }

    /// Particles in GPU memory as balls, coloured by depth as maps are.
    fn discs_of_device(&self, context: &DrawContext, particles: &DeviceParticles) -> Result<Balls, Error> {
        let shows = BallsOfDevice { radius: 0.5, raise: self.heights, value: ValueOfDevice::Depth };
        let gpu = context.renderer.gpu();
        Ok(context.balls.balls_of_device(gpu, &self.stage, &self.disc_style(), particles, shows)?)
    }

    /// Particles as balls, coloured by depth as maps are.
    fn discs(&self, context: &DrawContext, set: &ParticleSet) -> Balls {
        let style = self.disc_style();
        let depths = depths(set);
        let depth = |at: usize| depths.get(at).copied().unwrap_or(0.0);
        let balls = (0..set.len()).map(|at| (set.position[at], set.radius[at], depth(at)));
        context.balls.balls(context.renderer.gpu(), &self.stage, &style, balls)
    }

    fn overlay(&self, context: &DrawContext, title: &str, moment: &Moment<'_>, is_plan: bool) -> Overlay {
        let time = format!("t = {}", text::time(moment.frame.time));
        let (from, mut to): ([f64; 3], [f64; 3]) = (self.stage.from.into(), self.stage.to.into());
        if is_plan {
            to[2] = from[2];
        }
        let axes = || Axes { from, to, unit: "m".into(), heights: self.heights };
        let blues = || Key::Values("Depth, m".into(), self.blues.clone());
        let simple = (context.quality == Quality::Simple).then(blues);
        let key = self.depth.as_ref().map(|depth| Key::Kinds(depth.key())).or(simple);
        Overlay {
            title: title.into(),
            time: if self.heights == 1.0 { time } else { format!("{time}, heights × {}", self.heights) },
            key,
            scale_bar: Some("m".into()),
            north: is_plan || context.north,
            axes: context.shows_all().then(axes),
            key_position: if is_plan { KeyPosition::Below } else { KeyPosition::Corner },
            ..Overlay::default()
        }
    }
}

/// Heights of the ground as drawn: at the nodes of its own grid, at most so many a side.
pub(super) fn drawn_ground(ground: &corpuscle_terrain::Terrain) -> HeightField {
    let grid = ground.map_grid();
    sampled(ground, [grid.columns, grid.rows].map(|cells| (cells + 1).min(MOST_NODES)))
}

/// Ground so many times as high as it is.
fn raised_ground(mut ground: HeightField, times: f64) -> HeightField {
    if times != 1.0 {
        ground.heights.iter_mut().for_each(|height| *height = (times * f64::from(*height)) as f32);
    }
    ground
}

/// Heights of the ground at so many nodes `[eastwards, northwards]`.
pub(super) fn sampled(ground: &corpuscle_terrain::Terrain, nodes: [usize; 2]) -> HeightField {
    let bounds = ground.bounds();
    let nodes = nodes.map(|count| count.max(2));
    let [width, height] = bounds.size();
    let cell = [width / (nodes[0] - 1) as f64, height / (nodes[1] - 1) as f64];
    let mut field =
        HeightField { origin: [bounds.x_min, bounds.y_min], cell, nodes, heights: ground.heights_on(nodes) };
    if ground.has_holes() {
        for index in 0..field.heights.len() {
            if !has_data(ground, field.position(index)) {
                field.heights[index] = f32::NAN;
            }
        }
    }
    field
}

/// The colours of shallow to deep water, which is about so deep, m.
pub(super) fn blues(depth: f64) -> ColourTable {
    ColourTable { low: 0.0, high: 2.0 * depth as f32, colours: BLUES.map(split).to_vec() }
}

/// Depths of the particles of a set, m.
pub(super) fn depths(set: &ParticleSet) -> &[f64] {
    match set.columns.iter().find(|column| column.name == "depth").map(|column| &column.values) {
        Some(Values::Scalar(depths)) => depths,
        _ => &[],
    }
}

/// Style of an obstacle by its number.
fn style(number: usize, is_town: bool) -> SolidStyle {
    // Multiplied by the golden ratio numbers are spread evenly (Knuth, The Art of Computer Programming 3, 6.4).
    let spread = (number as u32).wrapping_mul(2_654_435_769) >> 16;
    let of = |colours: &[[u8; 3]], spread: u32| colours[spread as usize % colours.len()];
    if is_town {
        SolidStyle::Building(of(&PLASTER, spread), of(&ROOFS, spread / 16))
    } else {
        SolidStyle::Opaque(WALLS, 0.1)
    }
}

/// Mean radius of the particles, m; none where there are none.
fn mean_radius(sets: &[ParticleSet]) -> Option<f64> {
    let radii = || sets.iter().flat_map(|set| &set.radius);
    (!sets.is_empty()).then(|| radii().sum::<f64>() / radii().count() as f64)
}

/// Particles with exaggerated heights.
fn raised(set: &ParticleSet, times: f64) -> ParticleSet {
    let mut set = set.clone();
    set.position.iter_mut().for_each(|position| position[2] *= times);
    set
}

/// False for positions in or beside a cell of the terrain's own grid without data.
fn has_data(ground: &corpuscle_terrain::Terrain, [x, y]: [f64; 2]) -> bool {
    let grid = ground.map_grid();
    let [column, row] = grid.position(x, y);
    // A position on a line between cells belongs to both.
    let beside =
        |at: f64, count: usize| [at - 0.25, at + 0.25].map(|at| at.round().clamp(0.0, count as f64 - 1.0) as usize);
    let rows = beside(row, grid.rows);
    beside(column, grid.columns).iter().all(|column| rows.iter().all(|row| ground.is_valid_cell(*column, *row)))
}
