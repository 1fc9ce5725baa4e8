//! Section of the air round solids with different boundary treatments: to scale, air coloured by temperature.

use super::{MATT, caps};
use crate::Error;
use crate::pictures::{CameraOffset, DrawContext, Moment, Quality, Shown};
use corpuscle_dew::humid_air::ZERO_CELSIUS;
use corpuscle_drawing::colour::{VIRIDIS, split};
use corpuscle_drawing::text;
use corpuscle_model::{ParticleSet, Surface, Values};
use corpuscle_render::{
    Axes, BallStyle, BallsOfDevice, Camera, ColourTable, Drawable, Key, KeyPosition, Light, Overlay, Shading, Solid,
    SolidStyle, Stage, ValueOfDevice,
};
use corpuscle_scene::Dew;

/// At the left, at the right, below and above the box, parts of the picture's height.
const MARGINS: [f64; 4] = [0.13, 0.4, 0.12, 0.095];
/// Radius of a ball of air, part of the spacing.
pub(super) const RADIUS: f64 = 0.3;

/// What a section shows.
pub(super) struct Section {
    pub stage: Stage,
    /// The colours of temperatures of air, degrees Celsius.
    pub colours: ColourTable,
    /// Names of the solids, each before its solid.
    labels: Vec<([f64; 3], String)>,
}

/// Draws the section.
pub(crate) struct SectionPicture {
    section: Section,
    solids: Vec<Solid>,
    radius: f64,
}

impl Section {
    pub fn new(dew: &Dew, surfaces: &[Surface]) -> Self {
        let of_solids = surfaces.iter().filter_map(|surface| surface.scalar("temperature_k")).flatten();
        let low = of_solids.map(|kelvin| kelvin - ZERO_CELSIUS).fold(dew.air.temperature_c - 1.0, f64::min);
        let colours =
            ColourTable { low: low as f32, high: dew.air.temperature_c as f32, colours: VIRIDIS.map(split).to_vec() };
        let label = |surface: &Surface| {
            let [low, high] = surface.shape.bounds;
            (std::array::from_fn(|k| 0.5 * (low[k] + high[k])), surface.name.clone())
        };
        let labels = surfaces.iter().map(label).collect();
        Self { stage: Stage::new([0.0; 3], dew.size_m), colours, labels }
    }

    /// The camera before it.
    pub fn camera(&self, camera_offset: &CameraOffset, aspect: f64) -> Camera {
        camera_offset.moved(Camera::front(&self.stage, aspect, MARGINS))
    }

    pub fn overlay(&self, title: &str, time: f64) -> Overlay {
        let (from, to) = (self.stage.from.into(), self.stage.to.into());
        Overlay {
            title: title.into(),
            time: format!("t = {}", text::time(time)),
            key: Some(Key::Values("Temperature of the air, °C".into(), self.colours.clone())),
            key_position: KeyPosition::Beside,
            labels: self.labels.clone(),
            axes: Some(Axes { from, to, unit: "m".into(), heights: 1.0 }),
            ..Overlay::default()
        }
    }
}

impl SectionPicture {
    pub(super) fn new(context: &DrawContext, dew: &Dew, surfaces: &[Surface]) -> Self {
        let section = Section::new(dew, surfaces);
        let style = SolidStyle::Opaque(MATT, 0.3);
        let solid = |surface: &Surface| Solid::new(&context.renderer, &section.stage, &surface.shape, style);
        let solids = surfaces.iter().map(solid).collect();
        Self { section, solids, radius: RADIUS * dew.spacing_m }
    }

    pub(super) fn draw(&mut self, context: &DrawContext, title: &str, moment: &Moment<'_>) -> Result<Shown, Error> {
        let gpu = context.renderer.gpu();
        let stage = self.section.stage;
        let camera = self.section.camera(&context.camera_offset, context.aspect());
        let sets = |name: &'static str| moment.frame.sets.iter().filter(move |set| set.name == name);
        let shading = if context.quality == Quality::Simple { Shading::Matt } else { Shading::Full };
        let style = BallStyle { gloss: 0.4, shading, ..BallStyle::new(self.section.colours.clone()) };
        let mut air = match moment.on_device {
            Some(air) => {
                let shows = BallsOfDevice { radius: RADIUS, raise: 1.0, value: ValueOfDevice::Temperature };
                context.balls.balls_of_device(gpu, &stage, &style, air, shows)?
            }
            None => {
                let balls = |(position, kelvin): (&[f64; 3], &f64)| (*position, self.radius, kelvin - ZERO_CELSIUS);
                let air = sets("air").flat_map(|set| set.position.iter().zip(temperatures(set)).map(balls));
                context.balls.balls(gpu, &stage, &style, air)
            }
        };
        let mut drops = context.caps.caps(gpu, &stage, sets("drops").flat_map(caps), []);
        let overlay = self.section.overlay(title, moment.frame.time);
        let mut things: Vec<&mut dyn Drawable> = vec![&mut air];
        things.extend(self.solids.iter_mut().map(|solid| solid as &mut dyn Drawable));
        things.push(&mut drops);
        context.take(&stage, &camera, &context.lit(Light::studio().from_azimuth(-2.2)), &mut things, overlay)
    }
}

pub(super) fn temperatures(set: &ParticleSet) -> &[f64] {
    match set.columns.iter().find(|column| column.name == "temperature").map(|column| &column.values) {
        Some(Values::Scalar(values)) => values,
        _ => &[],
    }
}
