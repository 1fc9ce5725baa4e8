//! Pictures of a gas: to scale on paper in two dimensions, in a bright room in three.

use super::{Moment, OwnView, Studio};
use crate::Error;
use corpuscle_drawing::colour::{VIRIDIS, split};
use corpuscle_drawing::text;
use corpuscle_gpu::Image;
use corpuscle_model::{Container, ParticleSet};
use corpuscle_record::{GasKey, gas_key};
use corpuscle_render::{
    Axes, BallStyle, Balls, Camera, ColourTable, Drawable, Floor, Key, Light, Overlay, Stage, TubeStyle, Tubes,
    box_edges,
};
use corpuscle_scene::{Gas, Units, padded};

/// From where a box in space is seen, radians: to the right of its front, from above; and how wide the lens is.
const DIRECTION: [f64; 2] = [-1.02, 0.36];
const OWN_VIEW: OwnView = OwnView { direction: DIRECTION, field_of_view: 0.5, margin: 0.1, margins: MARGINS };
/// Room for axes in the plane at the sides, below and above, parts of the picture's height.
const MARGINS: [f64; 3] = [0.1, 0.215, 0.09];
/// How far the sun stands to the left of the eye, radians.
const SUN: f64 = -0.9;
/// Ink of edges, and the colour of a ball's way.
const INK: [u8; 3] = [0x46, 0x52, 0x5e];
const WAY: [u8; 3] = [0xc2, 0x18, 0x5b];

/// Draws a gas.
pub(super) struct GasPicture {
    gas: Gas,
}

impl GasPicture {
    pub(super) fn new(gas: Gas) -> Self {
        Self { gas }
    }

    pub(super) fn draw(&self, studio: &Studio, title: &str, moment: &Moment<'_>) -> Result<Image, Error> {
        let size = padded(&self.gas.size);
        let container = moment.container.unwrap_or(Container { from: [0.0; 3], to: size });
        // What moves must not move the camera.
        let stage = Stage::new(
            std::array::from_fn(|k| container.from[k].min(0.0)),
            std::array::from_fn(|k| container.to[k].max(size[k])),
        );
        let flat = self.gas.dimensions() == 2;
        let camera = match flat {
            true => Camera::plan(&stage, studio.aspect(), MARGINS),
            false => studio.camera(&stage, &OWN_VIEW, moment.frame.time),
        };
        let light = if flat { Light::paper() } else { Light::studio().from_azimuth(DIRECTION[0] + SUN) };
        let key = gas_key(&self.gas, moment.frame);
        let mut balls = self.balls(studio, &stage, moment, &key);
        let edges = box_edges(container.from, container.to);
        let mut edges = tubes(studio, &stage, INK, [1.6, 0.0], edges.iter().map(Vec::as_slice));
        let ways = moment.paths.iter().map(|path| {
            let so_far = path.times.partition_point(|time| *time <= moment.frame.time);
            &path.points[..so_far.min(path.points.len())]
        });
        let mut ways = tubes(studio, &stage, WAY, [2.0, 0.002], ways);
        let mut floor = Floor::new(&studio.renderer, &stage, stage.from.z);
        let mut things: Vec<&mut dyn Drawable> = Vec::new();
        if !flat {
            things.push(&mut floor);
        }
        things.extend(balls.iter_mut().map(|set| set as &mut dyn Drawable));
        things.extend([&mut edges as &mut dyn Drawable, &mut ways]);
        studio.take(&stage, &camera, &light, &mut things, &self.overlay(title, moment, &key, container))
    }

    /// The sets of balls, each in its colours.
    fn balls(&self, studio: &Studio, stage: &Stage, moment: &Moment<'_>, key: &GasKey) -> Vec<Balls> {
        let table = |number: usize| match key {
            GasKey::Kinds(kinds) => ColourTable::plain(kinds.get(number).map_or(INK, |(_, colour)| *colour)),
            GasKey::Speed { most, .. } => speeds(*most),
        };
        let speed =
            |set: &ParticleSet, at: usize| set.velocity[at].iter().map(|along| along * along).sum::<f64>().sqrt();
        let sets = moment.frame.sets.iter().enumerate();
        sets.map(|(number, set)| {
            let balls = (0..set.len()).map(|at| (set.position[at], set.radius[at], speed(set, at)));
            studio.balls.balls(studio.renderer.gpu(), stage, &BallStyle::new(table(number)), balls)
        })
        .collect()
    }

    fn overlay(&self, title: &str, moment: &Moment<'_>, key: &GasKey, container: Container) -> Overlay {
        let (unit, time) = match self.gas.units {
            Units::Si => ("m", text::any_time(moment.frame.time)),
            Units::Reduced => ("", text::short_number(moment.frame.time)),
        };
        let key = match key {
            GasKey::Kinds(kinds) => Key::Kinds(kinds.clone()),
            GasKey::Speed { most, unit: "" } => Key::Values("Speed".into(), speeds(*most)),
            GasKey::Speed { most, unit } => Key::Values(format!("Speed, {unit}"), speeds(*most)),
        };
        Overlay {
            title: title.into(),
            time: format!("t = {time}"),
            key: Some(key),
            scale_bar: None,
            axes: Some(Axes { from: container.from, to: container.to, unit: unit.into(), heights: 1.0 }),
        }
    }
}

/// The colours of speeds.
fn speeds(most: f64) -> ColourTable {
    ColourTable { low: 0.0, high: most as f32, colours: VIRIDIS.map(split).to_vec() }
}

/// Lines of a colour; `thick` is their radius in samples, and as a part of the stage.
fn tubes<'a>(
    studio: &Studio,
    stage: &Stage,
    colour: [u8; 3],
    thick: [f64; 2],
    lines: impl IntoIterator<Item = &'a [[f64; 3]]>,
) -> Tubes {
    let samples = f64::from(studio.target.samples) * f64::from(studio.target.size[1]) / 1080.0;
    let style = TubeStyle {
        colour,
        radius: thick[1] * stage.unit(),
        least_radius: (0.5 * thick[0] * samples) as f32,
        shaded: thick[1] > 0.0,
    };
    studio.tubes.tubes(studio.renderer.gpu(), stage, &style, lines)
}
