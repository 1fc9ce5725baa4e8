//! Pictures of a flood: water on the block of ground.

use super::ground_style::{self, DepthClasses};
use super::lines::plates;
use super::times::Times;
use super::{GroundStyle, Moment, OwnView, Quality, Shown, Studio, Subject};
use crate::Error;
use corpuscle_drawing::colour::split;
use corpuscle_drawing::text;
use corpuscle_flood::{line_walls, obstacle_shapes, usual_depth};
use corpuscle_gpu::{DeviceParticles, Gpu, PassTiming};
use corpuscle_model::{ParticleSet, Values};
use corpuscle_render::{
    Axes, BallStyle, Balls, BallsOfDevice, ColourTable, DeviceWater, Drawable, Droplet, Floor, Fluid, FluidStyle,
    HeightField, Key, KeyPlace, Lens, Light, Overlay, Shading, Solid, SolidStyle, Stage, Terrain, ValueOfDevice, Water,
    WaterSides, natural_colours,
};
use corpuscle_scene::Flood as Settings;
use corpuscle_terrain::Terrain as Ground;
use std::path::Path;

/// From where the block of ground is seen, radians: from the south-east, from above; and how wide the lens is.
const DIRECTION: [f64; 2] = [-1.15, 0.6];
const OWN_VIEW: OwnView =
    OwnView { direction: DIRECTION, field_of_view: 0.5, margin: 0.06, margins: [0.13, 0.06, 0.2, 0.09] };
/// How far the sun stands to the left of the eye, radians.
const SUN: f64 = -1.0;
/// Nodes a side of the drawn ground at most: what a texture can hold everywhere, and a terrain of 4096 x 4096 has.
const MOST_NODES: usize = 4097;
/// Height of the block below its lowest ground, part of its width.
const BASE: f64 = 0.06;
/// Height of obstacles that are only said to be high enough, m.
const HIGH_ENOUGH: f64 = 7.0;
/// Depth that water is made for which is as clear as clear deep water, m, and how turbid other water is at least and at most: a flood
/// of centimetres is muddy, and would not be seen otherwise.
const CLEAR: f64 = 1.5;
const TURBID: [f64; 2] = [0.4, 20.0];
/// Colours of shallow to deep water in the simple look.
const BLUES: [u32; 4] = [0x00bfe3f7, 0x006fb5e8, 0x001d6fbd, 0x000a2d63];
/// Walls of no thickness are drawn so thick, as a part of the longer side of the terrain.
const LINE_WIDTH: f64 = 0.003;
/// Colour of buildings.
const WALLS: [u8; 3] = [206, 196, 184];

/// Draws a flood.
pub(crate) struct FloodPicture {
    stage: Stage,
    ground: Terrain,
    floor: Floor,
    buildings: Vec<Solid>,
    field: HeightField,
    water: Water,
    /// Of particles that lie on the device, once there were any.
    pub(super) device_water: Option<DeviceWater>,
    /// Where passes are timed, what they have taken.
    pub(super) times: Option<Times>,
    sides: WaterSides,
    pub(super) fluid: Option<Fluid>,
    /// Whether compute shaders draw its particles.
    splats: bool,
    /// How many times clearer or more turbid the water is than clear deep water.
    turbid: f64,
    /// Where depth is drawn as a map has it, its classes.
    depth: Option<DepthClasses>,
    /// The colours of depth in the simple look.
    blues: ColourTable,
    /// How many times higher than they are heights are drawn.
    heights: f64,
}

impl Subject for FloodPicture {
    fn draw(&mut self, studio: &Studio, title: &str, moment: &Moment<'_>) -> Result<Shown, Error> {
        let gpu = studio.renderer.gpu();
        let camera = studio.camera(&self.stage, &OWN_VIEW, moment.frame.time);
        let is_plan = matches!(camera.lens, Lens::Orthographic { .. });
        let light = studio.lit(Light::day().from_azimuth(DIRECTION[0] + SUN));
        let is_of_frame = |set: &&ParticleSet| !set.is_empty() && (moment.on_device.is_none() || self.depth.is_some());
        let sets: Vec<ParticleSet> =
            moment.frame.sets.iter().filter(is_of_frame).map(|set| raised(set, self.heights)).collect();
        let overlay = self.overlay(studio, title, moment, is_plan);
        if let Some(depth) = &self.depth {
            self.ground.drape(gpu, &depth.drape(&self.field, sets.iter()))?;
        }
        let mut discs: Vec<Balls> = match (studio.quality, moment.on_device) {
            (Quality::Full, _) => Vec::new(),
            _ if self.depth.is_some() => Vec::new(),
            (Quality::Simple, Some(particles)) => vec![self.discs_of_device(studio, particles)?],
            (Quality::Simple, None) => sets.iter().map(|set| self.discs(studio, set)).collect(),
        };
        let is_wet =
            self.depth.is_none() && studio.quality == Quality::Full && self.fill_water(studio, moment, &sets)?;
        let quick = studio.quality == Quality::Simple;
        self.ground.draw_quickly(quick);
        let mut things: Vec<&mut dyn Drawable> = vec![&mut self.ground];
        if !is_plan && !quick {
            things.push(&mut self.floor);
        }
        things.extend(self.buildings.iter_mut().map(|building| building as &mut dyn Drawable));
        things.extend(discs.iter_mut().map(|set| set as &mut dyn Drawable));
        if let Some(fluid) = self.fluid.as_mut().filter(|_| is_wet) {
            things.extend([&mut self.sides as &mut dyn Drawable, fluid]);
        }
        let shown = studio.take(&self.stage, &camera, &light, &mut things, overlay)?;
        self.note_times();
        Ok(shown)
    }

    /// Not where the ground shows the water's depth in place of the water: that is the host's to draw.
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
        studio: &Studio,
        settings: &Settings,
        ground: &Ground,
        ground_style: GroundStyle,
        heights: f64,
    ) -> Result<Self, Error> {
        let bounds = ground.bounds();
        let grid = ground.map_grid();
        let nodes = [grid.columns, grid.rows].map(|cells| (cells + 1).min(MOST_NODES));
        let (from, to) = ([bounds.x_min, bounds.y_min], [bounds.x_max, bounds.y_max]);
        let field = HeightField::sampled(from, to, nodes, |x, y| {
            if has_data(ground, [x, y]) { heights * ground.height(x, y) } else { f64::NAN }
        });
        let [low, high] = field.range();
        let base = low - BASE * (to[0] - from[0]).max(to[1] - from[1]);
        // The paths of a scene that was opened are absolute.
        let shapes = obstacle_shapes(settings, ground, Path::new(""), HIGH_ENOUGH)?;
        let lines = line_walls(settings, ground, HIGH_ENOUGH)?;
        let tops = lines.iter().flat_map(|line| line.crest.map(|crest| heights * crest));
        let roof = shapes.iter().map(|shape| shape.bounds[1][2]).chain(tops).fold(high, f64::max);
        let stage = Stage::new([from[0], from[1], base], [to[0], to[1], roof]);
        let colours = natural_colours(&field);
        let walls = |shape| Solid::new(&studio.renderer, &stage, shape, SolidStyle::Opaque(WALLS, 0.1));
        let mut buildings: Vec<Solid> = shapes.iter().map(walls).collect();
        if !lines.is_empty() {
            let thickness = LINE_WIDTH * (to[0] - from[0]).max(to[1] - from[1]);
            let corners = plates(&lines, thickness, heights);
            buildings.push(Solid::of_corners(&studio.renderer, &stage, &corners, SolidStyle::Opaque(WALLS, 0.1)));
        }
        let mut mesh = Terrain::new(&studio.renderer, &stage, field.clone(), &colours, base)?;
        if let GroundStyle::Picture(path) = &ground_style {
            mesh.drape(studio.renderer.gpu(), &ground_style::picture(path)?)?;
        }
        let depth = usual_depth(settings, ground, Path::new(""))?;
        Ok(Self {
            stage,
            ground: mesh,
            buildings,
            floor: Floor::new(&studio.renderer, base),
            field,
            water: Water::default(),
            device_water: None,
            times: None,
            sides: WaterSides::new(&studio.renderer, &stage),
            fluid: None,
            splats: false,
            turbid: (CLEAR / depth).clamp(TURBID[0], TURBID[1]),
            depth: (ground_style == GroundStyle::Depth).then(|| DepthClasses::about(depth, settings.wet_depth_m)),
            blues: ColourTable { low: 0.0, high: 2.0 * depth as f32, colours: BLUES.map(split).to_vec() },
            heights,
        })
    }

    /// Takes the water of a moment, of these sets where it does not lie on the device; false where there is none.
    fn fill_water(&mut self, studio: &Studio, moment: &Moment<'_>, sets: &[ParticleSet]) -> Result<bool, Error> {
        let spacing = moment.on_device.map(|particles| particles.spacing);
        let Some(radius) = spacing.map(|spacing| 0.5 * spacing).or_else(|| mean_radius(sets)) else { return Ok(false) };
        let Self { stage, field, .. } = self;
        let (gpu, time) = (studio.renderer.gpu(), moment.frame.time);
        let within = Some([stage.from, stage.to].map(|corner| [corner.x, corner.y]));
        let style = || FluidStyle { within, ..FluidStyle::water(radius).turbid(self.turbid) };
        // Its style is that of the first particles there are, so that it does not change in a film.
        let fluid = self.fluid.get_or_insert_with(|| studio.fluids.fluid(gpu, stage, style()));
        fluid.splat(self.splats);
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
                sets.iter().flat_map(|set| water.droplets(time, set, |place| field.slope_at(place))).collect();
            self.sides.fill(gpu, field, &droplets);
            fluid.fill(gpu, droplets);
        }
        Ok(true)
    }

    fn disc_style(&self) -> BallStyle {
        BallStyle { shading: Shading::Matt, ..BallStyle::new(self.blues.clone()) }
    }

    /// Particles on the device as balls, coloured by depth as maps are.
    fn discs_of_device(&self, studio: &Studio, particles: &DeviceParticles) -> Result<Balls, Error> {
        let shows = BallsOfDevice { radius: 0.5, raise: self.heights, value: ValueOfDevice::Depth };
        let gpu = studio.renderer.gpu();
        Ok(studio.balls.balls_of_device(gpu, &self.stage, &self.disc_style(), particles, shows)?)
    }

    /// Particles as balls, coloured by depth as maps are.
    fn discs(&self, studio: &Studio, set: &ParticleSet) -> Balls {
        let style = self.disc_style();
        let depths = set.columns.iter().find(|column| column.name == "depth").map(|column| &column.values);
        let depth = |at: usize| match depths {
            Some(Values::Scalar(depths)) => depths[at],
            _ => 0.0,
        };
        let balls = (0..set.len()).map(|at| (set.position[at], set.radius[at], depth(at)));
        studio.balls.balls(studio.renderer.gpu(), &self.stage, &style, balls)
    }

    fn overlay(&self, studio: &Studio, title: &str, moment: &Moment<'_>, is_plan: bool) -> Overlay {
        let time = format!("t = {}", text::time(moment.frame.time));
        let (from, mut to): ([f64; 3], [f64; 3]) = (self.stage.from.into(), self.stage.to.into());
        if is_plan {
            to[2] = from[2];
        }
        let axes = || Axes { from, to, unit: "m".into(), heights: self.heights };
        let blues = || Key::Values("Depth, m".into(), self.blues.clone());
        let simple = (studio.quality == Quality::Simple).then(blues);
        let key = self.depth.as_ref().map(|depth| Key::Kinds(depth.key())).or(simple);
        Overlay {
            title: title.into(),
            time: if self.heights == 1.0 { time } else { format!("{time}, heights × {}", self.heights) },
            key,
            scale_bar: Some("m".into()),
            axes: studio.shows_all().then(axes),
            key_place: if is_plan { KeyPlace::Below } else { KeyPlace::Corner },
            ..Overlay::default()
        }
    }
}

/// Mean radius of the particles, m; none where there are none.
fn mean_radius(sets: &[ParticleSet]) -> Option<f64> {
    let radii = || sets.iter().flat_map(|set| &set.radius);
    (!sets.is_empty()).then(|| radii().sum::<f64>() / radii().count() as f64)
}

/// Particles with their heights drawn so many times higher than they are.
fn raised(set: &ParticleSet, times: f64) -> ParticleSet {
    let mut set = set.clone();
    set.position.iter_mut().for_each(|place| place[2] *= times);
    set
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
