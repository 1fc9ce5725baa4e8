//! Pictures of particles in a box, for models without their own: in a bright room, or on paper where all lie in one plane.

use super::{Disc, DrawContext, Moment, OwnView, Quality, Scenery, Shown, Sketch, SketchView, Sketcher, Subject};
use crate::Error;
use corpuscle_drawing::text;
use corpuscle_model::{Container, Frame, ParticleSet};
use corpuscle_render::{Axes, BallStyle, Balls, ColourTable, Drawable, Floor, Key, Light, Overlay, Shading, Stage};

/// Default azimuth and elevation of the camera, radians: to the right of the front, from above.
pub(super) const DIRECTION: [f64; 2] = [-1.02, 0.36];
/// Margin for axes.
const OWN_VIEW: OwnView =
    OwnView { direction: DIRECTION, field_of_view: 0.5, margin: 0.085, margins: [0.11, 0.11, 0.14, 0.1] };
/// Azimuth of the sun to the left of the camera, radians.
pub(super) const SUN: f64 = -0.9;
/// Least radius of a particle, fraction of the picture's height.
const LEAST_RADIUS: f64 = 0.004;
/// Margin round particles without a box, fraction of their extent.
const ROOM: f64 = 0.1;
/// The colours of sets, distinct without full colour vision too (Okabe & Ito 2008).
const COLOURS: [[u8; 3]; 6] =
    [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [230, 159, 0], [86, 180, 233]];

/// Draws the particles of a frame as balls, each set in a colour.
pub struct Particles {
    has_si_units: bool,
    /// The box of the first moment that was drawn.
    stage: Option<Stage>,
    floor: Option<Floor>,
}

impl Particles {
    /// The pictures of a scene.
    pub fn new(scenery: &Scenery) -> Self {
        Self { has_si_units: scenery.has_si_units, stage: None, floor: None }
    }

    fn overlay(&self, title: &str, frame: &Frame, stage: &Stage) -> Overlay {
        let (unit, time) = match self.has_si_units {
            true => ("m", text::any_time(frame.time)),
            false => ("", text::short_number(frame.time)),
        };
        let kinds = frame.sets.iter().zip(COLOURS.iter().cycle());
        let kinds: Vec<_> = kinds.map(|(set, colour)| (set.name.clone(), *colour)).collect();
        Overlay {
            title: title.into(),
            time: format!("t = {time}"),
            key: (kinds.len() > 1).then_some(Key::Kinds(kinds)),
            axes: Some(Axes { from: stage.from.into(), to: stage.to.into(), unit: unit.into(), heights: 1.0 }),
            ..Overlay::default()
        }
    }
}

impl Subject for Particles {
    fn draw(&mut self, context: &DrawContext, title: &str, moment: &Moment<'_>) -> Result<Shown, Error> {
        let stage = *self.stage.get_or_insert_with(|| stage_of(moment));
        let is_flat = stage.from.z == stage.to.z;
        let light = match is_flat {
            true => Light::paper_of(context.paper),
            false => context.lit(Light::studio().from_azimuth(DIRECTION[0] + SUN)),
        };
        let camera = context.seen(&stage, &OWN_VIEW, moment.frame.time, is_flat);
        let shading = match (is_flat, context.quality) {
            (true, _) => Shading::Discs,
            (false, Quality::Simple) => Shading::Matt,
            (false, Quality::Full) => Shading::Full,
        };
        let samples = f64::from(context.target.size[1] * context.target.samples);
        let balls = |(set, colour): (&ParticleSet, &[u8; 3])| {
            let least_radius = (LEAST_RADIUS * samples) as f32;
            let style = BallStyle { shading, least_radius, ..BallStyle::new(ColourTable::plain(*colour)) };
            let each = (0..set.len()).map(|at| (set.position[at], set.radius[at], 0.0));
            context.balls.balls(context.renderer.gpu(), &stage, &style, each)
        };
        let mut sets: Vec<Balls> = moment.frame.sets.iter().zip(COLOURS.iter().cycle()).map(balls).collect();
        let overlay = self.overlay(title, moment.frame, &stage);
        let mut things: Vec<&mut dyn Drawable> = sets.iter_mut().map(|set| set as &mut dyn Drawable).collect();
        if !is_flat && context.quality == Quality::Full {
            things.push(self.floor.get_or_insert_with(|| Floor::new(&context.renderer, stage.from.z)));
        }
        context.take(&stage, &camera, &light, &mut things, overlay)
    }
}

impl Sketcher for Particles {
    fn sketch(&mut self, seen: &SketchView, title: &str, moment: &Moment<'_>) -> Sketch {
        let stage = *self.stage.get_or_insert_with(|| stage_of(moment));
        let is_flat = stage.from.z == stage.to.z;
        let camera = if is_flat { seen.plan(&stage, OWN_VIEW.margins) } else { seen.orbit(&stage, &OWN_VIEW) };
        let discs = |(set, colour): (&ParticleSet, &[u8; 3])| {
            let positions = set.position.iter().zip(&set.radius);
            positions
                .map(|(position, radius)| Disc { position: *position, radius: *radius, colour: *colour, has_rim: true })
                .collect::<Vec<_>>()
        };
        let discs = moment.frame.sets.iter().zip(COLOURS.iter().cycle()).flat_map(discs).collect();
        let overlay = self.overlay(title, moment.frame, &stage);
        Sketch { shown: seen.shown(stage, camera, overlay), patches: Vec::new(), discs, lines: Vec::new() }
    }
}

/// The box of a model, or one round its particles.
fn stage_of(moment: &Moment<'_>) -> Stage {
    if let Some(Container { from, to }) = moment.container {
        return Stage::new(from, to);
    }
    let positions = || moment.frame.sets.iter().flat_map(|set| &set.position);
    let end = |pick: fn(f64, f64) -> f64, start: f64| -> [f64; 3] {
        std::array::from_fn(|axis| positions().map(|at| at[axis]).fold(start, pick))
    };
    if positions().next().is_none() {
        return Stage::new([0.0; 3], [1.0; 3]);
    }
    let [from, to] = [end(f64::min, f64::INFINITY), end(f64::max, f64::NEG_INFINITY)];
    let size = (0..3).map(|axis| to[axis] - from[axis]).fold(0.0, f64::max).max(1e-9);
    let room = |axis: usize| if from[axis] == to[axis] && axis == 2 { 0.0 } else { ROOM * size };
    Stage::new(std::array::from_fn(|axis| from[axis] - room(axis)), std::array::from_fn(|axis| to[axis] + room(axis)))
}
