//! Pictures of a gas: to scale on paper in two dimensions, in a bright room in three.

mod page;
mod sides;
mod sketch;

use super::particles::{DIRECTION, SUN};
use super::{DrawContext, Moment, OwnView, Quality, Shown, Subject};
use crate::Error;
use corpuscle_drawing::colour::{VIRIDIS, split};
use corpuscle_model::{Container, Frame, ParticleSet, Path};
use corpuscle_output::{GasKey, gas_key};
use corpuscle_render::{
    BallStyle, Balls, Camera, ColourTable, Drawable, Floor, KeyPosition, Lens, Light, Shading, Stage, TubeStyle, Tubes,
};
use corpuscle_scene::{Gas, padded};
use sides::Plates;

/// Margin for axes in three dimensions, fraction of the picture.
const OWN_VIEW: OwnView =
    OwnView { direction: DIRECTION, field_of_view: 0.5, margin: 0.085, margins: [0.12, 0.12, 0.16, 0.09] };
/// Margins in two dimensions: left, right, below and above, fractions of the height; with the legend beside the box, and below it.
const BESIDE: [f64; 4] = [0.11, 0.38, 0.095, 0.095];
const BELOW: [f64; 4] = [0.11, 0.06, 0.16, 0.095];
/// The same where the window draws the legend above the box.
const IN_WINDOW: [f64; 4] = [0.12, 0.05, 0.12, 0.11];
/// Most entries of a legend in a row.
const MOST_IN_A_ROW: usize = 4;
/// Least radius of a ball that is drawn, pixels of a picture 1080 pixels high, in the plane and in space; and in any picture.
const LEAST_RADIUS: [f64; 2] = [2.4, 4.5];
const LEAST_OF_ALL: f64 = 1.2;
/// Largest radius of enlarged balls over the mean distance between them.
const CLOSEST: f64 = 0.2;
/// Colours of edges and of trajectories.
const INK: [u8; 3] = [0x46, 0x52, 0x5e];
const TRAJECTORY: [u8; 3] = [0xc2, 0x18, 0x5b];
const REGION: [u8; 3] = [0x00, 0x70, 0x5f];

/// Draws a gas.
pub(crate) struct GasPicture {
    gas: Gas,
    plates: Plates,
    /// Made when it is first needed.
    floor: Option<Floor>,
}

/// Camera and stage of one picture.
struct View {
    stage: Stage,
    camera: Camera,
    container: Container,
    key_position: KeyPosition,
}

impl Subject for GasPicture {
    fn lift_partition(&mut self, time: f64) {
        self.lift(time);
    }

    fn draw(&mut self, context: &DrawContext, title: &str, moment: &Moment<'_>) -> Result<Shown, Error> {
        let key = gas_key(&self.gas, moment.frame);
        let view = self.view(context, moment, &key);
        let flat = self.gas.dimensions() == 2;
        let light = match flat {
            true => Light::paper_of(context.paper),
            false => context.lit(Light::studio().from_azimuth(DIRECTION[0] + SUN)),
        };
        let overlay = self.overlay(title, moment, &key, &view, self.remark(context, moment, &view));
        let stage = &view.stage;
        let mut balls = self.balls(context, &view, moment, &key);
        let trajectories = moment.paths.iter().map(|path| so_far(path, moment.frame.time));
        let mut trajectories = tubes(context, stage, TRAJECTORY, [2.2, 0.002], trajectories);
        let mut things: Vec<&mut dyn Drawable> = Vec::new();
        let mut edges = sides::edges(&self.gas, context, &view);
        things.extend(balls.iter_mut().map(|set| set as &mut dyn Drawable));
        things.push(&mut trajectories);
        if !flat {
            if context.quality == Quality::Full && !context.target.transparent {
                let floor = self.floor.get_or_insert_with(|| Floor::new(&context.renderer, stage.from.z));
                floor.lay_at(stage.from.z);
                things.push(floor);
            }
            things.extend(edges.iter_mut().map(|edges| edges as &mut dyn Drawable));
            things.extend(self.plates.of(&self.gas, context, &view, moment.frame.time));
        }
        context.take(stage, &view.camera, &light, &mut things, overlay)
    }
}

impl GasPicture {
    pub(crate) fn new(gas: Gas) -> Self {
        Self { gas, plates: Plates::default(), floor: None }
    }

    /// Notes that the partition was lifted at a time, s.
    fn lift(&mut self, time: f64) {
        if let Some(partition) = &mut self.gas.partition {
            partition.lifted_at_s = Some(partition.lifted_at_s.map_or(time, |planned| planned.min(time)));
        }
    }

    /// The camera. Moving walls do not move it.
    fn view(&self, context: &DrawContext, moment: &Moment<'_>, key: &GasKey) -> View {
        let (stage, container) = self.stage(moment);
        let aspect = context.aspect();
        if self.gas.dimensions() > 2 {
            let camera = context.camera(&stage, &OWN_VIEW, moment.frame.time);
            return View { stage, camera, container, key_position: KeyPosition::Corner };
        }
        if !context.overlaid {
            let camera = context.camera_offset.moved(Camera::plan(&stage, aspect, IN_WINDOW));
            return View { stage, camera, container, key_position: KeyPosition::Corner };
        }
        let positions = [(KeyPosition::Below, BELOW), (KeyPosition::Beside, BESIDE)];
        let [below, beside] = positions.map(|(key_position, margins)| View {
            stage,
            camera: context.camera_offset.moved(Camera::plan(&stage, aspect, margins)),
            container,
            key_position,
        });
        let many = matches!(key, GasKey::Kinds(kinds) if kinds.len() > MOST_IN_A_ROW);
        if many || shown_height(&beside.camera) < shown_height(&below.camera) { beside } else { below }
    }

    /// The stage, and the box, which may be smaller.
    fn stage(&self, moment: &Moment<'_>) -> (Stage, Container) {
        let size = padded(&self.gas.size);
        let container = moment.container.unwrap_or(Container { from: [0.0; 3], to: size });
        let stage = Stage::new(
            std::array::from_fn(|k| container.from[k].min(0.0)),
            std::array::from_fn(|k| container.to[k].max(size[k])),
        );
        (stage, container)
    }

    /// The colours of a set of balls, whose values are speeds where there is one set.
    fn colours(number: usize, key: &GasKey) -> ColourTable {
        match key {
            GasKey::Kinds(kinds) => ColourTable::plain(kinds.get(number).map_or(INK, |(_, colour)| *colour)),
            GasKey::Speed { most, .. } => speeds(*most),
        }
    }

    /// The sets of balls, each in its colours.
    fn balls(&self, context: &DrawContext, view: &View, moment: &Moment<'_>, key: &GasKey) -> Vec<Balls> {
        let shading = match (self.gas.dimensions(), context.quality) {
            (2, _) => Shading::Discs,
            (_, Quality::Simple) => Shading::Matt,
            (_, Quality::Full) => Shading::Full,
        };
        let style = |number: usize| BallStyle {
            shading,
            least_radius: self.least_radius(context, moment.frame, view) as f32,
            ..BallStyle::new(Self::colours(number, key))
        };
        let sets = moment.frame.sets.iter().enumerate();
        sets.map(|(number, set)| {
            let balls = (0..set.len()).map(|at| (set.position[at], set.radius[at], speed(set, at)));
            context.balls.balls(context.renderer.gpu(), &view.stage, &style(number), balls)
        })
        .collect()
    }

    /// Least drawn radius of a ball, samples: visible, but not so large that balls overlap.
    fn least_radius(&self, context: &DrawContext, frame: &Frame, view: &View) -> f64 {
        let dimensions = self.gas.dimensions();
        let of_1080 = LEAST_RADIUS[usize::from(dimensions > 2)];
        let samples = f64::from(context.target.samples);
        let seen = (of_1080 * f64::from(context.target.size[1]) / 1080.0).max(LEAST_OF_ALL) * samples;
        let room: f64 = (0..dimensions).map(|k| view.container.to[k] - view.container.from[k]).product();
        let count = frame.sets.iter().map(ParticleSet::len).sum::<usize>().max(1) as f64;
        let spacing = (room / count).powf(1.0 / dimensions as f64);
        seen.min(CLOSEST * spacing / sample_height(context, view)).max(0.5 * samples)
    }

    /// Enlargement of the smallest ball.
    fn enlarged(&self, context: &DrawContext, frame: &Frame, view: &View) -> f64 {
        let smallest = frame.sets.iter().flat_map(|set| &set.radius).copied().fold(f64::INFINITY, f64::min);
        (self.least_radius(context, frame, view) * sample_height(context, view) / smallest).max(1.0)
    }
}

/// Speed of a ball of a set.
fn speed(set: &ParticleSet, at: usize) -> f64 {
    set.velocity[at].iter().map(|along| along * along).sum::<f64>().sqrt()
}

/// The part of a trajectory before a time, s.
fn so_far(path: &Path, time: f64) -> &[[f64; 3]] {
    let count = path.times.partition_point(|at| *at <= time);
    &path.points[..count.min(path.points.len())]
}

/// Height of a sample in the middle of the stage, m.
fn sample_height(context: &DrawContext, view: &View) -> f64 {
    let tall = match view.camera.lens {
        Lens::Orthographic { height } => height,
        Lens::Perspective { field_of_view } => {
            2.0 * (view.camera.eye - view.camera.target).length() * (0.5 * field_of_view).tan()
        }
    };
    tall / f64::from(context.target.size[1] * context.target.samples)
}

/// Height of the world in a picture to scale, m.
fn shown_height(camera: &Camera) -> f64 {
    match camera.lens {
        Lens::Orthographic { height } => height,
        Lens::Perspective { .. } => f64::INFINITY,
    }
}

/// The colours of speeds.
fn speeds(most: f64) -> ColourTable {
    ColourTable { low: 0.0, high: most as f32, colours: VIRIDIS.map(split).to_vec() }
}

/// Lines of a colour; `thick` is their width in pixels of a picture 1080 pixels high, and their radius as a part of the stage.
fn tubes<'a>(
    context: &DrawContext,
    stage: &Stage,
    colour: [u8; 3],
    thick: [f64; 2],
    lines: impl IntoIterator<Item = &'a [[f64; 3]]>,
) -> Tubes {
    let samples = f64::from(context.target.samples) * f64::from(context.target.size[1]) / 1080.0;
    let style = TubeStyle {
        colour,
        radius: thick[1] * stage.unit(),
        least_radius: (0.5 * thick[0] * samples) as f32,
        shaded: thick[1] > 0.0,
    };
    context.tubes.tubes(context.renderer.gpu(), stage, &style, lines)
}
