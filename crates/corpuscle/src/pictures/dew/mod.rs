//! Pictures of dew: drops on solids in a dim room, against which they show; and air round solids, where ways to keep it out are
//! compared.

mod section;

use super::{Moment, OwnView, Shown, Studio, Subject};
use crate::Error;
use crate::models::dew::shows_air;
use corpuscle_drawing::text;
use corpuscle_model::{ParticleSet, Surface, Values};
use corpuscle_render::{Axes, Cap, Drawable, Floor, Light, Overlay, Solid, SolidStyle, Stage};
use corpuscle_scene::Dew;
use corpuscle_scene::dew::Material;
use section::Section;

/// How far beside the way that the wet side looks the eye stands, and how high, radians; and how wide the lens is.
const BESIDE: f64 = 0.45;
const RAISED: f64 = 0.2;
const FIELD_OF_VIEW: f64 = 0.5;
const MARGIN: f64 = 0.09;
/// How far the sun stands to the left of the eye, radians.
const SUN: f64 = -1.0;
/// From where solids are seen that look to no side together, radians.
const NO_SIDE: f64 = -1.9;
/// The clearest glass still takes a little, most of it red.
const GLASS: [u8; 3] = [232, 242, 238];
/// What is not glass.
const MATT: [u8; 3] = [150, 152, 156];

/// Draws dew.
pub(crate) enum DewPicture {
    Room(Room),
    Section(Section),
}

impl DewPicture {
    pub(crate) fn new(studio: &Studio, dew: &Dew, surfaces: &[Surface]) -> Self {
        match shows_air(dew) {
            true => Self::Section(Section::new(studio, dew, surfaces)),
            false => Self::Room(Room::new(studio, dew, surfaces)),
        }
    }
}

impl Subject for DewPicture {
    fn draw(&mut self, studio: &Studio, title: &str, moment: &Moment<'_>) -> Result<Shown, Error> {
        match self {
            Self::Room(room) => room.draw(studio, title, moment),
            Self::Section(section) => section.draw(studio, title, moment),
        }
    }

    fn draws_from_device(&self) -> bool {
        matches!(self, Self::Section(_))
    }
}

/// Drops on solids.
pub(crate) struct Room {
    stage: Stage,
    solids: Vec<Solid>,
    floor: Floor,
    /// From where it is seen, radians.
    azimuth: f64,
}

impl Room {
    fn new(studio: &Studio, dew: &Dew, surfaces: &[Surface]) -> Self {
        let corner = |pick: fn(f64, f64) -> f64, side: usize, start: f64| {
            std::array::from_fn(|k| surfaces.iter().map(|surface| surface.shape.bounds[side][k]).fold(start, pick))
        };
        let stage = match surfaces {
            [] => Stage::new([0.0; 3], dew.size_m),
            _ => Stage::new(corner(f64::min, 0, f64::INFINITY), corner(f64::max, 1, f64::NEG_INFINITY)),
        };
        let style = |surface: &Surface| {
            let solid = dew.solid.iter().find(|solid| solid.name == surface.name);
            solid.map_or(SolidStyle::Opaque(MATT, 0.6), |solid| style(&solid.material))
        };
        let solids =
            surfaces.iter().map(|surface| Solid::new(&studio.renderer, &stage, &surface.shape, style(surface)));
        let floor = Floor::new(&studio.renderer, stage.from.z - 0.002 * stage.unit());
        Self { solids: solids.collect(), floor, azimuth: wet_side(surfaces) + BESIDE, stage }
    }

    fn draw(&mut self, studio: &Studio, title: &str, moment: &Moment<'_>) -> Result<Shown, Error> {
        let own = OwnView {
            direction: [self.azimuth, RAISED],
            field_of_view: FIELD_OF_VIEW,
            margin: MARGIN,
            margins: [2.0 * MARGIN; 4],
        };
        let camera = studio.camera(&self.stage, &own, moment.frame.time);
        let light = studio.lit(Light::dim_room().from_azimuth(self.azimuth + SUN));
        let drops: Vec<Cap> = moment.frame.sets.iter().filter(|set| set.name == "drops").flat_map(caps).collect();
        let faces_eye = |cap: &&Cap| {
            let eye: [f64; 3] = camera.eye.into();
            (0..3).map(|k| cap.normal[k] * (eye[k] - cap.position[k])).sum::<f64>() > 0.0
        };
        let gpu = studio.renderer.gpu();
        // Those on the far side are seen through the solid, so they come before it.
        let far = drops.iter().filter(|cap| !faces_eye(cap)).copied();
        let mut far = studio.caps.caps(gpu, &self.stage, far);
        let mut near = studio.caps.caps(gpu, &self.stage, drops.iter().filter(faces_eye).copied());
        let mut things: Vec<&mut dyn Drawable> = vec![&mut self.floor, &mut far];
        things.extend(self.solids.iter_mut().map(|solid| solid as &mut dyn Drawable));
        things.push(&mut near);
        let overlay = Overlay {
            title: title.into(),
            time: format!("t = {}", text::time(moment.frame.time)),
            axes: Some(Axes { from: self.stage.from.into(), to: self.stage.to.into(), unit: "m".into(), heights: 1.0 }),
            ..Overlay::default()
        };
        studio.take(&self.stage, &camera, &light, &mut things, overlay)
    }
}

/// What a solid of a material looks like.
fn style(material: &Material) -> SolidStyle {
    let Material::Named(name) = material else { return SolidStyle::Opaque(MATT, 0.6) };
    match name.as_str() {
        "glass" | "pmma" | "polycarbonate" => SolidStyle::Glass(GLASS),
        "oak" | "wood" => SolidStyle::Opaque([150, 105, 66], 0.35),
        "copper" => SolidStyle::Opaque([184, 115, 62], 1.0),
        "concrete" => SolidStyle::Opaque([150, 146, 138], 0.0),
        _ => SolidStyle::Opaque(MATT, 0.6),
    }
}

/// The azimuth that the wet patches of all solids look to, where they look anywhere together.
fn wet_side(surfaces: &[Surface]) -> f64 {
    let mut sum = [0.0; 2];
    for surface in surfaces {
        for (normal, half_width) in surface.normal.iter().zip(&surface.half_width) {
            (0..2).for_each(|k| sum[k] += normal[k] * half_width * half_width);
        }
    }
    let area: f64 = surfaces.iter().flat_map(|surface| &surface.half_width).map(|half| half * half).sum();
    if sum[0].hypot(sum[1]) > 0.2 * area { sum[1].atan2(sum[0]) } else { NO_SIDE }
}

/// The drops of a set.
fn caps(set: &ParticleSet) -> Vec<Cap> {
    let column = |name: &str| set.columns.iter().find(|column| column.name == name).map(|column| &column.values);
    let (Some(Values::Scalar(heights)), Some(Values::Vector(normals))) = (column("height"), column("normal")) else {
        return Vec::new();
    };
    let drops = set.position.iter().zip(&set.radius).zip(heights.iter().zip(normals));
    drops
        .map(|((position, radius), (height, normal))| Cap {
            position: *position,
            radius: *radius,
            normal: *normal,
            height: *height,
        })
        .collect()
}
